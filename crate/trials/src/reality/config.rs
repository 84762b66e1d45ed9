//! The section `[reality]` of a scenario.

use mapless_parameters::{choices, parameters};
use mapless_world::{MotionConfig, SensingConfig};

use super::pose_config::PoseConfig;

choices! {
    /// How hard the world is; sets every value of `[reality]` that the file does not set.
    #[derive(Default)]
    pub enum RealityPreset {
        /// Nothing goes wrong.
        #[default]
        Ideal = "ideal",
        /// Typical values of a robot in the field.
        Field = "field",
        /// A bad day: rain, wet grass and a poor localisation.
        Harsh = "harsh",
    }
}

parameters! {
    /// What the real world does to sensing, knowing and doing; by default nothing.
    pub struct RealityConfig {
        /// How hard the world is. Sets every value here; keys beside it then change single ones.
        preset: RealityPreset = RealityPreset::Ideal;
    }
    tables {
        /// What spoils the scans.
        sensing: SensingConfig;
        /// What is wrong with the believed pose.
        pose: PoseConfig;
        /// What drive and ground do to a commanded motion.
        motion: MotionConfig;
    }
}
