"""ROS 2 itself: rclpy with Fast DDS."""

import os
import threading
from types import SimpleNamespace

# Over UDP, as between two computers.
os.environ["FASTDDS_BUILTIN_TRANSPORTS"] = "UDPv4"

import rclpy  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from geometry_msgs.msg import PoseStamped, TwistStamped  # noqa: E402
from nav_msgs.msg import Odometry  # noqa: E402
from rclpy.action import ActionClient  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.qos import QoSProfile, ReliabilityPolicy  # noqa: E402
from rosgraph_msgs.msg import Clock  # noqa: E402
from sensor_msgs.msg import Imu, PointCloud2, PointField  # noqa: E402
from std_msgs.msg import Bool  # noqa: E402


class Wire:
    """A node of rclpy, with publishers and subscriptions as the robot needs them."""

    messages = SimpleNamespace(
        Bool=Bool,
        Clock=Clock,
        DiagnosticArray=DiagnosticArray,
        Imu=Imu,
        Odometry=Odometry,
        PointCloud2=PointCloud2,
        PointField=PointField,
        PoseStamped=PoseStamped,
        TwistStamped=TwistStamped,
    )

    def __init__(self, namespace):
        rclpy.init()
        self.node = rclpy.create_node("robot", namespace=namespace)
        self.clients = {}

    def publisher(self, kind, topic, is_reliable=True):
        return self.node.create_publisher(kind, topic, qos(is_reliable))

    def subscribe(self, kind, topic, hear, is_reliable=True):
        return self.node.create_subscription(kind, topic, hear, qos(is_reliable))

    def action_client(self, kind, name):
        """The client of an action; the same one for the same action."""
        if name not in self.clients:
            self.clients[name] = ActionClient(self.node, kind, name)
        return self.clients[name]

    def remove_publisher(self, publisher):
        self.node.destroy_publisher(publisher)

    def remove_subscription(self, subscription):
        self.node.destroy_subscription(subscription)

    def now(self):
        return self.node.get_clock().now().to_msg()

    def spin(self):
        """Has a thread call those who subscribed."""
        executor = SingleThreadedExecutor()
        executor.add_node(self.node)
        threading.Thread(target=executor.spin, daemon=True).start()


def qos(is_reliable):
    reliability = ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT
    return QoSProfile(depth=10, reliability=reliability)
