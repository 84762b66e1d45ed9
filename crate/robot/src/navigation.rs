//! Which goal is pursued, and how it ends. Free of the middleware.

use core::time::Duration;

use mapless::glam::DVec3;
use mapless::{Goal, Pose, Status, StopReason};

use crate::estimator::{finite, unit};
use crate::frames::FrameChange;
use crate::messages::PoseStamped;
use crate::supervisor::{Decision, State};

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
    /// The robot gets nowhere.
    pub const NO_PROGRESS: u16 = 9705;
}

/// A goal as the planner and the supervisor know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Goals are numbered upwards as they are accepted.
    pub number: u64,
    /// Where to, in the odometry's frame.
    pub goal: Goal,
}

/// How a goal ended, whatever a ROS distribution can say of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// 0 for none.
    pub code: u16,
    /// What went wrong, for people; empty for none.
    pub text: String,
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

/// A goal that ended, and how; goals that were not given by the action have no id.
pub type Ended<Id> = (Option<Id>, End);

#[derive(Clone, Copy, Debug)]
struct Active<Id> {
    task: Task,
    id: Option<Id>,
    accepted: Duration,
}

/// The goal in service; `Id` is what the action calls it.
#[derive(Clone, Debug)]
pub struct Navigation<Id> {
    timeout: Duration,
    accepted: u64,
    active: Option<Active<Id>>,
}

fn aborted(code: u16, text: impl ToString) -> End {
    End::Aborted(Outcome { code, text: text.to_string() })
}

impl<Id: Copy + PartialEq> Navigation<Id> {
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
    pub fn action(&self) -> Option<(Task, Id)> {
        self.active.and_then(|active| active.id.map(|id| (active.task, id)))
    }

    /// Whether this goal is in service.
    #[must_use]
    pub fn pursues(&self, id: Id) -> bool {
        self.active.is_some_and(|active| active.id == Some(id))
    }

    /// How long the goal in service has been pursued.
    #[must_use]
    pub fn pursued_for(&self, now: Duration) -> Duration {
        self.active.map_or(Duration::ZERO, |active| now.saturating_sub(active.accepted))
    }

    /// Takes a goal in place of the one in service, which is pre-empted.
    pub fn accept(&mut self, goal: Goal, id: Option<Id>, now: Duration) -> Option<Ended<Id>> {
        let before = self.end(aborted(code::PREEMPTED, "another goal came"));
        self.accepted += 1;
        self.active = Some(Active { task: Task { number: self.accepted, goal }, id, accepted: now });
        before
    }

    /// Ends the goal in service.
    pub fn end(&mut self, how: End) -> Option<Ended<Id>> {
        self.active.take().map(|active| (active.id, how))
    }

    /// Ends the goal in service if the robot is there, if planner or supervisor gave it up, or if it took too
    /// long. `status` is what the planner last answered for that very goal.
    pub fn check(&mut self, decision: &Decision, status: Option<Status>, now: Duration) -> Option<Ended<Id>> {
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
            (_, Some(Status::Stopped(reason @ StopReason::NoProgress))) => aborted(code::NO_PROGRESS, reason),
            _ if self.pursued_for(now) > self.timeout => {
                aborted(code::TIMEOUT, format!("not reached within {} s", self.timeout.as_secs_f64()))
            }
            _ => return None,
        };
        self.end(how)
    }
}

/// The goal of a message, in the estimator's frame. `poses` are the robot's there and in the odometry's
/// frame, `odom`: the two part as odometry drifts, so a goal is taken as it lies to the robot when it is
/// accepted.
///
/// # Errors
/// Why it is refused: another frame, a stopped robot, or numbers that are not finite.
pub fn goal_of(
    message: &PoseStamped,
    odom: &str,
    decision: Option<&Decision>,
    poses: Option<[Pose; 2]>,
    has_final_heading: bool,
) -> Result<Goal, String> {
    let found = &message.header.frame_id;
    if found != odom {
        return Err(format!("a goal in frame {found:?}: expected {odom:?}"));
    }
    let decision = decision.ok_or("the supervisor has not begun")?;
    if !decision.takes_goals {
        let reason = decision.cause.or(decision.reason);
        return Err(reason.map_or_else(|| "the robot is stopped".to_owned(), |reason| reason.to_string()));
    }
    let (place_m, orientation) = (DVec3::from(message.pose.position), message.pose.orientation.to_glam());
    finite("goal.pose.position", place_m).map_err(|error| error.to_string())?;
    let [believed, told] = poses.ok_or("the robot's pose is not known yet")?;
    let change = FrameChange::new(told, believed);
    let goal = Goal::at(change.place_m(place_m.truncate()));
    if !has_final_heading {
        return Ok(goal);
    }
    unit("goal.pose.orientation", orientation).map_err(|error| error.to_string())?;
    Ok(goal.facing(change.heading_rad(Pose::from_quaternion(place_m, orientation).yaw_rad)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::Quaternion;
    use crate::supervisor::Reason;
    use mapless::Command;
    use mapless::glam::DVec2;

    const NOW: Duration = Duration::from_secs(10);

    fn decision(state: State, reason: Option<Reason>) -> Decision {
        Decision { command: Command::STOP, state, reason, cause: None, takes_goals: true }
    }

    fn begun(id: u8) -> Navigation<u8> {
        let mut navigation = Navigation::new(Duration::from_secs(60));
        assert_eq!(navigation.accept(Goal::at(DVec2::X), Some(id), NOW), None);
        navigation
    }

    fn code_of(ended: Option<Ended<u8>>) -> u16 {
        match ended {
            Some((_, End::Aborted(outcome))) => outcome.code,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_goal_needs_a_finite_place_and_a_rotation_only_if_it_is_to_be_faced() {
        let level = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0);
        let driving = decision(State::Driving, None);
        let goal = |x: f64, w: f64, has_final_heading: bool| {
            let mut message = PoseStamped::default();
            message.header.frame_id = "odom".to_owned();
            message.pose.position.x = x;
            message.pose.orientation = Quaternion { x: 0.0, y: 0.0, z: 0.0, w };
            goal_of(&message, "odom", Some(&driving), Some([level; 2]), has_final_heading)
        };
        assert_eq!(goal(3.0, 0.0, false), Ok(Goal::at(DVec2::X * 3.0)));
        assert_eq!(goal(3.0, 1.0, true), Ok(Goal::at(DVec2::X * 3.0).facing(0.0)));
        let refused = "goal.pose.orientation = [0, 0, 0, 0]: expected a quaternion of length 1";
        assert_eq!(goal(3.0, 0.0, true).unwrap_err(), refused);
        assert_eq!(
            goal(f64::NAN, 1.0, false).unwrap_err(),
            "goal.pose.position = [NaN, 0, 0]: expected finite numbers"
        );
    }

    #[test]
    fn another_goal_pre_empts_and_has_a_higher_number() {
        let (first, second) = (7, 8);
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
        let mut navigation = begun(7);
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
            (StopReason::NoProgress, code::NO_PROGRESS),
        ] {
            let mut navigation = begun(7);
            assert_eq!(code_of(navigation.check(&driving, Some(Status::Stopped(status)), NOW)), code);
        }
        let late = NOW + Duration::from_secs(61);
        assert_eq!(code_of(begun(7).check(&driving, None, late)), code::TIMEOUT);
        let latched = decision(State::Latched, Some(Reason::Tilt));
        let ended = begun(7).check(&latched, Some(Status::Arrived), NOW);
        assert!(
            matches!(&ended, Some((_, End::Aborted(outcome))) if outcome.text == Reason::Tilt.to_string())
        );
    }
}
