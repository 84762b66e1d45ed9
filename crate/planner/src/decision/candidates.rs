//! Candidate targets: the subgoals of the segments, the goal, the committed target, and the frontier.

use glam::DVec2;

use crate::config::PlannerConfig;
use crate::decision::subgoals::{Refusal, Subgoal, bearing_rad};
use crate::pose::Pose;
use crate::route::forecast::{Forecast, ReachEnd};
use crate::route::state_lattice::{PathPoint, ReachedState, StateLattice};
use crate::skyline::columns::column_of;
use crate::skyline::profile::Column;

/// Finds candidates from the robot's pose.
pub(crate) struct Candidates<'a> {
    pub(crate) config: &'a PlannerConfig,
    pub(crate) pose: &'a Pose,
    pub(crate) lattice: &'a StateLattice,
    /// Scratch.
    pub(crate) path: &'a mut Vec<PathPoint>,
}

impl Candidates<'_> {
    /// Moves a subgoal to the farthest reachable place in its direction; refuses it if that is too near.
    pub(crate) fn move_within_reach(&mut self, subgoal: &mut Subgoal) {
        let Self { config, pose, lattice, .. } = *self;
        let (sin, cos) = libm::sincos(pose.yaw_rad + subgoal.bearing_rad);
        let direction = DVec2::new(cos, sin);
        let (reach_m, end) = lattice.reach_along(direction, config.perception.surface_radius_m);
        let end_m = pose.plan_m() + direction * reach_m;
        let reached = lattice
            .to(end_m)
            .filter(|_| end == ReachEnd::Whole || reach_m >= config.state_lattice.min_reach_m);
        let found = reached.map_or(Forecast::default(), |reached| lattice.follow(reached, self.path));
        let height_m = reached.map_or(pose.position_m.z, |reached| lattice.height_m(reached));
        subgoal.position_m = end_m.extend(height_m);
        subgoal.forecast = Some(Forecast { reach_m, end, ..found });
        subgoal.refusal = match (reached, end) {
            (Some(_), _) => None,
            (None, ReachEnd::Unseen) => Some(Refusal::Unseen),
            (None, _) => Some(Refusal::Tilt),
        };
    }

    /// The goal itself, if a path leads to it or to a place within its tolerance.
    pub(crate) fn goal(&mut self, goal_m: DVec2, tolerance_m: f64) -> Option<Subgoal> {
        let distance_m = (goal_m - self.pose.plan_m()).length();
        if distance_m >= self.config.perception.surface_radius_m {
            return None;
        }
        let (reached, place_m) = self.lattice.to_within(goal_m, tolerance_m)?;
        Some(self.place(place_m, reached, ReachEnd::Whole))
    }

    /// The frontier place with the best path to the goal, by `cost_to_go_m` from there; walls do not count as
    /// frontier. On top of a steep hill no beam reaches the flanks, so no segment carries a subgoal; more can
    /// be seen from the frontier.
    pub(crate) fn frontier(
        &mut self,
        profile: &[Column],
        cost_to_go_m: impl Fn(DVec2) -> f64,
    ) -> Option<Subgoal> {
        let is_wall = |place_m| profile[column_of(bearing_rad(self.pose, place_m))] == Column::Wall;
        let total_m = |&(reached, place_m): &(ReachedState, DVec2)| {
            self.lattice.cost_m(reached) + cost_to_go_m(place_m)
        };
        let edge = self.lattice.frontier().filter(|&(_, place_m)| !is_wall(place_m));
        let (reached, place_m) = edge.min_by(|a, b| total_m(a).total_cmp(&total_m(b)))?;
        Some(self.place(place_m, reached, ReachEnd::Unseen))
    }

    /// A subgoal at a reached place.
    pub(crate) fn place(&mut self, place_m: DVec2, reached: ReachedState, end: ReachEnd) -> Subgoal {
        let reach_m = (place_m - self.pose.plan_m()).length();
        let height_m = self.lattice.height_m(reached);
        let bearing_rad = bearing_rad(self.pose, place_m);
        let over_sensor_m = height_m - self.pose.position_m.z - self.config.sensor.height_m;
        Subgoal {
            segment: None,
            azimuth_rad: bearing_rad,
            elevation_rad: libm::atan2(over_sensor_m, reach_m),
            position_m: place_m.extend(height_m),
            bearing_rad,
            forecast: Some(Forecast { reach_m, end, ..self.lattice.follow(reached, self.path) }),
            refusal: None,
            cost: None,
        }
    }
}
