//! The optimising controller: the best trajectory of the next two seconds, by the price of what it meets, its
//! smoothness, and what is left of the path at its end.
//!
//! A trajectory is a speed and two turn rates, one early and one at the end of the horizon, with a straight
//! line through time between them. A deterministic pattern search finds the best. Beside it stands the one
//! that drives from point to point of the path and turns on the spot to what is aside.

use core::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec2;

use crate::config::{ControllerConfig, PlannerConfig};
use crate::control::controller::Command;

/// Horizon, its steps, and the time of the first turn rate.
const STEP_S: f64 = 0.1;
const STEPS: usize = 20;
const EARLY_S: f64 = 0.6;
const HORIZON_S: f64 = STEP_S * STEPS as f64;
/// After lost scans, a command changes by no more than in this time.
const MOST_ELAPSED_S: f64 = 0.2;
/// A point of a path is passed within this distance, and its last one reached within this; turn rate for each
/// radian to the next one, and the angle beyond which the robot turns on the spot.
const PASSED_M: f64 = 0.3;
const ARRIVED_M: f64 = 0.05;
const FOLLOW_GAIN: f64 = 2.0;
const TURN_FIRST_RAD: f64 = 0.5;
/// A robot that is farther than this from facing along the path turns before it drives.
const FACES_AWAY_RAD: f64 = FRAC_PI_2;
/// A trajectory that gains less than this, in metres of level ground, leaves the robot where it stands.
const LEAST_PROGRESS_M: f64 = 0.05;
/// Below these speeds the robot stands.
const STILL_M_S: f64 = 0.01;
const STILL_RAD_S: f64 = 0.01;
/// Rounds of the pattern search; each halves its reach.
const ROUNDS: usize = 4;

fn is_still(command: &Command) -> bool {
    command.linear_m_s.abs() < STILL_M_S && command.angular_rad_s.abs() < STILL_RAD_S
}

/// Limits and prices of the trajectories.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    controller: ControllerConfig,
    /// Cost of a radian, metres.
    turn_m_rad: f64,
    tilt_price: f64,
    reverse_price: f64,
}

impl Limits {
    pub(crate) fn of(config: &PlannerConfig) -> Self {
        Self {
            controller: config.controller,
            turn_m_rad: config.state_lattice.turn_m_rad(),
            tilt_price: config.state_lattice.tilt_price,
            reverse_price: config.state_lattice.reverse_price,
        }
    }
}

/// A pose in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlanPose {
    pub(crate) position_m: DVec2,
    pub(crate) yaw_rad: f64,
}

impl PlanPose {
    /// Drives for a short time with a command.
    fn advance(&mut self, command: &Command, time_s: f64) {
        let (sin, cos) = libm::sincos(self.yaw_rad + 0.5 * command.angular_rad_s * time_s);
        self.position_m += DVec2::new(cos, sin) * (command.linear_m_s * time_s);
        self.yaw_rad += command.angular_rad_s * time_s;
    }
}

/// Where a trajectory begins, the last command, from which it accelerates, and the share of the tilt limits
/// that the robot's attitude has or is about to have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) pose: PlanPose,
    pub(crate) command: Command,
    /// Time since the last command, for which the first change of speed and turn rate may last.
    pub(crate) elapsed_s: f64,
    pub(crate) utilisation: f64,
}

/// What a trajectory meets at a pose: (slope / limit)², with what makes a place dear, and the share of the
/// limits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Met {
    pub(crate) risk: f64,
    pub(crate) utilisation: f64,
}

