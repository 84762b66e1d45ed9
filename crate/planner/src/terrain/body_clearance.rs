//! The distance of the body from what stands upright around it, at any pose near the robot.

use glam::DVec2;

use crate::robot_model::{RobotModel, distance_from_body_m};
use crate::terrain::elevation_window::TerrainQuery;
use crate::terrain::traversability::BEGUN_SHARE;

/// The robot keeps this far from what is upright, or as far as it already is.
const MARGIN_M: f64 = 0.05;
/// Things that there is room for without an allocation.
const USUAL_THINGS: usize = 4096;

/// What stands upright around the robot.
#[derive(Clone, Debug)]
pub(crate) struct BodyClearance {
    robot: RobotModel,
    half_body_m: DVec2,
    radius_m: f64,
    things_m: Vec<DVec2>,
    least_m: f64,
    /// The gradient of the robot's attitude less that of the ground known under it.
    gradient_off: DVec2,
}

impl BodyClearance {
    /// With things within `radius_m` of the robot.
    pub(crate) fn new(robot: &RobotModel, radius_m: f64) -> Self {
        let half_body_m = robot.half_body_m();
        let things_m = Vec::with_capacity(USUAL_THINGS);
        Self { robot: *robot, half_body_m, radius_m, things_m, least_m: MARGIN_M, gradient_off: DVec2::ZERO }
    }

    /// Looks at the ground around a robot at `here_m`, which faces along a unit vector. Its attitude has this
    /// gradient, the ground known under it `expected`. The difference is added to gradients nearby.
    pub(crate) fn look(
        &mut self,
        ground: &dyn TerrainQuery,
        here_m: DVec2,
        facing: DVec2,
        gradient: DVec2,
        expected: DVec2,
    ) {
        self.gradient_off = gradient - expected;
        self.things_m.clear();
        ground.each_upright(here_m, self.radius_m, &mut |thing_m| self.things_m.push(thing_m));
        self.least_m = self.at_m(here_m, facing, expected);
    }

    /// As [`is_too_near`](Self::is_too_near), at a pose on a turn that was begun, which keeps a share of the
    /// margin: whether the turn may go on must not depend on centimetres.
    pub(crate) fn is_too_near_when_begun(&self, place_m: DVec2, facing: DVec2, gradient: DVec2) -> bool {
        self.at_m(place_m, facing, gradient) < self.least_m.min(BEGUN_SHARE * MARGIN_M)
    }

    /// Whether the body at a pose, on ground with this gradient, is too near to something upright.
    pub(crate) fn is_too_near(&self, place_m: DVec2, facing: DVec2, gradient: DVec2) -> bool {
        self.at_m(place_m, facing, gradient) < self.least_m
    }

    /// The distance from the nearest thing, as far as it is below the margin.
    fn at_m(&self, place_m: DVec2, facing: DVec2, gradient: DVec2) -> f64 {
        let lean_m = self.robot.lean_m(gradient + self.gradient_off);
        let reach_m = self.half_body_m.length() + lean_m.length() + 2.0 * MARGIN_M;
        let from_middle_m = self.things_m.iter().map(|thing_m| thing_m - place_m);
        let near = from_middle_m.filter(|thing_m| thing_m.length_squared() < reach_m * reach_m);
        near.map(|thing_m| distance_from_body_m(self.half_body_m, lean_m, thing_m, facing))
            .fold(MARGIN_M, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::terrain::elevation_window::ElevationWindow;

    const LEVEL: DVec2 = DVec2::ZERO;

    fn ground_with(thing_m: DVec2) -> ElevationWindow {
        let mut ground = ElevationWindow::new(&PlannerConfig::default());
        ground.add(thing_m.extend(0.3));
        (0..20).for_each(|_| ground.add_face(thing_m));
        ground
    }

    fn beside(thing_m: DVec2) -> BodyClearance {
        let mut body =
            BodyClearance::new(&RobotModel { length_m: 1.0, width_m: 0.67, ..RobotModel::husky() }, 7.0);
        body.look(&ground_with(thing_m), DVec2::ZERO, DVec2::X, LEVEL, LEVEL);
        body
    }

    #[test]
    fn a_corner_may_not_sweep_into_what_the_side_passes() {
        let body = beside(DVec2::new(0.3, 0.45));
        assert!(!body.is_too_near(DVec2::ZERO, DVec2::X, LEVEL), "straight on");
        assert!(!body.is_too_near(DVec2::new(0.4, 0.0), DVec2::X, LEVEL), "past it");
        assert!(
            body.is_too_near(DVec2::ZERO, DVec2::new(libm::cos(0.4), libm::sin(0.4)), LEVEL),
            "turned towards it"
        );
        assert!(body.is_too_near(DVec2::new(0.0, 0.1), DVec2::X, LEVEL), "drawn towards it");
    }

    #[test]
    fn a_turn_that_was_begun_comes_nearer_than_one_that_was_not_but_does_not_touch() {
        let facing = |turn_rad: f64| DVec2::from_angle(turn_rad);
        let body = beside(DVec2::new(0.3, 0.45));
        let most_rad = |is_too_near: &dyn Fn(DVec2) -> bool| {
            (0..100).map(|k| 0.01 * f64::from(k)).find(|&turn_rad| is_too_near(facing(turn_rad)))
        };
        let anew_rad = most_rad(&|facing| body.is_too_near(DVec2::ZERO, facing, LEVEL)).unwrap();
        let begun_rad = most_rad(&|facing| body.is_too_near_when_begun(DVec2::ZERO, facing, LEVEL)).unwrap();
        let touches_rad = most_rad(&|facing| body.at_m(DVec2::ZERO, facing, LEVEL) <= 0.0).unwrap();
        assert!(anew_rad < begun_rad && begun_rad < touches_rad, "{anew_rad} {begun_rad} {touches_rad}");
    }

    #[test]
    fn who_is_near_already_may_go_away_but_no_nearer() {
        let body = beside(DVec2::new(0.52, 0.1));
        assert!(!body.is_too_near(DVec2::ZERO, DVec2::X, LEVEL), "where it is");
        assert!(!body.is_too_near(DVec2::new(-0.2, 0.0), DVec2::X, LEVEL), "away");
        assert!(body.is_too_near(DVec2::new(0.1, 0.0), DVec2::X, LEVEL), "nearer");
    }

    #[test]
    fn on_a_slope_the_body_leans_over_to_what_stands_below_it() {
        let body = beside(DVec2::new(0.3, 0.45));
        let slope = |across: f64| DVec2::new(0.0, across);
        assert!(body.is_too_near(DVec2::ZERO, DVec2::X, slope(-0.36)), "20° down to it");
        assert!(!body.is_too_near(DVec2::ZERO, DVec2::X, slope(0.36)), "20° up to it");
        assert!(!body.is_too_near(DVec2::new(0.0, -0.09), DVec2::X, slope(-0.36)), "at 0.39 m × sin 20°");
    }

    #[test]
    fn what_the_attitude_differs_from_the_ground_counts_nearby() {
        let slope = |across: f64| DVec2::new(0.0, across);
        let ahead_m = DVec2::new(0.1, 0.0);
        let thing_m = DVec2::new(0.3, 0.55);
        let mut body = beside(thing_m);
        assert!(!body.is_too_near(ahead_m, DVec2::X, slope(-0.4)));
        body.look(&ground_with(thing_m), DVec2::ZERO, DVec2::X, slope(-0.2), LEVEL);
        assert!(body.is_too_near(ahead_m, DVec2::X, slope(-0.4)));
    }
}
