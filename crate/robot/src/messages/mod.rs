//! The ROS 2 messages that a robot sends: fields in the order of the message definitions, under their names,
//! so that any encoder of CDR lays them out as ROS does.
//!
//! Source: the `.msg` files of `common_interfaces`.

mod geometry;
mod sensor;
mod standard;

pub use geometry::{
    Odometry, Path, Point, Pose, PoseStamped, PoseWithCovariance, Quaternion, Twist, TwistStamped,
    TwistWithCovariance, Vector3,
};
pub use sensor::{Imu, PointCloud2, PointField};
pub use standard::{Bool, Clock, Duration, Header, Time};
