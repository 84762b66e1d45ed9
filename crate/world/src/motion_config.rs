//! What the drive and the ground do to a commanded motion.

use mapless_parameters::parameters;

/// From this coefficient on, friction holds on every slope.
const HOLDS_ALWAYS: f64 = 2.0;

parameters! {
    /// What the drive and the ground do to a commanded motion; by default nothing.
    pub struct MotionConfig {
        /// Dead time: a command has no effect before. Rounded to motion steps, of which a sensor's period has
        /// ten.
        latency_s: f64 = 0.0, unit "s", range [0.0, 0.5], check Within(0.0, 5.0);
        /// Time constant of the first-order lag with which the drive follows a command.
        lag_s: f64 = 0.0, unit "s", range [0.0, 1.0], check Within(0.0, 10.0);
        /// Longitudinal slip on a slope, per tangent of the pitch: 0.2 loses a fifth of the speed up a slope
        /// of 45° and gains as much down it.
        slope_slip: f64 = 0.0, range [0.0, 0.9], check Within(0.0, 1.0);
        /// Sideways slip on a slope, in metres for each metre driven, per tangent of the roll; always
        /// downhill.
        side_slip: f64 = 0.0, range [0.0, 0.5], check Within(0.0, 2.0);
        /// Sideways slide of a skid-steered turn on a slope, in metres for each radian turned, per tangent of
        /// the roll; always downhill.
        turn_slide_m_rad: f64 = 0.0, unit "m/rad", range [0.0, 1.0], check Within(0.0, 5.0);
        /// Turn rate on level ground over the commanded one: below 1 the wheels skid more than the drive was
        /// calibrated for.
        turn_ratio: f64 = 1.0, range [0.5, 1.5], check Within(0.1, 3.0);
        /// Growth of the turn rate on a side slope, as a share per tangent of the roll.
        side_slope_turn: f64 = 0.0, range [-1.0, 1.5], check Within(-1.0, 5.0);
        /// Coefficient of friction between wheels and ground: beyond it the wheels spin and the robot slides.
        /// From 2 on it holds on every slope.
        friction: f64 = HOLDS_ALWAYS, range [0.2, HOLDS_ALWAYS], check Within(0.05, 10.0);
        /// Load as a share of the robot's own mass: the same motors accelerate it more slowly.
        payload: f64 = 0.0, range [0.0, 1.5], check Within(0.0, 10.0);
        /// Whether belly and bumpers meet the ground and wheels climb no step higher than they can: the trial
        /// then ends, high-centred or at a step. What stands on the ground is met in any case.
        touches_ground: bool = false;
    }
}

impl MotionConfig {
    /// Whether friction has a limit.
    pub(crate) fn may_slide(&self) -> bool {
        self.friction < HOLDS_ALWAYS
    }
}
