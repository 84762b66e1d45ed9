//! The ROS 2 messages that the node reads and writes, as CDR lays them out: fields in the order of the
//! message definitions, under their names.
//!
//! Source: the `.msg` files of `common_interfaces` and `navigation2`.

mod cloud;
mod diagnostic;
mod navigate;
#[cfg(test)]
mod tests;
mod tf;
mod visual;

pub use mapless_robot::messages::{
    Bool, Clock, Duration, Header, Imu, Odometry, Path, Point, PointCloud2, PointField, Pose, PoseStamped,
    PoseWithCovariance, Quaternion, Time, Twist, TwistStamped, TwistWithCovariance, Vector3,
};

pub use cloud::cloud_of_floats;
pub use diagnostic::{DiagnosticArray, DiagnosticStatus, KeyValue, Level};
pub use navigate::{Feedback, HumbleResult, JazzyResult, NavigateGoal, NavigateResult};
pub use tf::{TfMessage, Transform, TransformStamped};
pub use visual::{ColorRgba, Marker, MarkerArray};

/// The system's clock now.
#[must_use]
pub fn now() -> Time {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    Time::from_nanoseconds(since.as_nanos() as i64)
}
