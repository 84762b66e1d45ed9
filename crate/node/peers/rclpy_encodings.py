"""The messages of `encodings.json` by rclpy."""

import json
from array import array
from importlib import import_module
from pathlib import Path

import numpy as np
from nav2_msgs.action import NavigateToPose
from rclpy.serialization import deserialize_message, serialize_message

FILE = Path(__file__).parent.parent / "src/messages/encodings.json"
# Says that what follows is plain CDR, little-endian.
HEADER = b"\x00\x01\x00\x00"


def type_named(name):
    package, _, kind = name.split("/")
    if package == "nav2_msgs":
        return getattr(NavigateToPose, kind.removeprefix("NavigateToPose_"))
    return getattr(import_module(f"{package}.msg"), kind)


def values(message):
    """Its numbers, texts and switches in the order of the fields."""
    if isinstance(message, (list, tuple, array, np.ndarray)):
        return [value for entry in message for value in values(entry)]
    if isinstance(message, bytes):
        return list(message)
    if hasattr(message, "get_fields_and_field_types"):
        return [value for field in message.get_fields_and_field_types() for value in values(getattr(message, field))]
    return [message.item() if isinstance(message, np.generic) else message]


def is_same(wire, told):
    """Fast DDS leaves bytes between fields as they were in memory, 0 in what is told, and fills the last four."""
    return 0 <= len(wire) - len(told) < 4 and all(a == b for a, b in zip(wire, told) if b != 0)


def rclpy_encodes_messages_as_told(_robot, _node):
    encodings = [entry for entry in json.loads(FILE.read_text(encoding="utf-8")) if "jazzy" in entry["distributions"]]
    # rclpy's wheels have no tf2_msgs.
    encodings = [entry for entry in encodings if not entry["type"].startswith("tf2_msgs")]
    wrong = []
    for entry in encodings:
        wire, kind = HEADER + bytes.fromhex(entry["hex"]), type_named(entry["type"])
        message = deserialize_message(wire, kind)
        if values(message) != entry["values"] or not is_same(serialize_message(message), wire):
            wrong.append(entry["type"])
    return len(encodings) > 10 and not wrong, f"{len(encodings)} messages; otherwise encoded: {wrong}"
