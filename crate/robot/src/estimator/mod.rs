//! The pose of the robot from its odometry and its IMU.
//!
//! Roll and pitch are the IMU's. Where the odometry's covariance says that it is three-dimensional, position
//! and heading are the odometry's. Otherwise (wheels, or a filter in two-dimensional mode, whose z, roll and
//! pitch mean nothing) the position follows the wheels' speed along the tilted body, and the heading follows
//! the gyro, less the bias that it shows at standstill.
//!
//! Frames are those of REP 103 and REP 105 on the side of the messages: `base_link` x forward, y left, z up,
//! in a frame that is continuous. [`Estimator::pose`] is of the robot frame of [`mapless`], on the ground,
//! with pitch **nose-up** positive. It begins at the odometry's pose.

mod config;
mod reading;
mod slip;
mod trajectory;

use core::time::Duration;

use glam::{DQuat, DVec2, DVec3};
use mapless::Pose;
use mapless::math::angle::{difference_rad, wrap_rad};
use mapless_parameters::ConfigError;

pub use config::EstimatorConfig;
pub use reading::{Imu, Odometry, ReadingError};
pub(crate) use reading::{finite, unit};
pub use trajectory::Trajectory;

use slip::Slip;

/// Nothing is integrated over a longer gap.
const LONGEST_GAP_S: f64 = 1.0;
/// A velocity holds for this long after its message. By then the supervisor has stopped the robot.
const HOLD: Duration = Duration::from_millis(200);

/// A jump of the odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The pose at this time by the motion before it: with `after` for [`mapless::Planner::relocalise`].
    pub before: Pose,
    /// The pose that the estimator gives from now on. In two dimensions it did not jump.
    pub after: Pose,
}

/// Follows the robot's pose.
#[derive(Clone, Debug)]
pub struct Estimator {
    config: EstimatorConfig,
    /// Takes vectors of the IMU's frame to `base_link`.
    base_from_imu: DQuat,
    /// When, and where the robot is then; `None` until odometry and IMU came.
    pose: Option<(Duration, Pose)>,
    trajectory: Trajectory,
    attitude_rad: Option<[f64; 2]>,
    odometry: Option<Odometry>,
    /// The gyro in `base_link`, when it was read, and the part of it that is bias.
    gyro_rad_s: DVec3,
    gyro_at: Duration,
    bias_rad_s: DVec3,
    /// Time over which the bias was learned, up to its time constant, seconds.
    learned_s: f64,
    /// Since when the wheels rest.
    rests_since: Option<Duration>,
    /// Turned by the gyro since the last odometry.
    turned_rad: f64,
    /// The turn and shift from the odometry's frame to the estimator's, while it is three-dimensional.
    anchor: Option<(f64, DVec3)>,
    slip: Slip,
}

impl Estimator {
    /// An estimator that knows nothing. `base_from_imu` takes vectors of the IMU's frame to `base_link`.
    ///
    /// # Errors
    /// [`ConfigError`] for a value that makes no sense.
    pub fn new(config: EstimatorConfig, base_from_imu: DQuat) -> Result<Self, ConfigError> {
        config.validate("estimator")?;
        Ok(Self {
            config,
            base_from_imu,
            pose: None,
            trajectory: Trajectory::default(),
            attitude_rad: None,
            odometry: None,
            gyro_rad_s: DVec3::ZERO,
            gyro_at: Duration::ZERO,
            bias_rad_s: DVec3::ZERO,
            learned_s: 0.0,
            rests_since: None,
            turned_rad: 0.0,
            anchor: None,
            slip: Slip::default(),
        })
    }

    /// Takes a message of the IMU.
    ///
    /// # Errors
    /// [`ReadingError`] says what cannot be used; the message is passed over.
    pub fn take_imu(&mut self, imu: &Imu) -> Result<(), ReadingError> {
        imu.check()?;
        let elapsed_s = self.advance(imu.at);
        let gyro_rad_s = self.base_from_imu * imu.angular_rad_s;
        self.learn_bias(gyro_rad_s, imu.at, elapsed_s);
        (self.gyro_rad_s, self.gyro_at) = (gyro_rad_s, imu.at);
        let base = Pose::from_quaternion(DVec3::ZERO, imu.orientation * self.base_from_imu.conjugate());
        self.attitude_rad = Some([base.roll_rad, base.pitch_rad]);
        if let Some((_, pose)) = &mut self.pose {
            (pose.roll_rad, pose.pitch_rad) = (base.roll_rad, base.pitch_rad);
        }
        let wheels_rad_s = self.odometry.map_or(0.0, |odometry| odometry.angular_rad_s.z);
        self.slip.take(wheels_rad_s, self.gyro_rad_s.z - self.bias_rad_s.z, elapsed_s, self.config.slip_s);
        self.remember();
        Ok(())
    }

