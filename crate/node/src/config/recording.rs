//! Where drives are recorded, and which topics.

use std::path::PathBuf;

use mapless_parameters::ConfigError;
use mapless_recording::{Role, TopicNames};
use serde::Deserialize;

use super::NodeConfig;

/// Where drives are recorded, one file for each run of the node.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordingConfig {
    /// The folder; it is made if it is missing.
    pub folder: PathBuf,
    /// A recording ends at this size, in units of 2²⁰ bytes. A VLP-16 makes about 400 a minute.
    #[serde(default = "max_size_mb")]
    pub max_size_mb: u64,
}

/// About ten minutes of a VLP-16.
fn max_size_mb() -> u64 {
    4096
}

impl RecordingConfig {
    pub(super) fn validate(&self) -> Result<(), ConfigError> {
        let (place, folder) = ("recording", self.folder.display());
        ConfigError::require(self.folder.is_absolute(), place, "folder", folder, "an absolute path")?;
        let size = self.max_size_mb;
        ConfigError::require((1..=1 << 24).contains(&size), place, "max_size_mb", size, "1 to 16777216")
    }
}

impl NodeConfig {
    /// The absolute names of the topics that are recorded.
    #[must_use]
    pub fn recorded_topics(&self) -> TopicNames {
        let topics = &self.topics;
        let names = [
            (Role::Scan, &topics.scan),
            (Role::Odometry, &topics.odometry),
            (Role::Imu, &topics.imu),
            (Role::EmergencyStop, &topics.emergency_stop),
            (Role::Reset, &topics.reset),
            (Role::GoalPose, &topics.goal_pose),
            (Role::Clock, &topics.clock),
        ];
        let namespace = self.namespace.trim_end_matches('/');
        let absolute =
            |name: &str| if name.starts_with('/') { name.to_owned() } else { format!("{namespace}/{name}") };
        names.into_iter().map(|(role, name)| (role, absolute(name))).collect()
    }
}
