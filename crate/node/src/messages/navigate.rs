//! `nav2_msgs/action/NavigateToPose`, whose result has another layout in each distribution.

use mapless_robot::navigation::Outcome;
use ros2_client::Message;
use serde::{Deserialize, Serialize};

use super::{Duration, PoseStamped};

/// The goal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NavigateGoal {
    /// Where to drive; its heading is the heading to end with.
    pub pose: PoseStamped,
    /// A file of Nav2's behaviour tree; ignored.
    pub behavior_tree: String,
}
impl Message for NavigateGoal {}

/// The feedback, of Humble, Iron, Jazzy and Kilted.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Feedback {
    /// Where the robot is.
    pub current_pose: PoseStamped,
    /// Since the goal was accepted.
    pub navigation_time: Duration,
    /// As the crow flies, at the largest speed that is allowed.
    pub estimated_time_remaining: Duration,
    /// Times it began to drive back or to search since the goal was accepted.
    pub number_of_recoveries: i16,
    /// As the crow flies, metres.
    pub distance_remaining: f32,
}
impl Message for Feedback {}

/// The result in Humble: `std_msgs/Empty`, which CDR gives one byte.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct HumbleResult {
    structure_needs_at_least_one_member: u8,
}
impl Message for HumbleResult {}

/// The result in Jazzy and Kilted.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct JazzyResult {
    /// 0 for none.
    pub error_code: u16,
    /// What went wrong, for people.
    pub error_msg: String,
}
impl Message for JazzyResult {}

/// The result in the distribution that this is built for.
#[cfg(not(feature = "humble"))]
pub type NavigateResult = JazzyResult;
/// The result in the distribution that this is built for.
#[cfg(feature = "humble")]
pub type NavigateResult = HumbleResult;

impl From<Outcome> for HumbleResult {
    fn from(_: Outcome) -> Self {
        Self::default()
    }
}

impl From<Outcome> for JazzyResult {
    fn from(outcome: Outcome) -> Self {
        Self { error_code: outcome.code, error_msg: outcome.text }
    }
}
