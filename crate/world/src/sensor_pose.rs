//! The pose of a sensor.

use glam::{DMat3, DVec3};

/// The pose of a sensor. Its axes are those of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorPose {
    /// World position, in metres.
    pub position: DVec3,
    /// Rotation from the sensor frame to the world.
    pub world_from_sensor: DMat3,
}
