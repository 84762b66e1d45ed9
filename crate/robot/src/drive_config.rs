//! Everything that a drive depends on besides its messages.

use core::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, EulerRot};
use mapless::PlannerConfig;
use mapless_parameters::{ConfigError, parameters};
use serde::{Deserialize, Serialize};

use crate::estimator::{Estimator, EstimatorConfig};
pub use crate::senses::Frames;
use crate::senses::Senses;
use crate::supervisor::SupervisorConfig;

/// Everything that a drive depends on besides its messages: with them it can be replayed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DriveConfig {
    /// Names of frames.
    pub frames: Frames,
    /// The mount of the IMU.
    pub imu: ImuMount,
    /// How odometry and IMU become a pose.
    pub estimator: EstimatorConfig,
    /// What becomes of goals.
    pub navigation: NavigationConfig,
    /// The planner with its sensor and robot.
    pub planner: PlannerConfig,
    /// Limits of the supervisor.
    pub supervisor: SupervisorConfig,
}

impl DriveConfig {
    /// Checks every value.
    ///
    /// # Errors
    /// [`ConfigError`] for the first one that makes no sense.
    pub fn validate(&self) -> Result<(), ConfigError> {
        self.imu.validate("imu")?;
        self.estimator.validate("estimator")?;
        self.navigation.validate("navigation")?;
        self.planner.validate("planner")?;
        self.supervisor.validate("supervisor")
    }

    /// What follows the pose and says what each message means.
    ///
    /// # Errors
    /// [`ConfigError`] for a value that makes no sense.
    pub fn senses(&self) -> Result<Senses, ConfigError> {
        let estimator = Estimator::new(self.estimator, self.imu.base_from_imu())?;
        Ok(Senses::new(estimator, self.frames.clone(), self.planner.sensor))
    }
}

parameters! {
    /// How the IMU is mounted: its axes turned from those of the robot by yaw, then pitch, then roll, as
    /// ROS counts them (REP 103: pitch nose-down positive).
    #[derive(Copy)]
    pub struct ImuMount {
        /// Roll.
        roll_rad: f64 = 0.0, unit "rad", range [-PI, PI], check Within(-PI, PI);
        /// Pitch, nose-down positive.
        pitch_rad: f64 = 0.0, unit "rad", range [-FRAC_PI_2, FRAC_PI_2], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Yaw.
        yaw_rad: f64 = 0.0, unit "rad", range [-PI, PI], check Within(-PI, PI);
    }
}

impl ImuMount {
    /// Takes vectors of the IMU's frame to the robot's.
    #[must_use]
    pub fn base_from_imu(&self) -> DQuat {
        DQuat::from_euler(EulerRot::ZYX, self.yaw_rad, self.pitch_rad, self.roll_rad)
    }
}

parameters! {
    /// What becomes of goals.
    #[derive(Copy)]
    pub struct NavigationConfig {
        /// A goal that takes longer is aborted.
        timeout_s: f64 = 600.0, unit "s", range [10.0, 3600.0], check Within(1.0, 86400.0);
        /// Whether the robot turns to the goal's heading in the end; otherwise any heading will do.
        final_heading: bool = false;
        /// Feedback of the action, per second.
        feedback_hz: f64 = 5.0, unit "1/s", range [1.0, 20.0], check Within(0.1, 50.0);
    }
}
