//! The values of the presets. `docs/design/reality.md` gives the source of each.

use std::f64::consts::PI;

use mapless_world::{MotionCompensation, MotionConfig, SensingConfig};

use super::config::{RealityConfig, RealityPreset};
use super::pose_config::PoseConfig;

const DEGREE: f64 = PI / 180.0;

impl RealityPreset {
    /// Every value of this preset.
    #[must_use]
    pub fn config(self) -> RealityConfig {
        match self {
            Self::Ideal => RealityConfig::default(),
            Self::Field => field(),
            Self::Harsh => harsh(),
        }
    }
}

fn field() -> RealityConfig {
    RealityConfig {
        preset: RealityPreset::Field,
        sensing: SensingConfig {
            sweep: true,
            motion_compensation: MotionCompensation::Odometry,
            // A dark target of 10 % is seen out to 50 m, which is 1/25 of the power at 10 m.
            weakest_return: 0.04,
            stray_probability: 0.0005,
            self_returns: 5,
            mount_roll_rad: 0.5 * DEGREE,
            mount_pitch_rad: 0.5 * DEGREE,
            mount_height_m: 0.01,
            lost_scan_probability: 0.001,
            ..SensingConfig::default()
        },
        pose: PoseConfig {
            scale_drift: 0.01,
            heading_drift_rad: 0.005,
            position_noise_m: 0.01,
            angle_noise_rad: 0.3 * DEGREE,
            roll_bias_rad: 0.5 * DEGREE,
            pitch_bias_rad: 0.5 * DEGREE,
            latency_s: 0.05,
            ..PoseConfig::default()
        },
        motion: MotionConfig {
            latency_s: 0.1,
            lag_s: 0.1,
            slope_slip: 0.1,
            side_slip: 0.1,
            turn_slide_m_rad: 0.4,
            turn_ratio: 1.0,
            side_slope_turn: 0.75,
            friction: 0.9,
            payload: 0.2,
        },
    }
}

fn harsh() -> RealityConfig {
    let field = field();
    RealityConfig {
        preset: RealityPreset::Harsh,
        sensing: SensingConfig {
            motion_compensation: MotionCompensation::None,
            wetness: 0.8,
            stray_probability: 0.02,
            self_returns: 50,
            zeros: true,
            blocked_width_rad: 20.0 * DEGREE,
            mount_roll_rad: 1.0 * DEGREE,
            mount_pitch_rad: 1.0 * DEGREE,
            mount_height_m: 0.03,
            lost_scan_probability: 0.05,
            scan_delay_periods: 1,
            ..field.sensing
        },
        pose: PoseConfig {
            wheel_odometry: true,
            scale_drift: 0.03,
            heading_drift_rad: 0.02,
            position_noise_m: 0.03,
            angle_noise_rad: 1.0 * DEGREE,
            roll_bias_rad: 1.0 * DEGREE,
            pitch_bias_rad: 1.0 * DEGREE,
            correction_period_s: 10.0,
            correction_error_m: 0.5,
            correction_error_rad: 1.0 * DEGREE,
            latency_s: 0.1,
            ..field.pose
        },
        motion: MotionConfig {
            latency_s: 0.2,
            lag_s: 0.2,
            slope_slip: 0.3,
            side_slip: 0.3,
            turn_slide_m_rad: 0.6,
            turn_ratio: 1.2,
            friction: 0.4,
            payload: 1.0,
            ..field.motion
        },
    }
}
