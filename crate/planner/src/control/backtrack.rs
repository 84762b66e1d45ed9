//! Going back the way the robot came.
//!
//! Where it stands too steep, or nothing leads on, what it was told of the ground is not true or not enough. Where it has stood, and as it
//! turned there, it can stand again: that way back needs no forecast.

use std::collections::VecDeque;

use glam::DVec2;

use crate::math::angle::wrap_rad;
use crate::pose::Pose;

/// Stances on the trail lie this far or this much of a turn apart, and so many are kept.
const SPACING_M: f64 = 0.1;
const SPACING_RAD: f64 = 0.15;
const MOST_STANCES: usize = 200;
/// Two stances this near to each other, with a radian for so many metres, are the same, unless one is among the next on the trail.
const SAME_M: f64 = 0.08;
const NEIGHBOURS: usize = 3;
const RADIAN_M: f64 = 0.5;
/// The robot is at a stance that is no farther ahead or behind than this and, where it turned there, not turned further from it.
const THERE_M: f64 = 0.03;
const THERE_RAD: f64 = 0.05;
/// From a stance to one nearer than this it turned.
const TURN_M: f64 = 0.08;
/// A smaller part of a turn is not worth while.
const LEAST_TURN_RAD: f64 = 0.1;
/// It turns to how it stood within the way there or, where that is shorter, within this one, and in no sharper curve.
const LEAST_WAY_M: f64 = 0.05;
const MOST_TURN_RAD_M: f64 = 4.0;
/// Each metre that it is beside the trail bends its way towards it by so much of a turn a metre, up to so much.
const BESIDE_RAD_M2: f64 = 25.0;
const MOST_BESIDE_RAD_M: f64 = 2.0;
/// A robot this far from its trail has lost it.
const LOST_M: f64 = 0.4;
/// A robot that moves and turns less than this in a step stands still, and after so many steps it has had the time to.
const STILL_M: f64 = 0.01;
const STILL_RAD: f64 = 0.01;
const MOST_BRAKING_TICKS: u32 = 20;
/// A robot that is farther from where it last was did not drive there.
const JUMP_M: f64 = 1.0;
/// The direction in which it came is that from a place this far back or, where it came less far, from where it began, if that is no nearer than
/// the least.
const CAME_M: f64 = 0.3;
const LEAST_CAME_M: f64 = 0.1;
/// It goes back at least this far.
const LEAST_M: f64 = 1.0;

/// How the robot has stood, seen from above.
#[derive(Clone, Copy, Debug)]
struct Stance {
    place_m: DVec2,
    yaw_rad: f64,
}

impl Stance {
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

    /// Whether a robot that stands like this is past `stance` on its way to `next`.
    fn is_past(&self, stance: &Self, next: &Self) -> bool {
        let past_m = (self.place_m - stance.place_m).dot((next.place_m - stance.place_m).normalize_or_zero());
        past_m > if self.turned_rad(stance) < SPACING_RAD { 0.0 } else { THERE_M }
    }
}

/// The next move on the way back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BacktrackCommand {
    /// To a stop, out of the drive that led here.
    Brake,
    /// On the spot, anticlockwise.
    Turn { by_rad: f64 },
    /// Along an arc, with so much of a turn, anticlockwise, for each metre driven.
    Drive { turn_rad_m: f64, reverse: bool },
}

/// How the robot has last stood, and whether it goes back there.
#[derive(Clone, Debug)]
pub(crate) struct Backtrack {
    /// The newest last.
    trail: VecDeque<Stance>,
    last: Option<Stance>,
    began_at_m: Option<DVec2>,
    /// For so many steps yet, or until it stands.
    braking_ticks: u32,
}

impl Backtrack {
    pub(crate) fn new() -> Self {
        Self { trail: VecDeque::with_capacity(MOST_STANCES), last: None, began_at_m: None, braking_ticks: 0 }
    }

    pub(crate) fn clear(&mut self) {
        self.trail.clear();
        self.last = None;
        self.end();
    }

    /// The robot is here, wherever it goes.
    pub(crate) fn be_at(&mut self, pose: &Pose) {
        let here = Stance::of(pose);
        let last = self.last.replace(here);
        if self.is_on() && self.braking_ticks == 0 {
            return;
        }
        let moves = last.is_some_and(|last| {
            (here.place_m - last.place_m).length() > STILL_M || here.turned_rad(&last) > STILL_RAD
        });
        self.braking_ticks = if moves { self.braking_ticks.saturating_sub(1) } else { 0 };
        if let Some(last) = self.trail.back() {
            let moved_m = (here.place_m - last.place_m).length();
            if moved_m < SPACING_M && here.turned_rad(last) < SPACING_RAD {
                return;
            }
            if moved_m > JUMP_M {
                self.trail.clear();
            }
        }
        // A loop leads nowhere: the way back leaves it out.
        let older = self.trail.len().saturating_sub(NEIGHBOURS);
        if let Some(before) = self.trail.iter().take(older).position(|stance| here.away_m(stance) < SAME_M) {
            self.trail.truncate(before);
        }
        if self.trail.len() == MOST_STANCES {
            self.trail.pop_front();
        }
        self.trail.push_back(here);
    }

