//! The interface of everything that drives the robot of a trial: the mapless planner and the baselines.

use core::time::Duration;

use glam::{DVec2, Vec3};
use mapless::{Command, Goal, Planner, Pose, Status, StopReason};

/// Why a navigator stopped for good.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NavigatorStop {
    /// The planner stopped.
    #[error(transparent)]
    Planner(#[from] StopReason),
    /// A navigator with a map found no path on it.
    #[error("no path to the goal on the map")]
    NoPath,
}

/// What a navigator is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Activity {
    /// Driving to the goal.
    Driving,
    /// The goal is reached.
    Arrived,
    /// Backtracking along its own trajectory.
    Backtracking,
    /// Turning on the spot to find a candidate (spin recovery).
    Searching,
    /// Stopped for this reason.
    Stopped(NavigatorStop),
}

impl Activity {
    /// The name in files and on the page.
    pub fn name(self) -> &'static str {
        match self {
            Self::Driving => "driving",
            Self::Arrived => "arrived",
            Self::Backtracking => "backtracking",
            Self::Searching => "searching",
            Self::Stopped(_) => "stopped",
        }
    }
}

impl From<Status> for Activity {
    fn from(status: Status) -> Self {
        match status {
            Status::Driving => Self::Driving,
            Status::Arrived => Self::Arrived,
            Status::Backtracking => Self::Backtracking,
            Status::Searching => Self::Searching,
            Status::Stopped(reason) => Self::Stopped(reason.into()),
        }
    }
}

/// The result of a navigator's step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// What the navigator is doing.
    pub activity: Activity,
    /// The velocity command.
    pub command: Command,
}

/// Drives a robot to a goal.
///
/// [`Planner`] knows nothing but the arguments of [`navigate`](Self::navigate). A navigator with a map gets
/// it on construction.
pub trait Navigator {
    /// One decision. `points_m` are the scan's returns in the sensor frame, `pose` is the robot's pose in the
    /// world, `goal` its goal, and `elapsed` the time since the last decision.
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal: &Goal, elapsed: Duration) -> Decision;

    /// Range of the returns that the navigator uses: farther ones change nothing. A navigator with range 0
    /// gets no scans.
    fn sight_m(&self) -> f64 {
        f64::INFINITY
    }

    /// Its maximum speed.
    fn max_speed_m_s(&self) -> f64;

    /// Forgets everything that was sensed and driven.
    fn reset(&mut self);

    /// The localisation was corrected: what it gave as `before` it now gives as `after`.
    fn relocalise(&mut self, _before: &Pose, _after: &Pose) {}

    /// The last chosen subgoal, seen from above, in the world; `None` if there is none.
    fn subgoal_m(&self) -> Option<DVec2> {
        None
    }
}

impl<N: Navigator + ?Sized> Navigator for Box<N> {
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal: &Goal, elapsed: Duration) -> Decision {
        (**self).navigate(points_m, pose, goal, elapsed)
    }

    fn sight_m(&self) -> f64 {
        (**self).sight_m()
    }

    fn max_speed_m_s(&self) -> f64 {
        (**self).max_speed_m_s()
    }

    fn reset(&mut self) {
        (**self).reset();
    }

    fn relocalise(&mut self, before: &Pose, after: &Pose) {
        (**self).relocalise(before, after);
    }

    fn subgoal_m(&self) -> Option<DVec2> {
        (**self).subgoal_m()
    }
}

impl Navigator for Planner {
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal: &Goal, elapsed: Duration) -> Decision {
        self.set_goal(*goal);
        let step = self.step(points_m, pose, elapsed);
        Decision { activity: step.status.into(), command: step.command }
    }

    fn sight_m(&self) -> f64 {
        Planner::sight_m(self)
    }

    fn max_speed_m_s(&self) -> f64 {
        self.config().controller.max_speed_m_s
    }

    fn reset(&mut self) {
        Planner::reset(self);
    }

    fn relocalise(&mut self, before: &Pose, after: &Pose) {
        Planner::relocalise(self, before, after);
    }

    fn subgoal_m(&self) -> Option<DVec2> {
        let step = self.last_step();
        step.chosen.and_then(|index| step.subgoals.get(index)).map(|subgoal| subgoal.position_m.truncate())
    }
}
