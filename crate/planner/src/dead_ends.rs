//! Memory of dead ends: what was learned of how far the goal is from places around the robot.
//!
//! The straight distance is all that is known of the way to the goal beyond what the scans saw. Where every way on turns
//! out to be longer than that, the places from which those ways were looked for must be farther from the goal than the straight line
//! says. That is kept, so that the robot does not return there for the same promise: learning real-time A* with a local
//! search space (Koenig and Sun 2009), on cells of a metre.

use glam::{DVec2, IVec2};

use crate::elementary::floor;

/// Side of a cell.
const CELL_M: f64 = 1.0;
/// Cells per side of the window that moves with the robot.
const SIDE: i32 = 64;

#[derive(Clone, Copy, Debug)]
struct Cell {
    index: IVec2,
    to_goal_m: f64,
}

/// How far the goal is from places around the robot, where that is more than the straight distance.
#[derive(Clone, Debug)]
pub(crate) struct DeadEnds {
    cells: Vec<Option<Cell>>,
}

impl DeadEnds {
    pub(crate) fn new() -> Self {
        Self { cells: vec![None; (SIDE * SIDE) as usize] }
    }

    pub(crate) fn clear(&mut self) {
        self.cells.fill(None);
    }

    /// How much farther the goal is from a place than the straight line says, as far as is known.
    pub(crate) fn detour_m(&self, position_m: DVec2, goal_m: DVec2) -> f64 {
        let index = index_of(position_m);
        match self.cells[slot_of(index)] {
            Some(cell) if cell.index == index => (cell.to_goal_m - (goal_m - position_m).length()).max(0.0),
            _ => 0.0,
        }
    }

    /// Keeps that from a place the goal is at least `to_goal_m` away.
    pub(crate) fn learn(&mut self, position_m: DVec2, goal_m: DVec2, to_goal_m: f64) {
        if to_goal_m <= (goal_m - position_m).length() {
            return;
        }
        let index = index_of(position_m);
        let slot = &mut self.cells[slot_of(index)];
        let known_m = slot.filter(|cell| cell.index == index).map_or(0.0, |cell| cell.to_goal_m);
        *slot = Some(Cell { index, to_goal_m: to_goal_m.max(known_m) });
    }
}

fn index_of(position_m: DVec2) -> IVec2 {
    let cells = position_m / CELL_M;
    IVec2::new(floor(cells.x), floor(cells.y))
}

fn slot_of(index: IVec2) -> usize {
    (index.y.rem_euclid(SIDE) * SIDE + index.x.rem_euclid(SIDE)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOAL_M: DVec2 = DVec2::new(50.0, 0.0);
    const HERE_M: DVec2 = DVec2::new(0.5, 0.5);

    #[test]
    fn what_was_learned_holds_in_its_cell_and_only_grows() {
        let mut memory = DeadEnds::new();
        assert!(memory.detour_m(HERE_M, GOAL_M) < 1e-12);
        memory.learn(HERE_M, GOAL_M, 40.0);
        assert!(memory.detour_m(HERE_M, GOAL_M) < 1e-12, "less than the straight distance is no news");
        let straight_m = (GOAL_M - HERE_M).length();
        memory.learn(HERE_M, GOAL_M, straight_m + 10.0);
        memory.learn(HERE_M, GOAL_M, straight_m + 5.0);
        assert!((memory.detour_m(HERE_M, GOAL_M) - 10.0).abs() < 1e-12);
        assert!(memory.detour_m(HERE_M + DVec2::X, GOAL_M) < 1e-12);
        memory.clear();
        assert!(memory.detour_m(HERE_M, GOAL_M) < 1e-12);
    }

    #[test]
    fn a_place_far_away_does_not_answer_for_another() {
        let mut memory = DeadEnds::new();
        memory.learn(HERE_M, GOAL_M, 1e3);
        assert!(memory.detour_m(HERE_M + DVec2::new(f64::from(SIDE) * CELL_M, 0.0), GOAL_M) < 1e-12);
    }
}
