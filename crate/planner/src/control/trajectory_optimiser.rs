//! The optimising controller: the best short trajectory from the present motion, by its price along the way
//! and the cost-to-go at its end.
//!
//! A trajectory is a speed and two turn rates, one early and one at the end of the horizon, with a straight
//! line through time between them. A deterministic pattern search finds the best. Beside it stands the one
//! that follows the path of the cost-to-go from place to place.

use core::f64::consts::TAU;

use glam::DVec2;

use crate::control::controller::Command;

/// Horizon, its steps, and the time of the first turn rate.
const STEP_S: f64 = 0.1;
const STEPS: usize = 20;
const EARLY_S: f64 = 0.6;
const HORIZON_S: f64 = STEP_S * STEPS as f64;
/// A point of a path is passed within this distance; turn rate for each radian to the next one, and the angle
/// beyond which the robot turns on the spot.
const PASSED_M: f64 = 0.3;
const FOLLOW_GAIN: f64 = 2.0;
const TURN_FIRST_RAD: f64 = 0.5;
/// Rounds of the pattern search; each halves its reach.
const ROUNDS: usize = 4;

/// Limits and weights of the trajectories.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    pub(crate) speed_m_s: f64,
    pub(crate) reverse_m_s: f64,
    pub(crate) turn_rate_rad_s: f64,
    pub(crate) acceleration_m_s2: f64,
    pub(crate) turn_acceleration_rad_s2: f64,
    /// Cost of (rad/s²)² for a second, metres.
    pub(crate) smoothness: f64,
    /// Cost of (m/s²)² for a second, metres.
    pub(crate) speed_smoothness: f64,
    /// Cost of a radian, metres.
    pub(crate) turn_m_rad: f64,
    /// Weight of the cost-to-go at the end; more than 1, so that progress pays.
    pub(crate) progress: f64,
    pub(crate) tilt_price: f64,
    pub(crate) reverse_price: f64,
    /// Utilisation from which on the speed is reduced, and the least share that is kept.
    pub(crate) regulate_from: f64,
    pub(crate) least_share: f64,
}

/// A pose in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlanPose {
    pub(crate) position_m: DVec2,
    pub(crate) yaw_rad: f64,
}

/// Where a trajectory begins, and the last command, from which it accelerates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) pose: PlanPose,
    pub(crate) command: Command,
}

/// What a trajectory meets at a pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Met {
    pub(crate) risk: f64,
    pub(crate) utilisation: f64,
}

/// Where trajectories are judged.
pub(crate) trait Course {
    /// What the ground does to the robot at a pose; `None` if it must not be there.
    fn met(&self, pose: &PlanPose) -> Option<Met>;
    /// Cost-to-go from a pose.
    fn cost_to_go_m(&self, pose: &PlanPose) -> Option<f64>;
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

