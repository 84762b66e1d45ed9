//! An IMU that knows its attitude, with the errors of an Xsens MTi-30.
//!
//! Source: MTi User Manual (MT0605P), chapter 4, and Xsens on the repeatability of gyros' biases
//! (base.xsens.com, article 203307252). What the sheets do not say is marked as assumed.

use glam::{DMat3, DQuat, DVec3};
use mapless::Pose;
use mapless_node::messages::{Header, Imu, Quaternion, Time, Vector3};
use mapless_world::random;

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// It is told at 100 Hz, so noise has half of that as its bandwidth.
const BANDWIDTH_HZ: f64 = 50.0;
/// ±0.5°/s from one start to the next, taken as two standard deviations.
const GYRO_BIAS_RAD_S: f64 = 0.25 * DEGREE;
/// 18°/h, with an assumed time constant.
const GYRO_DRIFT_RAD_S: f64 = 18.0 / 3600.0 * DEGREE;
const GYRO_DRIFT_S: f64 = 100.0;
/// A second's root.
const GYRO_NOISE_RAD_S_RT_HZ: f64 = 0.03 * DEGREE;
/// Roll and pitch at rest, which stay; and what comes and goes in motion, with an assumed time constant.
const TILT_BIAS_RAD: f64 = 0.2 * DEGREE;
const TILT_ERROR_RAD: f64 = 0.5 * DEGREE;
const TILT_ERROR_S: f64 = 1.0;
const ACCELERATION_BIAS_M_S2: f64 = 0.03;
/// 80 µg a root of a hertz.
const ACCELERATION_NOISE_M_S2_RT_HZ: f64 = 80e-6 * GRAVITY_M_S2;
const GRAVITY_M_S2: f64 = 9.80665;

/// What a random number is for; see [`mapless_world::random`].
#[derive(Clone, Copy)]
enum Purpose {
    GyroBias = 1,
    GyroDrift = 2,
    GyroNoise = 3,
    TiltBias = 4,
    TiltError = 5,
    AccelerationBias = 6,
    AccelerationNoise = 7,
}

/// The sensor on a robot that moves.
#[derive(Clone, Debug)]
pub(crate) struct ImuModel {
    seed: u64,
    measured: u64,
    before: Pose,
    velocity_m_s: DVec3,
    gyro_drift_rad_s: DVec3,
    tilt_error_rad: DVec3,
}

impl ImuModel {
    /// On a robot at rest.
    pub(crate) fn new(seed: u64, rest: Pose) -> Self {
        Self {
            // Scans have the keys of their ticks.
            seed: random::key(seed, u64::MAX - 1),
            measured: 0,
            before: rest,
            velocity_m_s: DVec3::ZERO,
            gyro_drift_rad_s: DVec3::ZERO,
            tilt_error_rad: DVec3::ZERO,
        }
    }

    /// What it measures when the robot has come to `pose` in `dt_s`. The turn is the mean over that time.
    pub(crate) fn measure(&mut self, pose: Pose, dt_s: f64, stamp: Time) -> Imu {
        self.measured += 1;
        let (before, now) = (self.before.world_from_robot(), pose.world_from_robot());
        let turned = DQuat::from_mat3(&(before.transpose() * now));
        let velocity_m_s = (pose.position_m - self.before.position_m) / dt_s;
        let force_m_s2 = (velocity_m_s - self.velocity_m_s) / dt_s + DVec3::Z * GRAVITY_M_S2;
        (self.before, self.velocity_m_s) = (pose, velocity_m_s);

        self.gyro_drift_rad_s =
            self.wandered(self.gyro_drift_rad_s, Purpose::GyroDrift, GYRO_DRIFT_RAD_S, dt_s / GYRO_DRIFT_S);
        self.tilt_error_rad =
            self.wandered(self.tilt_error_rad, Purpose::TiltError, TILT_ERROR_RAD, dt_s / TILT_ERROR_S);
        let noise = |purpose, deviation: f64| self.drawn(purpose, self.measured) * deviation;
        let constant = |purpose, deviation: f64| self.drawn(purpose, 0) * deviation;
        let root_hz = BANDWIDTH_HZ.sqrt();
        let gyro_rad_s = turned.to_scaled_axis() / dt_s
            + constant(Purpose::GyroBias, GYRO_BIAS_RAD_S)
            + self.gyro_drift_rad_s
            + noise(Purpose::GyroNoise, GYRO_NOISE_RAD_S_RT_HZ * root_hz);
        let tilt_rad = constant(Purpose::TiltBias, TILT_BIAS_RAD) + self.tilt_error_rad;
        let acceleration_m_s2 = now.transpose() * force_m_s2
            + constant(Purpose::AccelerationBias, ACCELERATION_BIAS_M_S2)
            + noise(Purpose::AccelerationNoise, ACCELERATION_NOISE_M_S2_RT_HZ * root_hz);
        let felt = Pose::from_roll_pitch_yaw(
            DVec3::ZERO,
            pose.roll_rad + tilt_rad.x,
            pose.pitch_rad + tilt_rad.y,
            pose.yaw_rad,
        );
        Imu {
            header: Header { stamp, frame_id: "imu_0_link".to_owned() },
            orientation: quaternion(&felt.world_from_robot()),
            angular_velocity: vector(gyro_rad_s),
            linear_acceleration: vector(acceleration_m_s2),
            ..Imu::default()
        }
    }

