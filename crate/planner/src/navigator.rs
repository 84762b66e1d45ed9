//! What can drive the robot: the one interface that this planner and those it is compared with share.

use glam::{DVec2, Vec3};

use crate::control::controller::Command;
use crate::decision::step::Status;
use crate::planner::Planner;
use crate::pose::Pose;

/// What a navigator decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Whether it drives, looks, has arrived or has stopped, and why.
    pub status: Status,
    /// The velocity command.
    pub command: Command,
}

/// Something that drives a robot to a goal, asked once per period.
///
/// [`Planner`] knows only what it is given here. A navigator that knows more, as a map, gets it when it is made.
pub trait Navigator {
    /// One period: `points_m` are the scan's returns in the sensor frame, `pose` the robot's in the world, `goal_m` the
    /// goal seen from above, in the world.
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal_m: DVec2) -> Decision;

    /// How far it looks: returns farther from the sensor than this change nothing. With 0 it looks at no scan, and gets none.
    fn sight_m(&self) -> f64 {
        f64::INFINITY
    }

    /// Time between two calls, in seconds.
    fn period_s(&self) -> f64;

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
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal_m: DVec2) -> Decision {
        (**self).navigate(points_m, pose, goal_m)
    }

    fn sight_m(&self) -> f64 {
        (**self).sight_m()
    }

    fn period_s(&self) -> f64 {
        (**self).period_s()
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
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, goal_m: DVec2) -> Decision {
        let step = self.step(points_m, pose, goal_m);
        Decision { status: step.status, command: step.command }
    }

    fn sight_m(&self) -> f64 {
        self.config().perception.surface_radius_m.max(self.config().elevation_window.radius_m)
    }

    fn period_s(&self) -> f64 {
        self.config().period_s
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
