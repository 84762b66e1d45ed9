//! The sixteen headings of the state lattice, those of a king's and a knight's moves. The oracle's lattice
//! shares them.

use core::f64::consts::FRAC_1_SQRT_2;

use glam::{DVec2, IVec2};

/// Headings, anticlockwise from east.
pub const HEADINGS: usize = 16;

/// One drive along each heading, in places.
pub const STEPS: [IVec2; HEADINGS] = [
    IVec2::new(1, 0),
    IVec2::new(2, 1),
    IVec2::new(1, 1),
    IVec2::new(1, 2),
    IVec2::new(0, 1),
    IVec2::new(-1, 2),
    IVec2::new(-1, 1),
    IVec2::new(-2, 1),
    IVec2::new(-1, 0),
    IVec2::new(-2, -1),
    IVec2::new(-1, -1),
    IVec2::new(-1, -2),
    IVec2::new(0, -1),
    IVec2::new(1, -2),
    IVec2::new(1, -1),
    IVec2::new(2, -1),
];

/// A long step of (2, 1) kind: 2 / √5 and 1 / √5.
const LONG: f64 = 0.894_427_190_999_915_9;
const SHORT: f64 = 0.447_213_595_499_957_9;

/// Unit vectors of the first eight headings; the others are their opposites.
pub(crate) const DIRECTIONS: [DVec2; HEADINGS / 2] = [
    DVec2::new(1.0, 0.0),
    DVec2::new(LONG, SHORT),
    DVec2::new(FRAC_1_SQRT_2, FRAC_1_SQRT_2),
    DVec2::new(SHORT, LONG),
    DVec2::new(0.0, 1.0),
    DVec2::new(-SHORT, LONG),
    DVec2::new(-FRAC_1_SQRT_2, FRAC_1_SQRT_2),
    DVec2::new(-LONG, SHORT),
];

/// The two places between which a long step passes; for a short one, nothing.
pub(crate) fn passed(step: IVec2) -> Option<[IVec2; 2]> {
    let long = step.x.abs() + step.y.abs() == 3;
    let half = IVec2::new(step.x / 2, step.y / 2);
    long.then(|| [half, step - half])
}

/// The heading nearest to a direction.
pub(crate) fn nearest(direction: DVec2) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (heading, &unit) in DIRECTIONS.iter().enumerate() {
        let along = unit.dot(direction);
        for (candidate, share) in [(heading, along), (heading + HEADINGS / 2, -along)] {
            if share > best.1 {
                best = (candidate, share);
            }
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_step_leads_along_its_heading() {
        for (heading, step) in STEPS.iter().enumerate() {
            assert_eq!(nearest(step.as_dvec2()), heading);
            let unit = DIRECTIONS[heading % 8] * if heading < 8 { 1.0 } else { -1.0 };
            assert!((unit * step.as_dvec2().length() - step.as_dvec2()).length() < 1e-15);
            assert_eq!(STEPS[(heading + 8) % HEADINGS], -*step);
        }
    }

    #[test]
    fn a_long_step_passes_between_its_neighbours() {
        assert_eq!(passed(IVec2::new(1, -1)), None);
        assert_eq!(passed(IVec2::new(2, 1)), Some([IVec2::new(1, 0), IVec2::new(1, 1)]));
        assert_eq!(passed(IVec2::new(-1, 2)), Some([IVec2::new(0, 1), IVec2::new(-1, 1)]));
    }
}
