//! The detour budget: how far the robot drives towards a goal at the configured cost of slopes.
//!
//! If the only path is a steep one, it costs more than many detours on the level ground before it, and the
//! robot tries all of those first. Once the budget is spent, slopes cost less.

use glam::DVec2;

use crate::pose::FrameChange;

/// The budget is this multiple of the straight distance, which counts as at least this long.
const STRAIGHT_TIMES: f64 = 2.0;
const LEAST_STRAIGHT_M: f64 = 10.0;

/// The distance that may still be driven before slopes cost less.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DetourBudget {
    last_m: DVec2,
    left_m: f64,
}

impl DetourBudget {
    /// A full budget for a robot that sets out from `here_m`.
    pub(crate) fn new(here_m: DVec2, goal_m: DVec2) -> Self {
        let straight_m = (goal_m - here_m).length().max(LEAST_STRAIGHT_M);
        Self { last_m: here_m, left_m: STRAIGHT_TIMES * straight_m }
    }

    /// Subtracts the distance driven to `here_m`; true on the call that spends the budget.
    pub(crate) fn is_spent_now(&mut self, here_m: DVec2) -> bool {
        let had_some = self.left_m > 0.0;
        self.left_m -= (here_m - self.last_m).length();
        self.last_m = here_m;
        had_some && self.left_m <= 0.0
    }
}

impl DetourBudget {
    /// Moves the last position from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        self.last_m = change.place_m(self.last_m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spent_after_m(straight_m: f64) -> f64 {
        let mut budget = DetourBudget::new(DVec2::ZERO, DVec2::X * straight_m);
        let to_and_fro = |k: i32| DVec2::Y * 0.5 * f64::from(k % 2);
        let spent: Vec<_> = (1..1000).filter(|&k| budget.is_spent_now(to_and_fro(k))).collect();
        assert_eq!(spent.len(), 1, "it is spent once");
        0.5 * f64::from(spent[0])
    }

    #[test]
    fn the_budget_is_spent_once_after_twice_the_straight_distance() {
        assert!((spent_after_m(30.0) - 60.0).abs() < 1e-9);
        assert!((spent_after_m(1.0) - 20.0).abs() < 1e-9);
    }
}
