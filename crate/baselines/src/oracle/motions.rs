//! The motions from a place of the lattice to another, in units of its cells.

use glam::DVec2;

/// Headings of the lattice, in order: those of a king's and a knight's moves.
pub(super) const HEADINGS: [(i32, i32); 16] = [
    (1, 0),
    (2, 1),
    (1, 1),
    (1, 2),
    (0, 1),
    (-1, 2),
    (-1, 1),
    (-2, 1),
    (-1, 0),
    (-2, -1),
    (-1, -1),
    (-1, -2),
    (0, -1),
    (1, -2),
    (1, -1),
    (2, -1),
];

/// One motion from a place with a given heading.
pub(super) struct Motion {
    /// Columns and rows to the place where it ends.
    pub(super) step: (i32, i32),
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
    let (x, y) = HEADINGS[usize::from(heading)];
    libm::atan2(f64::from(y), f64::from(x))
}

/// The motions that drive, for each heading: straight, and bends into the next two headings to either side.
///
/// Poses are at most `step` cells apart.
pub(super) fn drives(step: f64) -> Vec<Vec<Motion>> {
    let count = HEADINGS.len();
    (0..count)
        .map(|from| {
            [0, 1, count - 1, 2, count - 2].map(|turn| drive(from, (from + turn) % count, step)).into()
        })
        .collect()
}

fn drive(from: usize, to: usize, step: f64) -> Motion {
    let vector = |(x, y): (i32, i32)| DVec2::new(f64::from(x), f64::from(y));
    let (begin, end) = (vector(HEADINGS[from]), vector(HEADINGS[to]));
    let angle = |direction: DVec2| libm::atan2(direction.y, direction.x);
    let shares = |pieces: f64| (1..=pieces.ceil() as u32).map(move |i| f64::from(i) / pieces.ceil());
    if from == to {
        let poses = shares(begin.length() / step).map(|share| (begin * share, angle(begin))).collect();
        return Motion { step: HEADINGS[from], heading: to as u8, poses };
    }
    // The parabola that leaves along the first heading and arrives along the second; its speed never exceeds
    // twice the longer of both.
    let poses = shares(2.0 * begin.length().max(end.length()) / step)
        .map(|t| (begin * (2.0 * t - t * t) + end * (t * t), angle(begin * (1.0 - t) + end * t)))
        .collect();
    let (east, north) = (HEADINGS[from].0 + HEADINGS[to].0, HEADINGS[from].1 + HEADINGS[to].1);
    Motion { step: (east, north), heading: to as u8, poses }
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
                let end = DVec2::new(f64::from(motion.step.0), f64::from(motion.step.1));
                assert!(last.0.distance(end) < 1e-12);
                assert!((last.1 - heading_rad(motion.heading)).abs() < 1e-12);
            }
        }
    }
}
