"""A Husky on level ground: publishes its sensors and obeys `cmd_vel`, by a wire that is rclpy or another DDS."""

import math
import threading
import time

import numpy as np

NAMESPACE = "/a200_0000"
SENSOR_HEIGHT_M = 0.8
BASE_HEIGHT_M = 0.165
RINGS = 16
COLUMNS = 1800
POINT = np.dtype(
    [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")]
)
CLOUD_BYTES = RINGS * COLUMNS * POINT.itemsize
assert CLOUD_BYTES == 633_600


def level_ground():
    """Ranges and directions of a VLP-16 that stands level; what looks up meets a wall 30 m away."""
    elevation = np.radians(np.linspace(-15.0, 15.0, RINGS))
    azimuth = np.linspace(-math.pi, math.pi, COLUMNS, endpoint=False)
    elevation, azimuth = np.meshgrid(elevation, azimuth)
    elevation, azimuth = elevation.ravel(), azimuth.ravel()
    with np.errstate(divide="ignore"):
        ground_m = np.where(elevation < 0.0, -SENSOR_HEIGHT_M / np.sin(elevation), np.inf)
    range_m = np.minimum(ground_m, 30.0 / np.cos(elevation))
    directions = np.stack(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], axis=1
    )
    return range_m, directions


class Robot:
    """The robot. Faults are switched on by its attributes."""

    def __init__(self, wire):
        self.wire, self.messages = wire, wire.messages
        self.x = self.y = self.yaw = 0.0
        self.speed = self.turn_rate = 0.0
        self.is_scanning = self.is_turning_wheels = self.is_feeling = True
        self.is_pressed = self.is_simulated = False
        self.roll = 0.0
        self.shift = 0.0
        self.is_cloud_whole = True
        self.commands = []  # arrival, speed, turn rate
        self.decisions = []  # arrival, stamp
        self.scans = []  # when sent, stamp
        self.ticks = []  # when it published anything
        self.diagnosis = None
        self.slowest_ms = []  # when told, from a scan's arrival to its command, the longest since told before
        messages = self.messages
        self.scan = self.scan_publisher(is_reliable=False)
        self.odometry = wire.publisher(messages.Odometry, "platform/odom/filtered")
        self.imu = wire.publisher(messages.Imu, "sensors/imu_0/data", is_reliable=False)
        self.stop = wire.publisher(messages.Bool, "platform/emergency_stop", is_reliable=False)
        self.reset = wire.publisher(messages.Bool, "mapless/reset")
        self.goal = wire.publisher(messages.PoseStamped, "goal_pose")
        self.clock = wire.publisher(messages.Clock, "/clock")
        wire.subscribe(messages.TwistStamped, "cmd_vel", self.obey)
        wire.subscribe(messages.TwistStamped, "mapless/decision", self.note)
        wire.subscribe(messages.DiagnosticArray, "diagnostics", self.diagnose)
        self.range_m, self.directions = level_ground()
        self.random = np.random.default_rng(1)
        self.points = np.zeros(RINGS * COLUMNS, dtype=POINT)
        self.points["ring"] = np.tile(np.arange(RINGS), COLUMNS)
        self.points["time"] = np.repeat(np.linspace(-0.1, 0.0, COLUMNS), RINGS)

    def start(self):
        """Begins to publish and to hear, in threads."""
        self.wire.spin()
        threading.Thread(target=self.publish_all, daemon=True).start()

    def scan_publisher(self, is_reliable):
        return self.wire.publisher(self.messages.PointCloud2, "sensors/lidar3d_0/points", is_reliable)

    def obey(self, message):
        twist = message.twist
        self.commands.append((time.monotonic(), twist.linear.x, twist.angular.z))
        self.speed, self.turn_rate = twist.linear.x, twist.angular.z

    def note(self, message):
        self.decisions.append((time.monotonic(), (message.header.stamp.sec, message.header.stamp.nanosec)))

    def diagnose(self, message):
        self.diagnosis = message.status[0]
        values = {entry.key: entry.value for entry in self.diagnosis.values}
        if "slowest scan to command, ms" in values:
            self.slowest_ms.append((time.monotonic(), float(values["slowest scan to command, ms"])))

    def publish_all(self):
        """Every 10 ms: the IMU; every second time odometry; every tenth a scan and the emergency stop."""
        tick, due = 0, time.monotonic()
        while True:
            self.ticks.append(time.monotonic())
            self.move(0.01)
            if self.is_simulated:
                self.clock.publish(self.messages.Clock(clock=self.wire.now()))
            if self.is_feeling:
                self.publish_imu()
            if tick % 2 == 0 and self.is_turning_wheels:
                self.publish_odometry()
            if tick % 10 == 0:
                self.stop.publish(self.messages.Bool(data=self.is_pressed))
                if self.is_scanning:
                    self.publish_scan()
            tick += 1
            due += 0.01
            time.sleep(max(0.0, due - time.monotonic()))

    def move(self, seconds):
        # As the platform does, when commands cease.
        if not self.commands or time.monotonic() - self.commands[-1][0] > 0.5:
            self.speed = self.turn_rate = 0.0
        self.x += seconds * self.speed * math.cos(self.yaw)
        self.y += seconds * self.speed * math.sin(self.yaw)
        self.yaw += seconds * self.turn_rate

    def publish_imu(self):
        imu = self.messages.Imu()
        imu.header.stamp, imu.header.frame_id = self.wire.now(), "imu_0_link"
        imu.orientation.x, imu.orientation.w = math.sin(0.5 * self.roll), math.cos(0.5 * self.roll)
        noise = self.random.normal(0.0, 0.001, 4)
        imu.angular_velocity.x, imu.angular_velocity.y = float(noise[0]), float(noise[1])
        imu.angular_velocity.z = float(self.turn_rate + noise[2])
        imu.linear_acceleration.z = float(9.81 + noise[3])
        self.imu.publish(imu)

    def publish_odometry(self):
        odometry = self.messages.Odometry()
        odometry.header.stamp, odometry.header.frame_id = self.wire.now(), "odom"
        odometry.child_frame_id = "base_link"
        pose = odometry.pose.pose
        pose.position.x, pose.position.y = self.x + self.shift, self.y
        pose.orientation.z, pose.orientation.w = math.sin(0.5 * self.yaw), math.cos(0.5 * self.yaw)
        odometry.twist.twist.linear.x = self.speed
        odometry.twist.twist.angular.z = self.turn_rate
        self.odometry.publish(odometry)

    def publish_scan(self):
        range_m = self.range_m + self.random.normal(0.0, 0.005, len(self.range_m))
        places = self.directions * range_m[:, None]
        self.points["x"], self.points["y"], self.points["z"] = places.T
        cloud, field = self.messages.PointCloud2(), self.messages.PointField
        cloud.header.stamp, cloud.header.frame_id = self.wire.now(), "lidar3d_0_laser"
        cloud.height, cloud.width, cloud.point_step = 1, len(self.points), POINT.itemsize
        cloud.row_step = CLOUD_BYTES
        types = {"<f4": field.FLOAT32, "<u2": field.UINT16}
        for name, (kind, offset) in POINT.fields.items():
            cloud.fields.append(field(name=name, offset=offset, datatype=types[kind.str], count=1))
        data = self.points.tobytes()
        cloud.data = data if self.is_cloud_whole else data[: CLOUD_BYTES // 3]
        cloud.is_dense = True
        self.scans.append((time.monotonic(), (cloud.header.stamp.sec, cloud.header.stamp.nanosec)))
        self.scan.publish(cloud)

    def send_goal(self, x, y):
        goal = self.messages.PoseStamped()
        goal.header.frame_id = "odom"
        goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.w = float(x), float(y), 1.0
        self.goal.publish(goal)

    def is_driving(self):
        return bool(self.commands) and self.commands[-1][1] > 0.05


def until(holds, seconds):
    """Waits until something holds; whether it did in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if holds():
            return True
        time.sleep(0.002)
    return False
