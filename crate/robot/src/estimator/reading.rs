//! What the estimator takes.

use core::time::Duration;

use glam::{DQuat, DVec3};

/// A quaternion this far from unit length is none.
const LENGTH_TOLERANCE: f64 = 0.1;

/// A message of odometry (`nav_msgs/Odometry`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Odometry {
    /// When it was measured.
    pub at: Duration,
    /// Position of `base_link` in the odometry's frame, metres.
    pub position_m: DVec3,
    /// Takes vectors of `base_link` to the odometry's frame.
    pub orientation: DQuat,
    /// Variances of the pose: the diagonal of its covariance, in m² and rad².
    pub variances: [f64; 6],
    /// Velocity in `base_link`, m/s.
    pub linear_m_s: DVec3,
    /// Turn rates in `base_link`, rad/s.
    pub angular_rad_s: DVec3,
}

/// A message of the IMU (`sensor_msgs/Imu`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imu {
    /// When it was measured.
    pub at: Duration,
    /// Takes vectors of the IMU's frame to one with z up. Its heading does not matter.
    pub orientation: DQuat,
    /// The first entry of the orientation's covariance: -1 says that there is no orientation.
    pub orientation_variance: f64,
    /// Turn rates in the IMU's frame, rad/s.
    pub angular_rad_s: DVec3,
}

/// Why a message cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReadingError {
    /// A number is NaN or infinite.
    #[error("{0} = {1}: expected finite numbers")]
    NotFinite(&'static str, String),
    /// A quaternion is no rotation.
    #[error("{0} = {1}: expected a quaternion of length 1")]
    NotUnit(&'static str, String),
    /// The IMU gives no orientation.
    #[error("imu.orientation_covariance[0] = -1: expected an IMU with an orientation, for roll and pitch")]
    NoOrientation,
}

impl Odometry {
    pub(crate) fn check(&self) -> Result<(), ReadingError> {
        finite("odometry.pose.position", self.position_m)?;
        unit("odometry.pose.orientation", self.orientation)?;
        finite("odometry.twist.linear", self.linear_m_s)?;
        finite("odometry.twist.angular", self.angular_rad_s)
    }
}

impl Imu {
    pub(crate) fn check(&self) -> Result<(), ReadingError> {
        // ROS says that there is none by this very number.
        if self.orientation_variance <= -1.0 {
            return Err(ReadingError::NoOrientation);
        }
        unit("imu.orientation", self.orientation)?;
        finite("imu.angular_velocity", self.angular_rad_s)
    }
}

pub(crate) fn finite(what: &'static str, value: DVec3) -> Result<(), ReadingError> {
    if value.is_finite() { Ok(()) } else { Err(ReadingError::NotFinite(what, value.to_string())) }
}

pub(crate) fn unit(what: &'static str, value: DQuat) -> Result<(), ReadingError> {
    if !value.is_finite() {
        return Err(ReadingError::NotFinite(what, value.to_string()));
    }
    let is_unit = (value.length() - 1.0).abs() <= LENGTH_TOLERANCE;
    if is_unit { Ok(()) } else { Err(ReadingError::NotUnit(what, value.to_string())) }
}