    /// Whether the robot goes back.
    pub(crate) fn is_on(&self) -> bool {
        self.began_at_m.is_some()
    }

    /// Whether it has gone back far enough to try again.
    pub(crate) fn has_gone_far(&self, here_m: DVec2) -> bool {
        self.began_at_m.is_some_and(|began_at_m| (here_m - began_at_m).length() > LEAST_M)
    }

    /// Turns back. Gives the unit vector along which the robot came; `None`, and no turning back, when it came from nowhere.
    pub(crate) fn begin(&mut self, here_m: DVec2) -> Option<DVec2> {
        let far = self.way_back_m().find(|place_m| (here_m - *place_m).length() > CAME_M);
        let came = here_m - far.or_else(|| self.way_back_m().last())?;
        if came.length() < LEAST_CAME_M {
            return None;
        }
        self.began_at_m = Some(here_m);
        self.braking_ticks = MOST_BRAKING_TICKS;
        Some(came.normalize())
    }

    /// The next move on the way back; `None`, and the end of it, when there is none left or the trail is lost. Where the trail begins stays
    /// known. Beside where it stood a turn may be too steep: `safe_turn_rad` says how much of one, anticlockwise, is not.
    pub(crate) fn next(
        &mut self,
        pose: &Pose,
        safe_turn_rad: impl Fn(f64) -> f64,
    ) -> Option<BacktrackCommand> {
        if self.braking_ticks > 0 {
            return Some(BacktrackCommand::Brake);
        }
        let here = Stance::of(pose);
        while let Some(&stance) = self.trail.back() {
            if (stance.place_m - here.place_m).length() > LOST_M {
                self.trail.clear();
                break;
            }
            let before = self.trail.iter().nth_back(1);
            if !before.is_some_and(|before| here.is_past(&stance, before)) {
                let turns = before.is_some_and(|before| (before.place_m - stance.place_m).length() < TURN_M);
                let enough_rad = if turns { THERE_RAD } else { SPACING_RAD };
                let back = toward(&here, &stance, enough_rad, &safe_turn_rad);
                if back.is_some() {
                    return back;
                }
            }
            if before.is_none() {
                break;
            }
            self.trail.pop_back();
        }
        self.end();
        None
    }

    /// The places on the way back, the nearest first.
    pub(crate) fn way_back_m(&self) -> impl Iterator<Item = DVec2> + use<'_> {
        self.trail.iter().rev().map(|stance| stance.place_m)
    }

    /// Goes on again.
    pub(crate) fn end(&mut self) {
        self.began_at_m = None;
        self.braking_ticks = 0;
    }
}

