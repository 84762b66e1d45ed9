//! What can drive the robot of a trial: the one interface that the planner shares with those it is compared with.

use core::time::Duration;

use glam::{DVec2, Vec3};
use mapless::{Command, Goal, Planner, Pose, Status, StopReason};

/// Why a navigator stands still for good.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NavigatorStop {
    /// The planner stopped.
    #[error(transparent)]
    Planner(#[from] StopReason),
    /// A navigator with a map found no path on it.
    #[error("no path to the goal on the map")]
    NoPath,
}

/// What a navigator does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Activity {
    /// Driving to the goal.
    Driving,
    /// The goal is reached.
    Arrived,
    /// Going back along its own trajectory.
    Backtracking,
    /// Turning on the spot to find a way on.
    Searching,
    /// Standing still, for this reason.
    Stopped(NavigatorStop),
}

impl Activity {
    /// The name in files and in the page.
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

/// What a navigator decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// What it does.
    pub activity: Activity,
    /// The velocity command.
    pub command: Command,
}

/// Something that drives a robot to a goal.
///
/// [`Planner`] knows only what it is given here. A navigator that knows more, as a map, gets it when it is made.
pub trait Navigator {
    /// One decision: `points_m` are the scan's returns in the sensor frame, `pose` the robot's in the world, `goal` where it is to go, and
    /// `elapsed` the time since the decision before.
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal: &Goal, elapsed: Duration) -> Decision;

    /// How far it looks: returns farther from the sensor than this change nothing. With 0 it looks at no scan, and gets none.
    fn sight_m(&self) -> f64 {
        f64::INFINITY
    }

    /// The fastest it drives.
    fn max_speed_m_s(&self) -> f64;

    /// Forgets everything seen and driven.
    fn reset(&mut self);

    /// The subgoal it last chose, seen from above, in the world; `None` when there is none.
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

    fn subgoal_m(&self) -> Option<DVec2> {
        let step = self.last_step();
        step.chosen.and_then(|index| step.subgoals.get(index)).map(|subgoal| subgoal.position_m.truncate())
    }
}
