//! Which goal is pursued, and how it ends. Free of the middleware.

use std::time::Duration;

use mapless::{Goal, Status, StopReason};
use mapless_robot::supervisor::{Decision, State};
use ros2_client::action::GoalId;

use crate::messages::Outcome;

/// Codes of an aborted goal. The first two are Nav2's.
pub mod code {
    /// The supervisor stopped the robot for good; the text names the reason.
    pub const STOPPED: u16 = 9000;
    /// The goal took longer than it may.
    pub const TIMEOUT: u16 = 9003;
    /// Another goal came.
    pub const PREEMPTED: u16 = 9701;
    /// Driving about the goal brings the robot no nearer.
    pub const UNREACHABLE: u16 = 9702;
    /// Turning to the goal's heading would tilt the robot too far.
    pub const HEADING_UNSAFE: u16 = 9703;
    /// The node is ending.
    pub const SHUTDOWN: u16 = 9704;
}

/// A goal as the planner and the supervisor know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Goals are numbered upwards as they are accepted.
    pub number: u64,
    /// Where to, in the odometry's frame.
    pub goal: Goal,
}

/// How a goal ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// The robot is there.
    Succeeded,
    /// Whoever gave it took it back.
    Canceled,
    /// It was given up.
    Aborted(Outcome),
}

/// A goal that ended, and how; goals by topic have no id.
pub type Ended = (Option<GoalId>, End);

#[derive(Clone, Copy, Debug)]
struct Active {
    task: Task,
    id: Option<GoalId>,
    accepted: Duration,
}

/// The goal in service.
#[derive(Debug)]
pub struct Navigation {
    timeout: Duration,
    accepted: u64,
    active: Option<Active>,
}

fn aborted(code: u16, text: impl ToString) -> End {
    End::Aborted(Outcome { code, text: text.to_string() })
}

impl Navigation {
    /// Without a goal. A goal may take `timeout`.
    #[must_use]
    pub fn new(timeout: Duration) -> Self {
        Self { timeout, accepted: 0, active: None }
    }

    /// From now on a goal may take `timeout`, the one in service included.
    pub fn set_timeout(&mut self, timeout: Duration) {
        self.timeout = timeout;
    }

    /// The goal in service.
    #[must_use]
    pub fn task(&self) -> Option<Task> {
        self.active.map(|active| active.task)
    }

    /// The goal in service with its id, if it was given by the action.
    #[must_use]
    pub fn action(&self) -> Option<(Task, GoalId)> {
        self.active.and_then(|active| active.id.map(|id| (active.task, id)))
    }

    /// Whether this goal is in service.
    #[must_use]
    pub fn pursues(&self, id: GoalId) -> bool {
        self.active.is_some_and(|active| active.id == Some(id))
    }

    /// How long the goal in service has been pursued.
    #[must_use]
    pub fn pursued_for(&self, now: Duration) -> Duration {
        self.active.map_or(Duration::ZERO, |active| now.saturating_sub(active.accepted))
    }

    /// Takes a goal in place of the one in service, which is pre-empted.
    pub fn accept(&mut self, goal: Goal, id: Option<GoalId>, now: Duration) -> Option<Ended> {
        let before = self.end(aborted(code::PREEMPTED, "another goal came"));
        self.accepted += 1;
        self.active = Some(Active { task: Task { number: self.accepted, goal }, id, accepted: now });
        before
    }

    /// Ends the goal in service.
    pub fn end(&mut self, how: End) -> Option<Ended> {
        self.active.take().map(|active| (active.id, how))
    }

    /// Ends the goal in service if the robot is there, if planner or supervisor gave it up, or if it took too
    /// long. `status` is what the planner last answered for that very goal.
    pub fn check(&mut self, decision: &Decision, status: Option<Status>, now: Duration) -> Option<Ended> {
        self.active?;
        let how = match (decision.state, status) {
            (State::Aborted | State::Latched, _) => {
                let reason = decision.reason.map_or_else(String::new, |reason| reason.to_string());
                aborted(code::STOPPED, reason)
            }
            (_, Some(Status::Arrived)) => End::Succeeded,
            (_, Some(Status::Stopped(reason @ StopReason::GoalUnreachable))) => {
                aborted(code::UNREACHABLE, reason)
            }
            (_, Some(Status::Stopped(reason @ StopReason::HeadingUnsafe))) => {
                aborted(code::HEADING_UNSAFE, reason)
            }
            _ if self.pursued_for(now) > self.timeout => {
                aborted(code::TIMEOUT, format!("not reached within {} s", self.timeout.as_secs_f64()))
            }
            _ => return None,
        };
        self.end(how)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless::Command;
    use mapless::glam::DVec2;
    use mapless_robot::supervisor::Reason;

    const NOW: Duration = Duration::from_secs(10);

    fn decision(state: State, reason: Option<Reason>) -> Decision {
        Decision { command: Command::STOP, state, reason, cause: None, takes_goals: true }
    }

    fn begun(id: GoalId) -> Navigation {
        let mut navigation = Navigation::new(Duration::from_secs(60));
        assert_eq!(navigation.accept(Goal::at(DVec2::X), Some(id), NOW), None);
        navigation
    }

    fn code_of(ended: Option<Ended>) -> u16 {
        match ended {
            Some((_, End::Aborted(outcome))) => outcome.code,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn another_goal_pre_empts_and_has_a_higher_number() {
        let (first, second) = (GoalId::new_random(), GoalId::new_random());
        let mut navigation = begun(first);
        let number = navigation.task().unwrap().number;
        let ended = navigation.accept(Goal::at(DVec2::Y), Some(second), NOW);
        assert_eq!(ended.as_ref().and_then(|(id, _)| *id), Some(first));
        assert_eq!(code_of(ended), code::PREEMPTED);
        assert!(navigation.task().unwrap().number > number && navigation.pursues(second));
    }

    #[test]
    fn each_end_has_its_code() {
        let driving = decision(State::Driving, None);
        let mut navigation = begun(GoalId::new_random());
        for status in [None, Some(Status::Driving), Some(Status::Stopped(StopReason::NoSubgoal))] {
            assert_eq!(navigation.check(&driving, status, NOW), None);
        }
        let paused = decision(State::Paused, Some(Reason::Suspended));
        assert_eq!(navigation.check(&paused, None, NOW), None, "a pause ends no goal");
        assert_eq!(navigation.check(&driving, Some(Status::Arrived), NOW).unwrap().1, End::Succeeded);
        assert_eq!(navigation.task(), None);

        for (status, code) in [
            (StopReason::GoalUnreachable, code::UNREACHABLE),
            (StopReason::HeadingUnsafe, code::HEADING_UNSAFE),
        ] {
            let mut navigation = begun(GoalId::new_random());
            assert_eq!(code_of(navigation.check(&driving, Some(Status::Stopped(status)), NOW)), code);
        }
        let late = NOW + Duration::from_secs(61);
        assert_eq!(code_of(begun(GoalId::new_random()).check(&driving, None, late)), code::TIMEOUT);
        let latched = decision(State::Latched, Some(Reason::Tilt));
        let ended = begun(GoalId::new_random()).check(&latched, Some(Status::Arrived), NOW);
        assert!(
            matches!(&ended, Some((_, End::Aborted(outcome))) if outcome.text == Reason::Tilt.to_string())
        );
    }
}