/// The move from how the robot stands to how it stood; `None` where it is there, turned by less than `enough_rad`, or can neither drive nor
/// turn there.
fn toward(
    here: &Stance,
    stance: &Stance,
    enough_rad: f64,
    safe_turn_rad: impl Fn(f64) -> f64,
) -> Option<BacktrackCommand> {
    let path_m = stance.place_m - here.place_m;
    let ahead_m = path_m.dot(here.facing());
    let turn_rad = wrap_rad(stance.yaw_rad - here.yaw_rad);
    if ahead_m.abs() > THERE_M {
        let reverse = ahead_m < 0.0;
        let beside_m = path_m.dot(stance.facing().perp());
        let onto_rad_m = (BESIDE_RAD_M2 * beside_m).clamp(-MOST_BESIDE_RAD_M, MOST_BESIDE_RAD_M);
        let turn_rad_m =
            turn_rad / ahead_m.abs().max(LEAST_WAY_M) + if reverse { -onto_rad_m } else { onto_rad_m };
        return Some(BacktrackCommand::Drive {
            turn_rad_m: turn_rad_m.clamp(-MOST_TURN_RAD_M, MOST_TURN_RAD_M),
            reverse,
        });
    }
    // Where it stood it can stand again, whatever the ground around looks like.
    let by_rad = if path_m.length() > THERE_M { safe_turn_rad(turn_rad) } else { turn_rad };
    (turn_rad.abs() > enough_rad && by_rad.abs() >= turn_rad.abs().min(LEAST_TURN_RAD))
        .then_some(BacktrackCommand::Turn { by_rad })
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use glam::DVec3;

    fn pose(place_m: DVec2, yaw_rad: f64) -> Pose {
        Pose { position_m: place_m.extend(0.0), roll_rad: 0.0, pitch_rad: 0.0, yaw_rad }
    }

    /// A robot that has driven straight ahead for so many tenths of a second.
    fn driven(ticks: usize) -> (Backtrack, Pose) {
        let (mut backtrack, mut robot) = (Backtrack::new(), pose(DVec2::ZERO, 0.0));
        for _ in 0..ticks {
            advance(&mut backtrack, &mut robot, 0.5, 0.0);
        }
        (backtrack, robot)
    }

    /// A robot that has driven a metre ahead, turned to the left for so many tenths of a second, and stands, about to go back.
    fn turned(ticks: usize) -> (Backtrack, Pose) {
        let (mut backtrack, mut robot) = driven(20);
        for _ in 0..ticks {
            advance(&mut backtrack, &mut robot, 0.0, 0.5);
        }
        assert!(backtrack.begin(robot.plan_m()).is_some());
        backtrack.be_at(&robot);
        (backtrack, robot)
    }

    /// Moves as a robot does in a tenth of a second, with the trail told of it.
    fn advance(backtrack: &mut Backtrack, pose: &mut Pose, speed_m_s: f64, turn_rate_rad_s: f64) {
        pose.yaw_rad += 0.1 * turn_rate_rad_s;
        let heading = DVec2::from_angle(pose.yaw_rad);
        pose.position_m += DVec3::from((0.1 * speed_m_s * heading, 0.0));
        backtrack.be_at(pose);
    }

    /// Goes all the way back, out of a drive at this speed; gives every pose on it. A Husky gains a metre a second in a second.
    fn go_back(backtrack: &mut Backtrack, pose: &mut Pose, speed_m_s: f64) -> Vec<Pose> {
        assert!(backtrack.begin(pose.plan_m()).is_some());
        let mut poses = Vec::new();
        let (mut speed_m_s, mut turn_rate_rad_s) = (speed_m_s, 0.0);
        while let Some(back) = backtrack.next(pose, |turn_rad| turn_rad) {
            let (wanted_m_s, wanted_rad_s) = match back {
                BacktrackCommand::Brake => (0.0, 0.0),
                BacktrackCommand::Turn { by_rad } => (0.0, (5.0 * by_rad).clamp(-0.5, 0.5)),
                BacktrackCommand::Drive { turn_rad_m, reverse } => {
                    (if reverse { -0.3 } else { 0.3 }, 0.3 * turn_rad_m)
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
        backtrack.be_at(&robot);
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
            let stance = Stance::of(pose);
            came.iter().map(|pose| stance.away_m(&Stance::of(pose))).fold(f64::INFINITY, f64::min)
        };
        let poses = go_back(&mut backtrack, &mut robot, 0.0);
        let worst_m = poses.iter().map(off_m).fold(0.0, f64::max);
        assert!(worst_m < 0.1, "{worst_m} m from how it stood");
        assert!(robot.position_m.length() < 0.2 && !backtrack.is_on());
    }

    #[test]
    fn it_stands_before_it_goes_back_and_goes_over_where_it_came_to_stand() {
        let (mut backtrack, mut robot) = driven(20);
        let poses = go_back(&mut backtrack, &mut robot, 0.8);
        let turned_at_m = poses.iter().map(|pose| pose.position_m.x).fold(0.0, f64::max);
        assert!((1.2..1.4).contains(&turned_at_m), "{turned_at_m}");
        assert!(poses.iter().all(|pose| pose.position_m.y.abs() < 0.01 && pose.yaw_rad.abs() < 0.05));
        assert!(robot.position_m.length() < 0.2);
    }

    #[test]
    fn beside_its_trail_it_gets_back_onto_it() {
        for (beside_m, yaw_rad) in [(0.1, 0.0), (-0.1, 0.2), (0.05, -0.2)] {
            for facing_back in [false, true] {
                let (mut backtrack, mut robot) = driven(40);
                if facing_back {
                    // The trail is driven forward after all.
                    backtrack = Backtrack::new();
                    robot = pose(DVec2::ZERO, PI);
                    backtrack.be_at(&robot);
                    for _ in 0..40 {
                        advance(&mut backtrack, &mut robot, -0.5, 0.0);
                    }
                }
                robot.position_m.y += beside_m;
                robot.yaw_rad += yaw_rad;
                let poses = go_back(&mut backtrack, &mut robot, 0.0);
                let off_m = |pose: &Pose| pose.position_m.y.abs();
                let soon = poses.iter().filter(|pose| pose.position_m.x < 1.0).map(off_m).fold(0.0, f64::max);
                assert!(soon < 0.03, "{soon} m after {beside_m} m and {yaw_rad}");
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
            backtrack.be_at(&robot);
            ticks += 1;
            assert!(ticks < 50, "it brakes for ever");
        }
        assert!(backtrack.is_on());
    }

    #[test]
    fn it_turns_where_it_turned_and_beside_that_no_farther_than_is_safe() {
        let (mut backtrack, mut robot) = turned(20);
        let turn_rad =
            |back| if let Some(BacktrackCommand::Turn { by_rad }) = back { by_rad } else { f64::NAN };
        let whole_rad = turn_rad(backtrack.clone().next(&robot, |_| 0.0));
        assert!((-0.2..-0.05).contains(&whole_rad), "{whole_rad} where it turned");
        // To its left.
        robot.position_m += 0.07 * DVec3::new(-libm::sin(1.0), libm::cos(1.0), 0.0);
        assert!((turn_rad(backtrack.clone().next(&robot, |turn| turn)) - whole_rad).abs() < 1e-12);
        assert!(
            (turn_rad(backtrack.clone().next(&robot, |turn| 0.8 * turn)) - 0.8 * whole_rad).abs() < 1e-12
        );
        // What is not safe is left out.
        let next = backtrack.next(&robot, |_| 0.0);
        assert!(!matches!(next, Some(BacktrackCommand::Turn { .. })), "{next:?}");
    }

    #[test]
    fn far_from_its_trail_it_does_not_drive_where_it_has_not_stood() {
        let (mut backtrack, mut robot) = driven(20);
        assert!(backtrack.begin(robot.plan_m()).is_some());
        backtrack.be_at(&robot);
        robot.position_m.y -= 0.5;
        assert_eq!((backtrack.next(&robot, |turn| turn), backtrack.is_on()), (None, false));
    }

    #[test]
    fn a_loop_is_left_out() {
        let (mut backtrack, mut robot) = driven(20);
        let ticks = 120;
        for _ in 0..ticks {
            advance(&mut backtrack, &mut robot, 0.5, core::f64::consts::TAU / (0.1 * f64::from(ticks)));
        }
        assert!(go_back(&mut backtrack, &mut robot, 0.0).iter().all(|pose| pose.position_m.y.abs() < 0.1));
        assert!(robot.position_m.length() < 0.3);
    }

    #[test]
    fn what_was_gone_back_is_no_trail_any_more() {
        let (mut backtrack, mut robot) = driven(100);
        assert!((backtrack.begin(robot.plan_m()).unwrap() - DVec2::X).length() < 1e-9);
        backtrack.be_at(&robot);
        while !backtrack.has_gone_far(robot.plan_m()) {
            assert!(matches!(
                backtrack.next(&robot, |turn_rad| turn_rad),
                Some(BacktrackCommand::Drive { reverse: true, .. })
            ));
            advance(&mut backtrack, &mut robot, -0.5, 0.0);
        }
        backtrack.end();
        assert!((3.8..4.0).contains(&robot.position_m.x), "{robot:?}");
        assert!(backtrack.way_back_m().all(|place_m| place_m.x < 4.1));
    }

    #[test]
    fn having_gone_all_the_way_back_it_still_knows_that_place() {
        let (mut backtrack, mut robot) = driven(10);
        for _ in 0..5 {
            go_back(&mut backtrack, &mut robot, 0.0);
            for _ in 0..4 {
                advance(&mut backtrack, &mut robot, 0.5, 0.0);
            }
        }
        assert!(robot.position_m.length() < 0.5, "{robot:?}");
    }

    #[test]
    fn it_goes_back_a_little_where_it_came_but_a_little() {
        let (mut backtrack, mut robot) = driven(4);
        go_back(&mut backtrack, &mut robot, 0.0);
        assert!(robot.position_m.length() < 0.15, "{robot:?}");
    }

    #[test]
    fn a_robot_that_has_not_driven_or_was_carried_has_no_way_back() {
        assert_eq!(Backtrack::new().begin(DVec2::ZERO), None);
        let (mut backtrack, _) = driven(100);
        let carried = pose(DVec2::splat(9.0), 0.0);
        backtrack.be_at(&carried);
        assert_eq!((backtrack.begin(carried.plan_m()), backtrack.is_on()), (None, false));
    }

    #[test]
    fn the_trail_is_as_long_as_it_may_be() {
        let (backtrack, robot) = driven(1000);
        let length_m = robot.position_m.x - backtrack.way_back_m().last().unwrap().x;
        assert!((19.0..31.0).contains(&length_m), "{length_m}");
    }
}
