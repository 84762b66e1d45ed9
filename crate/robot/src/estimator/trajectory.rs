//! The poses of the last seconds.

use core::time::Duration;
use std::collections::VecDeque;

use mapless::Pose;
use mapless::math::angle::difference_rad;

/// Longer ago, no scan is corrected.
const KEPT: Duration = Duration::from_secs(2);
/// A pose is extrapolated this far at most, by the motion of at least as long before: poses of one moment
/// differ by corrections, not by motion.
const AHEAD: Duration = Duration::from_millis(50);

/// Poses of the robot frame by time, the newest last.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    poses: VecDeque<(Duration, Pose)>,
}

impl Trajectory {
    /// Adds the pose at a time. One that is not later replaces the last.
    pub fn push(&mut self, at: Duration, pose: Pose) {
        while self.poses.back().is_some_and(|(last, _)| *last >= at) {
            self.poses.pop_back();
        }
        self.poses.push_back((at, pose));
        while self.poses.front().is_some_and(|(first, _)| *first + KEPT < at) {
            self.poses.pop_front();
        }
    }

    /// Forgets all poses, as when they jump.
    pub fn clear(&mut self) {
        self.poses.clear();
    }

    /// The pose at a time: between two poses, or up to 50 ms after the last by the motion of the 50 ms before
    /// it. `None` outside.
    pub fn pose_at(&self, at: Duration) -> Option<Pose> {
        let after = self.poses.partition_point(|(time, _)| *time < at);
        let (before, after) = match (after.checked_sub(1).map(|i| &self.poses[i]), self.poses.get(after)) {
            (_, Some((time, pose))) if *time == at => return Some(*pose),
            (Some(before), Some(after)) => (before, after),
            (Some(last), None) if at <= last.0 + AHEAD => {
                match self.poses.iter().rfind(|(time, _)| *time + AHEAD <= last.0) {
                    Some(earlier) => (earlier, last),
                    None => return Some(last.1),
                }
            }
            _ => return None,
        };
        let seconds = |from: Duration, to: Duration| to.saturating_sub(from).as_secs_f64();
        let share = seconds(before.0, at) / seconds(before.0, after.0);
        Some(between(&before.1, &after.1, share))
    }
}

/// The pose at a share of the way from one pose to another near it.
fn between(from: &Pose, to: &Pose, share: f64) -> Pose {
    let turned = |from: f64, to: f64| from + share * difference_rad(to, from);
    Pose::from_roll_pitch_yaw(
        from.position_m + share * (to.position_m - from.position_m),
        turned(from.roll_rad, to.roll_rad),
        turned(from.pitch_rad, to.pitch_rad),
        turned(from.yaw_rad, to.yaw_rad),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use mapless::glam::DVec3;

    fn pose(x_m: f64, yaw_rad: f64) -> Pose {
        Pose::from_roll_pitch_yaw(DVec3::X * x_m, 0.0, 0.0, yaw_rad)
    }

    #[test]
    fn a_correction_within_a_moment_is_not_extrapolated_as_motion() {
        let at = Duration::from_micros;
        let mut trajectory = Trajectory::default();
        (0..=10).for_each(|k| trajectory.push(at(10_000 * k), pose(0.008 * k as f64, 0.0)));
        trajectory.push(at(100_020), pose(0.082, 0.001));
        let ahead = trajectory.pose_at(at(105_020)).unwrap();
        assert!((ahead.position_m.x - 0.086).abs() < 0.001 && ahead.yaw_rad < 0.0012, "{ahead:?}");
        let mut alone = Trajectory::default();
        alone.push(at(0), pose(0.0, 0.0));
        alone.push(at(20), pose(0.001, 0.0));
        assert_eq!(alone.pose_at(at(5000)), Some(pose(0.001, 0.0)), "no motion is known yet");
    }

    #[test]
    fn poses_are_interpolated_the_shorter_way_round_and_a_little_extrapolated() {
        let at = Duration::from_millis;
        let mut trajectory = Trajectory::default();
        assert_eq!(trajectory.pose_at(at(0)), None);
        trajectory.push(at(100), pose(1.0, 3.1));
        trajectory.push(at(200), pose(2.0, -3.1));
        let middle = trajectory.pose_at(at(150)).unwrap();
        assert!((middle.position_m.x - 1.5).abs() < 1e-12 && (middle.yaw_rad.abs() - PI).abs() < 1e-9);
        assert!((trajectory.pose_at(at(250)).unwrap().position_m.x - 2.5).abs() < 1e-12);
        assert_eq!((trajectory.pose_at(at(99)), trajectory.pose_at(at(251))), (None, None));
        assert_eq!(trajectory.pose_at(at(200)), Some(pose(2.0, -3.1)));
        // A later word on the same time replaces the first.
        trajectory.push(at(200), pose(3.0, 0.0));
        assert_eq!(trajectory.pose_at(at(200)), Some(pose(3.0, 0.0)));
        trajectory.push(at(2150), pose(4.0, 0.0));
        assert_eq!(trajectory.pose_at(at(120)), None, "older than 2 s");
    }
}
