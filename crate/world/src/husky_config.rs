//! Dimensions and limits of a Husky A200.

use crate::config::{ConfigError, positive, within};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Dimensions and limits of the robot; the defaults are those of a Clearpath Husky A200.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct HuskyConfig {
    /// Distance between front and rear axle, in metres.
    pub wheelbase_m: f64,
    /// Distance between left and right wheel centres, in metres.
    pub track_m: f64,
    /// Radius of the wheels, in metres: the height of the axles above the contact plane.
    pub wheel_radius_m: f64,
    /// Overall width over the wheels, in metres.
    pub width_m: f64,
    /// Largest speed forward or backward, in m/s.
    pub max_speed_m_s: f64,
    /// Largest turn rate to either side, in rad/s.
    pub max_turn_rate_rad_s: f64,
    /// Largest change of speed, in m/s².
    pub max_acceleration_m_s2: f64,
    /// Largest change of turn rate, in rad/s².
    pub max_turn_acceleration_rad_s2: f64,
    /// Largest safe |roll|, in radians.
    pub roll_limit_rad: f64,
    /// Largest safe |pitch|, in radians.
    pub pitch_limit_rad: f64,
}

impl Default for HuskyConfig {
    fn default() -> Self {
        Self {
            wheelbase_m: 0.512,
            track_m: 0.571,
            wheel_radius_m: 0.165,
            width_m: 0.685,
            max_speed_m_s: 1.0,
            max_turn_rate_rad_s: 1.0,
            max_acceleration_m_s2: 1.0,
            max_turn_acceleration_rad_s2: 2.0,
            roll_limit_rad: 0.524,
            pitch_limit_rad: 0.785,
        }
    }
}

impl HuskyConfig {
    /// Checks every value.
    ///
    /// # Errors
    /// [`ConfigError`] names the first field outside its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        within("wheelbase_m", self.wheelbase_m, 0.1, 5.0)?;
        within("track_m", self.track_m, 0.1, 5.0)?;
        within("wheel_radius_m", self.wheel_radius_m, 0.01, 2.0)?;
        within("width_m", self.width_m, self.track_m, 6.0)?;
        positive("max_speed_m_s", self.max_speed_m_s)?;
        positive("max_turn_rate_rad_s", self.max_turn_rate_rad_s)?;
        positive("max_acceleration_m_s2", self.max_acceleration_m_s2)?;
        positive("max_turn_acceleration_rad_s2", self.max_turn_acceleration_rad_s2)?;
        within("roll_limit_rad", self.roll_limit_rad, 0.01, FRAC_PI_2)?;
        within("pitch_limit_rad", self.pitch_limit_rad, 0.01, FRAC_PI_2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn configuration_is_checked() {
        assert_eq!(HuskyConfig::default().validate(), Ok(()));
        let bad = HuskyConfig { max_speed_m_s: f64::NAN, ..HuskyConfig::default() };
        assert_eq!(bad.validate().unwrap_err().field, "max_speed_m_s");
        let narrow = HuskyConfig { width_m: 0.3, ..HuskyConfig::default() };
        assert_eq!(narrow.validate().unwrap_err().field, "width_m");
        assert!(mapless_toml::from_str::<HuskyConfig>("wheel_base_m = 1.0").is_err());
        assert_eq!(mapless_toml::from_str::<HuskyConfig>("").unwrap(), HuskyConfig::default());
    }
}
