//! Where the robot was in the period that has just passed.

use mapless::Pose;

/// Poses one motion step apart, oldest first, up to now.
#[derive(Clone, Debug)]
pub(crate) struct Trail {
    poses: Vec<Pose>,
    most: usize,
}

impl Trail {
    /// A trail over `steps` motion steps of a robot that has stood at `pose` so far.
    pub(crate) fn new(steps: usize, pose: Pose) -> Self {
        Self { poses: vec![pose; steps + 1], most: steps + 1 }
    }

    /// The robot is at `pose` after another step.
    pub(crate) fn push(&mut self, pose: Pose) {
        if self.poses.len() == self.most {
            self.poses.remove(0);
        }
        self.poses.push(pose);
    }

    /// The pose so many steps ago, which need not be whole: poses between two steps are interpolated, for
    /// which headings must not be wrapped. The oldest if that is farther back.
    pub(crate) fn ago(&self, steps: f64) -> Pose {
        let last = self.poses.len() - 1;
        let step = (last as f64 - steps).clamp(0.0, last as f64);
        let (before, rest) = (step as usize, step - (step as usize) as f64);
        let (from, to) = (self.poses[before], self.poses[(before + 1).min(last)]);
        let between = |from: f64, to: f64| from + (to - from) * rest;
        Pose::from_roll_pitch_yaw(
            from.position_m + (to.position_m - from.position_m) * rest,
            between(from.roll_rad, to.roll_rad),
            between(from.pitch_rad, to.pitch_rad),
            between(from.yaw_rad, to.yaw_rad),
        )
    }

    /// The robot stands at `pose` now and is taken to have stood there.
    pub(crate) fn settle(&mut self, pose: Pose) {
        self.poses.fill(pose);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn at(x_m: f64, yaw_rad: f64) -> Pose {
        Pose::from_roll_pitch_yaw(DVec3::new(x_m, 0.0, 1.0), 0.0, 0.1 * x_m, yaw_rad)
    }

    #[test]
    fn a_trail_is_interpolated_over_its_last_steps() {
        let mut trail = Trail::new(4, at(0.0, 3.0));
        assert_eq!((trail.ago(0.0), trail.ago(4.0)), (at(0.0, 3.0), at(0.0, 3.0)));
        for step in 1..=5 {
            trail.push(at(f64::from(step), 3.0 + 0.1 * f64::from(step)));
        }
        assert_eq!(
            (trail.ago(0.0), trail.ago(4.0), trail.ago(9.0)),
            (at(5.0, 3.5), at(1.0, 3.1), at(1.0, 3.1))
        );
        let middle = trail.ago(2.5);
        assert!((middle.position_m.x - 2.5).abs() < 1e-12 && (middle.yaw_rad - 3.25).abs() < 1e-12);
        assert!((middle.pitch_rad - 0.25).abs() < 1e-12);
        assert_eq!(trail.ago(2.0).position_m.x.to_bits(), 3.0_f64.to_bits());
    }
}
