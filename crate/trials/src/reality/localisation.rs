//! What the robot believes of its pose: an odometry that drifts, and corrections of it.
//!
//! As in ROS, the odometry is smooth and never corrected; a correction changes the frame of the map that it
//! is read in.

use glam::{DVec2, DVec3};
use mapless::Pose;
use mapless_world::random;

use super::pose_config::PoseConfig;

/// What a random number is for; see [`mapless_world::random`]. Scans use the keys of their beams.
#[derive(Clone, Copy)]
enum Purpose {
    Scale = 1,
    Heading = 2,
    Noise = 3,
    Correction = 4,
}

/// The localisation of a robot.
#[derive(Clone, Debug)]
pub(crate) struct Localisation {
    config: PoseConfig,
    is_ideal: bool,
    seed: u64,
    /// Believed over true length of a metre.
    scale: f64,
    odometry: Pose,
    /// From the odometry's frame to the map's: a turn about z, then a shift.
    turn_rad: f64,
    shift_m: DVec3,
    steps: u64,
}

impl Localisation {
    /// Of a robot that knows where it begins.
    pub(crate) fn new(config: PoseConfig, seed: u64, truth: Pose) -> Self {
        let is_ideal = config == PoseConfig::default();
        let seed = random::key(seed, u64::MAX);
        let scale = 1.0 + config.scale_drift * random::gaussian(random::key(seed, Purpose::Scale as u64));
        let odometry = biased(&config, truth);
        Self { config, is_ideal, seed, scale, odometry, turn_rad: 0.0, shift_m: DVec3::ZERO, steps: 0 }
    }

    fn key(&self, purpose: Purpose, count: u64) -> u64 {
        random::key(random::key(self.seed, purpose as u64), count)
    }

    /// What the odometry says now, in its own frame.
    pub(crate) fn odometry(&self) -> Pose {
        self.odometry
    }

    /// The robot moved from one true pose to another, while its wheels turned by `wheels_m`.
    pub(crate) fn moved(&mut self, before: &Pose, after: &Pose, wheels_m: f64) {
        self.steps += 1;
        if self.is_ideal {
            self.odometry = *after;
            return;
        }
        let way_m = before.world_from_robot().transpose() * (after.position_m - before.position_m);
        let way_m = if self.config.wheel_odometry { DVec3::X * wheels_m } else { way_m };
        let walk = self.config.heading_drift_rad * way_m.length().sqrt();
        let drift_rad = walk * random::gaussian(self.key(Purpose::Heading, self.steps));
        let position_m = self.odometry.position_m + self.odometry.world_from_robot() * way_m * self.scale;
        let yaw_rad = self.odometry.yaw_rad + (after.yaw_rad - before.yaw_rad) + drift_rad;
        self.stand(position_m, yaw_rad, after);
    }

    /// The ground changed under the robot, which now stands at `after`.
    pub(crate) fn settled(&mut self, before: &Pose, after: &Pose) {
        let position_m = self.odometry.position_m + (after.position_m - before.position_m);
        self.stand(position_m, self.odometry.yaw_rad, after);
    }

    fn stand(&mut self, position_m: DVec3, yaw_rad: f64, truth: &Pose) {
        let mut pose = biased(&self.config, *truth);
        (pose.position_m, pose.yaw_rad) = (position_m, yaw_rad);
        self.odometry = pose;
    }

    /// A pose of the odometry in the frame of the map, where goals are.
    pub(crate) fn in_map(&self, odometry: Pose) -> Pose {
        let (sin, cos) = libm::sincos(self.turn_rad);
        let plan_m = DVec2::new(cos, sin).rotate(odometry.position_m.truncate());
        let mut pose = odometry;
        pose.position_m = plan_m.extend(odometry.position_m.z) + self.shift_m;
        pose.yaw_rad += self.turn_rad;
        pose
    }

