//! The ROS 2 messages that the node reads and writes, as CDR lays them out: fields in the order of the
//! message definitions, under their names.
//!
//! Source: the `.msg` files of `common_interfaces` and `navigation2`.

mod diagnostic;
mod geometry;
mod navigate;
mod sensor;
mod standard;
#[cfg(test)]
mod tests;
mod tf;
mod visual;

pub use diagnostic::{DiagnosticArray, DiagnosticStatus, KeyValue, Level};
pub use geometry::{
    Odometry, Path, Point, Pose, PoseStamped, PoseWithCovariance, Quaternion, Twist, TwistStamped,
    TwistWithCovariance, Vector3,
};
pub use navigate::{Feedback, HumbleResult, JazzyResult, NavigateGoal, NavigateResult, Outcome};
pub use sensor::{Imu, PointCloud2, PointField};
pub use standard::{Bool, Clock, Duration, Header, Time};
pub use tf::{TfMessage, Transform, TransformStamped};
pub use visual::{ColorRgba, Marker, MarkerArray};
