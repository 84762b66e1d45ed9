"""Writes `crate/node/src/messages/encodings.json`: messages as `rosbags` encodes them, an implementation of its own.

    pip install -r crate/recording/peers/requirements.txt, then encodings.py > crate/node/src/messages/encodings.json

Values count up to a hundred and begin anew, so a field that stands in the wrong place shows. Sequences have two entries.
"""

import json
from itertools import count

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

GOAL = "geometry_msgs/PoseStamped pose\nstring behavior_tree"
FEEDBACK = (
    "geometry_msgs/PoseStamped current_pose\nbuiltin_interfaces/Duration navigation_time\n"
    "builtin_interfaces/Duration estimated_time_remaining\nint16 number_of_recoveries\nfloat32 distance_remaining"
)
# The action of nav2_msgs, which rosbags does not know: Humble's result and that of Jazzy.
RESULTS = {"humble": "std_msgs/Empty result", "jazzy": "uint16 error_code\nstring error_msg"}
STORES = {"humble": Stores.ROS2_HUMBLE, "jazzy": Stores.ROS2_JAZZY}
TYPES = (
    "diagnostic_msgs/msg/DiagnosticArray",
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/Twist",
    "geometry_msgs/msg/TwistStamped",
    "nav_msgs/msg/Odometry",
    "nav_msgs/msg/Path",
    "nav2_msgs/msg/NavigateToPose_Feedback",
    "nav2_msgs/msg/NavigateToPose_Goal",
    "nav2_msgs/msg/NavigateToPose_Result",
    "rosgraph_msgs/msg/Clock",
    "sensor_msgs/msg/Imu",
    "sensor_msgs/msg/PointCloud2",
    "std_msgs/msg/Bool",
    "tf2_msgs/msg/TFMessage",
    "visualization_msgs/msg/MarkerArray",
)


class Filler:
    """Makes messages, and keeps the values that it gave, in the order of the fields."""

    def __init__(self, store):
        self.store, self.numbers, self.values = store, count(1), []

    def primitive(self, name):
        number = next(self.numbers) % 100
        match name:
            case "string":
                value = f"s{number}"
            case "bool":
                value = number % 2 == 1
            case "float32" | "float64":
                value = number + 0.25
            case _:
                value = number
        self.values.append(value)
        return value

    def message(self, name):
        _, fields = self.store.fielddefs[name]
        return self.store.types[name](**{field: self.field(node) for field, node in fields})

    def field(self, node):
        kind, detail = node
        match kind:
            case Nodetype.BASE:
                return self.primitive(detail[0])
            case Nodetype.NAME:
                return self.message(detail)
            case Nodetype.ARRAY | Nodetype.SEQUENCE:
                inner, length = detail
                entries = [self.field(inner) for _ in range(length if kind == Nodetype.ARRAY else 2)]
                is_number = inner[0] == Nodetype.BASE and inner[1][0] != "string"
                return np.array(entries, dtype=inner[1][0]) if is_number else entries


def encodings(distribution):
    store = get_typestore(STORES[distribution])
    parts = {"Goal": GOAL, "Feedback": FEEDBACK, "Result": RESULTS[distribution]}
    for part, text in parts.items():
        store.register(get_types_from_msg(text, f"nav2_msgs/msg/NavigateToPose_{part}"))
    for name in TYPES:
        filler = Filler(store)
        message = filler.message(name)
        # Four bytes say how it is encoded.
        yield name, filler.values, bytes(store.serialize_cdr(message, name))[4:].hex()


humble, jazzy = (list(encodings(distribution)) for distribution in ("humble", "jazzy"))
lines = []
for ours, theirs in zip(humble, jazzy):
    both = {"humble, jazzy": ours} if ours == theirs else {"humble": ours, "jazzy": theirs}
    for distributions, (name, values, encoded) in both.items():
        entry = {"type": name, "distributions": distributions, "values": values, "hex": encoded}
        lines.append(json.dumps(entry, separators=(",", ":")))
print("[\n" + ",\n".join(lines) + "\n]")