/// Where trajectories are judged.
pub(crate) trait Course {
    /// What the ground does to the robot at a pose; `None` if it may not be there.
    fn met(&self, pose: &PlanPose) -> Option<Met>;
    /// Cost of what is left of the path from a pose.
    fn cost_to_go_m(&self, pose: &PlanPose) -> f64;
    /// How far the robot is from facing along the path, up to half a turn.
    fn facing_off_rad(&self, pose: &PlanPose) -> f64;
    /// A path to follow, as points and whether each is driven to in reverse.
    fn path(&self) -> impl Iterator<Item = (DVec2, bool)>;
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Plan {
    speed_m_s: f64,
    early_rad_s: f64,
    late_rad_s: f64,
}

const STAND: Plan = Plan { speed_m_s: 0.0, early_rad_s: 0.0, late_rad_s: 0.0 };

impl Plan {
    /// The turn rate at a time, beginning with `now_rad_s`.
    fn turn_rate_rad_s(&self, time_s: f64, now_rad_s: f64) -> f64 {
        if time_s <= EARLY_S {
            now_rad_s + (self.early_rad_s - now_rad_s) * (time_s / EARLY_S)
        } else {
            let share = (time_s - EARLY_S) / (HORIZON_S - EARLY_S);
            self.early_rad_s + (self.late_rad_s - self.early_rad_s) * share
        }
    }
}

/// What makes a trajectory.
#[derive(Clone, Copy, Debug)]
enum Law<'a> {
    Plan(&'a Plan),
    /// Drive from point to point of the path, and turn on the spot to what is aside.
    Follow,
}

/// A trajectory's cost, infinite if it meets what it must not, what is left of the path at its end, its first
/// command, and whether that or the second one moves the robot: the first may have no time to.
#[derive(Clone, Copy, Debug)]
struct RolledOut {
    cost: f64,
    to_go_m: f64,
    first: Command,
    moves: bool,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    plan: Plan,
    rolled: RolledOut,
}

/// Keeps the last trajectory, from which the next search begins.
#[derive(Clone, Debug)]
pub(crate) struct TrajectoryOptimiser {
    limits: Limits,
    last: Plan,
}

impl TrajectoryOptimiser {
    pub(crate) fn new(limits: Limits) -> Self {
        Self { limits, last: STAND }
    }

    pub(crate) fn reset(&mut self) {
        self.last = STAND;
    }

    /// The command that begins the best trajectory from a pose and the last command. If every trajectory
    /// meets what it must not, or the best one leaves the robot where it stands and the path does not, it
    /// begins the drive along the path, which was found safe. `None` if the robot stands and the trajectory
    /// would leave it standing: the body would come too near to something on the way that the search took,
    /// or the path ends here.
    pub(crate) fn drive(&mut self, course: &impl Course, from: Start) -> Option<Command> {
        let (speed_m_s, reverse_m_s) =
            (self.limits.controller.max_speed_m_s, self.limits.controller.reverse_m_s());
        let turn_rate_rad_s = self.limits.controller.max_turn_rate_rad_s;
        // The path tells whether the robot drives in reverse, and where it faces away from the path it turns
        // first. In two seconds it would gain more by backing along a path that leads back, or by an arc off
        // it, than by turning to it.
        let reverse = course.path().next().is_some_and(|(_, reverse)| reverse);
        let full_m_s = if course.facing_off_rad(&from.pose) > FACES_AWAY_RAD {
            0.0
        } else if reverse {
            -reverse_m_s
        } else {
            speed_m_s
        };
        let roll_out = |plan: Plan| {
            let plan = Plan {
                speed_m_s: plan.speed_m_s.clamp(full_m_s.min(0.0), full_m_s.max(0.0)),
                early_rad_s: plan.early_rad_s.clamp(-turn_rate_rad_s, turn_rate_rad_s),
                late_rad_s: plan.late_rad_s.clamp(-turn_rate_rad_s, turn_rate_rad_s),
            };
            Candidate { plan, rolled: self.roll_out(course, from, Law::Plan(&plan)) }
        };
        let mut best = roll_out(self.last);
        let try_plan = |best: &mut Candidate, plan: Plan| {
            let candidate = roll_out(plan);
            if candidate.rolled.cost < best.rolled.cost {
                *best = candidate;
            }
        };
        for turn in [0.0, 0.25, -0.25, 0.8, -0.8] {
            try_plan(&mut best, Plan { speed_m_s: full_m_s, early_rad_s: turn, late_rad_s: turn });
        }
        for turn in [0.8, -0.8, 0.0] {
            try_plan(&mut best, Plan { speed_m_s: 0.0, early_rad_s: turn, late_rad_s: turn });
        }
        let mut reach = 1.0;
        for _ in 0..ROUNDS {
            for sign in [1.0, -1.0] {
                let by = sign * reach;
                let plan = best.plan;
                try_plan(&mut best, Plan { early_rad_s: plan.early_rad_s + 0.3 * by, ..plan });
                let plan = best.plan;
                try_plan(&mut best, Plan { late_rad_s: plan.late_rad_s + 0.4 * by, ..plan });
                let plan = best.plan;
                try_plan(&mut best, Plan { speed_m_s: plan.speed_m_s + 0.3 * by, ..plan });
            }
            reach *= 0.5;
        }
        // What no such trajectory can do, as to turn first and then to drive, following the path can.
        let following = self.roll_out(course, from, Law::Follow);
        let stands = course.cost_to_go_m(&from.pose) - best.rolled.to_go_m < LEAST_PROGRESS_M;
        let chosen = if !best.rolled.cost.is_finite() || (stands && following.cost.is_finite()) {
            // The robot stands beside what was found safe, or where no short trajectory pays: the path leads
            // off.
            self.reset();
            following
        } else {
            self.last = best.plan;
            if following.cost < best.rolled.cost { following } else { best.rolled }
        };
        (chosen.moves || !is_still(&from.command)).then_some(chosen.first)
    }

