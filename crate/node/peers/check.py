"""Runs `mapless-node` with a robot of rclpy, and checks what it does; prints the number that passed.

    check.py PROGRAM CONFIG [CHECK ...]
"""

import math
import os
import time

import checks

os.environ["ROS_DOMAIN_ID"] = str(checks.DOMAIN)

import numpy as np  # noqa: E402
from geometry_msgs.msg import TwistStamped  # noqa: E402
from nav_msgs.msg import Path  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402
from rclpy.parameter_client import AsyncParameterClient  # noqa: E402
from sensor_msgs.msg import PointCloud2, PointField  # noqa: E402
from visualization_msgs.msg import Marker, MarkerArray  # noqa: E402

import navigation  # noqa: E402
from checks import DISCOVERY_S, drive, state, stops  # noqa: E402
from rclpy_encodings import rclpy_encodes_messages_as_told  # noqa: E402
from robot import BASE_HEIGHT_M, NAMESPACE, until  # noqa: E402
from wire_rclpy import Wire  # noqa: E402


def no_cloud_of_a_reliable_publisher_is_lost(robot, node):
    robot.is_scanning = False
    time.sleep(0.3)
    robot.wire.remove_publisher(robot.scan)
    robot.scan = robot.scan_publisher(is_reliable=True)
    robot.is_scanning = True
    time.sleep(1.0)
    return checks.no_cloud_is_lost(robot, node)


def the_picture_lies_where_the_robot_is(robot, _node):
    got = {}
    kept = [
        robot.wire.subscribe(Path, "mapless/path", lambda m: got.update(path=m)),
        robot.wire.subscribe(MarkerArray, "mapless/subgoals", lambda m: got.update(subgoals=m)),
    ]
    if not drive(robot) or not until(lambda: len(got) == 2, DISCOVERY_S):
        return False, f"{state(robot)}; only {sorted(got)} came"
    time.sleep(0.5)
    path, marker = got["path"], got["subgoals"].markers[0]
    greens = [p for p, c in zip(marker.points, marker.colors) if c.g > 0.7]
    begins = path.poses[0].pose.position
    off_m = math.hypot(begins.x - robot.x - robot.shift, begins.y - robot.y)
    ok = off_m < 1.0 and len(greens) == 1 and greens[0].x > robot.x and path.header.frame_id == "odom"
    for subscription in kept:
        robot.wire.remove_subscription(subscription)
    return ok, f"the path begins {off_m:.2f} m from the robot; {len(marker.points)} subgoals, {len(greens)} chosen"


def another_publisher_is_noticed(robot, _node):
    other = []
    checked = stops(
        robot, lambda: other.append(robot.wire.publisher(TwistStamped, "cmd_vel")), 3.0, "another publisher"
    )
    for publisher in other:
        robot.wire.remove_publisher(publisher)
    return checked


def answer(future):
    until(future.done, 10.0)
    return future.result() if future.done() else None


def parameters_are_told_and_set(robot, _node):
    """rclpy's own client lists, describes, gets and sets; a limit holds at once, and what is refused says why."""
    client = AsyncParameterClient(robot.wire.node, f"{NAMESPACE}/mapless")
    if not client.wait_for_services(DISCOVERY_S):
        return False, "its services were not found"
    limit = "supervisor.max_speed_m_s"
    names = answer(client.list_parameters(prefixes=["supervisor"], depth=0)).result.names
    threshold = answer(client.describe_parameters(["planner.perception.variance_threshold"])).descriptors[0]
    kind = answer(client.get_parameter_types([limit])).types[0]
    before = answer(client.get_parameters([limit])).values[0].double_value
    change = lambda name, value: answer(client.set_parameters([Parameter(name, value=value)])).results[0]
    if not drive(robot):
        return False, f"it does not drive: {state(robot)}"
    lowered = change(limit, 0.2)
    time.sleep(2.0)
    began = time.monotonic()
    time.sleep(1.0)
    fastest = max(abs(v) for at, v, _ in robot.commands if at > began)
    refused = change(limit, -1.0)
    both = [Parameter(limit, value=before), Parameter("supervisor.scan_s", value=9.0)]
    neither = answer(client.set_parameters_atomically(both)).result
    after = answer(client.get_parameters([limit])).values[0].double_value
    raised = change(limit, before)
    ok = (
        limit in names
        and "a share between 0 and 1" in threshold.additional_constraints
        and threshold.description.startswith("Share V_th")
        and kind == Parameter.Type.DOUBLE.value
        and lowered.successful
        and 0.05 < fastest <= 0.2 + 1e-9
        and refused.reason == f"{limit} = -1: expected a positive number"
        and not neither.successful
        and after == 0.2
        and raised.successful
    )
    return ok, f"{len(names)} names; {before} to {after} m/s, the fastest command {fastest:.3f}; {refused.reason!r}; {neither.reason!r}"


