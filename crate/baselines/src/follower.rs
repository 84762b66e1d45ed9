//! A path follower with the paper's PID controller.

use core::time::Duration;

use glam::DVec2;
use mapless::config::ControllerConfig;
use mapless::control::controller::Controller;
use mapless::{Command, Pose};

/// Lookahead distance along the path, metres. A corner is cut by about half of it.
const LOOK_AHEAD_M: f64 = 0.6;
/// Bounds on how far the nearest point moves along the path in one step, back and on, metres. They keep the
/// robot on its branch of a path that passes by itself.
const BACK_M: f64 = 1.0;
const ON_M: f64 = 2.0;
/// Nearer to the end than this the bearing is undefined, metres.
const AT_END_M: f64 = 0.01;

/// Steers along a polyline: the yaw loop turns to a lookahead point 0.6 m ahead on it, the distance loop
/// regulates the path length left.
///
/// Points are seen from above in the world frame, in metres.
#[derive(Clone, Debug)]
pub struct PathFollower {
    controller: Controller,
    points_m: Vec<DVec2>,
    /// Arc length of the path's point nearest to the robot; `None` before the first step on this path.
    along_m: Option<f64>,
}

/// The point of a path nearest to a place.
struct Nearest {
    along_m: f64,
    distance_m: f64,
}

impl PathFollower {
    /// A follower without a path. The configuration must have been validated.
    #[must_use]
    pub fn new(controller: ControllerConfig) -> Self {
        Self { controller: Controller::new(controller), points_m: Vec::new(), along_m: None }
    }

    /// Replaces the path, which begins at the robot. The controller keeps its state, so that a planner may
    /// give a new path at every step.
    pub fn set_path(&mut self, points_m: impl IntoIterator<Item = DVec2>) {
        self.points_m.clear();
        self.points_m.extend(points_m);
        self.along_m = None;
    }

    /// The path.
    #[must_use]
    pub fn path_m(&self) -> &[DVec2] {
        &self.points_m
    }

    /// The command for a robot at `pose`, `elapsed` after the last. If the path ends within 0.6 m of
    /// `goal_m`, the robot goes on to the goal; otherwise it stops at the end. Without a path, or with a pose
    /// or path that is not finite, it stops.
    pub fn step(&mut self, pose: &Pose, goal_m: DVec2, elapsed: Duration) -> Command {
        let here_m = pose.plan_m();
        let finite = pose.is_finite() && self.points_m.iter().all(|point| point.is_finite());
        let Some(&end_m) = self.points_m.last().filter(|_| finite) else { return self.stop() };
        let nearest = self.nearest(here_m);
        self.along_m = Some(nearest.along_m);

        let to_end_m = length_m(&self.points_m) - nearest.along_m;
        let (last_m, beyond_m) = match end_m.distance(goal_m) {
            beyond_m if beyond_m <= LOOK_AHEAD_M => (goal_m, beyond_m),
            _ => (end_m, 0.0),
        };
        let aim_m =
            if to_end_m <= LOOK_AHEAD_M { last_m } else { self.point(nearest.along_m + LOOK_AHEAD_M) };
        let to_aim_m = aim_m - here_m;
        if to_aim_m.length() < AT_END_M {
            return self.stop();
        }
        let left_m = nearest.distance_m + to_end_m + beyond_m;
        self.controller.drive(left_m, libm::atan2(to_aim_m.y, to_aim_m.x) - pose.yaw_rad, elapsed)
    }

    fn stop(&mut self) -> Command {
        self.controller.reset();
        Command::STOP
    }