    /// Takes a message of odometry; a jump, if it shows one.
    ///
    /// # Errors
    /// [`ReadingError`] says what cannot be used; the message is passed over.
    pub fn take_odometry(&mut self, odometry: &Odometry) -> Result<Option<Jump>, ReadingError> {
        odometry.check()?;
        self.advance(odometry.at);
        let jumps = self.odometry.is_some_and(|last| self.is_jump(&last, odometry));
        self.odometry = Some(*odometry);
        self.turned_rad = 0.0;
        let rests = odometry.linear_m_s.length() < self.config.standstill_m_s
            && odometry.angular_rad_s.length() < self.config.standstill_m_s;
        self.rests_since = if rests { self.rests_since.or(Some(odometry.at)) } else { None };
        let Some([roll_rad, pitch_rad]) = self.attitude_rad else { return Ok(None) };
        let told = Pose::from_quaternion(odometry.position_m, odometry.orientation);
        let (at, before) = *self.pose.get_or_insert_with(|| {
            let level = Pose::from_roll_pitch_yaw(told.position_m, roll_rad, pitch_rad, told.yaw_rad);
            (odometry.at, level.moved(DVec3::NEG_Z * self.config.base_height_m))
        });
        let mut after = before;
        if self.is_three_dimensional(odometry, &told) {
            let (turn_rad, shift_m) = *self.anchor.get_or_insert_with(|| {
                let turn_rad = before.yaw_rad - told.yaw_rad;
                let base_m = before.moved(DVec3::Z * self.config.base_height_m).position_m;
                (turn_rad, base_m - turned(turn_rad, told.position_m))
            });
            let base_m = turned(turn_rad, told.position_m) + shift_m;
            let base =
                Pose::from_roll_pitch_yaw(base_m, roll_rad, pitch_rad, wrap_rad(told.yaw_rad + turn_rad));
            after = base.moved(DVec3::NEG_Z * self.config.base_height_m);
        } else {
            self.anchor = None;
        }
        if jumps {
            // Nothing in between is where the robot was.
            self.trajectory.clear();
        }
        self.pose = Some((at, after));
        self.remember();
        Ok(jumps.then_some(Jump { before, after }))
    }

    /// The pose now; `None` until odometry and IMU came.
    pub fn pose(&self) -> Option<Pose> {
        self.pose.map(|(_, pose)| pose)
    }

    /// The poses of the last seconds.
    pub fn trajectory(&self) -> &Trajectory {
        &self.trajectory
    }

    /// Roll, left side up, and pitch, nose-up, by the IMU.
    pub fn attitude_rad(&self) -> Option<[f64; 2]> {
        self.attitude_rad
    }

    /// The gyro's bias in `base_link`, as learned.
    pub fn gyro_bias_rad_s(&self) -> DVec3 {
        self.bias_rad_s
    }

    /// Turn rate of the wheels that the gyro does not feel, averaged.
    pub fn slip_rad_s(&self) -> f64 {
        self.slip.turn_rad_s()
    }

    /// Whether wheels and gyro disagree: the wheels spin, or the robot is turned.
    pub fn wheels_disagree(&self) -> bool {
        self.slip.is_beyond(self.config.slip_rad_s, self.config.slip_share)
    }

    /// Whether position and heading are the odometry's.
    pub fn is_three_dimensional_now(&self) -> bool {
        self.anchor.is_some()
    }

