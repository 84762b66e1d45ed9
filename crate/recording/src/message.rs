//! The messages of `mapless_msgs` that hold a drive's decisions, laid out as their definitions in
//! `schema.rs` say. Times are nanoseconds since the recording's begin.

use mapless::glam::DVec2;
use mapless::{Command, Goal};
use mapless_robot::navigation::Task;
use mapless_robot::pilot::Answer;
use mapless_robot::supervisor::{Decision, Inputs, Outcome, Proposal};
use serde::{Deserialize, Serialize};

/// `mapless_msgs/Goal`: the goal in service from now on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GoalMessage {
    /// Goals are numbered upwards; 0 for none.
    pub number: u64,
    /// The place in the estimator's frame, metres.
    pub x_m: f64,
    /// See `x_m`.
    pub y_m: f64,
    /// The heading to end with, radians; NaN for any.
    pub heading_rad: f64,
}

/// `mapless_msgs/Tick`: what a tick of the supervisor took besides messages and goals, and its decision.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TickMessage {
    /// Whether a peer took the commands.
    pub has_peer: bool,
    /// Whether a command could not be published since the last tick.
    pub publish_failed: bool,
    /// Others that published on the topic of the commands.
    pub other_publishers: u32,
    /// When the scan arrived whose answer it took; −1 if it took none.
    pub answered_scan_ns: i64,
    /// The command, m/s and rad/s.
    pub linear_m_s: f64,
    /// See `linear_m_s`.
    pub angular_rad_s: f64,
    /// The state.
    pub state: String,
    /// Why the robot was stopped; empty if it was not.
    pub reason: String,
    /// What was wrong at that moment; empty for nothing.
    pub cause: String,
    /// Whether a goal would have been accepted.
    pub takes_goals: bool,
}

/// `mapless_msgs/Answer`: what the planner made of a scan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnswerMessage {
    /// When the scan arrived.
    pub scan_ns: i64,
    /// The number of the goal.
    pub goal: u64,
    /// Whether the ground was forgotten before, since the localisation jumped.
    pub has_jumped: bool,
    /// What it proposed, m/s and rad/s; zero after a stop or a panic.
    pub linear_m_s: f64,
    /// See `linear_m_s`.
    pub angular_rad_s: f64,
    /// How the step ended; empty after a panic.
    pub status: String,
    /// The digest of every bit of the decision.
    pub digest: String,
}

/// `mapless_msgs/Spoilt`: a scan that was spoilt on its way, as by a packet that was lost.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SpoiltMessage {
    /// What is wrong with it.
    pub why: String,
}

/// `mapless_msgs/Config`: a configuration that holds from now on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct ConfigMessage {
    /// With every key.
    pub(crate) json: String,
}

/// `mapless_msgs/Lost`: entries that could not be recorded here.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LostMessage {
    /// How many.
    pub entries: u32,
}

impl GoalMessage {
    /// The message about what is pursued.
    #[must_use]
    pub fn new(task: Option<&Task>) -> Self {
        let (number, place_m) = task.map_or((0, DVec2::ZERO), |task| (task.number, task.goal.position_m));
        let heading_rad = task.and_then(|task| task.goal.heading_rad).unwrap_or(f64::NAN);
        Self { number, x_m: place_m.x, y_m: place_m.y, heading_rad }
    }

    /// What is pursued.
    #[must_use]
    pub fn task(&self) -> Option<Task> {
        let goal = Goal::at(DVec2::new(self.x_m, self.y_m));
        let goal = if self.heading_rad.is_nan() { goal } else { goal.facing(self.heading_rad) };
        (self.number > 0).then_some(Task { number: self.number, goal })
    }
}

impl TickMessage {
    /// The message about a tick.
    #[must_use]
    pub fn new(inputs: &Inputs, proposal: Option<&Proposal>, decision: &Decision) -> Self {
        let word = |reason: Option<_>| reason.map_or_else(String::new, |reason| format!("{reason}"));
        Self {
            has_peer: inputs.has_peer,
            publish_failed: inputs.publish_failed,
            other_publishers: u32::try_from(inputs.other_publishers).unwrap_or(u32::MAX),
            answered_scan_ns: proposal.map_or(-1, |proposal| nanoseconds(proposal.scan_arrived)),
            linear_m_s: decision.command.linear_m_s,
            angular_rad_s: decision.command.angular_rad_s,
            state: format!("{:?}", decision.state),
            reason: word(decision.reason),
            cause: word(decision.cause),
            takes_goals: decision.takes_goals,
        }
    }
}

impl AnswerMessage {
    /// The message about an answer of the planner.
    #[must_use]
    pub fn new(answer: &Answer, has_jumped: bool) -> Self {
        let Command { linear_m_s, angular_rad_s } = match answer.proposal.outcome {
            Outcome::Command(command) => command,
            Outcome::Stopped | Outcome::Panicked => Command::STOP,
        };
        Self {
            scan_ns: nanoseconds(answer.proposal.scan_arrived),
            goal: answer.proposal.goal,
            has_jumped,
            linear_m_s,
            angular_rad_s,
            status: answer.status.map_or_else(String::new, |status| format!("{status:?}")),
            digest: answer.digest.clone(),
        }
    }
}

/// A time as a message holds it.
pub(crate) fn nanoseconds(time: core::time::Duration) -> i64 {
    i64::try_from(time.as_nanos()).unwrap_or(i64::MAX)
}
