//! The policy `paper`: subgoals on the skyline at r_oc, judged by their height alone; three normalised cost
//! terms (paper, section V-C, eq. 6).

use core::time::Duration;

use glam::DVec2;

use crate::config::PlannerConfig;
use crate::control::controller::Controller;
use crate::decision::cost::{choose_cheapest, steepness_cost};
use crate::decision::policy::{Motion, Plan, Situation, SubgoalPolicy};
use crate::decision::subgoals::{Cost, Subgoal, bearing_rad, on_segments};
use crate::pose::Pose;
use crate::skyline::columns::column_of;
use crate::skyline::profile::Column;
use crate::skyline::scan_filter::ScanFilter;

/// The policy has no memory.
#[derive(Clone, Debug)]
pub(crate) struct PaperPolicy;

impl SubgoalPolicy for PaperPolicy {
    fn start(&mut self) {}

    fn forget_terrain(&mut self) {}

    fn observe(&mut self, _: &PlannerConfig, _: &ScanFilter, _: &Pose, _: Duration) {}

    fn decide(&mut self, situation: &Situation<'_>, controller: &mut Controller, plan: &mut Plan) -> Motion {
        let Situation { config, pose, .. } = *situation;
        plan.subgoals.extend(on_segments(config, pose, situation.segments));
        plan.chosen = if let Some(goal) = goal_in_sight(situation) {
            plan.subgoals.push(goal);
            Some(plan.subgoals.len() - 1)
        } else {
            for subgoal in &mut plan.subgoals {
                subgoal.cost = Some(terms(subgoal, situation));
            }
            normalise(&mut plan.subgoals);
            choose_cheapest(&mut plan.subgoals, &config.decision)
        };
        let Some(chosen) = plan.chosen else { return Motion::NoCandidate };
        let subgoal = &plan.subgoals[chosen];
        let distance_m = (subgoal.position_m.truncate() - pose.plan_m()).length();
        Motion::Drive(controller.drive(distance_m, subgoal.bearing_rad, situation.elapsed))
    }

    fn stand(&mut self, _: &Pose, _: Duration) {}

    fn safe_turn_rad(&self, turn_rad: f64) -> f64 {
        turn_rad
    }

    fn has_room_within(&self, _: DVec2, _: f64) -> Option<bool> {
        None
    }

    fn may_spin(&self) -> bool {
        true
    }
}

/// The goal itself, if it is nearer than the profile in its direction.
fn goal_in_sight(situation: &Situation<'_>) -> Option<Subgoal> {
    let Situation { config, pose, goal_m, profile, .. } = *situation;
    let distance_m = (goal_m - pose.plan_m()).length();
    let bearing_rad = bearing_rad(pose, goal_m);
    let Column::Ground { elevation_rad } = profile[column_of(bearing_rad)] else { return None };
    (distance_m < config.perception.surface_radius_m * libm::cos(elevation_rad)).then_some(Subgoal {
        segment: None,
        azimuth_rad: bearing_rad,
        elevation_rad: -libm::atan2(config.sensor.height_m, distance_m),
        position_m: goal_m.extend(pose.position_m.z),
        bearing_rad,
        forecast: None,
        refusal: None,
        cost: None,
    })
}

/// |α_g|, D_fg and C_stp, not yet normalised.
fn terms(subgoal: &Subgoal, situation: &Situation<'_>) -> Cost {
    let Situation { pose, goal_m, .. } = *situation;
    Cost {
        direction: subgoal.azimuth_rad.abs(),
        distance: (goal_m - subgoal.position_m.truncate()).length(),
        steepness: steepness_cost(subgoal.position_m.z - pose.position_m.z, pose.pitch_rad),
        ..Cost::default()
    }
}

/// Divides each term by its greatest value over the candidates.
fn normalise(subgoals: &mut [Subgoal]) {
    let mut most = Cost::default();
    for cost in subgoals.iter().filter_map(|s| s.cost) {
        most.direction = most.direction.max(cost.direction);
        most.distance = most.distance.max(cost.distance);
        most.steepness = most.steepness.max(cost.steepness);
    }
    let share = |value: f64, most: f64| if most > 0.0 { value / most } else { 0.0 };
    for cost in subgoals.iter_mut().filter_map(|s| s.cost.as_mut()) {
        cost.direction = share(cost.direction, most.direction);
        cost.distance = share(cost.distance, most.distance);
        cost.steepness = share(cost.steepness, most.steepness);
    }
}
