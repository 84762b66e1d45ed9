//! The learned heuristic: a correction of the straight-line cost-to-go for places around the robot.
//!
//! Beyond the elevation window, the straight distance is the only estimate of the cost-to-go. Where every
//! path turns out longer than that, the places it was planned from get a larger cost-to-go, so that the robot
//! does not return for the same estimate. This is learning real-time A* with a local search space, LSS-LRTA*
//! (Koenig and Sun 2009, <https://doi.org/10.1007/s10458-008-9061-x>).

use glam::{DVec2, IVec2};

use crate::math::elementary::floor;
use crate::pose::FrameChange;
use crate::terrain::rolling_grid::RollingGrid;

/// Places per side of the window, which moves with the robot.
const SIDE: usize = 128;

/// Corrections of the straight-line heuristic, in metres, at the places of the state lattice.
#[derive(Clone, Debug)]
pub(crate) struct HeuristicTable {
    step_m: f64,
    /// Corrections in metres.
    corrections_m: RollingGrid<f64>,
}

impl HeuristicTable {
    /// An empty table for places `step_m` apart.
    pub(crate) fn new(step_m: f64) -> Self {
        Self { step_m, corrections_m: RollingGrid::new(SIDE) }
    }

    pub(crate) fn clear(&mut self) {
        self.corrections_m.clear();
    }

    /// Learned cost-to-go at the place nearest to a point, less the straight distance; 0 where nothing was
    /// learned.
    pub(crate) fn correction_m(&self, point_m: DVec2) -> f64 {
        self.corrections_m.get(self.index_of(point_m)).copied().unwrap_or(0.0)
    }

    /// Cost-to-go at the place nearest to a point: the straight distance and the correction.
    pub(crate) fn cost_to_go_m(&self, point_m: DVec2, goal_m: DVec2) -> f64 {
        (goal_m - point_m).length() + self.correction_m(point_m)
    }

    /// Raises the cost-to-go of a place to `to_goal_m`, if that is more than before.
    pub(crate) fn learn(&mut self, place_m: DVec2, goal_m: DVec2, to_goal_m: f64) {
        let correction_m = to_goal_m - (goal_m - place_m).length();
        if correction_m > self.correction_m(place_m) {
            self.corrections_m.set(self.index_of(place_m), correction_m);
        }
    }

    /// Adds `by_m` to the corrections in a square around a point, `half_side_m` to each side.
    pub(crate) fn raise(&mut self, point_m: DVec2, half_side_m: f64, by_m: f64) {
        let centre = self.index_of(point_m);
        let reach = (half_side_m / self.step_m) as i32;
        for y in -reach..=reach {
            for x in -reach..=reach {
                let index = centre + IVec2::new(x, y);
                let correction_m = self.correction_m(index.as_dvec2() * self.step_m) + by_m;
                self.corrections_m.set(index, correction_m);
            }
        }
    }

    /// Multiplies every correction by `share`.
    pub(crate) fn scale(&mut self, share: f64) {
        for correction_m in self.corrections_m.cells_mut() {
            *correction_m *= share;
        }
    }

    /// Moves the corrections from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        let mut moved = RollingGrid::new(SIDE);
        for (index, &correction_m) in self.corrections_m.iter() {
            moved.set(self.index_of(change.place_m(index.as_dvec2() * self.step_m)), correction_m);
        }
        self.corrections_m = moved;
    }

    fn index_of(&self, point_m: DVec2) -> IVec2 {
        let steps = point_m / self.step_m;
        IVec2::new(floor(steps.x + 0.5), floor(steps.y + 0.5))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_M: f64 = 0.5;
    const GOAL_M: DVec2 = DVec2::new(50.0, 0.0);
    const HERE_M: DVec2 = DVec2::new(0.5, 0.5);

    #[test]
    fn a_correction_holds_around_its_place_and_only_grows() {
        let mut memory = HeuristicTable::new(STEP_M);
        let straight_m = (GOAL_M - HERE_M).length();
        memory.learn(HERE_M, GOAL_M, 40.0);
        assert!(memory.correction_m(HERE_M) < 1e-12, "less than the straight distance is no news");
        for (learned_m, known_m) in [(10.0, 10.0), (5.0, 10.0), (12.0, 12.0)] {
            memory.learn(HERE_M, GOAL_M, straight_m + learned_m);
            assert!((memory.correction_m(HERE_M) - known_m).abs() < 1e-12);
        }
        assert!((memory.correction_m(HERE_M + DVec2::splat(0.24)) - 12.0).abs() < 1e-12);
        assert!(memory.correction_m(HERE_M + DVec2::X * STEP_M) < 1e-12);
        memory.clear();
        assert!(memory.correction_m(HERE_M) < 1e-12);
    }

    #[test]
    fn raised_corrections_add_up_and_only_nearby() {
        let mut memory = HeuristicTable::new(STEP_M);
        memory.learn(HERE_M, GOAL_M, (GOAL_M - HERE_M).length() + 3.0);
        for times in 1..=3 {
            memory.raise(HERE_M, 1.0, 7.0);
            assert!((memory.correction_m(HERE_M) - 3.0 - 7.0 * f64::from(times)).abs() < 1e-12);
            assert!((memory.correction_m(HERE_M + DVec2::splat(1.0)) - 7.0 * f64::from(times)).abs() < 1e-12);
            assert!(memory.correction_m(HERE_M + DVec2::X * 1.5) < 1e-12);
        }
        memory.scale(0.25);
        assert!((memory.correction_m(HERE_M) - 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_place_far_away_does_not_answer_for_another() {
        let mut memory = HeuristicTable::new(STEP_M);
        memory.learn(HERE_M, GOAL_M, 1e3);
        assert!(memory.correction_m(HERE_M + DVec2::new(SIDE as f64 * STEP_M, 0.0)) < 1e-12);
    }
}
