//! What is the case at a moment of a replay.

use core::time::Duration;

use mapless::{Planner, PlannerConfig, Pose, Step};
use mapless_robot::navigation::Task;
use mapless_robot::senses::Scan;
use mapless_robot::supervisor::Decision;

use super::Replay;

/// What the robot saw and decided, as far as messages came until now.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// Where the robot is, in the estimator's frame, if that is known.
    pub pose: Option<Pose>,
    /// The goal in service.
    pub task: Option<Task>,
    /// The supervisor's last decision.
    pub decision: Option<Decision>,
    /// The scan in view.
    pub seen: Option<Seen<'a>>,
    /// When the planner last answered, or a scan came that it had no goal for.
    pub looked: Option<Duration>,
    /// What the planner is configured with.
    pub config: &'a PlannerConfig,
}

/// A scan, and what the planner made of it.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// The scan with the pose for it.
    pub scan: &'a Scan,
    /// The planner's step on it, if it was asked.
    pub step: Option<Step<'a>>,
}

impl Replay {
    /// What is the case now. The scan is the one that the planner answered last for its goal, otherwise the
    /// newest.
    pub(crate) fn moment(&self) -> Moment<'_> {
        let number = self.task.map(|task| task.number);
        let answered = self.answered.as_ref().filter(|(_, goal)| Some(*goal) == number);
        let seen = match answered {
            Some((scan, _)) => Some(Seen { scan, step: Some(self.pilot.last_step()) }),
            None => self.newest.as_deref().map(|scan| Seen { scan, step: None }),
        };
        Moment {
            pose: self.poses.map(|[believed, _]| believed),
            task: self.task,
            decision: self.decision,
            seen,
            looked: self.looked,
            config: &self.config.planner,
        }
    }

    /// Asks the planner for what a step by itself does not predict; `None` after a panic.
    pub(crate) fn ask_planner<T>(&mut self, ask: impl FnOnce(&mut Planner) -> T) -> Option<T> {
        self.pilot.ask(ask)
    }

    /// What its scans take, bytes.
    pub(crate) fn scan_bytes(&self) -> usize {
        let scans = self.scans.iter().chain(&self.newest).chain(self.answered.iter().map(|(scan, _)| scan));
        scans.map(|scan| size_of_val(&*scan.points_m)).sum()
    }
}
