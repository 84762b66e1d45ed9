//! Going back the way the robot came.
//!
//! Where it stands too steep, or nothing leads on, what it was told of the ground is not true or not enough. Where it has stood, and as it
//! turned there, it can stand again: that way back needs no forecast.

use core::f64::consts::{FRAC_PI_2, PI};
use std::collections::VecDeque;

use glam::DVec2;

use crate::angle::wrap_rad;
use crate::pose::Pose;
use crate::subgoals::bearing_rad;

/// Stances on the trail lie this far or this much of a turn apart, and so many are kept.
const SPACING_M: f64 = 0.1;
const SPACING_RAD: f64 = 0.15;
const MOST_STANCES: usize = 200;
/// Two stances this near to each other, with a radian for so many metres, are the same, unless one is among the next on the trail.
const SAME_M: f64 = 0.12;
const NEIGHBOURS: usize = 3;
const RADIAN_M: f64 = 0.5;
/// A stance this near is turned to, one farther away driven to; steering no more than this, so as not to turn where it drove straight.
const TURN_M: f64 = 0.08;
/// Where it may not turn from there, it drives on until the stance is no farther ahead or behind than this; one to its side cannot be
/// driven to.
const THERE_M: f64 = 0.03;
/// A smaller part of a turn is not worth while.
const LEAST_TURN_RAD: f64 = 0.1;
const MOST_STEERING_RAD: f64 = 0.4;
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
}

/// The next move on the way back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Back {
    /// On the spot, anticlockwise.
    Turn { by_rad: f64 },
    /// To a place at a bearing.
    Drive { bearing_rad: f64, reverse: bool },
}

/// How the robot has last stood, and whether it goes back there.
#[derive(Clone, Debug)]
pub(crate) struct Retreat {
    /// The newest last.
    trail: VecDeque<Stance>,
    began_at_m: Option<DVec2>,
}

impl Retreat {
    pub(crate) fn new() -> Self {
        Self { trail: VecDeque::with_capacity(MOST_STANCES), began_at_m: None }
    }

    pub(crate) fn clear(&mut self) {
        self.trail.clear();
        self.began_at_m = None;
    }

    /// The robot is here, wherever it goes.
    pub(crate) fn be_at(&mut self, pose: &Pose) {
        if self.is_on() {
            return;
        }
        let here = Stance::of(pose);
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
        Some(came.normalize())
    }

    /// The next move on the way back; `None`, and the end of it, when there is none left. Where the trail begins stays known. Beside where it
    /// stood a turn may be too steep: `safe_turn_rad` says how much of one, anticlockwise, is not.
    pub(crate) fn next(&mut self, pose: &Pose, safe_turn_rad: impl Fn(f64) -> f64) -> Option<Back> {
        let here = Stance::of(pose);
        loop {
            while let Some((last, before)) = self.trail.back().zip(self.trail.iter().nth_back(1)) {
                let away_m = here.away_m(last);
                if away_m > SAME_M && here.away_m(before) > away_m {
                    break;
                }
                self.trail.pop_back();
            }
            let left = self.trail.back().filter(|last| here.away_m(last) > SAME_M);
            let Some(&Stance { place_m, yaw_rad }) = left else {
                self.end();
                return None;
            };
            let bearing = bearing_rad(pose, place_m);
            let reverse = bearing.abs() > FRAC_PI_2;
            let straight = if reverse { PI } else { 0.0 };
            let away_m = (place_m - here.place_m).length();
            let is_abeam = (away_m * libm::cos(bearing)).abs() < THERE_M;
            let turn_rad = wrap_rad(yaw_rad - pose.yaw_rad);
            let by_rad = safe_turn_rad(turn_rad);
            let may_turn = by_rad.abs() >= turn_rad.abs().min(LEAST_TURN_RAD);
            if may_turn && (away_m < TURN_M || is_abeam && turn_rad.abs() > SPACING_RAD) {
                return Some(Back::Turn { by_rad });
            }
            if !is_abeam {
                let most_rad = if away_m < TURN_M { 0.0 } else { MOST_STEERING_RAD };
                let steering = wrap_rad(bearing - straight).clamp(-most_rad, most_rad);
                return Some(Back::Drive { bearing_rad: straight + safe_turn_rad(steering), reverse });
            }
            self.trail.pop_back();
        }
    }