    /// A first-order process of this deviation, a share of its time constant later.
    fn wandered(&self, from: DVec3, purpose: Purpose, deviation: f64, share: f64) -> DVec3 {
        let kept = libm::exp(-share);
        from * kept + self.drawn(purpose, self.measured) * (deviation * (1.0 - kept * kept).sqrt())
    }

    fn drawn(&self, purpose: Purpose, count: u64) -> DVec3 {
        let key = random::key(random::key(self.seed, purpose as u64), count);
        DVec3::from_array([0, 1, 2].map(|axis| random::gaussian(random::key(key, axis))))
    }
}

fn quaternion(rotation: &DMat3) -> Quaternion {
    let DQuat { x, y, z, w } = DQuat::from_mat3(rotation);
    Quaternion { x, y, z, w }
}

fn vector(vector: DVec3) -> Vector3 {
    Vector3 { x: vector.x, y: vector.y, z: vector.z }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.01;

    fn at(pitch_rad: f64, yaw_rad: f64) -> Pose {
        Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, pitch_rad, yaw_rad)
    }

    /// Mean and standard deviation of what a robot at rest is told over so many messages.
    fn at_rest(seed: u64, count: usize, value: fn(&Imu) -> f64) -> (f64, f64) {
        let mut imu = ImuModel::new(seed, at(0.2, 1.0));
        let values: Vec<f64> =
            (0..count).map(|_| value(&imu.measure(at(0.2, 1.0), DT_S, Time::default()))).collect();
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
        (mean, (squares / count as f64).sqrt())
    }

    #[test]
    fn the_errors_are_those_of_the_sheet_and_of_the_seed() {
        let biases: Vec<f64> =
            (0..300).map(|seed| at_rest(seed, 50, |imu| imu.angular_velocity.z).0).collect();
        let deviation = (biases.iter().map(|bias| bias * bias).sum::<f64>() / 300.0).sqrt();
        assert!((deviation / GYRO_BIAS_RAD_S - 1.0).abs() < 0.15, "{deviation}");
        let (_, noise) = at_rest(1, 2000, |imu| imu.angular_velocity.x);
        assert!((noise / (0.03 * DEGREE * BANDWIDTH_HZ.sqrt()) - 1.0).abs() < 0.05, "{noise}");
        let pitch = |imu: &Imu| Pose::from_quaternion(DVec3::ZERO, imu.orientation.to_glam()).pitch_rad;
        let (mean, wander) = at_rest(2, 20_000, pitch);
        assert!((mean - 0.2).abs() < 0.02 && (wander / TILT_ERROR_RAD - 1.0).abs() < 0.25, "{mean} {wander}");
        assert_eq!(at_rest(3, 10, pitch), at_rest(3, 10, pitch));
        assert_ne!(at_rest(3, 10, pitch), at_rest(4, 10, pitch));
        let (up, _) = at_rest(5, 200, |imu| imu.linear_acceleration.z);
        assert!((up - GRAVITY_M_S2 * libm::cos(0.2)).abs() < 0.15, "{up}");
    }

    #[test]
    fn a_turn_on_a_slope_is_felt_about_the_body_s_axes() {
        let mut imu = ImuModel::new(7, at(0.3, 0.0));
        let rested: Vec<Imu> = (0..1000).map(|_| imu.measure(at(0.3, 0.0), DT_S, Time::default())).collect();
        let mean =
            |told: &[Imu], axis: fn(&Imu) -> f64| told.iter().map(axis).sum::<f64>() / told.len() as f64;
        let turned: Vec<Imu> = (1..=1000)
            .map(|step| imu.measure(at(0.3, 0.5 * DT_S * f64::from(step)), DT_S, Time::default()))
            .collect();
        let z = mean(&turned, |imu| imu.angular_velocity.z) - mean(&rested, |imu| imu.angular_velocity.z);
        let x = mean(&turned, |imu| imu.angular_velocity.x) - mean(&rested, |imu| imu.angular_velocity.x);
        // Nose-up, the vertical is tilted to the body's front.
        assert!(
            (z - 0.5 * libm::cos(0.3)).abs() < 2e-3 && (x - 0.5 * libm::sin(0.3)).abs() < 2e-3,
            "{x} {z}"
        );
    }
}
