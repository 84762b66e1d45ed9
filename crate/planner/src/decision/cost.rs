//! The cost function J and the choice of the cheapest subgoal (paper, section V-C, eq. 6).

use crate::config::DecisionConfig;
use crate::decision::subgoals::Subgoal;

/// The paper's steepness cost: C_stp = dz² + exp(sign(ψ) dz) |ψ|, with dz the subgoal's height over the robot's and ψ
/// the pitch, nose-up positive, so that it charges subgoals that would increase |ψ|.
pub fn steepness_cost(height_difference_m: f64, pitch_rad: f64) -> f64 {
    let sign = if pitch_rad == 0.0 { 0.0 } else { pitch_rad.signum() };
    height_difference_m * height_difference_m + libm::exp(sign * height_difference_m) * pitch_rad.abs()
}

/// Weights the terms of every candidate and returns the index of the cheapest; the first of equals.
pub(crate) fn choose_cheapest(subgoals: &mut [Subgoal], config: &DecisionConfig) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (index, subgoal) in subgoals.iter_mut().enumerate() {
        let Some(cost) = &mut subgoal.cost else { continue };
        cost.direction *= config.direction_weight;
        cost.distance *= config.distance_weight;
        cost.steepness *= config.steepness_weight;
        cost.commitment *= config.commitment_weight;
        cost.correction *= config.correction_weight;
        let total = cost.total();
        if best.is_none_or(|(_, least)| total < least) {
            best = Some((index, total));
        }
    }
    best.map(|(index, _)| index)
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
