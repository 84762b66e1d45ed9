//! Backtracking along the robot's own recorded trajectory.
//!
//! The robot backtracks when the attitude is too steep or no path leads on: the elevation window was wrong or
//! incomplete. Every pose of the trajectory was safe once, so returning needs no prediction.

use core::f64::consts::FRAC_PI_2;
use core::time::Duration;
use std::collections::VecDeque;

use glam::DVec2;

use crate::math::angle::wrap_rad;
use crate::pose::{FrameChange, Pose};

/// Distance and turn between two poses of the trajectory, and the number of poses that are kept.
const SPACING_M: f64 = 0.1;
const SPACING_RAD: f64 = 0.15;
const MOST_POSES: usize = 200;
/// Two poses this near to each other, with a radian counted as this many metres, are the same, unless they
/// are close neighbours on the trajectory.
const SAME_POSE_M: f64 = 0.08;
const NEIGHBOURS: usize = 3;
const RADIAN_M: f64 = 0.5;
/// The robot has arrived at a pose within this distance along its heading and, where it turned there, within
/// this angle.
const ARRIVAL_M: f64 = 0.03;
const ARRIVAL_RAD: f64 = 0.05;
/// Between poses nearer than this the robot turned on the spot.
const TURN_M: f64 = 0.08;
/// A turn on the spot is undone in parts of up to this, so that the robot turns at its full rate, and never
/// by more than half a circle, which would be the other way round.
const MOST_TURN_RAD: f64 = FRAC_PI_2;
/// Smaller parts of a turn are not worth commanding.
const LEAST_TURN_RAD: f64 = 0.1;
/// The robot turns to the recorded heading over the distance to the pose, or over this distance if that is
/// shorter, and with at most this curvature.
const LEAST_ARC_M: f64 = 0.05;
const MOST_TURN_RAD_M: f64 = 4.0;
/// Gain from the lateral offset to the curvature that leads back onto the trajectory, and its bound.
const OFFSET_GAIN_RAD_M2: f64 = 25.0;
const MOST_OFFSET_RAD_M: f64 = 2.0;
/// Farther than this from its trajectory the robot has lost it.
const LOST_M: f64 = 0.4;
/// Below these speeds the robot stands still; braking ends after this time at the latest.
const STILL_M_S: f64 = 0.1;
const STILL_RAD_S: f64 = 0.1;
const MOST_BRAKING_TIME: Duration = Duration::from_secs(2);
/// A larger distance from the last pose is a jump of the localisation.
const JUMP_M: f64 = 1.0;
/// The direction of travel is taken from the pose this far back on the trajectory or, on a shorter one, from
/// its first pose, if that is at least the second distance away.
const TRAVEL_M: f64 = 0.3;
const LEAST_TRAVEL_M: f64 = 0.1;
/// The robot backtracks at least this far.
const LEAST_M: f64 = 1.0;

/// A pose of the trajectory, seen from above.
#[derive(Clone, Copy, Debug)]
struct Pose2 {
    place_m: DVec2,
    yaw_rad: f64,
}

impl Pose2 {
    fn of(pose: &Pose) -> Self {
        Self { place_m: pose.plan_m(), yaw_rad: pose.yaw_rad }
    }

    fn turned_rad(&self, other: &Self) -> f64 {
        wrap_rad(self.yaw_rad - other.yaw_rad).abs()
    }

    fn away_m(&self, other: &Self) -> f64 {
        (self.place_m - other.place_m).length() + RADIAN_M * self.turned_rad(other)
    }

    fn facing(&self) -> DVec2 {
        let (sin, cos) = libm::sincos(self.yaw_rad);
        DVec2::new(cos, sin)
    }

    /// Whether this pose is past `recorded` on the path to `next`, which may be a turn on the spot.
    fn is_past(&self, recorded: &Self, next: &Self) -> bool {
        let path_m = next.place_m - recorded.place_m;
        let past_m = (self.place_m - recorded.place_m).dot(path_m.normalize_or_zero());
        if path_m.length() < TURN_M {
            let turned_rad = wrap_rad(self.yaw_rad - recorded.yaw_rad);
            let is_there = self.place_m.distance(recorded.place_m) < ARRIVAL_M;
            if is_there && turned_rad * wrap_rad(next.yaw_rad - recorded.yaw_rad) > 0.0 {
                return true;
            }
        }
        past_m > if self.turned_rad(recorded) < SPACING_RAD { 0.0 } else { ARRIVAL_M }
    }
}

