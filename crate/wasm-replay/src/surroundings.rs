//! Heights around the robot, by the returns of one scan. Nobody knows the ground of a recording: these only
//! say how high marks stand.

use glam::{DMat3, DVec2, DVec3, Vec3};
use js_sys::Float32Array;
use mapless::skyline::scan_filter::ReturnKind;
use serde::Serialize;
use tsify::Tsify;

/// Samples of a side, and their spacing.
const SIDE: usize = 41;
const CELL_M: f64 = 0.5;

/// A square of heights around the robot: row by row, each from west to east, the southern row first.
#[derive(Debug, Serialize, Tsify)]
pub struct Surroundings {
    columns: usize,
    rows: usize,
    cell_m: f64,
    /// The south-western corner.
    origin: [f64; 2],
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    heights_m: Float32Array,
}

/// The lowest return of each cell; others take the mean of their neighbours, from cells with returns on.
pub(crate) fn around(
    robot_m: DVec3,
    points_m: &[Vec3],
    kinds: &[ReturnKind],
    sensor_m: DVec3,
    world_from_sensor: DMat3,
) -> Surroundings {
    let half_m = CELL_M * (SIDE / 2) as f64;
    let corner_m = ((robot_m.truncate() - DVec2::splat(half_m)) / CELL_M).round() * CELL_M;
    let mut heights_m = vec![f64::NAN; SIDE * SIDE];
    for (index, point_m) in points_m.iter().enumerate() {
        if kinds.get(index).is_some_and(|kind| !matches!(kind, ReturnKind::Surface | ReturnKind::Far)) {
            continue;
        }
        let place_m = sensor_m + world_from_sensor * point_m.as_dvec3();
        let cell = ((place_m.truncate() - corner_m) / CELL_M).round();
        if cell.min_element() >= 0.0 && cell.max_element() < SIDE as f64 {
            let height_m = &mut heights_m[cell.y as usize * SIDE + cell.x as usize];
            *height_m = height_m.min(place_m.z);
        }
    }
    // The robot stands on the ground.
    heights_m[SIDE / 2 * SIDE + SIDE / 2] = robot_m.z;
    for _ in 0..SIDE {
        if !spread(&mut heights_m) {
            break;
        }
    }
    let heights_m: Vec<f32> = heights_m.iter().map(|&height_m| height_m as f32).collect();
    Surroundings {
        columns: SIDE,
        rows: SIDE,
        cell_m: CELL_M,
        origin: corner_m.to_array(),
        heights_m: Float32Array::from(&heights_m[..]),
    }
}

/// Gives cells without a height the mean of their neighbours; whether there were any.
fn spread(heights_m: &mut [f64]) -> bool {
    let before = heights_m.to_vec();
    for (index, height_m) in heights_m.iter_mut().enumerate().filter(|(_, height_m)| height_m.is_nan()) {
        let (row, column) = ((index / SIDE) as isize, (index % SIDE) as isize);
        let beside = [(-1, 0), (1, 0), (0, -1), (0, 1)].map(|(north, east)| {
            let (row, column) = (row + north, column + east);
            let inside = (0..SIDE as isize).contains(&row) && (0..SIDE as isize).contains(&column);
            if inside { before[row as usize * SIDE + column as usize] } else { f64::NAN }
        });
        let known = beside.iter().filter(|beside_m| !beside_m.is_nan());
        *height_m = known.clone().sum::<f64>() / known.count() as f64;
    }
    before.iter().any(|height_m| height_m.is_nan())
}
