//! What is wrong with the pose that the robot believes.

use mapless_parameters::parameters;
use std::f64::consts::FRAC_PI_2;

parameters! {
    /// What is wrong with the pose that the robot believes; by default nothing.
    pub struct PoseConfig {
        /// Measure the way along the body by the wheels, slip included. Heading and tilt are those of a gyro
        /// and an accelerometer.
        wheel_odometry: bool = false;
        /// Standard deviation of the odometry's scale: every metre of a trial is too long or too short by the
        /// same share.
        scale_drift: f64 = 0.0, range [0.0, 0.1], check Within(0.0, 0.5);
        /// Random walk of the heading: its standard deviation after one metre. It grows with the root of the
        /// way.
        heading_drift_rad: f64 = 0.0, unit "rad", range [0.0, 0.05], check Within(0.0, 1.0);
        /// Standard deviation of the position along each axis, drawn anew for every scan.
        position_noise_m: f64 = 0.0, unit "m", range [0.0, 0.2], check Within(0.0, 10.0);
        /// Standard deviation of roll, pitch and heading, drawn anew for every scan.
        angle_noise_rad: f64 = 0.0, unit "rad", range [0.0, 0.05], check Within(0.0, 1.0);
        /// Constant error of the roll. The odometry integrates it into the height.
        roll_bias_rad: f64 = 0.0, unit "rad", range [-0.05, 0.05], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Constant error of the pitch. The odometry integrates it into the height.
        pitch_bias_rad: f64 = 0.0, unit "rad", range [-0.05, 0.05], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Time between two corrections of the drift, as by a GPS: the believed pose then jumps. 0: there are
        /// none.
        correction_period_s: f64 = 0.0, unit "s", range [0.0, 60.0], check Within(0.0, 10_000.0);
        /// Standard deviation of the position along each axis that is left after a correction.
        correction_error_m: f64 = 0.0, unit "m", range [0.0, 2.0], check Within(0.0, 100.0);
        /// Standard deviation of the heading that is left after a correction.
        correction_error_rad: f64 = 0.0, unit "rad", range [0.0, 0.1], check Within(0.0, 3.0);
        /// Tell the planner of a correction, so that it moves what it remembers along.
        relocalises: bool = true;
        /// Age of the pose that the planner gets with a scan. Rounded to motion steps, of which a sensor's
        /// period has ten.
        latency_s: f64 = 0.0, unit "s", range [0.0, 0.5], check Within(0.0, 5.0);
    }
}
