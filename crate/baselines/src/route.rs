//! Route planners, and the navigator that drives along their routes.

use core::time::Duration;

use glam::{DVec2, Vec3};
use mapless::{Command, Goal, PlannerConfig, Pose, StopReason};
use mapless_trials::{Activity, Decision, Navigator, NavigatorStop};

use crate::follower::PathFollower;

/// Finds a whole route on a map.
pub trait RoutePlanner {
    /// A path from a pose to a place, seen from above, in metres; `None` if the map has none.
    fn route(&self, from: &Pose, to_m: DVec2) -> Option<Vec<DVec2>>;
}

/// The straight line to the goal, whatever the ground.
#[derive(Clone, Copy, Debug)]
pub struct Straight;

impl RoutePlanner for Straight {
    fn route(&self, from: &Pose, to_m: DVec2) -> Option<Vec<DVec2>> {
        Some(vec![from.plan_m(), to_m])
    }
}

/// Drives along a planned route with the paper's PID controller. It plans for each new goal, and on the first
/// step after a reset; it does not use the scans.
#[derive(Clone, Debug)]
pub struct RouteNavigator<R> {
    planner: R,
    follower: PathFollower,
    max_speed_m_s: f64,
    goal_tolerance_m: f64,
    goal_m: Option<DVec2>,
}

impl<R: RoutePlanner> RouteNavigator<R> {
    /// Takes tolerance and controller from `config`, which must be valid.
    #[must_use]
    pub fn new(planner: R, config: &PlannerConfig) -> Self {
        Self {
            planner,
            follower: PathFollower::new(config.controller),
            max_speed_m_s: config.controller.max_speed_m_s,
            goal_tolerance_m: config.goal_tolerance_m,
            goal_m: None,
        }
    }

    /// The current route, seen from above, in metres; empty if there is none.
    #[must_use]
    pub fn route_m(&self) -> &[DVec2] {
        self.follower.path_m()
    }

    fn activity(&mut self, pose: &Pose, goal: &Goal) -> Activity {
        let goal_m = goal.position_m;
        if !(pose.is_finite() && goal.is_valid()) {
            return Activity::Stopped(StopReason::InvalidInput.into());
        }
        let here_m = pose.plan_m();
        if here_m.distance(goal_m) <= goal.tolerance_m.unwrap_or(self.goal_tolerance_m) {
            return Activity::Arrived;
        }
        if self.goal_m != Some(goal_m) {
            self.goal_m = Some(goal_m);
            self.follower.set_path(self.planner.route(pose, goal_m).unwrap_or_default());
        }
        if self.route_m().is_empty() { Activity::Stopped(NavigatorStop::NoPath) } else { Activity::Driving }
    }
}

impl<R: RoutePlanner> Navigator for RouteNavigator<R> {
    fn navigate(&mut self, _points_m: &[Vec3], pose: &Pose, goal: &Goal, elapsed: Duration) -> Decision {
        let activity = self.activity(pose, goal);
        let command = match activity {
            Activity::Driving => self.follower.step(pose, goal.position_m, elapsed),
            _ => Command::STOP,
        };
        Decision { activity, command }
    }

    fn sight_m(&self) -> f64 {
        0.0
    }

    fn max_speed_m_s(&self) -> f64 {
        self.max_speed_m_s
    }

    fn reset(&mut self) {
        self.goal_m = None;
        self.follower.set_path([]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    const PERIOD: Duration = Duration::from_millis(100);

    fn pose(x: f64, y: f64) -> Pose {
        Pose::from_roll_pitch_yaw(DVec3::new(x, y, 0.0), 0.0, 0.0, 0.0)
    }

    #[test]
    fn a_new_goal_and_a_reset_plan_anew() {
        let mut navigator = RouteNavigator::new(Straight, &PlannerConfig::default());
        let [first, second] = [DVec2::new(9.0, 0.0), DVec2::new(0.0, 9.0)];
        assert_eq!(
            navigator.navigate(&[], &pose(0.0, 0.0), &Goal::at(first), PERIOD).activity,
            Activity::Driving
        );
        navigator.navigate(&[], &pose(1.0, 0.0), &Goal::at(first), PERIOD);
        assert_eq!(navigator.route_m(), [DVec2::ZERO, first]);
        navigator.navigate(&[], &pose(2.0, 0.0), &Goal::at(second), PERIOD);
        assert_eq!(navigator.route_m(), [DVec2::new(2.0, 0.0), second]);
        navigator.reset();
        navigator.navigate(&[], &pose(3.0, 0.0), &Goal::at(second), PERIOD);
        assert_eq!(navigator.route_m(), [DVec2::new(3.0, 0.0), second]);
    }

    #[test]
    fn it_stops_with_a_reason() {
        let mut navigator = RouteNavigator::new(Straight, &PlannerConfig::default());
        let decision = navigator.navigate(&[], &pose(0.0, 0.0), &Goal::at(DVec2::NAN), PERIOD);
        assert_eq!(decision.activity, Activity::Stopped(StopReason::InvalidInput.into()));
        assert_eq!(decision.command, Command::STOP);
        assert_eq!(
            navigator.navigate(&[], &pose(1.0, 1.0), &Goal::at(DVec2::new(1.2, 1.3)), PERIOD).activity,
            Activity::Arrived
        );
    }
}