    /// The command that begins the best trajectory from a pose and the last command; `None` if there is none.
    /// Writes the trajectory to `path`.
    pub(crate) fn drive(
        &mut self,
        course: &impl Course,
        from: Start,
        path: &mut Vec<PlanPose>,
    ) -> Option<Command> {
        let Limits { speed_m_s, reverse_m_s, turn_rate_rad_s, .. } = self.limits;
        let cost = |plan: &Plan| self.roll_out(course, from, Law::Plan(plan), None).0;
        let mut best = (self.last, cost(&self.last));
        let try_plan = |best: &mut (Plan, f64), plan: Plan| {
            let plan = Plan {
                speed_m_s: plan.speed_m_s.clamp(-reverse_m_s, speed_m_s),
                early_rad_s: plan.early_rad_s.clamp(-turn_rate_rad_s, turn_rate_rad_s),
                late_rad_s: plan.late_rad_s.clamp(-turn_rate_rad_s, turn_rate_rad_s),
            };
            let cost = cost(&plan);
            if cost < best.1 {
                *best = (plan, cost);
            }
        };
        for speed in [speed_m_s, -reverse_m_s] {
            for turn in [0.0, 0.25, -0.25, 0.8, -0.8] {
                try_plan(&mut best, Plan { speed_m_s: speed, early_rad_s: turn, late_rad_s: turn });
            }
        }
        for turn in [0.8, -0.8, 0.0] {
            try_plan(&mut best, Plan { speed_m_s: 0.0, early_rad_s: turn, late_rad_s: turn });
        }
        let mut reach = 1.0;
        for _ in 0..ROUNDS {
            for sign in [1.0, -1.0] {
                let by = sign * reach;
                let plan = best.0;
                try_plan(&mut best, Plan { early_rad_s: plan.early_rad_s + 0.3 * by, ..plan });
                let plan = best.0;
                try_plan(&mut best, Plan { late_rad_s: plan.late_rad_s + 0.4 * by, ..plan });
                let plan = best.0;
                try_plan(&mut best, Plan { speed_m_s: plan.speed_m_s + 0.3 * by, ..plan });
            }
            reach *= 0.5;
        }
        // What no such trajectory can do, as to turn first and then to drive, following the path can.
        let law = if self.roll_out(course, from, Law::Follow, None).0 < best.1 {
            Law::Follow
        } else {
            Law::Plan(&best.0)
        };
        path.clear();
        let (cost, command) = self.roll_out(course, from, law, Some(path));
        if !cost.is_finite() {
            self.reset();
            return None;
        }
        self.last = best.0;
        Some(command)
    }