    /// Speed and turn rate towards a point.
    fn towards(&self, pose: &PlanPose, point_m: DVec2, reverse: bool) -> (f64, f64) {
        let (speed_m_s, reverse_m_s) =
            (self.limits.controller.max_speed_m_s, self.limits.controller.reverse_m_s());
        let turn_rate_rad_s = self.limits.controller.max_turn_rate_rad_s;
        let path_m = point_m - pose.position_m;
        let path_m = if reverse { -path_m } else { path_m };
        let aside_rad = libm::remainder(libm::atan2(path_m.y, path_m.x) - pose.yaw_rad, TAU);
        let turn = (FOLLOW_GAIN * aside_rad).clamp(-turn_rate_rad_s, turn_rate_rad_s);
        if aside_rad.abs() > TURN_FIRST_RAD {
            return (0.0, turn);
        }
        let speed = if reverse { -reverse_m_s } else { speed_m_s };
        (speed * libm::cos(aside_rad), turn)
    }

    fn roll_out(&self, course: &impl Course, from: Start, law: Law<'_>) -> RolledOut {
        let limits = &self.limits;
        let (controller, trajectory) = (&limits.controller, &limits.controller.trajectory);
        let Start { mut pose, command: last, elapsed_s, utilisation } = from;
        let (mut speed, mut turn) = (last.linear_m_s, last.angular_rad_s);
        let mut cost = 0.0;
        let (mut first, mut moves) = (last, false);
        let mut met = course.met(&pose).unwrap_or(Met { risk: 1.0, utilisation: 1.0 });
        met.utilisation = met.utilisation.max(utilisation);
        let mut way = course.path().peekable();
        let mut next = way.next();
        for step in 0..STEPS {
            let time_s = STEP_S * (step + 1) as f64;
            let (wanted_speed, wanted) = match law {
                Law::Plan(plan) => (plan.speed_m_s, plan.turn_rate_rad_s(time_s, last.angular_rad_s)),
                Law::Follow => {
                    while let Some((point_m, _)) = next
                        && way.peek().is_some()
                        && point_m.distance(pose.position_m) < PASSED_M
                    {
                        next = way.next();
                    }
                    let left = next.filter(|(point_m, _)| point_m.distance(pose.position_m) > ARRIVED_M);
                    left.map_or((0.0, 0.0), |(point_m, reverse)| self.towards(&pose, point_m, reverse))
                }
            };
            let change_s = if step == 0 { elapsed_s.min(MOST_ELAPSED_S) } else { STEP_S };
            let most = trajectory.turn_acceleration_rad_s2 * change_s;
            let next_turn = turn + (wanted - turn).clamp(-most, most);
            let most_speed = controller.max_speed_m_s * controller.speed_share(met.utilisation);
            let wanted = wanted_speed.clamp(-most_speed, most_speed);
            let most = trajectory.acceleration_m_s2 * change_s;
            let next_speed = speed + (wanted - speed).clamp(-most, most);
            let bend = (next_turn - turn) / STEP_S;
            let push = (next_speed - speed) / STEP_S;
            cost += STEP_S
                * (trajectory.turn_smoothness * bend * bend + trajectory.speed_smoothness * push * push);
            (speed, turn) = (next_speed, next_turn);
            let command = Command { linear_m_s: speed, angular_rad_s: turn };
            if step == 0 {
                first = command;
            }
            moves |= step < 2 && !is_still(&command);
            pose.advance(&command, STEP_S);
            let price = if speed < 0.0 { limits.reverse_price } else { 1.0 };
            let way_m = speed.abs() * STEP_S;
            // What is turned while driving costs nothing beyond the way, as on the lattice.
            let turned_m = (limits.turn_m_rad * turn.abs() * STEP_S - way_m).max(0.0);
            if step % 2 == 1 {
                match course.met(&pose) {
                    Some(now) => met = now,
                    None => return RolledOut { cost: f64::INFINITY, to_go_m: f64::INFINITY, first, moves },
                }
            }
            cost += price * way_m * (1.0 + limits.tilt_price * met.risk.min(1.0)) + turned_m;
        }
        let to_go_m = course.cost_to_go_m(&pose);
        RolledOut { cost: cost + trajectory.progress_weight * to_go_m, to_go_m, first, moves }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FROM: Start = Start {
        pose: PlanPose { position_m: DVec2::ZERO, yaw_rad: 0.0 },
        command: Command::STOP,
        elapsed_s: STEP_S,
        utilisation: 0.0,
    };

    /// Level ground with a target, and a half plane where the robot must not be.
    struct Level {
        target_m: DVec2,
        closed_from_x_m: f64,
    }

    impl Course for Level {
        fn met(&self, pose: &PlanPose) -> Option<Met> {
            (pose.position_m.x < self.closed_from_x_m).then_some(Met { risk: 0.0, utilisation: 0.0 })
        }

        fn cost_to_go_m(&self, pose: &PlanPose) -> f64 {
            pose.position_m.distance(self.target_m) + 0.38 * self.facing_off_rad(pose)
        }

        fn facing_off_rad(&self, pose: &PlanPose) -> f64 {
            let path_m = self.target_m - pose.position_m;
            libm::remainder(libm::atan2(path_m.y, path_m.x) - pose.yaw_rad, TAU).abs()
        }

        fn path(&self) -> impl Iterator<Item = (DVec2, bool)> {
            core::iter::once((self.target_m, false))
        }
    }

    /// Drives for some seconds; the poses and commands.
    fn drive(course: &impl Course, seconds: f64) -> Vec<(PlanPose, Command)> {
        drive_with(course, seconds, STEP_S)
    }

    /// With a scan every `elapsed_s`.
    fn drive_with(course: &impl Course, seconds: f64, elapsed_s: f64) -> Vec<(PlanPose, Command)> {
        let mut optimiser = TrajectoryOptimiser::new(Limits::of(&PlannerConfig::default()));
        let mut start = Start { elapsed_s, ..FROM };
        (0..(seconds / elapsed_s) as usize)
            .map(|_| {
                let command = optimiser.drive(course, start).unwrap_or(Command::STOP);
                let mut pose = start.pose;
                pose.advance(&command, elapsed_s);
                start = Start { pose, command, ..start };
                (pose, command)
            })
            .collect()
    }

    #[test]
    fn it_drives_straight_to_what_lies_ahead_at_full_speed() {
        let driven = drive(&Level { target_m: DVec2::new(20.0, 0.0), closed_from_x_m: 100.0 }, 10.0);
        let (pose, command) = driven[99];
        assert!(pose.position_m.x > 7.0 && pose.position_m.y.abs() < 0.05, "{pose:?}");
        assert!((command.linear_m_s - 0.8).abs() < 1e-6 && command.angular_rad_s.abs() < 0.05, "{command:?}");
    }

    #[test]
    fn it_comes_to_a_target_behind_within_its_limits_of_acceleration() {
        let target_m = DVec2::new(-6.0, 2.0);
        for elapsed_s in [0.05, STEP_S] {
            let driven = drive_with(&Level { target_m, closed_from_x_m: 100.0 }, 20.0, elapsed_s);
            let nearest_m =
                driven.iter().map(|(pose, _)| pose.position_m.distance(target_m)).fold(100.0, f64::min);
            assert!(nearest_m < 0.4, "{nearest_m}");
            for pair in driven.windows(2) {
                let (before, after) = (pair[0].1, pair[1].1);
                assert!((after.linear_m_s - before.linear_m_s).abs() <= 0.8 * elapsed_s + 1e-9);
                assert!((after.angular_rad_s - before.angular_rad_s).abs() <= 1.5 * elapsed_s + 1e-9);
            }
        }
    }

    #[test]
    fn it_turns_to_a_path_that_leads_back_and_does_not_back_along_it() {
        let driven = drive(&Level { target_m: DVec2::new(-6.0, 0.0), closed_from_x_m: 100.0 }, 14.0);
        assert!(driven.iter().all(|(_, command)| command.linear_m_s > -1e-9));
        assert!(driven.iter().all(|(pose, _)| pose.position_m.x < 0.05), "no arc away from it");
        assert!(driven.iter().any(|(pose, _)| pose.position_m.distance(DVec2::new(-6.0, 0.0)) < 0.4));
    }

    #[test]
    fn it_stops_before_closed_ground_and_follows_the_path_off_it() {
        let driven = drive(&Level { target_m: DVec2::new(20.0, 0.0), closed_from_x_m: 3.0 }, 15.0);
        assert_eq!(driven.len(), 150);
        assert!(driven.iter().all(|(pose, _)| pose.position_m.x < 3.0));
        let target_m = DVec2::new(-4.0, 0.0);
        let driven = drive(&Level { target_m, closed_from_x_m: -3.0 }, 40.0);
        assert!(driven.iter().any(|(pose, _)| pose.position_m.x < -3.0), "{:?}", driven.last());
    }

    #[test]
    fn it_says_so_where_the_robot_stands_and_nothing_admissible_leads_on() {
        // Less than what counts as progress lies before the closed ground, and the path leads into it.
        let course = Level { target_m: DVec2::new(20.0, 0.0), closed_from_x_m: 0.04 };
        let mut optimiser = TrajectoryOptimiser::new(Limits::of(&PlannerConfig::default()));
        assert_eq!(optimiser.drive(&course, FROM), None);
        // A robot that still moves is braked first.
        let command = Command { linear_m_s: 0.05, angular_rad_s: 0.0 };
        let braked = optimiser.drive(&course, Start { command, ..FROM });
        assert!(braked.is_some_and(|braked| braked.linear_m_s < 0.05), "{braked:?}");
        // With ground to drive on, it goes.
        let course = Level { closed_from_x_m: 10.0, ..course };
        assert!(optimiser.drive(&course, FROM).is_some_and(|command| command.linear_m_s > 0.0));
        let at_once = optimiser.drive(&course, Start { elapsed_s: 0.0, ..FROM });
        assert_eq!(at_once, Some(Command::STOP), "a step that leaves no time to accelerate");
    }

    /// Ground at its limit, where a metre in reverse costs more than it gains, and a short way back.
    struct SteepWayBack;

    const BACK_M: DVec2 = DVec2::new(-0.25, 0.0);

    impl Course for SteepWayBack {
        fn met(&self, _: &PlanPose) -> Option<Met> {
            Some(Met { risk: 1.0, utilisation: 0.5 })
        }

        fn cost_to_go_m(&self, pose: &PlanPose) -> f64 {
            pose.position_m.distance(BACK_M)
        }

        fn facing_off_rad(&self, _: &PlanPose) -> f64 {
            0.0
        }

        fn path(&self) -> impl Iterator<Item = (DVec2, bool)> {
            core::iter::once((BACK_M, true))
        }
    }

    /// Ground at its limit, where the path ends under the robot.
    struct PathEnds;

    impl Course for PathEnds {
        fn met(&self, _: &PlanPose) -> Option<Met> {
            Some(Met { risk: 1.0, utilisation: 0.5 })
        }

        fn cost_to_go_m(&self, _: &PlanPose) -> f64 {
            1.0
        }

        fn facing_off_rad(&self, _: &PlanPose) -> f64 {
            0.0
        }

        fn path(&self) -> impl Iterator<Item = (DVec2, bool)> {
            core::iter::once((DVec2::ZERO, false))
        }
    }

    #[test]
    fn it_says_so_where_the_robot_stands_and_the_path_ends() {
        let mut optimiser = TrajectoryOptimiser::new(Limits::of(&PlannerConfig::default()));
        assert_eq!(optimiser.drive(&PathEnds, FROM), None);
    }

    #[test]
    fn a_leg_too_short_to_be_passed_is_driven_to_its_end() {
        let driven = drive(&SteepWayBack, 5.0);
        let away_m = driven.last().map(|(pose, _)| pose.position_m.distance(BACK_M));
        assert!(away_m.is_some_and(|away_m| away_m < 0.15), "{away_m:?}");
    }
}
