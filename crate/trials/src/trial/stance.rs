//! What would come of standing somewhere.

use glam::DVec2;
use mapless_world::{Attitude, Contact, Footing, RobotState, attitude_on};

use super::Trial;
use crate::navigator::Navigator;

/// How the robot would stand at a place, by the true ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// Height and tilt.
    pub attitude: Attitude,
    /// Whether roll or pitch would be beyond its limit.
    pub is_too_steep: bool,
    /// What the body would touch, if anything.
    pub contact: Option<Contact>,
}

impl<N: Navigator> Trial<N> {
    /// How the robot would stand at `position_m` with this heading, on the ground as it is now and among the
    /// objects where they are; `None` where a wheel is off the terrain.
    pub fn stance_at(&self, position_m: DVec2, heading_rad: f64) -> Option<Stance> {
        let (field, solids) = (self.caster.field(), self.objects.solids());
        let footing = Footing { field, solids };
        let limits = self.husky.config();
        let attitude = attitude_on(&footing, position_m, heading_rad, limits)?;
        let here = *self.husky.state();
        let there = RobotState { position: position_m, yaw_rad: heading_rad, attitude, ..here };
        let state = self.body.on_wheels(&there, &footing);
        let on_ground = || self.body.contact_with_ground(field, &footing, &state);
        Some(Stance {
            attitude,
            is_too_steep: attitude.roll_rad.abs() > limits.roll_limit_rad
                || attitude.pitch_rad.abs() > limits.pitch_limit_rad,
            contact: self.body.contact_with(solids, &state).or_else(on_ground),
        })
    }
}
