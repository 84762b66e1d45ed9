//! What the planner takes each return of a scan for.

use mapless::skyline::scan_filter::ReturnKind;
use serde::Serialize;
use tsify::Tsify;

/// How many returns of the last scan the planner set aside, by kind.
#[derive(Debug, Default, PartialEq, Eq, Serialize, Tsify)]
pub struct SetAside {
    /// Rain, dust, insects, multipath.
    stray: usize,
    /// The robot itself.
    body: usize,
    /// What the robot can pass below.
    overhead: usize,
}

impl SetAside {
    pub(crate) fn of(kinds: &[ReturnKind]) -> Self {
        let count = |kind| kinds.iter().filter(|&&one| one == kind).count();
        Self {
            stray: count(ReturnKind::Stray),
            body: count(ReturnKind::Body),
            overhead: count(ReturnKind::Overhead),
        }
    }
}

/// The number of a kind, as `FrameBuffers` documents it.
pub(crate) const fn code(kind: ReturnKind) -> u8 {
    match kind {
        ReturnKind::Surface => 0,
        ReturnKind::Invalid => 1,
        ReturnKind::Far => 2,
        ReturnKind::Body => 3,
        ReturnKind::Stray => 4,
        ReturnKind::Overhead => 5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_set_aside_is_counted_by_kind() {
        use ReturnKind::{Body, Far, Invalid, Overhead, Stray, Surface};
        let kinds = [Surface, Stray, Body, Stray, Far, Overhead, Invalid, Stray];
        assert_eq!(SetAside::of(&kinds), SetAside { stray: 3, body: 1, overhead: 1 });
        assert_eq!(kinds.map(code), [0, 4, 3, 4, 2, 5, 1, 4]);
    }
}