    /// What the robot is told with the scan of `tick`, if the odometry said `odometry`.
    pub(crate) fn believed(&self, odometry: Pose, tick: u64) -> Pose {
        let PoseConfig { position_noise_m, angle_noise_rad, .. } = self.config;
        let mut pose = self.in_map(odometry);
        let key = self.key(Purpose::Noise, tick);
        let drawn = |index: u64| random::gaussian(random::key(key, index));
        if position_noise_m > 0.0 {
            pose.position_m += DVec3::new(drawn(0), drawn(1), drawn(2)) * position_noise_m;
        }
        if angle_noise_rad > 0.0 {
            pose.roll_rad += angle_noise_rad * drawn(3);
            pose.pitch_rad += angle_noise_rad * drawn(4);
            pose.yaw_rad += angle_noise_rad * drawn(5);
        }
        pose
    }

    /// Corrects the drift, if that is due at `tick`: gives the believed poses before and after.
    pub(crate) fn correct(&mut self, truth: &Pose, tick: u64, period_s: f64) -> Option<(Pose, Pose)> {
        let PoseConfig { correction_period_s, correction_error_m, correction_error_rad, .. } = self.config;
        let every = (correction_period_s / period_s).round() as u64;
        if every == 0 || !tick.is_multiple_of(every) {
            return None;
        }
        let before = self.in_map(self.odometry);
        let key = self.key(Purpose::Correction, tick);
        let drawn = |index: u64| random::gaussian(random::key(key, index));
        let found_m = truth.position_m + DVec3::new(drawn(0), drawn(1), drawn(2)) * correction_error_m;
        self.turn_rad = truth.yaw_rad + correction_error_rad * drawn(3) - self.odometry.yaw_rad;
        self.shift_m = DVec3::ZERO;
        self.shift_m = found_m - self.in_map(self.odometry).position_m;
        Some((before, self.in_map(self.odometry)))
    }
}

