//! The robot model.

use glam::DVec2;
use mapless_parameters::{ConfigError, parameters};

parameters! {
    /// Dimensions and limits of a differential-drive (skid-steer) robot. The default is a Clearpath Husky
    /// A200.
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
        /// Height of the belly above the ground that the wheels stand on.
        ground_clearance_m: f64 = 0.13, unit "m", range [0.02, 0.5], check Positive;
        /// Height of the underside of body and bumpers beyond the axles.
        overhang_clearance_m: f64 = 0.18, unit "m", range [0.02, 1.0], check Positive;
        /// Highest vertical step that the wheels climb.
        max_step_m: f64 = 0.165, unit "m", range [0.0, 0.5], check NotNegative;
        /// Height of the top of the body and its load above the ground, without mast and sensor. On a slope
        /// the body leans over to the lower side by this times the sine of the slope.
        deck_height_m: f64 = 0.39, unit "m", range [0.1, 2.0], check Positive;
        /// Overall height with mast and sensor: the robot passes below what is higher.
        height_m: f64 = 0.9, unit "m", range [0.2, 3.0], check Positive;
        /// Returns this near to the body's outline are the robot's own.
        body_margin_m: f64 = 0.1, unit "m", range [0.0, 0.5], check NotNegative;
        /// How far a load sticks out ahead of the body.
        load_front_m: f64 = 0.0, unit "m", range [0.0, 2.0], check NotNegative;
        /// How far a load sticks out behind the body.
        load_rear_m: f64 = 0.0, unit "m", range [0.0, 2.0], check NotNegative;
        /// How far a load sticks out on each side.
        load_side_m: f64 = 0.0, unit "m", range [0.0, 1.0], check NotNegative;
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
            ground_clearance_m: 0.065,
            overhang_clearance_m: 0.1,
            max_step_m: 0.098,
            deck_height_m: 0.25,
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
            ground_clearance_m: 0.254,
            overhang_clearance_m: 0.35,
            max_step_m: 0.3,
            deck_height_m: 0.83,
            ..Self::husky()
        }
    }

    /// Radius of the footprint: ground within it carries the robot at any heading. Its four wheels are a
    /// little inside.
    pub fn footprint_radius_m(&self) -> f64 {
        let half_diagonal_m = 0.5 * libm::hypot(self.wheelbase_m, self.track_m);
        0.1 * ((half_diagonal_m + 0.1) / 0.1).ceil()
    }

    /// Half the length and half the width of the body, with its load, about the middle of the axles.
    pub fn half_body_m(&self) -> DVec2 {
        let load_m = self.load_front_m.max(self.load_rear_m);
        DVec2::new(0.5 * self.length_m + load_m, 0.5 * self.width_m + self.load_side_m)
    }

    /// How far the top of the body lies aside of the ground that it stands on, on a plane with this gradient.
    pub(crate) fn lean_m(&self, gradient: DVec2) -> DVec2 {
        -gradient * (self.deck_height_m / (1.0 + gradient.length_squared()).sqrt())
    }

    fn check_axles(&self, place: &str) -> Result<(), ConfigError> {
        let fits = self.wheelbase_m <= self.length_m;
        ConfigError::require(fits, place, "wheelbase_m", self.wheelbase_m, "at most length_m")
    }
}

/// The distance of a point from a body with these half sides, along and across the unit vector `facing`,
/// whose top lies `lean_m` aside of its middle; negative inside. Beside a corner it is the larger of both
/// axes' distances.
pub(crate) fn distance_from_body_m(
    half_body_m: DVec2,
    lean_m: DVec2,
    from_middle_m: DVec2,
    facing: DVec2,
) -> f64 {
    let along_across = |vector: DVec2| DVec2::new(vector.dot(facing), vector.perp_dot(facing));
    let half_lean_m = 0.5 * along_across(lean_m);
    ((along_across(from_middle_m) - half_lean_m).abs() - half_body_m - half_lean_m.abs()).max_element()
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
