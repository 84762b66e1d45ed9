//! Memory of dead ends: what was learned of how far the goal is from places around the robot.
//!
//! The straight distance is all that is known of the way to the goal beyond what the scans saw. Where every way on turns
//! out to be longer than that, the places that it leads from are farther from the goal than the straight line says. That is kept, so
//! that the robot does not return there for the same promise: learning real-time A* with a local search space (Koenig and
//! Sun 2009).

use glam::{DVec2, IVec2};

use crate::math::elementary::floor;

/// Places per side of the window that moves with the robot.
const SIDE: i32 = 128;

#[derive(Clone, Copy, Debug)]
struct Known {
    index: IVec2,
    correction_m: f64,
}

/// How much farther the goal is from the places of the ways' lattice than the straight line says.
#[derive(Clone, Debug)]
pub(crate) struct HeuristicTable {
    step_m: f64,
    known: Vec<Option<Known>>,
}

impl HeuristicTable {
    /// For places `step_m` apart.
    pub(crate) fn new(step_m: f64) -> Self {
        Self { step_m, known: vec![None; (SIDE * SIDE) as usize] }
    }

    pub(crate) fn clear(&mut self) {
        self.known.fill(None);
    }

    /// How much farther the goal is from the place nearest to a point than the straight line says, as far as is known.
    pub(crate) fn correction_m(&self, point_m: DVec2) -> f64 {
        let index = self.index_of(point_m);
        self.known[slot_of(index)]
            .filter(|known| known.index == index)
            .map_or(0.0, |known| known.correction_m)
    }

    /// How far the goal is from the place nearest to a point, as far as is known.
    pub(crate) fn left_m(&self, point_m: DVec2, goal_m: DVec2) -> f64 {
        (goal_m - point_m).length() + self.correction_m(point_m)
    }

    /// Keeps that from a place the goal is at least `to_goal_m` away.
    pub(crate) fn learn(&mut self, place_m: DVec2, goal_m: DVec2, to_goal_m: f64) {
        let correction_m = to_goal_m - (goal_m - place_m).length();
        if correction_m > self.correction_m(place_m) {
            let index = self.index_of(place_m);
            self.known[slot_of(index)] = Some(Known { index, correction_m });
        }
    }

    /// Puts the goal farther from the places in a square around a point, `half_side_m` to each side.
    pub(crate) fn raise(&mut self, point_m: DVec2, half_side_m: f64, by_m: f64) {
        let centre = self.index_of(point_m);
        let reach = (half_side_m / self.step_m) as i32;
        for y in -reach..=reach {
            for x in -reach..=reach {
                let index = centre + IVec2::new(x, y);
                let correction_m = self.correction_m(index.as_dvec2() * self.step_m) + by_m;
                self.known[slot_of(index)] = Some(Known { index, correction_m });
            }
        }
    }

    /// Takes a share of every detour.
    pub(crate) fn scale(&mut self, share: f64) {
        for known in self.known.iter_mut().flatten() {
            known.correction_m *= share;
        }
    }

    fn index_of(&self, point_m: DVec2) -> IVec2 {
        let steps = point_m / self.step_m;
        IVec2::new(floor(steps.x + 0.5), floor(steps.y + 0.5))
    }
}

fn slot_of(index: IVec2) -> usize {
    (index.y.rem_euclid(SIDE) * SIDE + index.x.rem_euclid(SIDE)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_M: f64 = 0.5;
    const GOAL_M: DVec2 = DVec2::new(50.0, 0.0);
    const HERE_M: DVec2 = DVec2::new(0.5, 0.5);

    #[test]
    fn what_was_learned_holds_around_its_place_and_only_grows() {
        let mut memory = HeuristicTable::new(STEP_M);
        let straight_m = (GOAL_M - HERE_M).length();
        memory.learn(HERE_M, GOAL_M, 40.0);
        assert!(memory.correction_m(HERE_M) < 1e-12, "less than the straight distance is no news");
        for (told_m, known_m) in [(10.0, 10.0), (5.0, 10.0), (12.0, 12.0)] {
            memory.learn(HERE_M, GOAL_M, straight_m + told_m);
            assert!((memory.correction_m(HERE_M) - known_m).abs() < 1e-12);
        }
        assert!((memory.correction_m(HERE_M + DVec2::splat(0.24)) - 12.0).abs() < 1e-12);
        assert!(memory.correction_m(HERE_M + DVec2::X * STEP_M) < 1e-12);
        memory.clear();
        assert!(memory.correction_m(HERE_M) < 1e-12);
    }

    #[test]
    fn what_is_raised_grows_each_time_and_only_around() {
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
        assert!(memory.correction_m(HERE_M + DVec2::new(f64::from(SIDE) * STEP_M, 0.0)) < 1e-12);
    }
}