/// `truth` with the bias of the measured tilt.
fn biased(config: &PoseConfig, truth: Pose) -> Pose {
    let mut pose = truth;
    pose.roll_rad += config.roll_bias_rad;
    pose.pitch_rad += config.pitch_bias_rad;
    pose
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 0.1;

    fn at(x_m: f64, pitch_rad: f64) -> Pose {
        Pose::from_roll_pitch_yaw(DVec3::new(x_m, 0.0, x_m * libm::tan(pitch_rad)), 0.0, pitch_rad, 0.0)
    }

    /// The localisation after 100 m straight on in steps of 0.1 m.
    fn after_100_m(config: &PoseConfig, seed: u64, pitch_rad: f64, wheels_m: f64) -> Localisation {
        let mut localisation = Localisation::new(config.clone(), seed, at(0.0, pitch_rad));
        let metres = |step: u32| 0.1 * f64::from(step) * libm::cos(pitch_rad);
        for step in 0..1000 {
            let (before, after) = (at(metres(step), pitch_rad), at(metres(step + 1), pitch_rad));
            localisation.moved(&before, &after, wheels_m);
        }
        localisation
    }

    /// Standard deviation of a value over 400 seeds.
    fn deviation(value: impl Fn(u64) -> f64) -> f64 {
        ((0..400).map(|seed| value(seed) * value(seed)).sum::<f64>() / 400.0).sqrt()
    }

    fn ideal() -> PoseConfig {
        PoseConfig::default()
    }

    #[test]
    fn without_errors_the_truth_is_believed_to_the_bit() {
        let localisation = after_100_m(&ideal(), 1, 0.2, 0.1);
        let truth = at(100.0 * libm::cos(0.2), 0.2);
        assert_eq!(localisation.believed(localisation.odometry(), 5), truth);
    }

    #[test]
    fn the_scale_is_off_by_a_share_of_the_way() {
        let config = PoseConfig { scale_drift: 0.02, ..ideal() };
        let error_m = |seed| after_100_m(&config, seed, 0.0, 0.1).odometry().position_m.x - 100.0;
        assert!((deviation(error_m) - 2.0).abs() < 0.2, "{}", deviation(error_m));
    }

    #[test]
    fn the_heading_walks_with_the_root_of_the_way() {
        let config = PoseConfig { heading_drift_rad: 0.01, ..ideal() };
        let error_rad = |seed| after_100_m(&config, seed, 0.0, 0.1).odometry().yaw_rad;
        assert!((deviation(error_rad) - 0.1).abs() < 0.01, "{}", deviation(error_rad));
        // Which leads aside: a walk from 0 to σ has the mean square σ² / 3 over the way.
        let aside_m = |seed| after_100_m(&config, seed, 0.0, 0.1).odometry().position_m.y;
        assert!((deviation(aside_m) - 100.0 * 0.1 / 3.0_f64.sqrt()).abs() < 0.6, "{}", deviation(aside_m));
    }

    #[test]
    fn a_bias_of_the_pitch_climbs_into_the_height() {
        let config = PoseConfig { pitch_bias_rad: 0.01, roll_bias_rad: -0.02, ..ideal() };
        let pose = after_100_m(&config, 1, 0.0, 0.1).odometry();
        assert!((pose.position_m.z - 1.0).abs() < 1e-3, "{}", pose.position_m.z);
        assert!((pose.pitch_rad - 0.01).abs() < 1e-12 && (pose.roll_rad + 0.02).abs() < 1e-12);
    }

    #[test]
    fn wheels_that_slip_measure_too_long_a_way() {
        let config = PoseConfig { wheel_odometry: true, ..ideal() };
        let pose = after_100_m(&config, 1, 0.3, 0.11).odometry();
        assert!((pose.position_m.truncate().length() - 110.0 * libm::cos(0.3)).abs() < 1e-6);
        assert!((pose.position_m.z - 110.0 * libm::sin(0.3)).abs() < 1e-6);
    }

    #[test]
    fn noise_has_its_deviation_and_no_memory() {
        let config = PoseConfig { position_noise_m: 0.05, angle_noise_rad: 0.02, ..ideal() };
        let localisation = Localisation::new(config, 1, at(3.0, 0.1));
        let of = |tick| localisation.believed(localisation.odometry(), tick);
        assert!((deviation(|tick| of(tick).position_m.z - at(3.0, 0.1).position_m.z) - 0.05).abs() < 0.005);
        assert!((deviation(|tick| of(tick).pitch_rad - 0.1) - 0.02).abs() < 0.002);
        assert!((deviation(|tick| of(tick).yaw_rad) - 0.02).abs() < 0.002);
        assert_eq!(of(7), of(7));
        assert_ne!(of(7), of(8));
    }

    #[test]
    fn a_correction_removes_the_drift_and_leaves_its_own_error() {
        let config = PoseConfig {
            scale_drift: 0.1,
            heading_drift_rad: 0.05,
            correction_period_s: 2.0,
            correction_error_m: 0.3,
            correction_error_rad: 0.02,
            ..ideal()
        };
        let truth = at(100.0, 0.0);
        let corrected = |seed: u64| {
            let mut localisation = after_100_m(&config, seed, 0.0, 0.1);
            assert!(localisation.correct(&truth, 19, PERIOD_S).is_none());
            let (before, after) = localisation.correct(&truth, 20, PERIOD_S).unwrap();
            assert!(before.position_m.distance(truth.position_m) > 1e-3);
            assert_eq!(after, localisation.in_map(localisation.odometry()));
            after
        };
        assert!((deviation(|seed| corrected(seed).position_m.x - 100.0) - 0.3).abs() < 0.03);
        assert!((deviation(|seed| corrected(seed).yaw_rad) - 0.02).abs() < 0.002);
        // The odometry itself does not jump: a sweep is corrected by it.
        let mut localisation = after_100_m(&config, 1, 0.0, 0.1);
        let odometry = localisation.odometry();
        localisation.correct(&truth, 20, PERIOD_S);
        assert_eq!(localisation.odometry(), odometry);
    }
}
