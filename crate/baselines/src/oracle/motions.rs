//! The motions from a place of the lattice to another, in units of its cells.

use glam::{DVec2, IVec2};
use mapless::terrain::headings::{HEADINGS, STEPS};

/// One motion from a place with a given heading.
pub(super) struct Motion {
    /// Columns and rows to the place where it ends.
    pub(super) step: IVec2,
    /// Heading there.
    pub(super) heading: u8,
    /// Positions and headings along the motion, the last one at its end.
    pub(super) poses: Vec<(DVec2, f64)>,
}

impl Motion {
    /// Length, in cells.
    pub(super) fn length(&self) -> f64 {
        let mut last = DVec2::ZERO;
        self.poses.iter().map(|&(place, _)| std::mem::replace(&mut last, place).distance(place)).sum()
    }
}

/// Angle of a heading, radians from the lattice's first axis.
pub(super) fn heading_rad(heading: u8) -> f64 {
    let along = STEPS[usize::from(heading)].as_dvec2();
    libm::atan2(along.y, along.x)
}

/// The motions that drive, for each heading: straight, and bends into the next two headings to either side.
///
/// Poses are at most `step` cells apart.
pub(super) fn drives(step: f64) -> Vec<Vec<Motion>> {
    (0..HEADINGS)
        .map(|from| {
            let turns = [0, 1, HEADINGS - 1, 2, HEADINGS - 2];
            turns.map(|turn| drive(from, (from + turn) % HEADINGS, step)).into()
        })
        .collect()
}

fn drive(from: usize, to: usize, step: f64) -> Motion {
    let (begin, end) = (STEPS[from].as_dvec2(), STEPS[to].as_dvec2());
    let angle = |direction: DVec2| libm::atan2(direction.y, direction.x);
    let shares = |pieces: f64| (1..=pieces.ceil() as u32).map(move |i| f64::from(i) / pieces.ceil());
    if from == to {
        let poses = shares(begin.length() / step).map(|share| (begin * share, angle(begin))).collect();
        return Motion { step: STEPS[from], heading: to as u8, poses };
    }
    // The parabola that leaves along the first heading and arrives along the second; its speed never exceeds
    // twice the longer of both.
    let poses = shares(2.0 * begin.length().max(end.length()) / step)
        .map(|t| (begin * (2.0 * t - t * t) + end * (t * t), angle(begin * (1.0 - t) + end * t)))
        .collect();
    Motion { step: STEPS[from] + STEPS[to], heading: to as u8, poses }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn motions_end_on_the_lattice_and_have_no_kinks() {
        for (from, motions) in drives(0.25).iter().enumerate() {
            assert_eq!(motions.len(), 5);
            for motion in motions {
                let mut last = (DVec2::ZERO, heading_rad(from as u8));
                for &(place, yaw_rad) in &motion.poses {
                    let path = place - last.0;
                    assert!(path.length() <= 0.25 + 1e-12 && path.length() > 0.01);
                    let turn = |a: f64, b: f64| libm::remainder(a - b, TAU).abs();
                    assert!(turn(yaw_rad, last.1) < 0.2, "{yaw_rad} {}", last.1);
                    assert!(turn(libm::atan2(path.y, path.x), yaw_rad) < 0.2, "drives where it looks");
                    last = (place, yaw_rad);
                }
                let end = motion.step.as_dvec2();
                assert!(last.0.distance(end) < 1e-12);
                assert!((last.1 - heading_rad(motion.heading)).abs() < 1e-12);
            }
        }
    }
}
