//! Limits of the supervisor.

use mapless_parameters::parameters;

parameters! {
    /// Limits of the supervisor: how old an input may get, how far the robot may tilt, how commands may
    /// change. A limit in seconds is how long a fault may last until the robot is stopped.
    #[derive(Copy)]
    pub struct SupervisorConfig {
        /// Longest time since a good scan.
        scan_s: f64 = 0.35, unit "s", range [0.1, 2.0], check Within(0.01, 10.0);
        /// Longest time since good odometry.
        odometry_s: f64 = 0.15, unit "s", range [0.05, 2.0], check Within(0.01, 10.0);
        /// Longest time since a good message of the IMU.
        imu_s: f64 = 0.10, unit "s", range [0.05, 2.0], check Within(0.01, 10.0);
        /// Longest time for which odometry or IMU may repeat its content while the robot is to move. A scan
        /// may for `scan_s`.
        frozen_s: f64 = 0.5, unit "s", range [0.1, 5.0], check Within(0.01, 10.0);
        /// A message is from the future when its stamp is ahead of its sender's clock by more.
        future_s: f64 = 0.5, unit "s", range [0.05, 5.0], check Within(0.01, 60.0);
        /// Longest time between two ticks: after a longer one the process had been suspended.
        tick_s: f64 = 0.2, unit "s", range [0.05, 1.0], check Within(0.02, 10.0);
        /// Longest time for which a good scan may wait for the planner's answer.
        planner_s: f64 = 0.3, unit "s", range [0.05, 2.0], check Within(0.01, 10.0);
        /// Whether the robot tells the state of its emergency stop; then it must go on telling.
        has_emergency_stop: bool = true;
        /// Longest silence of the emergency stop.
        emergency_stop_s: f64 = 1.0, unit "s", range [0.1, 5.0], check Within(0.01, 60.0);
        /// Whether time is simulated; then the simulation's clock must run.
        has_clock: bool = false;
        /// Longest time for which the simulation's clock may stand.
        clock_s: f64 = 0.5, unit "s", range [0.1, 5.0], check Within(0.01, 60.0);
        /// Longest time without a peer that takes the commands.
        peer_s: f64 = 0.1, unit "s", range [0.0, 5.0], check Within(0.0, 60.0);
        /// Largest |roll|.
        max_roll_rad: f64 = 0.48, unit "rad", range [0.1, 1.2], check Angle;
        /// Largest |pitch|.
        max_pitch_rad: f64 = 0.72, unit "rad", range [0.1, 1.2], check Angle;
        /// How long everything must have been in order before a stop clears.
        clear_after_s: f64 = 1.0, unit "s", range [0.2, 10.0], check Within(0.0, 60.0);
        /// Largest speed, forward or back.
        max_speed_m_s: f64 = 1.0, unit "m/s", range [0.1, 3.0], check Positive;
        /// Largest turn rate.
        max_turn_rate_rad_s: f64 = 1.2, unit "rad/s", range [0.1, 3.0], check Positive;
        /// Largest acceleration of the commanded speed.
        max_acceleration_m_s2: f64 = 1.0, unit "m/s²", range [0.1, 5.0], check Positive;
        /// Largest acceleration of the commanded turn rate.
        max_turn_acceleration_rad_s2: f64 = 2.0, unit "rad/s²", range [0.1, 10.0], check Positive;
        /// Largest jerk of the commanded speed.
        max_jerk_m_s3: f64 = 5.0, unit "m/s³", range [0.5, 50.0], check Positive;
        /// Largest jerk of the commanded turn rate.
        max_turn_jerk_rad_s3: f64 = 20.0, unit "rad/s³", range [0.5, 100.0], check Positive;
    }
}

impl SupervisorConfig {
    /// Speed, acceleration and jerk.
    pub(crate) fn linear(&self) -> [f64; 3] {
        [self.max_speed_m_s, self.max_acceleration_m_s2, self.max_jerk_m_s3]
    }

    /// The same of the turn rate.
    pub(crate) fn angular(&self) -> [f64; 3] {
        [self.max_turn_rate_rad_s, self.max_turn_acceleration_rad_s2, self.max_turn_jerk_rad_s3]
    }

    /// The same with the limits on motion and tilt of another.
    pub(crate) fn limited_as(&self, limits: &Self) -> Self {
        Self {
            max_roll_rad: limits.max_roll_rad,
            max_pitch_rad: limits.max_pitch_rad,
            max_speed_m_s: limits.max_speed_m_s,
            max_turn_rate_rad_s: limits.max_turn_rate_rad_s,
            max_acceleration_m_s2: limits.max_acceleration_m_s2,
            max_turn_acceleration_rad_s2: limits.max_turn_acceleration_rad_s2,
            max_jerk_m_s3: limits.max_jerk_m_s3,
            max_turn_jerk_rad_s3: limits.max_turn_jerk_rad_s3,
            ..*self
        }
    }
}