    /// The nearest point of the path: of all of it on the first step, then of the part around the last one.
    fn nearest(&self, here_m: DVec2) -> Nearest {
        let (from_m, to_m) = self
            .along_m
            .map_or((0.0, f64::INFINITY), |along_m| ((along_m - BACK_M).max(0.0), along_m + ON_M));
        let mut best = Nearest { along_m: 0.0, distance_m: f64::INFINITY };
        let mut begin_m = 0.0;
        for pair in self.points_m.windows(2) {
            let along = pair[1] - pair[0];
            let length_m = along.length();
            let end_m = begin_m + length_m;
            if length_m > 0.0 && end_m >= from_m && begin_m <= to_m {
                let share = (here_m - pair[0]).dot(along) / (length_m * length_m);
                let low = (from_m - begin_m).max(0.0) / length_m;
                let high = (to_m - begin_m).min(length_m) / length_m;
                let share = share.clamp(low.min(high), high);
                let distance_m = (pair[0] + along * share).distance(here_m);
                if distance_m < best.distance_m {
                    best = Nearest { along_m: begin_m + length_m * share, distance_m };
                }
            }
            begin_m = end_m;
        }
        if best.distance_m.is_infinite() {
            // All points coincide.
            best.distance_m = self.points_m.first().map_or(0.0, |point| point.distance(here_m));
        }
        best
    }

    /// The point at an arc length, which is not longer than the path.
    fn point(&self, along_m: f64) -> DVec2 {
        let mut left_m = along_m;
        let mut at_m = DVec2::ZERO;
        for pair in self.points_m.windows(2) {
            let length_m = pair[0].distance(pair[1]);
            if left_m <= length_m && length_m > 0.0 {
                return pair[0].lerp(pair[1], left_m / length_m);
            }
            left_m -= length_m;
            at_m = pair[1];
        }
        at_m
    }
}

