//! Slopes along and across the robot.

use glam::DVec2;

use crate::robot_model::RobotModel;

/// Slopes along and across the robot, the tangents of its pitch and roll.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slopes {
    pub(crate) across: f64,
    pub(crate) along: f64,
}

impl Slopes {
    /// The slopes at which a robot is `margin_rad` inside its tilt limits.
    pub(crate) fn of_limits(limits: &RobotModel, margin_rad: f64) -> Self {
        Self {
            across: libm::tan(limits.roll_limit_rad - margin_rad),
            along: libm::tan(limits.pitch_limit_rad - margin_rad),
        }
    }

    /// The slopes of ground with a gradient under a robot that faces along the unit vector `direction`.
    pub(crate) fn facing(gradient: DVec2, direction: DVec2) -> Self {
        Self { across: gradient.dot(direction.perp()).abs(), along: gradient.dot(direction).abs() }
    }

    /// The steeper of each.
    pub(crate) fn max(self, other: Self) -> Self {
        Self { across: self.across.max(other.across), along: self.along.max(other.along) }
    }

    /// Utilisation of the limits, in slope: the larger of both axes.
    pub(crate) fn share_of(&self, limits: &Self) -> f64 {
        (self.across / limits.across).max(self.along / limits.along)
    }

    /// Whether both stay within limits, with a margin for uncertainty.
    pub(crate) fn within(&self, limits: &Self, margin: f64) -> bool {
        self.across + margin <= limits.across && self.along + margin <= limits.along
    }
}
