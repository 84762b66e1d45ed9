//! The robot as data.

use mapless_parameters::{ConfigError, parameters};

parameters! {
    /// Dimensions and limits of a wheeled robot that turns by the difference of its wheels' speeds. The default is a Clearpath
    /// Husky A200.
    ///
    /// All lengths are in metres, angles in radians.
    #[derive(Copy)]
    #[non_exhaustive]
    pub struct RobotModel {
        /// Overall length of the body.
        length_m: f64 = 0.99, unit "m", range [0.55, 3.0], check Positive;
        /// Overall width w_r over the wheels, which a segment must let through.
        width_m: f64 = 0.685, unit "m", range [0.3, 1.5], check Positive;
        /// Distance between front and rear axle.
        wheelbase_m: f64 = 0.512, unit "m", range [0.2, 0.95], check Positive;
        /// Distance between the middles of left and right wheels.
        track_m: f64 = 0.571, unit "m", range [0.2, 1.5], check Positive;
        /// Radius of the wheels.
        wheel_radius_m: f64 = 0.165, unit "m", range [0.05, 0.5], check Positive;
        /// Height of the belly above the ground that the wheels stand on.
        ground_clearance_m: f64 = 0.13, unit "m", range [0.02, 0.5], check Positive;
        /// Highest vertical step that the wheels climb.
        max_step_m: f64 = 0.165, unit "m", range [0.0, 0.5], check NotNegative;
        /// Largest safe |roll|.
        roll_limit_rad: f64 = 0.524, paper 0.524, unit "rad", range [0.1, 1.2], check Angle;
        /// Largest safe |pitch|.
        pitch_limit_rad: f64 = 0.785, paper 0.785, unit "rad", range [0.1, 1.2], check Angle;
    }
    relations check_axles;
}

impl RobotModel {
    /// Clearpath Husky A200.
    pub fn husky() -> Self {
        Self::default()
    }

    /// Clearpath Jackal J100.
    pub fn jackal() -> Self {
        Self {
            length_m: 0.508,
            width_m: 0.43,
            wheelbase_m: 0.262,
            track_m: 0.376,
            wheel_radius_m: 0.098,
            ground_clearance_m: 0.065,
            max_step_m: 0.098,
            ..Self::husky()
        }
    }

    /// Clearpath Warthog.
    pub fn warthog() -> Self {
        Self {
            length_m: 1.52,
            width_m: 1.38,
            wheelbase_m: 0.914,
            track_m: 1.1,
            wheel_radius_m: 0.3,
            ground_clearance_m: 0.254,
            max_step_m: 0.3,
            ..Self::husky()
        }
    }

    fn check_axles(&self, place: &str) -> Result<(), ConfigError> {
        let fits = self.wheelbase_m <= self.length_m;
        ConfigError::require(fits, place, "wheelbase_m", self.wheelbase_m, "at most length_m")
    }
}
