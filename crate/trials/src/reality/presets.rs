//! The values of the presets. `docs/design/reality.md` gives the source of each.

use std::f64::consts::PI;

use mapless_world::{MotionCompensation, MotionConfig, SensingConfig};

use super::config::{RealityConfig, RealityPreset};
use super::pose_config::PoseConfig;

const DEGREE: f64 = PI / 180.0;

impl RealityConfig {
    /// The preset whose values these are; `None` where they differ from those of every preset.
    #[must_use]
    pub fn matching_preset(&self) -> Option<RealityPreset> {
        let is_it = |preset: &RealityPreset| Self { preset: *preset, ..self.clone() } == preset.config();
        RealityPreset::ALL.iter().copied().find(is_it)
    }
}

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
            // A revolution of a VLP-16 at 10 Hz takes 0.1 s (its manual).
            sweep: true,
            motion_compensation: MotionCompensation::Odometry,
            // 50 m on pavement of 10 % (HDL-64E manual): a 25th of the power at 10 m.
            weakest_return: 0.04,
            // Assumed: some dust; a quarter of the least share that `strays` tries.
            stray_probability: 0.0005,
            // Assumed: an antenna and a cable.
            self_returns: 5,
            // As the static error of an inertial sensor (Xsens MTi manual), with which a mount is levelled.
            // In pitch it adds to the bias of the pose, in roll they cancel: what comes of both is their root
            // mean square.
            mount_roll_rad: 0.5 * DEGREE,
            mount_pitch_rad: -0.5 * DEGREE,
            // Assumed: a tape measure.
            mount_height_m: 0.01,
            // Assumed: one in 100 s.
            lost_scan_probability: 0.001,
            ..SensingConfig::default()
        },
        pose: PoseConfig {
            // 0.42 m over 40.5 m, skid-steered (Pentzer et al. 2014).
            scale_drift: 0.01,
            // Assumed: 3° after 100 m.
            heading_drift_rad: 0.005,
            // Assumed: as a centimetre GPS or a scan matcher.
            position_noise_m: 0.01,
            // As tried in the physics engine; 0.5° is also the static error of an Xsens MTi.
            angle_noise_rad: 0.3 * DEGREE,
            roll_bias_rad: 0.5 * DEGREE,
            pitch_bias_rad: 0.5 * DEGREE,
            // Odometry of an A200 comes every 32 to 58 ms (clearpath_robot#359).
            latency_s: 0.05,
            ..PoseConfig::default()
        },
        motion: MotionConfig {
            // As tried in the physics engine.
            latency_s: 0.1,
            // Assumed: a wheel speed loop of some hertz.
            lag_s: 0.1,
            // Assumed: firm ground; 4 % at 20°.
            slope_slip: 0.1,
            side_slip: 0.1,
            // Half the diagonal between the wheels, 0.38 m, over the friction; 0.2 m a radian at 27°, as in
            // the physics engine.
            turn_slide_m_rad: 0.42,
            turn_ratio: 1.0,
            // Physics engine: at 0.4 rad/s 1.05 times at 10°, 1.19 at 20°, 1.21 at 25°.
            side_slope_turn: 0.45,
            // Of the physics engine; dry grass and firm soil.
            friction: 0.9,
            // 59.5 kg in the physics engine, of which 50 kg are the robot's.
            payload: 0.2,
            touches_ground: true,
        },
    }
}

fn harsh() -> RealityConfig {
    let field = field();
    RealityConfig {
        preset: RealityPreset::Harsh,
        sensing: SensingConfig {
            motion_compensation: MotionCompensation::None,
            // Assumed: a film of water throws four fifths away.
            wetness: 0.8,
            // The most that `strays` tries.
            stray_probability: 0.02,
            self_returns: 50,
            zeros: true,
            // Assumed: a mast behind the sensor.
            blocked_width_rad: 20.0 * DEGREE,
            mount_roll_rad: DEGREE,
            mount_pitch_rad: -DEGREE,
            mount_height_m: 0.03,
            // Assumed: one every two seconds, as over a radio link.
            lost_scan_probability: 0.05,
            scan_delay_periods: 1,
            ..field.sensing
        },
        pose: PoseConfig {
            wheel_odometry: true,
            // Assumed: three times the typical one.
            scale_drift: 0.03,
            heading_drift_rad: 0.02,
            position_noise_m: 0.03,
            // Half the dynamic error of an Xsens MTi.
            angle_noise_rad: DEGREE,
            roll_bias_rad: DEGREE,
            pitch_bias_rad: DEGREE,
            // Assumed: a GPS without a base station.
            correction_period_s: 10.0,
            correction_error_m: 0.5,
            correction_error_rad: DEGREE,
            latency_s: 0.1,
            ..field.pose
        },
        motion: MotionConfig {
            // Dead time of a Kobuki (kobuki#389); also tried in the physics engine.
            latency_s: 0.2,
            lag_s: 0.2,
            slope_slip: 0.3,
            side_slip: 0.3,
            // 0.38 m over the friction.
            turn_slide_m_rad: 0.95,
            // A Husky turned rightly with 1.525 in place of the multiplier 1.875 (husky#193).
            turn_ratio: 1.2,
            // Wet grass in the physics engine; accident analysts give 0.2 (Noon 1994).
            friction: 0.4,
            // 50 kg of the 75 kg that an A200 may carry.
            payload: 1.0,
            ..field.motion
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preset_is_known_by_its_values_however_they_were_set() {
        for &preset in RealityPreset::ALL {
            assert_eq!(preset.config().matching_preset(), Some(preset));
            let by_hand = RealityConfig { preset: RealityPreset::Ideal, ..preset.config() };
            assert_eq!(by_hand.matching_preset(), Some(preset));
            let mut own = preset.config();
            own.motion.friction = 0.77;
            assert_eq!(own.matching_preset(), None);
        }
    }
}
