//! Outcomes of a trial.

use mapless_world::ContactKind;

/// How a trial ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// At the goal, never beyond a tilt limit.
    Reached,
    /// Roll or pitch beyond its limit.
    TiltLimit,
    /// The body ran into an object.
    Collision,
    /// The belly or a bumper on the ground or on a low object.
    HighCentred,
    /// A wheel against more than it climbs.
    Step,
    /// A minute without progress.
    Stuck,
    /// The navigator stopped with a reason.
    NoSubgoal,
    /// A wheel would have left the terrain.
    LeftTerrain,
    /// Over the time limit.
    Timeout,
}

impl From<ContactKind> for Outcome {
    fn from(kind: ContactKind) -> Self {
        match kind {
            ContactKind::Collision => Self::Collision,
            ContactKind::HighCentred => Self::HighCentred,
            ContactKind::Step => Self::Step,
        }
    }
}

impl Outcome {
    /// The name used in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::TiltLimit => "tilt_limit",
            Self::Collision => "collision",
            Self::HighCentred => "high_centred",
            Self::Step => "step",
            Self::Stuck => "stuck",
            Self::NoSubgoal => "no_subgoal",
            Self::LeftTerrain => "left_terrain",
            Self::Timeout => "timeout",
        }
    }
}