/// The next move of the backtrack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BacktrackCommand {
    /// Brake to a stop.
    Brake,
    /// Turn on the spot, anticlockwise.
    Turn { by_rad: f64 },
    /// Drive an arc with this curvature, anticlockwise turn per metre.
    Drive { turn_rad_m: f64, reverse: bool },
}

/// The recorded trajectory, and whether the robot backtracks along it.
#[derive(Clone, Debug)]
pub(crate) struct Backtrack {
    /// The newest last.
    trajectory: VecDeque<Pose2>,
    last: Option<Pose2>,
    started_at_m: Option<DVec2>,
    /// Time left for braking.
    braking: Duration,
}

impl Backtrack {
    pub(crate) fn new() -> Self {
        Self {
            trajectory: VecDeque::with_capacity(MOST_POSES),
            last: None,
            started_at_m: None,
            braking: Duration::ZERO,
        }
    }

    pub(crate) fn clear(&mut self) {
        self.trajectory.clear();
        self.last = None;
        self.end();
    }

    /// Records the robot's pose.
    pub(crate) fn record(&mut self, pose: &Pose, elapsed: Duration) {
        let here = Pose2::of(pose);
        let last = self.last.replace(here);
        if self.is_active() && self.braking.is_zero() {
            return;
        }
        let elapsed_s = elapsed.as_secs_f64();
        let moves = last.is_some_and(|last| {
            (here.place_m - last.place_m).length() > STILL_M_S * elapsed_s
                || here.turned_rad(&last) > STILL_RAD_S * elapsed_s
        });
        self.braking = if moves { self.braking.saturating_sub(elapsed) } else { Duration::ZERO };
        if let Some(last) = self.trajectory.back() {
            let moved_m = (here.place_m - last.place_m).length();
            if moved_m < SPACING_M && here.turned_rad(last) < SPACING_RAD {
                return;
            }
            if moved_m > JUMP_M {
                self.trajectory.clear();
            }
        }
        // Loops are cut out of the trajectory.
        let older = self.trajectory.len().saturating_sub(NEIGHBOURS);
        if let Some(before) =
            self.trajectory.iter().take(older).position(|recorded| here.away_m(recorded) < SAME_POSE_M)
        {
            self.trajectory.truncate(before);
        }
        if self.trajectory.len() == MOST_POSES {
            self.trajectory.pop_front();
        }
        self.trajectory.push_back(here);
    }

    /// Whether the robot is backtracking.
    pub(crate) fn is_active(&self) -> bool {
        self.started_at_m.is_some()
    }

    /// Whether it has backtracked far enough to try again.
    pub(crate) fn has_driven_far(&self, here_m: DVec2) -> bool {
        self.started_at_m.is_some_and(|started_at_m| (here_m - started_at_m).length() > LEAST_M)
    }

    /// Begins to backtrack. Returns the unit vector of the last direction of travel; `None`, without
    /// backtracking, if the trajectory is too short for one.
    pub(crate) fn begin(&mut self, here_m: DVec2) -> Option<DVec2> {
        let far = self.positions_m().find(|place_m| (here_m - *place_m).length() > TRAVEL_M);
        let came = here_m - far.or_else(|| self.positions_m().last())?;
        if came.length() < LEAST_TRAVEL_M {
            return None;
        }
        self.started_at_m = Some(here_m);
        self.braking = MOST_BRAKING_TIME;
        Some(came.normalize())
    }

    /// The next move; `None`, which ends the backtrack, at the first pose of the trajectory or if the
    /// trajectory is lost. Its first pose is kept. Off the trajectory a turn may be too steep:
    /// `safe_turn_rad` returns the largest part of a turn, anticlockwise, that is safe.
    pub(crate) fn next(
        &mut self,
        pose: &Pose,
        safe_turn_rad: impl Fn(f64) -> f64,
    ) -> Option<BacktrackCommand> {
        if !self.braking.is_zero() {
            return Some(BacktrackCommand::Brake);
        }
        let here = Pose2::of(pose);
        while let Some(&recorded) = self.trajectory.back() {
            if (recorded.place_m - here.place_m).length() > LOST_M {
                self.trajectory.clear();
                break;
            }
            let before = self.trajectory.iter().nth_back(1);
            if !before.is_some_and(|before| here.is_past(&recorded, before)) {
                let turns =
                    before.is_some_and(|before| (before.place_m - recorded.place_m).length() < TURN_M);
                let enough_rad = if turns { ARRIVAL_RAD } else { SPACING_RAD };
                let whole_turn_rad = self.turn_on_the_spot_rad(&here);
                let back = move_to(&here, &recorded, whole_turn_rad, enough_rad, &safe_turn_rad);
                if back.is_some() {
                    return back;
                }
            }
            if before.is_none() {
                break;
            }
            self.trajectory.pop_back();
        }
        self.end();
        None
    }

