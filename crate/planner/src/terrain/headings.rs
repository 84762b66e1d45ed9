//! The sixteen headings of the state lattice, those of a king's and a knight's moves. The oracle's lattice
//! shares them.

use core::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, TAU};

use glam::{DVec2, IVec2};

/// Headings, anticlockwise from east.
pub const HEADINGS: usize = 16;

/// Axes of travel: a robot on its wheels tilts alike in both directions, and its body covers the same ground.
pub(crate) const AXES: usize = HEADINGS / 2;

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
pub(crate) const DIRECTIONS: [DVec2; AXES] = [
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

/// Angles of the headings of a quarter circle, and of the next one's first.
const QUARTER_RAD: [f64; 5] =
    [0.0, 0.463_647_609_000_806_1, FRAC_PI_4, FRAC_PI_2 - 0.463_647_609_000_806_1, FRAC_PI_2];

/// The heading next to an angle on its clockwise side, and the share of the way from it to the next.
pub(crate) fn heading_below(yaw_rad: f64) -> (usize, f64) {
    let quarters = yaw_rad.rem_euclid(TAU) / FRAC_PI_2;
    let quarter = quarters.floor();
    let rest_rad = (quarters - quarter) * FRAC_PI_2;
    let below = (1..4).rev().find(|&k| QUARTER_RAD[k] <= rest_rad).unwrap_or(0);
    let width_rad = QUARTER_RAD[below + 1] - QUARTER_RAD[below];
    ((quarter as usize * 4 + below) % HEADINGS, (rest_rad - QUARTER_RAD[below]) / width_rad)
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
    fn an_angle_lies_between_the_headings_beside_it() {
        for k in -200..200 {
            let yaw_rad = f64::from(k) * 0.05;
            let (heading, share) = heading_below(yaw_rad);
            assert!((0.0..=1.0).contains(&share));
            let angle_rad = |heading: usize| {
                let step = STEPS[heading % HEADINGS].as_dvec2();
                libm::atan2(step.y, step.x)
            };
            let below_rad = angle_rad(heading);
            let width_rad = (angle_rad(heading + 1) - below_rad).rem_euclid(TAU);
            let off_rad = (yaw_rad - below_rad - share * width_rad).rem_euclid(TAU);
            assert!(off_rad.min(TAU - off_rad) < 1e-9, "{yaw_rad}: heading {heading}, share {share}");
        }
    }

    #[test]
    fn a_long_step_passes_between_its_neighbours() {
        assert_eq!(passed(IVec2::new(1, -1)), None);
        assert_eq!(passed(IVec2::new(2, 1)), Some([IVec2::new(1, 0), IVec2::new(1, 1)]));
        assert_eq!(passed(IVec2::new(-1, 2)), Some([IVec2::new(0, 1), IVec2::new(-1, 1)]));
    }
}