    /// The places on the way back, the nearest first.
    pub(crate) fn way_back_m(&self) -> impl Iterator<Item = DVec2> + use<'_> {
        self.trail.iter().rev().map(|stance| stance.place_m)
    }

    /// Goes on again.
    pub(crate) fn end(&mut self) {
        self.began_at_m = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn pose(place_m: DVec2, yaw_rad: f64) -> Pose {
        Pose { position_m: place_m.extend(0.0), roll_rad: 0.0, pitch_rad: 0.0, yaw_rad }
    }

    /// A robot that has driven straight ahead for so many tenths of a second.
    fn driven(ticks: usize) -> (Retreat, Pose) {
        let (mut retreat, mut robot) = (Retreat::new(), pose(DVec2::ZERO, 0.0));
        for _ in 0..ticks {
            advance(&mut retreat, &mut robot, 0.5, 0.0);
        }
        (retreat, robot)
    }

    /// Moves as a robot does in a tenth of a second, with the trail told of it.
    fn advance(retreat: &mut Retreat, pose: &mut Pose, speed_m_s: f64, turn_rate_rad_s: f64) {
        pose.yaw_rad += 0.1 * turn_rate_rad_s;
        let heading = DVec2::from_angle(pose.yaw_rad);
        pose.position_m += DVec3::from((0.1 * speed_m_s * heading, 0.0));
        retreat.be_at(pose);
    }

    /// Goes all the way back; gives every pose on it.
    fn go_back(retreat: &mut Retreat, pose: &mut Pose) -> Vec<Pose> {
        assert!(retreat.begin(pose.plan_m()).is_some());
        let mut poses = Vec::new();
        while let Some(back) = retreat.next(pose, |turn_rad| turn_rad) {
            let (speed_m_s, turn_rate_rad_s) = match back {
                Back::Turn { by_rad } => (0.0, (5.0 * by_rad).clamp(-0.5, 0.5)),
                Back::Drive { bearing_rad, reverse: true } => (-0.3, 2.0 * wrap_rad(bearing_rad - PI)),
                Back::Drive { bearing_rad, reverse: false } => (0.3, 2.0 * bearing_rad),
            };
            advance(retreat, pose, speed_m_s, turn_rate_rad_s);
            poses.push(*pose);
            assert!(poses.len() < 1000, "it does not get back");
        }
        poses
    }

    #[test]
    fn it_goes_back_as_it_came_turns_and_arcs_too() {
        let mut retreat = Retreat::new();
        let mut robot = pose(DVec2::ZERO, 0.0);
        retreat.be_at(&robot);
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
                advance(&mut retreat, &mut robot, speed_m_s, turn_rate_rad_s);
                came.push(robot);
            }
        }
        for pose in go_back(&mut retreat, &mut robot) {
            let stance = Stance::of(&pose);
            let off_m =
                came.iter().map(|pose| stance.away_m(&Stance::of(pose))).fold(f64::INFINITY, f64::min);
            assert!(off_m < 0.2, "{off_m} m from how it stood: {pose:?}");
        }
        assert!(robot.position_m.length() < 0.2 && !retreat.is_on());
    }

    #[test]
    fn beside_where_it_stood_it_turns_no_farther_than_is_safe() {
        // Ahead, a turn of a radian to the left, ahead; then back, but for the last 0.07 m.
        let (mut retreat, mut robot) = driven(20);
        for _ in 0..20 {
            advance(&mut retreat, &mut robot, 0.0, 0.5);
        }
        for _ in 0..10 {
            advance(&mut retreat, &mut robot, 0.5, 0.0);
        }
        assert!(retreat.begin(robot.plan_m()).is_some());
        robot.position_m = DVec3::new(1.0, 0.0, 0.0) + 0.07 * DVec3::new(libm::cos(1.0), libm::sin(1.0), 0.0);
        let part = |share: f64| move |turn_rad: f64| share * turn_rad;
        let turn_rad = |back| if let Some(Back::Turn { by_rad }) = back { by_rad } else { f64::NAN };
        let whole_rad = turn_rad(retreat.clone().next(&robot, part(1.0)));
        assert!((-0.3..-0.1).contains(&whole_rad), "{whole_rad}");
        assert!((turn_rad(retreat.clone().next(&robot, part(0.8))) - 0.8 * whole_rad).abs() < 1e-12);
        // What is safe nowhere is tried where it stood, and then left out.
        assert_eq!(retreat.next(&robot, part(0.0)), Some(Back::Drive { bearing_rad: PI, reverse: true }));
        robot.position_m = DVec3::new(1.0, 0.0, 0.0);
        let Some(Back::Drive { bearing_rad, .. }) = retreat.next(&robot, part(0.0)) else {
            panic!("the stance is not left out");
        };
        assert!((bearing_rad - PI).abs() < 1e-12);
        assert!(retreat.way_back_m().next().unwrap().x < 0.95);
    }

    #[test]
    fn a_trail_to_its_side_does_not_hold_it() {
        let (mut retreat, mut robot) = driven(20);
        for _ in 0..10 {
            advance(&mut retreat, &mut robot, 0.0, 0.5);
        }
        assert!(retreat.begin(robot.plan_m()).is_some());
        robot.position_m.y -= 0.15;
        let mut moves = Vec::new();
        while let Some(back) = retreat.next(&robot, |_| 0.0) {
            let Back::Drive { reverse, .. } = back else { panic!("{back:?} is not safe") };
            advance(&mut retreat, &mut robot, if reverse { -0.3 } else { 0.3 }, 0.0);
            moves.push(reverse);
            assert!(moves.len() < 100, "to and fro: {moves:?}");
        }
        let changes = moves.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes < 3, "{moves:?}");
    }

    #[test]
    fn a_loop_is_left_out() {
        let (mut retreat, mut robot) = driven(20);
        let ticks = 120;
        for _ in 0..ticks {
            advance(&mut retreat, &mut robot, 0.5, core::f64::consts::TAU / (0.1 * f64::from(ticks)));
        }
        assert!(go_back(&mut retreat, &mut robot).iter().all(|pose| pose.position_m.y.abs() < 0.1));
        assert!(robot.position_m.length() < 0.3);
    }

    #[test]
    fn what_was_gone_back_is_no_trail_any_more() {
        let (mut retreat, mut robot) = driven(100);
        assert!((retreat.begin(robot.plan_m()).unwrap() - DVec2::X).length() < 1e-9);
        while !retreat.has_gone_far(robot.plan_m()) {
            assert!(matches!(
                retreat.next(&robot, |turn_rad| turn_rad),
                Some(Back::Drive { reverse: true, .. })
            ));
            advance(&mut retreat, &mut robot, -0.5, 0.0);
        }
        retreat.end();
        assert!((3.8..4.0).contains(&robot.position_m.x), "{robot:?}");
        assert!(retreat.way_back_m().all(|place_m| place_m.x < 4.1));
    }

    #[test]
    fn having_gone_all_the_way_back_it_still_knows_that_place() {
        let (mut retreat, mut robot) = driven(10);
        for _ in 0..5 {
            go_back(&mut retreat, &mut robot);
            for _ in 0..4 {
                advance(&mut retreat, &mut robot, 0.5, 0.0);
            }
        }
        assert!(robot.position_m.length() < 0.5, "{robot:?}");
    }

    #[test]
    fn it_goes_back_a_little_where_it_came_but_a_little() {
        let (mut retreat, mut robot) = driven(4);
        go_back(&mut retreat, &mut robot);
        assert!(robot.position_m.length() < 0.15, "{robot:?}");
    }

    #[test]
    fn a_robot_that_has_not_driven_or_was_carried_has_no_way_back() {
        assert_eq!(Retreat::new().begin(DVec2::ZERO), None);
        let (mut retreat, _) = driven(100);
        let carried = pose(DVec2::splat(9.0), 0.0);
        retreat.be_at(&carried);
        assert_eq!((retreat.begin(carried.plan_m()), retreat.is_on()), (None, false));
    }

    #[test]
    fn the_trail_is_as_long_as_it_may_be() {
        let (retreat, robot) = driven(1000);
        let length_m = robot.position_m.x - retreat.way_back_m().last().unwrap().x;
        assert!((19.0..31.0).contains(&length_m), "{length_m}");
    }
}