    /// The turn from a pose to the newest of the trajectory and on, as far as the trajectory turns the same
    /// way on the spot there; anticlockwise positive.
    fn turn_on_the_spot_rad(&self, here: &Pose2) -> f64 {
        let poses = self.trajectory.iter().rev();
        let Some(newest) = poses.clone().next() else { return 0.0 };
        let mut turn_rad = wrap_rad(newest.yaw_rad - here.yaw_rad);
        for (recorded, before) in poses.clone().zip(poses.skip(1)) {
            let step_rad = wrap_rad(before.yaw_rad - recorded.yaw_rad);
            let goes_on = before.place_m.distance(newest.place_m) < ARRIVAL_M && turn_rad * step_rad >= 0.0;
            if !goes_on || (turn_rad + step_rad).abs() > MOST_TURN_RAD {
                break;
            }
            turn_rad += step_rad;
        }
        turn_rad
    }

    /// The positions of the trajectory, the newest first.
    pub(crate) fn positions_m(&self) -> impl Iterator<Item = DVec2> + use<'_> {
        self.trajectory.iter().rev().map(|recorded| recorded.place_m)
    }

    /// Moves the trajectory from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        let moved = |recorded: &Pose2| Pose2 {
            place_m: change.place_m(recorded.place_m),
            yaw_rad: recorded.yaw_rad + change.turn_rad(),
        };
        for recorded in &mut self.trajectory {
            *recorded = moved(recorded);
        }
        self.last = self.last.as_ref().map(moved);
        self.started_at_m = self.started_at_m.map(|place_m| change.place_m(place_m));
    }

    /// Ends the backtrack.
    pub(crate) fn end(&mut self) {
        self.started_at_m = None;
        self.braking = Duration::ZERO;
    }
}

