//! The distance of the body from what stands upright around it, at any pose near the robot.

use glam::DVec2;

use crate::robot_model::distance_from_body_m;
use crate::terrain::elevation_window::TerrainQuery;

/// The robot keeps this far from what is upright, or as far as it already is.
const MARGIN_M: f64 = 0.05;
/// Things that there is room for without an allocation.
const USUAL_THINGS: usize = 4096;

/// What stands upright around the robot.
#[derive(Clone, Debug)]
pub(crate) struct BodyClearance {
    half_body_m: DVec2,
    radius_m: f64,
    things_m: Vec<DVec2>,
    least_m: f64,
}

impl BodyClearance {
    /// With things within `radius_m` of the robot.
    pub(crate) fn new(half_body_m: DVec2, radius_m: f64) -> Self {
        Self { half_body_m, radius_m, things_m: Vec::with_capacity(USUAL_THINGS), least_m: MARGIN_M }
    }

    /// Looks at the ground around a robot at `here_m`, which faces along a unit vector.
    pub(crate) fn look(&mut self, ground: &dyn TerrainQuery, here_m: DVec2, facing: DVec2) {
        self.things_m.clear();
        ground.each_upright(here_m, self.radius_m, &mut |thing_m| self.things_m.push(thing_m));
        self.least_m = self.at_m(here_m, facing);
    }

    /// Whether the body at a pose is too near to something upright.
    pub(crate) fn is_too_near(&self, place_m: DVec2, facing: DVec2) -> bool {
        self.at_m(place_m, facing) < self.least_m
    }

    /// The distance from the nearest thing, as far as it is below the margin.
    fn at_m(&self, place_m: DVec2, facing: DVec2) -> f64 {
        let reach_m = self.half_body_m.length() + 2.0 * MARGIN_M;
        let from_middle_m = self.things_m.iter().map(|thing_m| thing_m - place_m);
        let near = from_middle_m.filter(|thing_m| thing_m.length_squared() < reach_m * reach_m);
        near.map(|thing_m| distance_from_body_m(self.half_body_m, thing_m, facing)).fold(MARGIN_M, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::terrain::elevation_window::ElevationWindow;

    fn beside(thing_m: DVec2) -> BodyClearance {
        let mut ground = ElevationWindow::new(&PlannerConfig::default());
        ground.add(thing_m.extend(0.3));
        (0..20).for_each(|_| ground.add_face(thing_m));
        let mut body = BodyClearance::new(DVec2::new(0.5, 0.335), 7.0);
        body.look(&ground, DVec2::ZERO, DVec2::X);
        body
    }

    #[test]
    fn a_corner_may_not_sweep_into_what_the_side_passes() {
        let body = beside(DVec2::new(0.3, 0.45));
        assert!(!body.is_too_near(DVec2::ZERO, DVec2::X), "straight on");
        assert!(!body.is_too_near(DVec2::new(0.4, 0.0), DVec2::X), "past it");
        assert!(
            body.is_too_near(DVec2::ZERO, DVec2::new(libm::cos(0.4), libm::sin(0.4))),
            "turned towards it"
        );
        assert!(body.is_too_near(DVec2::new(0.0, 0.1), DVec2::X), "drawn towards it");
    }

    #[test]
    fn who_is_near_already_may_go_away_but_no_nearer() {
        let body = beside(DVec2::new(0.52, 0.1));
        assert!(!body.is_too_near(DVec2::ZERO, DVec2::X), "where it is");
        assert!(!body.is_too_near(DVec2::new(-0.2, 0.0), DVec2::X), "away");
        assert!(body.is_too_near(DVec2::new(0.1, 0.0), DVec2::X), "nearer");
    }
}
