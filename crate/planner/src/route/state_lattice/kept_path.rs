//! The path that is driven, as far as the next search must know it.
//!
//! Two searches a few centimetres apart may judge the ground, or a turn on the spot, differently. If each
//! began anew, the robot would sway between their paths. So the next state of the path stays possible while
//! its place is safe, and the path is left only for one that is cheaper by
//! [`WORTH_LEAVING_M`](super::WORTH_LEAVING_M).

use glam::DVec2;

use super::path::Entered;
use super::{FIRST_STEP_M, ReachedState, StateLattice};

/// The robot is on a path this near to it: what the search judged of the path holds.
pub(crate) const ON_PATH_M: f64 = 0.25;

/// A state that a path enters by a drive. Its position outlives a move of the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KeptState {
    pub(super) position_m: DVec2,
    pub(super) heading: usize,
    pub(super) reverse: bool,
}

/// The next two states of the driven path.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct KeptPath {
    /// Where the robot was when it set out to the next state.
    from_m: DVec2,
    next: Option<KeptState>,
    after: Option<KeptState>,
}

impl KeptPath {
    /// Whether the path begins in reverse.
    pub(super) fn is_reverse(&self) -> bool {
        self.next.is_some_and(|next| next.reverse)
    }

    /// The next state for a robot at `here_m`, which may have passed the last one.
    pub(super) fn next(&mut self, here_m: DVec2) -> Option<KeptState> {
        let next = self.next?;
        let way_m = next.position_m - here_m;
        let is_passed = way_m.length() < FIRST_STEP_M || way_m.dot(next.position_m - self.from_m) <= 0.0;
        if is_passed {
            *self = Self { from_m: here_m, next: self.after, after: None };
        }
        self.next
    }

    /// The turn on the spot, anticlockwise, that leads to the next state, if the robot is on the path.
    pub(super) fn turn_rad(&self, here_m: DVec2, facing: DVec2) -> Option<f64> {
        let next = self.next?;
        let leg_m = next.position_m - self.from_m;
        let share = ((here_m - self.from_m).dot(leg_m) / leg_m.length_squared().max(1e-9)).clamp(0.0, 1.0);
        let away_m = here_m.distance(self.from_m + share * leg_m);
        let way_m = next.position_m - here_m;
        let wanted = if next.reverse { -way_m } else { way_m };
        let turn_rad = libm::atan2(facing.perp_dot(wanted), facing.dot(wanted));
        (away_m <= ON_PATH_M).then_some(turn_rad)
    }
}

impl StateLattice {
    /// The path to a reached state as the one to keep.
    pub(super) fn kept_path_to(&self, reached: ReachedState) -> KeptPath {
        let (mut next, mut after) = (None, None);
        for entered in self.entered(reached) {
            after = next;
            let Entered { position_m, heading, reverse, .. } = entered;
            next = Some(KeptState { position_m, heading, reverse });
        }
        let from_m = if next == self.kept.next { self.kept.from_m } else { self.here_m };
        KeptPath { from_m, next, after }
    }
}
