//! What a task is driven in.

use clap::ValueEnum;
use mapless_trials::{PoseConfig, RealityConfig, RealityPreset};
use mapless_world::{MotionCompensation, MotionConfig, SensingConfig};

/// What moves the robot, and what goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Simulator {
    /// The physics engine; sensing and pose are exact.
    Mujoco,
    /// The physics engine; sensing, pose and the dead time of commands as in the preset `field`.
    MujocoField,
    /// The kinematic world without anything that goes wrong.
    Ideal,
    /// The kinematic world with the preset `field`.
    Field,
}

impl Simulator {
    /// Whether the physics engine moves the robot.
    pub(crate) fn is_physical(self) -> bool {
        matches!(self, Self::Mujoco | Self::MujocoField)
    }

    /// What goes wrong beside what the physics engine does. Slip, lag, load and friction are its own.
    pub(crate) fn reality(self) -> RealityConfig {
        let field = RealityPreset::Field.config();
        match self {
            Self::Mujoco | Self::Ideal => RealityConfig::default(),
            Self::MujocoField => {
                let motion = MotionConfig { latency_s: field.motion.latency_s, ..MotionConfig::default() };
                RealityConfig { motion, ..field }
            }
            Self::Field => field,
        }
    }
}

/// What goes wrong where the node itself drives: sensing and dead time of commands as in
/// [`Simulator::MujocoField`]. The node corrects sweeps for motion, and believes a pose of its own.
pub(crate) fn reality_of_the_node() -> RealityConfig {
    let RealityConfig { sensing, motion, preset, .. } = Simulator::MujocoField.reality();
    let sensing = SensingConfig { motion_compensation: MotionCompensation::None, ..sensing };
    RealityConfig { preset, sensing, pose: PoseConfig::default(), motion }
}

/// The coefficient of friction in the physics engine: that of the preset `field`.
pub(crate) fn friction() -> f64 {
    RealityPreset::Field.config().motion.friction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_physics_engine_gets_no_slip_that_it_has_itself() {
        let (physics, field) = (Simulator::MujocoField.reality(), Simulator::Field.reality());
        assert_eq!((&physics.sensing, &physics.pose), (&field.sensing, &field.pose));
        assert_eq!(physics.motion.latency_s.to_bits(), field.motion.latency_s.to_bits());
        assert_eq!(MotionConfig { latency_s: 0.0, ..physics.motion }, MotionConfig::default());
        assert_eq!(Simulator::Mujoco.reality(), RealityConfig::default());
        assert_eq!(friction().to_bits(), field.motion.friction.to_bits());
    }
}
