//! Outcomes of a trial.

/// How a trial ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// At the goal, never beyond a tilt limit.
    Reached,
    /// Roll or pitch beyond its limit.
    TiltLimit,
    /// A minute without progress.
    Stuck,
    /// The navigator stopped with a reason.
    NoSubgoal,
    /// A wheel would have left the terrain.
    LeftTerrain,
    /// Over the time limit.
    Timeout,
}

impl Outcome {
    /// The name used in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::TiltLimit => "tilt_limit",
            Self::Stuck => "stuck",
            Self::NoSubgoal => "no_subgoal",
            Self::LeftTerrain => "left_terrain",
            Self::Timeout => "timeout",
        }
    }
}
