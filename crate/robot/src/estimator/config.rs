//! Parameters of the estimator.

use mapless_parameters::parameters;

parameters! {
    /// How odometry and IMU become a pose.
    #[derive(Copy)]
    pub struct EstimatorConfig {
        /// Height of the frame of the odometry (`base_link`) over the ground between the wheels.
        base_height_m: f64 = 0.165, unit "m", range [0.0, 1.0], check NotNegative;
        /// Odometry whose variances of z, in m², and of roll and pitch, in rad², are above 0 and at most this
        /// is three-dimensional.
        most_variance: f64 = 0.1, range [0.001, 1.0], check Positive;
        /// The robot stands when its wheels move it by less than this, and turn it by less than as many
        /// radians a second.
        standstill_m_s: f64 = 0.005, unit "m/s", range [0.0, 0.05], check NotNegative;
        /// How long the wheels must rest before the gyro's bias is learned.
        standstill_s: f64 = 0.5, unit "s", range [0.1, 5.0], check Positive;
        /// No gyro has a larger bias: a larger rate at standstill is a motion.
        most_bias_rad_s: f64 = 0.05, unit "rad/s", range [0.01, 0.2], check Positive;
        /// Time constant with which the bias is learned.
        bias_s: f64 = 2.0, unit "s", range [0.5, 20.0], check Positive;
        /// A change of position is a jump beyond this distance from what the wheels say, and beyond as many
        /// metres a second.
        jump_m: f64 = 0.3, unit "m", range [0.05, 2.0], check Positive;
        /// A change of heading is a jump beyond this angle from what the gyro says, and beyond as many
        /// radians a second.
        jump_rad: f64 = 0.2, unit "rad", range [0.05, 1.0], check Positive;
        /// Wheels and gyro disagree when their turn rates differ by more than this and by more than
        /// `slip_share` of the wheels', both averaged over `slip_s`.
        slip_rad_s: f64 = 0.3, unit "rad/s", range [0.1, 2.0], check Positive;
        /// A skid-steered base turns up to half as far again, or as much less, on side slopes.
        slip_share: f64 = 0.6, range [0.0, 1.0], check NotNegative;
        /// Time constant of that average.
        slip_s: f64 = 0.5, unit "s", range [0.1, 5.0], check Positive;
    }
}
