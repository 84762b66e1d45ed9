//! The robot's goal.

use glam::DVec2;

/// A goal: a place in the world frame and, if asked for, the heading to end with (the paper's x_f has one).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Goal {
    /// The place seen from above, metres.
    pub position_m: DVec2,
    /// The goal is reached within this distance, metres; the configuration's `goal_tolerance_m` when absent.
    pub tolerance_m: Option<f64>,
    /// Final heading, anticlockwise from the world's x axis, radians; any heading when absent.
    pub heading_rad: Option<f64>,
}

impl Goal {
    /// A place to be reached with any heading.
    pub fn at(position_m: DVec2) -> Self {
        Self { position_m, tolerance_m: None, heading_rad: None }
    }

    /// The same goal, to be reached with this heading, radians.
    #[must_use]
    pub fn facing(self, heading_rad: f64) -> Self {
        Self { heading_rad: Some(heading_rad), ..self }
    }

    /// The same goal, reached within this distance, metres.
    #[must_use]
    pub fn within(self, tolerance_m: f64) -> Self {
        Self { tolerance_m: Some(tolerance_m), ..self }
    }

    /// Whether every number is finite and the tolerance positive.
    pub fn is_valid(&self) -> bool {
        self.position_m.is_finite()
            && self.tolerance_m.is_none_or(|tolerance_m| tolerance_m.is_finite() && tolerance_m > 0.0)
            && self.heading_rad.is_none_or(f64::is_finite)
    }
}
