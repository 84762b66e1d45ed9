//! The robot as data.

/// Dimensions and limits of a wheeled robot that turns by the difference of its wheels' speeds. The default is a Clearpath Husky A200.
///
/// All lengths are in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct RobotModel {
    /// Overall length of the body.
    pub length_m: f64,
    /// Overall width w_r over the wheels.
    pub width_m: f64,
    /// Distance between front and rear axle.
    pub wheelbase_m: f64,
    /// Distance between the middles of left and right wheels.
    pub track_m: f64,
    /// Radius of the wheels.
    pub wheel_radius_m: f64,
    /// Height of the belly above the ground that the wheels stand on.
    pub ground_clearance_m: f64,
    /// Highest vertical step that the wheels climb.
    pub max_step_m: f64,
    /// Largest safe |roll|. Paper: 0.524.
    pub roll_limit_rad: f64,
    /// Largest safe |pitch|. Paper: 0.785.
    pub pitch_limit_rad: f64,
}

impl RobotModel {
    /// Clearpath Husky A200.
    pub fn husky() -> Self {
        Self {
            length_m: 0.99,
            width_m: 0.685,
            wheelbase_m: 0.512,
            track_m: 0.571,
            wheel_radius_m: 0.165,
            ground_clearance_m: 0.13,
            max_step_m: 0.165,
            roll_limit_rad: 0.524,
            pitch_limit_rad: 0.785,
        }
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

    /// Ground within this distance of a place carries the robot there, whichever way it faces: its four wheels stand a little inside.
    pub fn footprint_radius_m(&self) -> f64 {
        let half_diagonal_m = 0.5 * libm::hypot(self.wheelbase_m, self.track_m);
        0.1 * ((half_diagonal_m + 0.1) / 0.1).ceil()
    }
}

impl Default for RobotModel {
    fn default() -> Self {
        Self::husky()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_footprint_holds_the_wheels() {
        let radius_m = |robot: RobotModel| robot.footprint_radius_m();
        assert_eq!(radius_m(RobotModel::husky()).to_bits(), 0.5_f64.to_bits());
        assert!((radius_m(RobotModel::jackal()) - 0.4).abs() < 1e-12);
        assert!((radius_m(RobotModel::warthog()) - 0.9).abs() < 1e-12);
    }
}