def as_points(cloud, names):
    """The points of a cloud, whose fields must be floats with these names."""
    found = [field.name for field in cloud.fields]
    assert found == names and all(field.datatype == PointField.FLOAT32 for field in cloud.fields), found
    layout = {"names": names, "formats": ["<f4"] * len(names), "offsets": [field.offset for field in cloud.fields]}
    points = np.frombuffer(bytes(cloud.data), dtype=np.dtype({**layout, "itemsize": cloud.point_step}))
    return points.reshape(cloud.height, cloud.width)


def surfaces_are_shown(robot, node):
    """The node is begun anew with `visualise`."""
    if node.process.poll() is None:
        node.end()
    node.configure("node_name: mapless", "node_name: mapless\n    visualise: true")
    got, elevations = {}, []
    kept = [
        robot.wire.subscribe(PointCloud2, "mapless/variance", lambda m: got.update(variance=m), is_reliable=False),
        robot.wire.subscribe(PointCloud2, "mapless/elevation", elevations.append, is_reliable=False),
        robot.wire.subscribe(MarkerArray, "mapless/skyline", lambda m: got.update(skyline=m)),
    ]
    node.start()
    if not drive(robot) or not until(lambda: len(got) == 2 and elevations, DISCOVERY_S):
        return False, f"{state(robot)}; only {sorted(got)} and {len(elevations)} of remembered ground came"
    time.sleep(2.0)
    begin, first = time.monotonic(), len(elevations)
    time.sleep(5.0)
    rate = (len(elevations) - first) / 5.0
    sent = {stamp: at for at, stamp in robot.scans if begin <= at < begin + 4.5}
    delays = sorted(at - sent[stamp] for at, stamp in list(robot.decisions) if stamp in sent)
    cloud, marker, ground = got["variance"], got["skyline"].markers[0], elevations[-1]
    # Level ground from 0.8 m up: the lowest beam meets it 3.1 m away; every direction below the horizon was seen.
    lowest = as_points(cloud, ["x", "y", "z", "variance", "range"])[0]
    off = np.hypot(lowest["x"] - robot.x - robot.shift, lowest["y"] - robot.y) - 7.0 * math.cos(math.radians(15.0))
    ends = np.array([(p.x, p.y, p.z) for p in marker.points])
    cells = as_points(ground, ["x", "y", "z", "returns", "age", "upright"])[0]
    away = np.maximum(np.abs(cells["x"] - robot.x - robot.shift), np.abs(cells["y"] - robot.y))
    ok = (
        cloud.width == 360
        and cloud.header.frame_id == marker.header.frame_id == ground.header.frame_id == "odom"
        and np.abs(off).max() < 1.0
        and lowest["variance"].max() < 0.3
        and abs(np.median(lowest["range"]) - 3.1) < 0.8
        and marker.type == Marker.LINE_LIST
        and len(marker.points) == len(marker.colors) > 600
        and np.abs(ends[:, 2] - ends[:, 2].mean()).max() < 0.7
        and 0.4 <= rate <= 1.2
        and len(cells) > 1000
        and np.abs(cells["z"] + BASE_HEIGHT_M).max() < 0.1
        and away.min() < 0.5
        and away.max() < 14.0
        and cells["upright"].max() == 0.0
        and 1.0 <= cells["returns"].min()
        and cells["returns"].max() == 30.0
    )
    median = 1e3 * delays[len(delays) // 2] if delays else float("nan")
    for subscription in kept:
        robot.wire.remove_subscription(subscription)
    return ok, (
        f"{cloud.height} rows, {len(marker.points) // 2} lines; {len(cells)} cells of ground in {len(ground.data)} bytes, "
        f"{rate:.1f} times a second, as high as {cells['z'].min():.3f} to {cells['z'].max():.3f} m; "
        f"{len(delays)} of {len(sent)} clouds answered, median {median:.1f} ms"
    )


CHECKS = (
    rclpy_encodes_messages_as_told,
    checks.no_cloud_is_lost,
    no_cloud_of_a_reliable_publisher_is_lost,
    checks.limits_hold,
    the_picture_lies_where_the_robot_is,
    checks.scans_cease,
    checks.odometry_ceases,
    checks.imu_ceases,
    checks.clouds_are_cut,
    checks.the_robot_leans,
    checks.the_odometry_jumps,
    checks.the_emergency_stop_is_pressed,
    checks.a_release_moves_nothing,
    checks.it_arrives,
    *navigation.CHECKS,
    parameters_are_told_and_set,
    checks.a_suspended_process_goes_on_standing,
    another_publisher_is_noticed,
    checks.killed_it_stands_until_a_goal,
    checks.it_ends_with_zero,
    surfaces_are_shown,
    checks.stamps_ahead_of_the_simulated_clock_stop_it,
)


if __name__ == "__main__":
    checks.main(Wire(NAMESPACE), CHECKS)
