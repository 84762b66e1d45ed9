//! What spoils the scans of a sensor in the field.

use mapless_parameters::{choices, parameters};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

choices! {
    /// Motion compensation of a sweep.
    #[derive(Default)]
    pub enum MotionCompensation {
        /// Points stay as they were fired, as if the robot had stood still.
        #[default]
        None = "none",
        /// Points are moved by what the odometry says of the motion since they were fired.
        Odometry = "odometry",
    }
}

parameters! {
    /// What spoils the scans of a sensor in the field; by default nothing.
    pub struct SensingConfig {
        /// Fire the columns of a revolution one after the other, over the sensor's period, each from where
        /// the robot is then. The scan belongs to the end of the sweep.
        sweep: bool = false;
        /// How the points of a sweep are corrected for the motion during it.
        motion_compensation: MotionCompensation = MotionCompensation::None;
        /// Least power of a return that is noticed, as a share of that from dry ground 10 m away, met at a
        /// right angle. Power falls with the square of the range and with the cosine of the incidence.
        weakest_return: f64 = 0.0, range [0.0, 0.2], check Within(0.0, 1.0);
        /// Share of a return's power that wet ground throws away from the sensor. It matters where
        /// weakest_return is above 0.
        wetness: f64 = 0.0, range [0.0, 0.95], check Within(0.0, 1.0);
        /// Share of beams that end early, on rain, dust or insects: anywhere before what they would hit, and
        /// within 7 m.
        stray_probability: f64 = 0.0, range [0.0, 0.1], check Within(0.0, 1.0);
        /// Returns on the robot itself in each scan: anywhere above its outline, up to the sensor's height.
        self_returns: usize = 0, range [0, 100], check Within(0.0, 10_000.0);
        /// Give a beam without a return as a point at the sensor's origin, as some drivers do.
        zeros: bool = false;
        /// Middle of a sector in which something before the lens takes every return, anticlockwise from the
        /// sensor's x axis.
        blocked_azimuth_rad: f64 = PI, unit "rad", range [-PI, PI], check Within(-PI, PI);
        /// Width of that sector.
        blocked_width_rad: f64 = 0.0, unit "rad", range [0.0, PI], check Within(0.0, TAU);
        /// Roll of the true mount above that which the planner is told, left side up positive.
        mount_roll_rad: f64 = 0.0, unit "rad", range [-0.1, 0.1], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Pitch of the true mount above that which the planner is told, nose-up positive.
        mount_pitch_rad: f64 = 0.0, unit "rad", range [-0.1, 0.1], check Within(-FRAC_PI_2, FRAC_PI_2);
        /// Height of the true mount above that which the planner is told.
        mount_height_m: f64 = 0.0, unit "m", range [-0.1, 0.1], check Within(-1.0, 1.0);
        /// Share of scans that never arrive. The last command then holds until the next scan.
        lost_scan_probability: f64 = 0.0, range [0.0, 0.5], check Within(0.0, 1.0);
        /// Periods of the sensor by which a scan arrives late, with the pose that belongs to it.
        scan_delay_periods: usize = 0, range [0, 5], check Within(0.0, 50.0);
    }
}
