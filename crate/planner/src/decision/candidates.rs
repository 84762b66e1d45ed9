//! What the robot may head for: the subgoals of the segments, the goal, what it headed for before, and where what was seen ends.

use glam::DVec2;

use crate::config::{CostModel, PlannerConfig};
use crate::decision::subgoals::{
    Refusal, Subgoal, bearing_rad, carries_subgoals, spread_azimuths, world_position_m,
};
use crate::pose::Pose;
use crate::route::forecast::{Forecast, ReachEnd};
use crate::route::state_lattice::{PathPoint, ReachedState, StateLattice};
use crate::skyline::occupancy::column_of;
use crate::skyline::profile::Column;
use crate::skyline::segments::Segment;

/// Finds candidates from where the robot stands.
pub(crate) struct Candidates<'a> {
    pub(crate) config: &'a PlannerConfig,
    pub(crate) pose: &'a Pose,
    pub(crate) lattice: &'a StateLattice,
    /// Overwritten.
    pub(crate) path: &'a mut Vec<PathPoint>,
}

impl Candidates<'_> {
    /// The subgoals of the segments, refused ones too.
    pub(crate) fn on_segments(&mut self, segments: &[Segment], subgoals: &mut Vec<Subgoal>) {
        let Self { config, pose, .. } = *self;
        let radius_m = config.perception.surface_radius_m;
        for (index, segment) in segments.iter().enumerate() {
            if !carries_subgoals(segment, config.robot.width_m, &config.segments) {
                continue;
            }
            let elevation_rad = segment.elevation_rad.unwrap_or(config.sensor.lowest_elevation_rad);
            for azimuth_rad in spread_azimuths(segment, config.robot.width_m, &config.segments) {
                let skyline_m = world_position_m(pose, &config.sensor, azimuth_rad, elevation_rad, radius_m);
                let mut subgoal = Subgoal {
                    segment: Some(index),
                    azimuth_rad,
                    elevation_rad,
                    position_m: skyline_m,
                    bearing_rad: bearing_rad(pose, skyline_m.truncate()),
                    forecast: None,
                    refusal: None,
                    cost: None,
                };
                if config.decision.cost_model == CostModel::Forecast {
                    self.look_along(&mut subgoal);
                }
                subgoals.push(subgoal);
            }
        }
    }

    /// Moves a subgoal to where the ways in its direction reach, and refuses it when that is too near.
    fn look_along(&mut self, subgoal: &mut Subgoal) {
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

    /// The goal itself, when it is nearer than what was seen in its direction or, with the forecast, when a way leads to it or to a
    /// place within its tolerance.
    pub(crate) fn goal(&mut self, goal_m: DVec2, profile: &[Column]) -> Option<Subgoal> {
        let distance_m = (goal_m - self.pose.plan_m()).length();
        let radius_m = self.config.perception.surface_radius_m;
        match self.config.decision.cost_model {
            CostModel::Paper => {
                let bearing_rad = bearing_rad(self.pose, goal_m);
                let Column::Ground { elevation_rad } = profile[column_of(bearing_rad)] else { return None };
                (distance_m < radius_m * libm::cos(elevation_rad)).then_some(Subgoal {
                    segment: None,
                    azimuth_rad: bearing_rad,
                    elevation_rad: -libm::atan2(self.config.sensor.height_m, distance_m),
                    position_m: goal_m.extend(self.pose.position_m.z),
                    bearing_rad,
                    forecast: None,
                    refusal: None,
                    cost: None,
                })
            }
            CostModel::Forecast if distance_m < radius_m => {
                let (reached, place_m) = self.lattice.to_within(goal_m, self.config.goal_tolerance_m)?;
                Some(self.place(place_m, reached, ReachEnd::Whole))
            }
            CostModel::Forecast => None,
        }
    }

    /// Where what was seen ends, walls apart, on the best way to the goal with what is `left_m` from there. On top of a steep hill no
    /// beam reaches the flanks, and no segment carries a subgoal: from the edge more will be seen.
    pub(crate) fn edge_of_sight(
        &mut self,
        profile: &[Column],
        left_m: impl Fn(DVec2) -> f64,
    ) -> Option<Subgoal> {
        let is_wall = |place_m| profile[column_of(bearing_rad(self.pose, place_m))] == Column::Wall;
        let total_m =
            |&(reached, place_m): &(ReachedState, DVec2)| self.lattice.cost_m(reached) + left_m(place_m);
        let edge = self.lattice.frontier().filter(|&(_, place_m)| !is_wall(place_m));
        let (reached, place_m) = edge.min_by(|a, b| total_m(a).total_cmp(&total_m(b)))?;
        Some(self.place(place_m, reached, ReachEnd::Unseen))
    }

    /// A place that a way leads to.
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
