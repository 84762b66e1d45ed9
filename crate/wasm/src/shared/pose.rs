//! Where the robot is.

use serde::Serialize;
use tsify::Tsify;

/// Where the robot is: x east, y north, z up; pitch positive nose-up, roll positive with the left side up.
#[derive(Debug, Serialize, Tsify)]
pub struct Pose {
    x: f64,
    y: f64,
    /// Height of the ground contact under the body's centre.
    z: f64,
    roll: f64,
    pitch: f64,
    yaw: f64,
}

impl From<mapless::Pose> for Pose {
    fn from(pose: mapless::Pose) -> Self {
        let [x, y, z] = pose.position_m.to_array();
        Self { x, y, z, roll: pose.roll_rad, pitch: pose.pitch_rad, yaw: pose.yaw_rad }
    }
}