    /// Speed and turn rate towards a point.
    fn towards(&self, pose: &PlanPose, point_m: DVec2, reverse: bool) -> (f64, f64) {
        let Limits { speed_m_s, reverse_m_s, turn_rate_rad_s, .. } = self.limits;
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

    /// Cost of a trajectory, and its first command.
    fn roll_out(
        &self,
        course: &impl Course,
        from: Start,
        law: Law<'_>,
        mut path: Option<&mut Vec<PlanPose>>,
    ) -> (f64, Command) {
        let limits = &self.limits;
        let Start { mut pose, command: last } = from;
        let (mut speed, mut turn) = (last.linear_m_s, last.angular_rad_s);
        let mut cost = 0.0;
        let mut first = last;
        let mut met = course.met(&pose).unwrap_or(Met { risk: 1.0, utilisation: 1.0 });
        let mut way = course.path().peekable();
        for step in 0..STEPS {
            let time_s = STEP_S * (step + 1) as f64;
            let (wanted_speed, wanted) = match law {
                Law::Plan(plan) => (plan.speed_m_s, plan.turn_rate_rad_s(time_s, last.angular_rad_s)),
                Law::Follow => {
                    while way.next_if(|(point_m, _)| point_m.distance(pose.position_m) < PASSED_M).is_some() {
                    }
                    way.peek().map_or((0.0, 0.0), |&(point_m, reverse)| self.towards(&pose, point_m, reverse))
                }
            };
            let most = limits.turn_acceleration_rad_s2 * STEP_S;
            let next_turn = turn + (wanted - turn).clamp(-most, most);
            let kept =
                ((1.0 - met.utilisation) / (1.0 - limits.regulate_from)).clamp(limits.least_share, 1.0);
            let most_speed = limits.speed_m_s * kept;
            let wanted = wanted_speed.clamp(-most_speed, most_speed);
            let most = limits.acceleration_m_s2 * STEP_S;
            let next_speed = speed + (wanted - speed).clamp(-most, most);
            let bend = (next_turn - turn) / STEP_S;
            let push = (next_speed - speed) / STEP_S;
            cost += STEP_S * (limits.smoothness * bend * bend + limits.speed_smoothness * push * push);
            (speed, turn) = (next_speed, next_turn);
            if step == 0 {
                first = Command { linear_m_s: speed, angular_rad_s: turn };
            }
            let middle = pose.yaw_rad + 0.5 * turn * STEP_S;
            let (sin, cos) = libm::sincos(middle);
            pose.position_m += DVec2::new(cos, sin) * (speed * STEP_S);
            pose.yaw_rad += turn * STEP_S;
            let price = if speed < 0.0 { limits.reverse_price } else { 1.0 };
            let way_m = speed.abs() * STEP_S;
            // What is turned while driving costs nothing beyond the way, as on the lattice.
            let turned_m = (limits.turn_m_rad * turn.abs() * STEP_S - way_m).max(0.0);
            if step % 2 == 1 {
                match course.met(&pose) {
                    Some(now) => met = now,
                    None => return (f64::INFINITY, first),
                }
            }
            cost += price * way_m * (1.0 + limits.tilt_price * met.risk) + turned_m;
            if let Some(path) = path.as_deref_mut() {
                path.push(pose);
            }
        }
        let left = course.cost_to_go_m(&pose).unwrap_or(f64::INFINITY);
        (cost + limits.progress * left, first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        speed_m_s: 0.8,
        reverse_m_s: 0.4,
        turn_rate_rad_s: 1.0,
        acceleration_m_s2: 0.8,
        turn_acceleration_rad_s2: 1.5,
        smoothness: 0.45,
        speed_smoothness: 0.15,
        turn_m_rad: 0.38,
        progress: 3.0,
        tilt_price: 4.0,
        reverse_price: 2.0,
        regulate_from: 0.3,
        least_share: 0.2,
    };
    const FROM: Start =
        Start { pose: PlanPose { position_m: DVec2::ZERO, yaw_rad: 0.0 }, command: Command::STOP };

    /// Level ground with a target, and a half plane where the robot must not be.
    struct Level {
        target_m: DVec2,
        closed_from_x_m: f64,
    }

    impl Course for Level {
        fn met(&self, pose: &PlanPose) -> Option<Met> {
            (pose.position_m.x < self.closed_from_x_m).then_some(Met { risk: 0.0, utilisation: 0.0 })
        }

        fn cost_to_go_m(&self, pose: &PlanPose) -> Option<f64> {
            let path_m = self.target_m - pose.position_m;
            let bearing_rad = libm::atan2(path_m.y, path_m.x) - pose.yaw_rad;
            let turn_rad = libm::remainder(bearing_rad, core::f64::consts::TAU).abs();
            Some(path_m.length() + LIMITS.turn_m_rad * turn_rad)
        }

        fn path(&self) -> impl Iterator<Item = (DVec2, bool)> {
            core::iter::once((self.target_m, false))
        }
    }

    /// Drives for some seconds; the poses and commands.
    fn drive(course: &Level, seconds: f64) -> Vec<(PlanPose, Command)> {
        let mut optimiser = TrajectoryOptimiser::new(LIMITS);
        let (mut start, mut path) = (FROM, Vec::new());
        (0..(seconds / STEP_S) as usize)
            .map_while(|_| {
                let command = optimiser.drive(course, start, &mut path)?;
                start = Start { pose: path[0], command };
                Some((start.pose, command))
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
        let driven = drive(&Level { target_m, closed_from_x_m: 100.0 }, 20.0);
        let nearest_m =
            driven.iter().map(|(pose, _)| pose.position_m.distance(target_m)).fold(100.0, f64::min);
        assert!(nearest_m < 0.4, "{nearest_m}");
        for pair in driven.windows(2) {
            let (before, after) = (pair[0].1, pair[1].1);
            assert!((after.linear_m_s - before.linear_m_s).abs() <= LIMITS.acceleration_m_s2 * STEP_S + 1e-9);
            assert!(
                (after.angular_rad_s - before.angular_rad_s).abs()
                    <= LIMITS.turn_acceleration_rad_s2 * STEP_S + 1e-9
            );
        }
    }

    #[test]
    fn it_stops_before_closed_ground_and_has_no_command_on_it() {
        let driven = drive(&Level { target_m: DVec2::new(20.0, 0.0), closed_from_x_m: 3.0 }, 15.0);
        assert_eq!(driven.len(), 150);
        assert!(driven.iter().all(|(pose, _)| pose.position_m.x < 3.0));
        let mut path = Vec::new();
        let closed = Level { target_m: DVec2::new(20.0, 0.0), closed_from_x_m: -5.0 };
        assert_eq!(TrajectoryOptimiser::new(LIMITS).drive(&closed, FROM, &mut path), None);
    }
}
