//! From the motion of the wheels to that of the body: slip on slopes and in turns, and the limit of friction.

use crate::attitude::Attitude;
use crate::motion_config::MotionConfig;
use crate::robot::DriveCommand;
use glam::DVec2;

const GRAVITY_M_S2: f64 = 9.81;

/// Motion of the body over the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BodyMotion {
    /// Speed forward and to the left, along the body, in m/s.
    pub(crate) velocity_m_s: DVec2,
    /// Rate of the heading, in rad/s.
    pub(crate) turn_rate_rad_s: f64,
}

/// The motion that follows `before` within `dt_s`, on ground of this attitude, when the wheels would drive a
/// body that does not slip by `wheels`.
pub(crate) fn body_motion(
    config: &MotionConfig,
    wheels: DriveCommand,
    attitude: &Attitude,
    before: BodyMotion,
    dt_s: f64,
) -> BodyMotion {
    let (sin_pitch, cos_pitch) = libm::sincos(attitude.pitch_rad);
    let (sin_roll, cos_roll) = libm::sincos(attitude.roll_rad);
    let (tan_pitch, tan_roll) = (sin_pitch / cos_pitch, sin_roll / cos_roll);
    // On a side slope the lower wheels carry more and skid less, so the same wheel speeds turn more.
    let turn_rate_rad_s =
        wheels.turn_rate_rad_s * config.turn_ratio * (1.0 + config.side_slope_turn * tan_roll.abs());
    // A wheel that drives up slips back, one that drives down slips on: both downhill.
    let ahead = wheels.speed_m_s - config.slope_slip * tan_pitch * wheels.speed_m_s.abs();
    // In a turn every wheel skids at |ω| r, with r half the diagonal between the wheels. Friction acts against
    // the skid, so that a pull of tan(roll) from the side is balanced by a drift of |ω| r tan(roll) / μ.
    let pull = config.side_slip * wheels.speed_m_s.abs() + config.turn_slide_m_rad * turn_rate_rad_s.abs();
    let wanted = DVec2::new(ahead, -pull * tan_roll);
    let downhill = DVec2::new(-sin_pitch, -sin_roll * cos_pitch) * GRAVITY_M_S2;
    let most = config.friction * GRAVITY_M_S2 * cos_pitch * cos_roll;
    let velocity_m_s = if config.may_slide() && dt_s > 0.0 {
        held(before.velocity_m_s, wanted, downhill, most, dt_s)
    } else {
        wanted
    };
    BodyMotion { velocity_m_s, turn_rate_rad_s }
}

/// Coulomb friction: the ground gives what acceleration it takes to reach `wanted` against gravity, but not
/// more than `most`; what is missing leaves the wheels spinning or the body sliding `downhill`.
fn held(velocity: DVec2, wanted: DVec2, downhill: DVec2, most: f64, dt_s: f64) -> DVec2 {
    let needed = (wanted - velocity) / dt_s - downhill;
    if needed.length() <= most { wanted } else { velocity + (needed.normalize() * most + downhill) * dt_s }
}
