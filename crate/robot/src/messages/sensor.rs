//! `sensor_msgs`.

use serde::{Deserialize, Serialize};
use serde_bytes::ByteBuf;

use super::{Header, Quaternion, Vector3};

/// `sensor_msgs/PointField`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointField {
    /// Such as `x`, `ring` or `time`.
    pub name: String,
    /// Bytes from the point's begin.
    pub offset: u32,
    /// 1 to 8: i8, u8, i16, u16, i32, u32, f32, f64.
    pub datatype: u8,
    /// Values of it.
    pub count: u32,
}

/// `sensor_msgs/PointCloud2`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointCloud2 {
    /// Stamp and sensor frame.
    pub header: Header,
    /// Rows of an organised cloud, else 1.
    pub height: u32,
    /// Points in a row.
    pub width: u32,
    /// What a point holds.
    pub fields: Vec<PointField>,
    /// Byte order of `data`.
    pub is_bigendian: bool,
    /// Bytes of a point.
    pub point_step: u32,
    /// Bytes of a row.
    pub row_step: u32,
    /// The points.
    pub data: ByteBuf,
    /// No point is NaN.
    pub is_dense: bool,
}

/// `sensor_msgs/Imu`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Imu {
    /// Stamp and the IMU's frame.
    pub header: Header,
    /// Of that frame in the world.
    pub orientation: Quaternion,
    /// Its first entry is −1 where the IMU gives no orientation.
    pub orientation_covariance: [f64; 9],
    /// rad/s, in that frame.
    pub angular_velocity: Vector3,
    /// Row-major.
    pub angular_velocity_covariance: [f64; 9],
    /// m/s², in that frame, gravity included.
    pub linear_acceleration: Vector3,
    /// Row-major.
    pub linear_acceleration_covariance: [f64; 9],
}
