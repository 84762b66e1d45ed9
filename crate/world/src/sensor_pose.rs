//! Where a sensor is.

use glam::{DMat3, DVec3};

/// Where the sensor is. Its axes are those of the robot, turned by its mount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorPose {
    /// World position, in metres.
    pub position: DVec3,
    /// Rotation from the sensor frame to the world.
    pub world_from_sensor: DMat3,
}
