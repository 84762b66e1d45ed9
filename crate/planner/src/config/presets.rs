//! The paper's preset. The defaults stand with their parameters.

use super::{InducingInputs, PlannerConfig};
use crate::gp::kernel::RationalQuadratic;
use crate::gp::learning::{LearningConfig, LearningMode};

impl PlannerConfig {
    /// The paper read literally: isotropic kernel, V_th = 0.7, subgoals at r_oc, three normalised cost terms.
    ///
    /// What the text leaves open (length-scale, noise, δ, slope range, gains) is written up in DESIGN.md.
    pub fn paper() -> Self {
        let mut config = Self::default().with_paper_values();
        // What the text leaves open.
        let perception = &mut config.perception;
        perception.kernel =
            RationalQuadratic { variance: 1.0, length_scales_rad: [0.035, 0.035], alpha: 10.0 };
        perception.noise_variance_m2 = 0.01;
        perception.inducing_inputs = InducingInputs::FarthestPoints;
        perception.inducing_spacing_length_scales = 0.85;
        // The paper learns on every scan. That takes seconds a scan, so it is done only where it is asked for.
        perception.learning = LearningConfig { mode: LearningMode::Fixed, ..LearningConfig::paper() };
        config
    }
}
