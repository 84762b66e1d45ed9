//! The cost function J and the choice of the subgoal (paper, section V-C, eq. 6).

use core::f64::consts::PI;

use glam::DVec2;

use crate::config::{CostModel, DecisionConfig};
use crate::decision::subgoals::Subgoal;
use crate::math::angle::difference_rad;
use crate::pose::Pose;
use crate::route::heuristic_table::HeuristicTable;

/// The weighted terms of J for one subgoal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// k_dir times the direction cost.
    pub direction: f64,
    /// k_dst times the distance cost.
    pub distance: f64,
    /// k_stp times the steepness cost.
    pub steepness: f64,
    /// Charge for turning away from the last choice.
    pub commitment: f64,
    /// Charge for the detour that is known from there.
    pub dead_end: f64,
}

impl Cost {
    /// J.
    pub fn total(&self) -> f64 {
        self.direction + self.distance + self.steepness + self.commitment + self.dead_end
    }
}

/// The paper's steepness cost: C_stp = dz² + exp(sign(ψ) dz) |ψ|, with dz the subgoal's height over the robot's and ψ
/// the pitch, nose-up positive, so that it charges subgoals that would increase |ψ|.
pub fn steepness_cost(height_difference_m: f64, pitch_rad: f64) -> f64 {
    let sign = if pitch_rad == 0.0 { 0.0 } else { pitch_rad.signum() };
    height_difference_m * height_difference_m + libm::exp(sign * height_difference_m) * pitch_rad.abs()
}

/// What the terms are measured against.
pub(crate) struct Situation<'a> {
    pub(crate) pose: &'a Pose,
    pub(crate) goal_m: DVec2,
    pub(crate) surface_radius_m: f64,
    /// World bearing of the last choice.
    pub(crate) last_bearing_rad: Option<f64>,
    pub(crate) heuristic: &'a HeuristicTable,
}

/// Gives every candidate its cost and returns the index of the cheapest; the first of equals.
pub(crate) fn choose(
    subgoals: &mut [Subgoal],
    config: &DecisionConfig,
    situation: &Situation<'_>,
) -> Option<usize> {
    for subgoal in subgoals.iter_mut() {
        subgoal.cost = subgoal.refusal.is_none().then(|| match config.cost_model {
            CostModel::Paper => paper_terms(subgoal, situation),
            CostModel::Forecast => forecast_terms(subgoal, config, situation),
        });
    }
    if config.cost_model == CostModel::Paper {
        normalise(subgoals);
    }
    let mut best: Option<(usize, f64)> = None;
    for (index, subgoal) in subgoals.iter_mut().enumerate() {
        let Some(cost) = &mut subgoal.cost else { continue };
        cost.direction *= config.direction_weight;
        cost.distance *= config.distance_weight;
        cost.steepness *= config.steepness_weight;
        cost.commitment *= config.commitment_weight;
        cost.dead_end *= config.correction_weight;
        let total = cost.total();
        if best.is_none_or(|(_, least)| total < least) {
            best = Some((index, total));
        }
    }
    best.map(|(index, _)| index)
}

/// |α_g|, D_fg and C_stp, not yet normalised.
fn paper_terms(subgoal: &Subgoal, situation: &Situation<'_>) -> Cost {
    Cost {
        direction: subgoal.azimuth_rad.abs(),
        distance: (situation.goal_m - subgoal.position_m.truncate()).length(),
        steepness: steepness_cost(
            subgoal.position_m.z - situation.pose.position_m.z,
            situation.pose.pitch_rad,
        ),
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

/// Every term on a fixed scale: half a turn, the surface's radius, the tilt limits.
fn forecast_terms(subgoal: &Subgoal, config: &DecisionConfig, situation: &Situation<'_>) -> Cost {
    let here = situation.pose.plan_m();
    let there = subgoal.position_m.truncate();
    let forecast = subgoal.forecast.unwrap_or_default();
    let around_m = forecast.path_m - forecast.reach_m + config.climb_weight * forecast.climb_m;
    let lost_m = (situation.goal_m - there).length() - (situation.goal_m - here).length() + around_m;
    let turn = situation
        .last_bearing_rad
        .map_or(0.0, |last| difference_rad(situation.pose.yaw_rad + subgoal.bearing_rad, last));
    let correction_m = situation.heuristic.correction_m(there);
    Cost {
        direction: subgoal.bearing_rad.abs() / PI,
        distance: 0.5 + 0.5 * lost_m / situation.surface_radius_m,
        steepness: forecast.mean_risk,
        commitment: turn.abs() / PI,
        dead_end: 0.5 * correction_m / situation.surface_radius_m,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steepness_charges_what_would_increase_the_pitch() {
        assert!(steepness_cost(1.0, 0.3) > steepness_cost(-1.0, 0.3));
        assert!(steepness_cost(-1.0, -0.3) > steepness_cost(1.0, -0.3));
        assert!((steepness_cost(2.0, 0.0) - 4.0).abs() < 1e-15);
    }
}
