"""The messages of ROS 2 Jazzy that the robot needs, as types of Cyclone DDS: fields in the order of the `.msg` files."""

import struct
from dataclasses import dataclass, field

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import array, float64, int32, sequence, uint8, uint32


def nested(kind):
    return field(default_factory=kind)


def zeros(count):
    return field(default_factory=lambda: [0.0] * count)


@dataclass
@final
class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    sec: int32 = 0
    nanosec: uint32 = 0


@dataclass
@final
class Header(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    stamp: Time = nested(Time)
    frame_id: str = ""


@dataclass
@final
class Bool(IdlStruct, typename="std_msgs.msg.dds_.Bool_"):
    data: bool = False


@dataclass
@final
class Point(IdlStruct, typename="geometry_msgs.msg.dds_.Point_"):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
@final
class Vector3(IdlStruct, typename="geometry_msgs.msg.dds_.Vector3_"):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0


@dataclass
@final
class Quaternion(IdlStruct, typename="geometry_msgs.msg.dds_.Quaternion_"):
    x: float64 = 0.0
    y: float64 = 0.0
    z: float64 = 0.0
    w: float64 = 1.0


@dataclass
@final
class Pose(IdlStruct, typename="geometry_msgs.msg.dds_.Pose_"):
    position: Point = nested(Point)
    orientation: Quaternion = nested(Quaternion)


@dataclass
@final
class PoseStamped(IdlStruct, typename="geometry_msgs.msg.dds_.PoseStamped_"):
    header: Header = nested(Header)
    pose: Pose = nested(Pose)


@dataclass
@final
class PoseWithCovariance(IdlStruct, typename="geometry_msgs.msg.dds_.PoseWithCovariance_"):
    pose: Pose = nested(Pose)
    covariance: array[float64, 36] = zeros(36)


@dataclass
@final
class Twist(IdlStruct, typename="geometry_msgs.msg.dds_.Twist_"):
    linear: Vector3 = nested(Vector3)
    angular: Vector3 = nested(Vector3)


@dataclass
@final
class TwistStamped(IdlStruct, typename="geometry_msgs.msg.dds_.TwistStamped_"):
    header: Header = nested(Header)
    twist: Twist = nested(Twist)


@dataclass
@final
class TwistWithCovariance(IdlStruct, typename="geometry_msgs.msg.dds_.TwistWithCovariance_"):
    twist: Twist = nested(Twist)
    covariance: array[float64, 36] = zeros(36)


@dataclass
@final
class Odometry(IdlStruct, typename="nav_msgs.msg.dds_.Odometry_"):
    header: Header = nested(Header)
    child_frame_id: str = ""
    pose: PoseWithCovariance = nested(PoseWithCovariance)
    twist: TwistWithCovariance = nested(TwistWithCovariance)


@dataclass
@final
class Imu(IdlStruct, typename="sensor_msgs.msg.dds_.Imu_"):
    header: Header = nested(Header)
    orientation: Quaternion = nested(Quaternion)
    orientation_covariance: array[float64, 9] = zeros(9)
    angular_velocity: Vector3 = nested(Vector3)
    angular_velocity_covariance: array[float64, 9] = zeros(9)
    linear_acceleration: Vector3 = nested(Vector3)
    linear_acceleration_covariance: array[float64, 9] = zeros(9)


@dataclass
@final
class PointField(IdlStruct, typename="sensor_msgs.msg.dds_.PointField_"):
    name: str = ""
    offset: uint32 = 0
    datatype: uint8 = 0
    count: uint32 = 0


PointField.UINT16 = 4
PointField.FLOAT32 = 7


@dataclass
@final
class PointCloud2(IdlStruct, typename="sensor_msgs.msg.dds_.PointCloud2_"):
    header: Header = nested(Header)
    height: uint32 = 0
    width: uint32 = 0
    fields: sequence[PointField] = nested(list)
    is_bigendian: bool = False
    point_step: uint32 = 0
    row_step: uint32 = 0
    data: sequence[uint8] = b""
    is_dense: bool = False

    def serialize(self, *args, **options):
        """Puts the bytes of `data` in as they are: the library packs them number by number, which takes 0.15 s."""
        data, self.data = self.data, b""
        empty = super().serialize(*args, **options)
        self.data = data
        # It ends with the length of `data` and with `is_dense`.
        return empty[:-5] + struct.pack("<I", len(data)) + data + empty[-1:]


@dataclass
@final
class KeyValue(IdlStruct, typename="diagnostic_msgs.msg.dds_.KeyValue_"):
    key: str = ""
    value: str = ""


@dataclass
@final
class DiagnosticStatus(IdlStruct, typename="diagnostic_msgs.msg.dds_.DiagnosticStatus_"):
    # `byte` of a `.msg` file.
    level: uint8 = 0
    name: str = ""
    message: str = ""
    hardware_id: str = ""
    values: sequence[KeyValue] = nested(list)


@dataclass
@final
class DiagnosticArray(IdlStruct, typename="diagnostic_msgs.msg.dds_.DiagnosticArray_"):
    header: Header = nested(Header)
    status: sequence[DiagnosticStatus] = nested(list)


@dataclass
@final
class Clock(IdlStruct, typename="rosgraph_msgs.msg.dds_.Clock_"):
    clock: Time = nested(Time)
