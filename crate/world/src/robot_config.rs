//! Dimensions and limits of a differential-drive robot.

use mapless_parameters::{ConfigError, parameters};
use std::f64::consts::FRAC_PI_2;

parameters! {
    /// Dimensions and limits of the robot; the defaults are those of a Clearpath Husky A200.
    pub struct RobotConfig {
        /// Beyond this |roll| the run has failed.
        roll_limit_rad: f64 = 0.524, paper 0.524, unit "rad", range [0.1, 1.2], check Within(0.01, FRAC_PI_2);
        /// Beyond this |pitch| the run has failed.
        pitch_limit_rad: f64 = 0.785, paper 0.785, unit "rad", range [0.1, 1.2], check Within(0.01, FRAC_PI_2);
        /// Largest speed forward or backward.
        max_speed_m_s: f64 = 1.0, unit "m/s", range [0.1, 3.0], check Positive;
        /// Largest turn rate to either side.
        max_turn_rate_rad_s: f64 = 1.0, unit "rad/s", range [0.1, 3.0], check Positive;
        /// Largest change of speed.
        max_acceleration_m_s2: f64 = 1.0, unit "m/s²", range [0.1, 5.0], check Positive;
        /// Largest change of turn rate.
        max_turn_acceleration_rad_s2: f64 = 2.0, unit "rad/s²", range [0.1, 10.0], check Positive;
        /// Overall length of the body.
        length_m: f64 = 0.99, unit "m", range [0.55, 3.0], check Within(0.1, 10.0);
        /// Distance between front and rear axle.
        wheelbase_m: f64 = 0.512, unit "m", range [0.2, 0.95], check Within(0.1, 5.0);
        /// Distance between left and right wheel centres.
        track_m: f64 = 0.571, unit "m", range [0.2, 0.68], check Within(0.1, 5.0);
        /// Radius of the wheels: the height of the axles above the contact plane.
        wheel_radius_m: f64 = 0.165, unit "m", range [0.05, 0.5], check Within(0.01, 2.0);
        /// Overall width over the wheels.
        width_m: f64 = 0.685, unit "m", range [0.58, 1.5], check UpTo(6.0);
        /// Height of the belly above the contact plane.
        ground_clearance_m: f64 = 0.13, unit "m", range [0.02, 0.5], check Within(0.01, 2.0);
        /// Height of the top of the body, without what is mounted on it.
        height_m: f64 = 0.39, unit "m", range [0.1, 2.0], check Within(0.05, 5.0);
        /// Height of the underside of body and bumpers before the front and behind the rear axle.
        overhang_clearance_m: f64 = 0.18, unit "m", range [0.02, 1.0], check Within(0.01, 2.0);
        /// Highest vertical step that the wheels climb.
        max_step_m: f64 = 0.165, unit "m", range [0.0, 0.5], check Within(0.0, 2.0);
    }
    relations check_size;
}

impl RobotConfig {
    /// Clearpath Husky A200.
    #[must_use]
    pub fn husky() -> Self {
        Self::default()
    }

    /// Clearpath Jackal J100, as fast as the Husky.
    #[must_use]
    pub fn jackal() -> Self {
        Self {
            length_m: 0.508,
            wheelbase_m: 0.262,
            track_m: 0.376,
            wheel_radius_m: 0.098,
            width_m: 0.43,
            ground_clearance_m: 0.065,
            height_m: 0.25,
            overhang_clearance_m: 0.1,
            max_step_m: 0.098,
            ..Self::default()
        }
    }

    /// Clearpath Warthog, as fast as the Husky.
    #[must_use]
    pub fn warthog() -> Self {
        Self {
            length_m: 1.52,
            wheelbase_m: 0.914,
            track_m: 1.1,
            wheel_radius_m: 0.3,
            width_m: 1.38,
            ground_clearance_m: 0.254,
            height_m: 0.83,
            overhang_clearance_m: 0.35,
            max_step_m: 0.3,
            ..Self::default()
        }
    }

    fn check_size(&self, place: &str) -> Result<(), ConfigError> {
        let is_wide = self.width_m >= self.track_m;
        ConfigError::require(is_wide, place, "width_m", self.width_m, "at least track_m")?;
        let is_long = self.length_m >= self.wheelbase_m;
        ConfigError::require(is_long, place, "length_m", self.length_m, "at least wheelbase_m")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn configuration_is_checked() {
        assert_eq!(RobotConfig::default().validate("robot"), Ok(()));
        let bad = RobotConfig { max_speed_m_s: f64::NAN, ..RobotConfig::default() };
        assert_eq!(bad.validate("robot").unwrap_err().name, "max_speed_m_s");
        let narrow = RobotConfig { width_m: 0.3, ..RobotConfig::default() };
        assert_eq!(narrow.validate("robot").unwrap_err().name, "width_m");
        assert!(mapless_toml::from_str::<RobotConfig>("wheel_base_m = 1.0").is_err());
        assert_eq!(mapless_toml::from_str::<RobotConfig>("").unwrap(), RobotConfig::default());
    }
}