    /// Moves on to a time by the last velocities, as long as they hold; seconds that passed. Without a gyro
    /// the heading follows the odometry's turn rate.
    fn advance(&mut self, to: Duration) -> f64 {
        let Some((at, pose)) = &mut self.pose else { return 0.0 };
        let elapsed_s = to.saturating_sub(*at).as_secs_f64();
        let held_s = |said: Duration| to.min(said + HOLD).saturating_sub(*at).as_secs_f64();
        let gyro_s = held_s(self.gyro_at);
        let (told_m_s, told_rad_s, told_s) = self.odometry.map_or((DVec3::ZERO, 0.0, 0.0), |odometry| {
            (odometry.linear_m_s, odometry.angular_rad_s.z, held_s(odometry.at))
        });
        *at = (*at).max(to);
        if elapsed_s > LONGEST_GAP_S {
            return 0.0;
        }
        // Turn rates of the body as a rate of the heading (Euler angles of yaw, pitch, roll).
        let rate_rad_s = self.gyro_rad_s - self.bias_rad_s;
        let (sin_roll, cos_roll) = libm::sincos(pose.roll_rad);
        let level_rad_s = rate_rad_s.y * sin_roll + rate_rad_s.z * cos_roll;
        let mut turn_rad = gyro_s * level_rad_s / libm::cos(pose.pitch_rad).max(0.1);
        if self.rests_since.is_some() && rate_rad_s.length() < self.config.most_bias_rad_s {
            turn_rad = 0.0;
        }
        turn_rad += (told_s - gyro_s).max(0.0) * told_rad_s;
        let velocity_m_s = if self.anchor.is_some() { told_m_s } else { DVec3::X * told_m_s.x };
        // Along the heading in the middle of the turn.
        let mut middle = *pose;
        middle.yaw_rad += 0.5 * turn_rad;
        pose.position_m += middle.world_from_robot() * velocity_m_s * told_s;
        pose.yaw_rad = wrap_rad(pose.yaw_rad + turn_rad);
        self.turned_rad += turn_rad;
        elapsed_s
    }

    fn learn_bias(&mut self, gyro_rad_s: DVec3, at: Duration, elapsed_s: f64) {
        let EstimatorConfig { standstill_s, most_bias_rad_s, bias_s, .. } = self.config;
        let rests =
            self.rests_since.is_some_and(|since| at.saturating_sub(since).as_secs_f64() > standstill_s);
        if rests && gyro_rad_s.length() < most_bias_rad_s {
            // A plain mean at first, one that forgets later.
            self.learned_s = (self.learned_s + elapsed_s).min(bias_s);
            let share = if self.learned_s > 0.0 { elapsed_s / self.learned_s } else { 0.0 };
            self.bias_rad_s += share * (gyro_rad_s - self.bias_rad_s);
        }
    }

    /// Whether the odometry's pose changed otherwise than its speed and the gyro say.
    fn is_jump(&self, last: &Odometry, odometry: &Odometry) -> bool {
        let elapsed_s = odometry.at.saturating_sub(last.at).as_secs_f64();
        let tolerance = 1.0 + elapsed_s;
        let speed_m_s = 0.5 * (last.linear_m_s + odometry.linear_m_s);
        let moved_m = last.orientation * speed_m_s * elapsed_s;
        let missed_m = (odometry.position_m - last.position_m - moved_m).length();
        let yaw_rad = |odometry: &Odometry| Pose::from_quaternion(DVec3::ZERO, odometry.orientation).yaw_rad;
        let missed_rad = difference_rad(yaw_rad(odometry) - yaw_rad(last), self.turned_rad).abs();
        missed_m > self.config.jump_m * tolerance || missed_rad > self.config.jump_rad * tolerance
    }

    /// Whether the odometry knows height and tilt. What a filter in two-dimensional mode says of them is
    /// exactly zero, whatever its covariance.
    fn is_three_dimensional(&self, odometry: &Odometry, told: &Pose) -> bool {
        let [_, _, z, roll, pitch, _] = odometry.variances;
        let is_known = |variance: f64| variance > 0.0 && variance <= self.config.most_variance;
        let DQuat { x, y, .. } = odometry.orientation;
        let is_flat = told.position_m.z == 0.0 && x == 0.0 && y == 0.0;
        [z, roll, pitch].into_iter().all(is_known) && !is_flat
    }

    fn remember(&mut self) {
        if let Some((at, pose)) = self.pose {
            self.trajectory.push(at, pose);
        }
    }
}

fn turned(turn_rad: f64, vector: DVec3) -> DVec3 {
    let (sin, cos) = libm::sincos(turn_rad);
    DVec2::new(cos, sin).rotate(vector.truncate()).extend(vector.z)
}
