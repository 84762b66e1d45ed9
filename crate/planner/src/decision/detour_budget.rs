//! How long the robot goes around steep ground at the price that is configured.
//!
//! Where the only way is a steep one, it costs more than much driving to and fro on the ground before it: a robot that minds steepness
//! tries all of that first. So one that has driven far without getting there minds it less.

use glam::DVec2;

/// DetourBudget lasts for so many times the straight way, which counts as this long at least.
const STRAIGHT_TIMES: f64 = 2.0;
const LEAST_STRAIGHT_M: f64 = 10.0;

/// The way that the robot has driven towards a goal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DetourBudget {
    last_m: DVec2,
    left_m: f64,
}

impl DetourBudget {
    /// Of a robot that sets out.
    pub(crate) fn new(here_m: DVec2, goal_m: DVec2) -> Self {
        let straight_m = (goal_m - here_m).length().max(LEAST_STRAIGHT_M);
        Self { last_m: here_m, left_m: STRAIGHT_TIMES * straight_m }
    }

    /// Whether it is lost just now, with the robot here.
    pub(crate) fn lost(&mut self, here_m: DVec2) -> bool {
        let had_some = self.left_m > 0.0;
        self.left_m -= (here_m - self.last_m).length();
        self.last_m = here_m;
        had_some && self.left_m <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lost_after_m(straight_m: f64) -> f64 {
        let mut patience = DetourBudget::new(DVec2::ZERO, DVec2::X * straight_m);
        let to_and_fro = |k: i32| DVec2::Y * 0.5 * f64::from(k % 2);
        let lost: Vec<_> = (1..1000).filter(|&k| patience.lost(to_and_fro(k))).collect();
        assert_eq!(lost.len(), 1, "it is lost once");
        0.5 * f64::from(lost[0])
    }

    #[test]
    fn patience_is_lost_once_after_twice_the_straight_way() {
        assert!((lost_after_m(30.0) - 60.0).abs() < 1e-9);
        assert!((lost_after_m(1.0) - 20.0).abs() < 1e-9);
    }
}
