//! Goals that are given by the action of `ros2-client`.

use ros2_client::action::GoalId;

pub use mapless_robot::navigation::{End, Task, code};

/// The goal in service.
pub(crate) type Navigation = mapless_robot::navigation::Navigation<GoalId>;
/// A goal that ended, and how.
pub(crate) type Ended = mapless_robot::navigation::Ended<GoalId>;
