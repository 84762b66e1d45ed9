//! Small sections of the file.

use mapless::RobotModel;
use mapless_parameters::choices;
pub use mapless_robot::drive_config::{Frames, ImuMount, NavigationConfig};

choices! {
    /// A robot whose dimensions are known.
    pub enum RobotPreset {
        /// Clearpath Husky A200.
        Husky = "husky",
        /// Clearpath Jackal J100.
        Jackal = "jackal",
        /// Clearpath Warthog.
        Warthog = "warthog",
    }
}

impl RobotPreset {
    pub(super) fn model(self) -> RobotModel {
        match self {
            Self::Husky => RobotModel::husky(),
            Self::Jackal => RobotModel::jackal(),
            Self::Warthog => RobotModel::warthog(),
        }
    }
}

choices! {
    /// A preset of the planner.
    pub enum PlannerPreset {
        /// The default one.
        Default = "default",
        /// The paper's.
        Paper = "paper",
    }
}
