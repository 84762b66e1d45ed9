//! The closed loop: a planner drives a robot over a terrain, rated by the paper's metrics.
//!
//! [`Scenario`] reads the files under `terrains/scenarios/`, [`Trial`] runs one, [`Metrics`] are the six of
//! the paper, and a digest over the whole trajectory shows that two runs had the same bits.

mod digest;
mod history;
mod metrics;
mod navigator;
mod outcome;
pub mod parameters;
mod places;
mod profile_accuracy;
mod progress_checker;
mod reality;
mod scenario;
pub mod statistics;
mod trial;

pub use history::History;
pub use metrics::{Metrics, Ride};
pub use navigator::{Activity, Decision, Navigator, NavigatorStop};
pub use outcome::Outcome;
pub use places::StartPose;
pub use profile_accuracy::{ColumnKind, ProfileAccuracy, profile_accuracy};
pub use progress_checker::{BASE_TIME_LIMIT_S, MOST_STRAIGHT_TIMES};
pub use reality::{PoseConfig, RealityConfig, RealityPreset};
#[cfg(not(target_arch = "wasm32"))]
pub use scenario::LoadedScenario;
pub use scenario::renamed_keys::{current_path, current_value};
pub use scenario::{Preset, Scenario, ScenarioError, ScenarioFault, planner_config_for};
pub use trial::{Moved, Question, Stance, Trial, TrialError};