/// The move from the robot's pose to a recorded one, or the turn there and on; `None` if the robot is there,
/// to within `enough_rad`, or can neither drive nor turn there.
fn move_to(
    here: &Pose2,
    recorded: &Pose2,
    whole_turn_rad: f64,
    enough_rad: f64,
    safe_turn_rad: impl Fn(f64) -> f64,
) -> Option<BacktrackCommand> {
    let path_m = recorded.place_m - here.place_m;
    let ahead_m = path_m.dot(here.facing());
    let turn_rad = wrap_rad(recorded.yaw_rad - here.yaw_rad);
    if ahead_m.abs() > ARRIVAL_M {
        let reverse = ahead_m < 0.0;
        let offset_m = path_m.dot(recorded.facing().perp());
        let correction_rad_m = (OFFSET_GAIN_RAD_M2 * offset_m).clamp(-MOST_OFFSET_RAD_M, MOST_OFFSET_RAD_M);
        let turn_rad_m = turn_rad / ahead_m.abs().max(LEAST_ARC_M)
            + if reverse { -correction_rad_m } else { correction_rad_m };
        return Some(BacktrackCommand::Drive {
            turn_rad_m: turn_rad_m.clamp(-MOST_TURN_RAD_M, MOST_TURN_RAD_M),
            reverse,
        });
    }
    // At a recorded position every recorded heading is safe, whatever the window says.
    let by_rad = if path_m.length() > ARRIVAL_M { safe_turn_rad(whole_turn_rad) } else { whole_turn_rad };
    (whole_turn_rad.abs() > enough_rad && by_rad.abs() >= whole_turn_rad.abs().min(LEAST_TURN_RAD))
        .then_some(BacktrackCommand::Turn { by_rad })
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: Duration = Duration::from_millis(100);
    use crate::config::ControllerConfig;
    use crate::control::controller::Controller;
    use core::f64::consts::PI;
    use glam::DVec3;

    fn pose(place_m: DVec2, yaw_rad: f64) -> Pose {
        Pose { position_m: place_m.extend(0.0), roll_rad: 0.0, pitch_rad: 0.0, yaw_rad }
    }

    /// A robot that has driven straight ahead for this many tenths of a second.
    fn driven(ticks: usize) -> (Backtrack, Pose) {
        let (mut backtrack, mut robot) = (Backtrack::new(), pose(DVec2::ZERO, 0.0));
        for _ in 0..ticks {
            advance(&mut backtrack, &mut robot, 0.5, 0.0);
        }
        (backtrack, robot)
    }

    /// A robot that has driven a metre ahead, turned to the left for this many tenths of a second, and
    /// stands, about to backtrack.
    fn turned(ticks: usize) -> (Backtrack, Pose) {
        let (mut backtrack, mut robot) = driven(20);
        for _ in 0..ticks {
            advance(&mut backtrack, &mut robot, 0.0, 0.5);
        }
        assert!(backtrack.begin(robot.plan_m()).is_some());
        backtrack.record(&robot, STEP);
        (backtrack, robot)
    }

    /// Moves a robot for a tenth of a second and records its pose.
    fn advance(backtrack: &mut Backtrack, pose: &mut Pose, speed_m_s: f64, turn_rate_rad_s: f64) {
        pose.yaw_rad += 0.1 * turn_rate_rad_s;
        let heading = DVec2::from_angle(pose.yaw_rad);
        pose.position_m += DVec3::from((0.1 * speed_m_s * heading, 0.0));
        backtrack.record(pose, STEP);
    }

    /// Backtracks to the first pose, out of a drive at this speed; returns every pose. A Husky accelerates at
    /// 1 m/s².
    fn backtrack_all(backtrack: &mut Backtrack, pose: &mut Pose, speed_m_s: f64) -> Vec<Pose> {
        backtrack_with(backtrack, pose, speed_m_s, |by_rad| (5.0 * by_rad).clamp(-0.5, 0.5))
    }

    /// As [`backtrack_all`], with a law for the rate of turns on the spot.
    fn backtrack_with(
        backtrack: &mut Backtrack,
        pose: &mut Pose,
        speed_m_s: f64,
        mut law: impl FnMut(f64) -> f64,
    ) -> Vec<Pose> {
        assert!(backtrack.begin(pose.plan_m()).is_some());
        let full_m_s = ControllerConfig::default().reverse_m_s();
        let mut poses = Vec::new();
        let (mut speed_m_s, mut turn_rate_rad_s) = (speed_m_s, 0.0);
        while let Some(back) = backtrack.next(pose, |turn_rad| turn_rad) {
            let (wanted_m_s, wanted_rad_s) = match back {
                BacktrackCommand::Brake => (0.0, 0.0),
                BacktrackCommand::Turn { by_rad } => (0.0, law(by_rad)),
                BacktrackCommand::Drive { turn_rad_m, reverse } => {
                    (if reverse { -full_m_s } else { full_m_s }, full_m_s * turn_rad_m)
                }
            };
            speed_m_s += f64::clamp(wanted_m_s - speed_m_s, -0.1, 0.1);
            turn_rate_rad_s += f64::clamp(wanted_rad_s - turn_rate_rad_s, -0.2, 0.2);
            advance(backtrack, pose, speed_m_s, turn_rate_rad_s);
            poses.push(*pose);
            assert!(poses.len() < 1000, "it does not get back");
        }
        poses
    }

    #[test]
    fn it_goes_back_as_it_came_turns_and_arcs_too() {
        let mut backtrack = Backtrack::new();
        let mut robot = pose(DVec2::ZERO, 0.0);
        backtrack.record(&robot, STEP);
        let mut came = vec![robot];
        for (ticks, speed_m_s, turn_rate_rad_s) in [
            (30, 0.5, 0.0),
            (20, 0.0, 0.4),
            (20, 0.4, 0.3),
            (10, -0.5, 0.0),
            (15, 0.0, -0.5),
            (20, 0.4, -0.3),
        ] {
            for _ in 0..ticks {
                advance(&mut backtrack, &mut robot, speed_m_s, turn_rate_rad_s);
                came.push(robot);
            }
        }
        let off_m = |pose: &Pose| {
            let recorded = Pose2::of(pose);
            came.iter().map(|pose| recorded.away_m(&Pose2::of(pose))).fold(f64::INFINITY, f64::min)
        };
        let poses = backtrack_all(&mut backtrack, &mut robot, 0.0);
        let worst_m = poses.iter().map(off_m).fold(0.0, f64::max);
        assert!(worst_m < 0.1, "{worst_m} m from how it stood");
        assert!(robot.position_m.length() < 0.2 && !backtrack.is_active());
    }

    #[test]
    fn it_brakes_before_it_backtracks_and_passes_the_pose_where_it_stopped() {
        let (mut backtrack, mut robot) = driven(20);
        let poses = backtrack_all(&mut backtrack, &mut robot, 0.8);
        let turned_at_m = poses.iter().map(|pose| pose.position_m.x).fold(0.0, f64::max);
        assert!((1.2..1.4).contains(&turned_at_m), "{turned_at_m}");
        assert!(poses.iter().all(|pose| pose.position_m.y.abs() < 0.01 && pose.yaw_rad.abs() < 0.05));
        assert!(robot.position_m.length() < 0.2);
    }

    #[test]
    fn beside_its_trail_it_gets_back_onto_it() {
        for (offset_m, yaw_rad) in [(0.1, 0.0), (-0.1, 0.2), (0.05, -0.2)] {
            for facing_back in [false, true] {
                let (mut backtrack, mut robot) = driven(40);
                if facing_back {
                    // The trajectory is driven forward after all.
                    backtrack = Backtrack::new();
                    robot = pose(DVec2::ZERO, PI);
                    backtrack.record(&robot, STEP);
                    for _ in 0..40 {
                        advance(&mut backtrack, &mut robot, -0.5, 0.0);
                    }
                }
                robot.position_m.y += offset_m;
                robot.yaw_rad += yaw_rad;
                let poses = backtrack_all(&mut backtrack, &mut robot, 0.0);
                let off_m = |pose: &Pose| pose.position_m.y.abs();
                let soon = poses.iter().filter(|pose| pose.position_m.x < 1.0).map(off_m).fold(0.0, f64::max);
                assert!(soon < 0.03, "{soon} m after {offset_m} m and {yaw_rad}");
            }
        }
    }

    #[test]
    fn a_trail_to_its_side_does_not_hold_it() {
        let (mut backtrack, mut robot) = turned(10);
        robot.position_m.y -= 0.15;
        let mut moves = Vec::new();
        while let Some(back) = backtrack.next(&robot, |_| 0.0) {
            let BacktrackCommand::Drive { turn_rad_m, reverse } = back else {
                panic!("{back:?} is not safe")
            };
            advance(&mut backtrack, &mut robot, if reverse { -0.3 } else { 0.3 }, 0.3 * turn_rad_m);
            moves.push(reverse);
            assert!(moves.len() < 100, "to and fro: {moves:?}");
        }
        let changes = moves.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes < 3, "{moves:?}");
    }

    #[test]
    fn a_pose_that_trembles_does_not_hold_it() {
        let (mut backtrack, mut robot) = driven(20);
        assert!(backtrack.begin(robot.plan_m()).is_some());
        let mut ticks = 0;
        while backtrack.next(&robot, |turn| turn) == Some(BacktrackCommand::Brake) {
            robot.position_m.y = if ticks % 2 == 0 { 0.02 } else { -0.02 };
            backtrack.record(&robot, STEP);
            ticks += 1;
            assert!(ticks < 50, "it brakes for ever");
        }
        assert!(backtrack.is_active());
    }

    #[test]
    fn it_turns_where_it_turned_and_beside_that_no_farther_than_is_safe() {
        let (mut backtrack, mut robot) = turned(20);
        let turn_rad =
            |back| if let Some(BacktrackCommand::Turn { by_rad }) = back { by_rad } else { f64::NAN };
        let whole_rad = turn_rad(backtrack.clone().next(&robot, |_| 0.0));
        assert!((-1.1..-0.8).contains(&whole_rad), "{whole_rad} where it turned");
        // To its left.
        robot.position_m += 0.07 * DVec3::new(-libm::sin(1.0), libm::cos(1.0), 0.0);
        assert!((turn_rad(backtrack.clone().next(&robot, |turn| turn)) - whole_rad).abs() < 1e-12);
        assert!(
            (turn_rad(backtrack.clone().next(&robot, |turn| 0.8 * turn)) - 0.8 * whole_rad).abs() < 1e-12
        );
        // Unsafe turns are left out.
        let next = backtrack.next(&robot, |_| 0.0);
        assert!(!matches!(next, Some(BacktrackCommand::Turn { .. })), "{next:?}");
    }

    #[test]
    fn a_turn_on_the_spot_is_undone_about_as_fast_as_it_was_made() {
        for turn_rate_rad_s in [0.5, -0.5] {
            let (mut backtrack, mut robot) = driven(20);
            for _ in 0..60 {
                advance(&mut backtrack, &mut robot, 0.0, turn_rate_rad_s);
            }
            let mut controller = Controller::new(ControllerConfig::default());
            let poses = backtrack_with(&mut backtrack, &mut robot, 0.0, |by_rad| {
                controller.drive(0.0, by_rad, STEP).angular_rad_s
            });
            let turning = poses.iter().filter(|pose| pose.position_m.x > 0.95).count();
            assert!(turning < 70, "{turning} tenths of a second");
            assert!(robot.yaw_rad.abs() < 0.06 && robot.position_m.length() < 0.15, "{robot:?}");
        }
    }

    #[test]
    fn a_turn_that_goes_on_past_half_a_circle_is_begun_the_way_it_was_made() {
        let (mut backtrack, mut robot) = turned(40);
        robot.yaw_rad += 2.0;
        let back = backtrack.next(&robot, |turn| turn);
        let Some(BacktrackCommand::Turn { by_rad }) = back else { panic!("{back:?}") };
        assert!((-2.2..-1.9).contains(&by_rad), "{by_rad}");
    }

    #[test]
    fn far_from_its_trail_it_does_not_drive_where_it_has_not_stood() {
        let (mut backtrack, mut robot) = driven(20);
        assert!(backtrack.begin(robot.plan_m()).is_some());
        backtrack.record(&robot, STEP);
        robot.position_m.y -= 0.5;
        assert_eq!((backtrack.next(&robot, |turn| turn), backtrack.is_active()), (None, false));
    }

    #[test]
    fn a_loop_is_left_out() {
        let (mut backtrack, mut robot) = driven(20);
        let ticks = 120;
        for _ in 0..ticks {
            advance(&mut backtrack, &mut robot, 0.5, core::f64::consts::TAU / (0.1 * f64::from(ticks)));
        }
        assert!(
            backtrack_all(&mut backtrack, &mut robot, 0.0).iter().all(|pose| pose.position_m.y.abs() < 0.1)
        );
        assert!(robot.position_m.length() < 0.3);
    }

    #[test]
    fn what_was_gone_back_is_no_trail_any_more() {
        let (mut backtrack, mut robot) = driven(100);
        assert!((backtrack.begin(robot.plan_m()).unwrap() - DVec2::X).length() < 1e-9);
        backtrack.record(&robot, STEP);
        while !backtrack.has_driven_far(robot.plan_m()) {
            assert!(matches!(
                backtrack.next(&robot, |turn_rad| turn_rad),
                Some(BacktrackCommand::Drive { reverse: true, .. })
            ));
            advance(&mut backtrack, &mut robot, -0.5, 0.0);
        }
        backtrack.end();
        assert!((3.8..4.0).contains(&robot.position_m.x), "{robot:?}");
        assert!(backtrack.positions_m().all(|place_m| place_m.x < 4.1));
    }

    #[test]
    fn after_backtracking_to_the_first_pose_it_still_knows_that_pose() {
        let (mut backtrack, mut robot) = driven(10);
        for _ in 0..5 {
            backtrack_all(&mut backtrack, &mut robot, 0.0);
            for _ in 0..4 {
                advance(&mut backtrack, &mut robot, 0.5, 0.0);
            }
        }
        assert!(robot.position_m.length() < 0.5, "{robot:?}");
    }

    #[test]
    fn it_goes_back_a_little_where_it_came_but_a_little() {
        let (mut backtrack, mut robot) = driven(4);
        backtrack_all(&mut backtrack, &mut robot, 0.0);
        assert!(robot.position_m.length() < 0.15, "{robot:?}");
    }

    #[test]
    fn a_robot_that_has_not_driven_or_was_carried_has_no_trajectory() {
        assert_eq!(Backtrack::new().begin(DVec2::ZERO), None);
        let (mut backtrack, _) = driven(100);
        let carried = pose(DVec2::splat(9.0), 0.0);
        backtrack.record(&carried, STEP);
        assert_eq!((backtrack.begin(carried.plan_m()), backtrack.is_active()), (None, false));
    }

    #[test]
    fn the_trail_is_as_long_as_it_may_be() {
        let (backtrack, robot) = driven(1000);
        let length_m = robot.position_m.x - backtrack.positions_m().last().unwrap().x;
        assert!((19.0..31.0).contains(&length_m), "{length_m}");
    }
}