/// Length of a polyline, metres.
pub(crate) fn length_m(points_m: &[DVec2]) -> f64 {
    points_m.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use mapless_world::{DriveCommand, HeightField, Robot, RobotConfig};
    use proptest::prelude::*;

    const PERIOD: Duration = Duration::from_millis(100);
    const PERIOD_S: f64 = 0.1;

    fn follower(path_m: &[DVec2]) -> PathFollower {
        let mut follower = PathFollower::new(ControllerConfig::default());
        follower.set_path(path_m.iter().copied());
        follower
    }

    fn pose(x: f64, y: f64, yaw_rad: f64) -> Pose {
        Pose::from_roll_pitch_yaw(DVec3::new(x, y, 0.0), 0.0, 0.0, yaw_rad)
    }

    /// Drives a Husky on level ground along the path; gives its positions, ten a second.
    fn drive(path_m: &[DVec2], start: Pose, goal_m: DVec2, seconds: f64) -> Vec<DVec2> {
        let field = HeightField::new(61, 61, 1.0, vec![0.0; 61 * 61]).unwrap();
        let mut husky = Robot::new(RobotConfig::default(), &field, start.plan_m(), start.yaw_rad).unwrap();
        let mut follower = follower(path_m);
        let mut places_m = vec![start.plan_m()];
        for _ in 0..(seconds / PERIOD_S) as usize {
            let state = *husky.state();
            let here = pose(state.position.x, state.position.y, state.yaw_rad);
            let command = follower.step(&here, goal_m, PERIOD);
            let command =
                DriveCommand { speed_m_s: command.linear_m_s, turn_rate_rad_s: command.angular_rad_s };
            for _ in 0..10 {
                husky.step(command, PERIOD_S / 10.0, &field).unwrap();
            }
            places_m.push(husky.state().position);
        }
        places_m
    }

    fn distance_to_m(path_m: &[DVec2], place_m: DVec2) -> f64 {
        follower(path_m).nearest(place_m).distance_m
    }

    #[test]
    fn goes_straight_on_a_straight_path_and_stops_at_its_end() {
        let path_m = [DVec2::new(10.0, 20.0), DVec2::new(30.0, 20.0)];
        let places_m = drive(&path_m, pose(10.0, 20.0, 0.0), DVec2::new(50.0, 50.0), 40.0);
        assert!(places_m.iter().all(|place| (place.y - 20.0).abs() < 1e-9));
        // Full speed until the last metre.
        assert!((places_m[220].x - places_m[210].x - 0.8).abs() < 1e-6);
        let end_m = places_m[places_m.len() - 1];
        assert!(end_m.distance(path_m[1]) < 0.02, "{end_m}");
        assert_eq!(follower(&path_m).step(&pose(30.0, 20.0, 0.0), DVec2::ZERO, PERIOD), Command::STOP);
    }

    #[test]
    fn a_corner_is_cut_little() {
        let corner_m = [DVec2::new(10.0, 20.0), DVec2::new(20.0, 20.0), DVec2::new(20.0, 30.0)];
        let places_m = drive(&corner_m, pose(10.0, 20.0, 0.0), corner_m[2], 40.0);
        let worst_m = places_m.iter().map(|&place| distance_to_m(&corner_m, place)).fold(0.0, f64::max);
        assert!(worst_m < 0.3, "{worst_m}");
        assert!(places_m[places_m.len() - 1].distance(corner_m[2]) < 0.05);
    }

    #[test]
    fn goes_on_to_a_goal_that_is_near_the_end() {
        let path_m = [DVec2::new(10.0, 20.0), DVec2::new(15.0, 20.0)];
        let goal_m = DVec2::new(15.3, 20.3);
        let places_m = drive(&path_m, pose(10.0, 20.0, 0.0), goal_m, 20.0);
        assert!(places_m[places_m.len() - 1].distance(goal_m) < 0.05);
    }

    #[test]
    fn keeps_to_its_branch_where_the_path_returns() {
        // Out and back, half a metre apart; a corner every time.
        let path_m = [
            DVec2::new(10.0, 20.0),
            DVec2::new(20.0, 20.0),
            DVec2::new(20.0, 20.5),
            DVec2::new(10.0, 20.5),
            DVec2::new(10.0, 25.0),
        ];
        let places_m = drive(&path_m, pose(10.0, 20.0, 0.0), path_m[4], 60.0);
        assert!(places_m.iter().any(|place| place.x > 19.6), "not before it has been at the far end");
        assert!(places_m[places_m.len() - 1].distance(path_m[4]) < 0.05);
    }

    #[test]
    fn without_a_path_or_a_pose_it_stands_still() {
        let goal_m = DVec2::new(1.0, 1.0);
        assert_eq!(follower(&[]).step(&pose(0.0, 0.0, 0.0), goal_m, PERIOD), Command::STOP);
        let path_m = [DVec2::ZERO, DVec2::X];
        assert_eq!(follower(&path_m).step(&pose(f64::NAN, 0.0, 0.0), goal_m, PERIOD), Command::STOP);
        let broken_m = [DVec2::ZERO, DVec2::NAN, DVec2::X];
        assert_eq!(follower(&broken_m).step(&pose(0.0, 0.0, 0.0), goal_m, PERIOD), Command::STOP);
    }

    #[test]
    fn a_path_of_one_point_is_driven_to() {
        let only_m = DVec2::new(14.0, 22.0);
        let places_m = drive(&[only_m], pose(10.0, 20.0, 2.0), DVec2::ZERO, 20.0);
        assert!(places_m[places_m.len() - 1].distance(only_m) < 0.05);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn comes_back_from_off_the_path(aside_m in -4.0..4.0f64, yaw_rad in -3.1..3.1f64) {
            let path_m = [DVec2::new(10.0, 20.0), DVec2::new(30.0, 20.0)];
            let places_m = drive(&path_m, pose(15.0, 20.0 + aside_m, yaw_rad), path_m[1], 50.0);
            let back = places_m.iter().filter(|place| place.x > 21.0).all(|place| (place.y - 20.0).abs() < 0.1);
            prop_assert!(back, "{places_m:?}");
            prop_assert!(places_m[places_m.len() - 1].distance(path_m[1]) < 0.05);
        }
    }
}
