//! Dimensions and limits of a Husky A200.

use mapless_parameters::{ConfigError, parameters};
use std::f64::consts::FRAC_PI_2;

parameters! {
    /// Dimensions and limits of the robot; the defaults are those of a Clearpath Husky A200.
    pub struct HuskyConfig {
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
        /// Distance between front and rear axle.
        wheelbase_m: f64 = 0.512, unit "m", range [0.2, 1.5], check Within(0.1, 5.0);
        /// Distance between left and right wheel centres.
        track_m: f64 = 0.571, unit "m", range [0.2, 0.68], check Within(0.1, 5.0);
        /// Radius of the wheels: the height of the axles above the contact plane.
        wheel_radius_m: f64 = 0.165, unit "m", range [0.05, 0.5], check Within(0.01, 2.0);
        /// Overall width over the wheels.
        width_m: f64 = 0.685, unit "m", range [0.58, 1.5], check UpTo(6.0);
    }
    relations check_width;
}

impl HuskyConfig {
    fn check_width(&self, place: &str) -> Result<(), ConfigError> {
        let ok = self.width_m >= self.track_m;
        ConfigError::require(ok, place, "width_m", self.width_m, "at least track_m")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn configuration_is_checked() {
        assert_eq!(HuskyConfig::default().validate("robot"), Ok(()));
        let bad = HuskyConfig { max_speed_m_s: f64::NAN, ..HuskyConfig::default() };
        assert_eq!(bad.validate("robot").unwrap_err().name, "max_speed_m_s");
        let narrow = HuskyConfig { width_m: 0.3, ..HuskyConfig::default() };
        assert_eq!(narrow.validate("robot").unwrap_err().name, "width_m");
        assert!(mapless_toml::from_str::<HuskyConfig>("wheel_base_m = 1.0").is_err());
        assert_eq!(mapless_toml::from_str::<HuskyConfig>("").unwrap(), HuskyConfig::default());
    }
}
