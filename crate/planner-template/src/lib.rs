//! A planner of your own, as WebAssembly for the page: `cargo build --release -p mapless-planner-template
//! --target wasm32-unknown-unknown` makes a file to drop on it. Any language that exports these functions and
//! its memory will do; arguments that are not needed may be left out at the end.
//!
//! World: x east, y north, z up. Robot and sensor: x ahead, y left, z up. Metres, radians, seconds. This one
//! drives towards the goal, and turns away from whatever rises more than 0.4 m within 3 m ahead.

use std::f64::consts::PI;
use std::sync::{Mutex, MutexGuard, PoisonError};

struct Planner {
    points_m: Vec<[f32; 3]>,
    max_speed_m_s: f64,
    max_turn_rate_rad_s: f64,
    sensor_height_m: f64,
    command: [f64; 2],
}

static PLANNER: Mutex<Planner> = Mutex::new(Planner {
    points_m: Vec::new(),
    max_speed_m_s: 0.0,
    max_turn_rate_rad_s: 0.0,
    sensor_height_m: 0.0,
    command: [0.0; 2],
});

fn planner() -> MutexGuard<'static, Planner> {
    PLANNER.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Told once, and may be absent. The roll, pitch and yaw of the sensor's mount would follow.
#[unsafe(no_mangle)]
pub extern "C" fn begin(
    max_speed_m_s: f64,
    max_turn_rate_rad_s: f64,
    _length_m: f64,
    _width_m: f64,
    _roll_limit_rad: f64,
    _pitch_limit_rad: f64,
    sensor_height_m: f64,
) {
    let mut own = planner();
    (own.max_speed_m_s, own.max_turn_rate_rad_s) = (max_speed_m_s, max_turn_rate_rad_s);
    own.sensor_height_m = sensor_height_m;
}

/// Room for so many returns: x, y, z of each in the sensor frame, as `f32`. They are there when `decide` is
/// called.
#[unsafe(no_mangle)]
pub extern "C" fn points(count: usize) -> *mut f32 {
    let mut own = planner();
    own.points_m.resize(count, [0.0; 3]);
    own.points_m.as_mut_ptr().cast()
}

/// Called for each scan. `goal_heading_rad` would follow; it is NaN where any heading will do.
#[unsafe(no_mangle)]
pub extern "C" fn decide(
    _count: usize,
    _time_s: f64,
    _elapsed_s: f64,
    x: f64,
    y: f64,
    _z: f64,
    _roll: f64,
    pitch: f64,
    yaw: f64,
    goal_x: f64,
    goal_y: f64,
) {
    let mut own = planner();
    // Left minus right: how much more is in the way on the left.
    let mut in_the_way = 0.0;
    for &[ahead_m, left_m, up_m] in &own.points_m {
        let [ahead_m, left_m, up_m] = [ahead_m, left_m, up_m].map(f64::from);
        let rise_m = up_m + own.sensor_height_m + ahead_m * pitch.sin();
        if ahead_m > 0.0 && ahead_m.hypot(left_m) < 3.0 && rise_m > 0.4 && left_m.abs() < ahead_m {
            in_the_way += left_m.signum() / ahead_m;
        }
    }
    let bearing_rad = (goal_y - y).atan2(goal_x - x) - yaw;
    let turn_rad = bearing_rad - 2.0 * PI * (bearing_rad / (2.0 * PI)).round() - 0.05 * in_the_way;
    let turn = (1.5 * turn_rad).clamp(-1.0, 1.0);
    own.command = [own.max_speed_m_s * (1.0 - turn.abs()), own.max_turn_rate_rad_s * turn];
}

/// The speed that was decided on, m/s.
#[unsafe(no_mangle)]
pub extern "C" fn linear_m_s() -> f64 {
    planner().command[0]
}

/// The turn rate that was decided on, rad/s, positive to the left.
#[unsafe(no_mangle)]
pub extern "C" fn angular_rad_s() -> f64 {
    planner().command[1]
}
