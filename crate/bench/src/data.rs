//! The inputs, computed so that they have the same bits on every target.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3, Vec3};
use mapless::PlannerConfig;
use mapless::gp::hyperparameters::Hyperparameters;
use mapless::skyline::beam_grid::BeamGrid;
use mapless::skyline::columns::{COLUMNS, column_azimuth_rad, column_of};
use mapless::skyline::occupancy::OccupancySurface;
use mapless_world::{Caster, HeightField, Object, Objects, SensorConfig, SensorPose, random};

use crate::BenchError;

/// Columns of a full scan, 0.2° apart.
const SCAN_COLUMNS: u32 = 1800;
/// Height of the sensor above the ground, metres.
const SENSOR_HEIGHT_M: f64 = 0.8;
/// Columns of the occupancy surface in which the sixth ring meets the ground within its radius.
const RISE: core::ops::Range<usize> = 169..192;
/// Rows of the predicted surface.
const QUERY_ROWS: u32 = 30;
/// Spacing of the height fields' samples, metres.
pub(crate) const CELL_M: f64 = 0.1;

/// The default preset's hyperparameters.
pub(crate) fn hyperparameters() -> Hyperparameters {
    let perception = PlannerConfig::default().perception;
    Hyperparameters { kernel: perception.kernel, noise_variance: perception.noise_variance_m2 }
}

/// A full scan in the sensor frame, of the ranges that `range_m` gives for azimuth and ring.
fn scan(range_m: impl Fn(f64, usize) -> Option<f64>) -> Vec<Vec3> {
    let mut points = Vec::new();
    for column in 0..SCAN_COLUMNS {
        let azimuth = f64::from(column) * (TAU / f64::from(SCAN_COLUMNS)) - PI;
        for ring in 0..SensorConfig::default().rings {
            if let Some(range_m) = range_m(azimuth, ring) {
                points.push(
                    (beam(azimuth, SensorConfig::default().ring_elevation_rad(ring)) * range_m).as_vec3(),
                );
            }
        }
    }
    points
}

/// Unit vector of a direction in the sensor frame.
pub(crate) fn beam(azimuth_rad: f64, elevation_rad: f64) -> DVec3 {
    let (sin_azimuth, cos_azimuth) = libm::sincos(azimuth_rad);
    let (sin, cos) = libm::sincos(elevation_rad);
    DVec3::new(cos * cos_azimuth, cos * sin_azimuth, sin)
}

/// Unit vectors of the beams of an upright sensor that faces east, in the order of a scan's ranges.
pub(crate) fn directions(sensor: &SensorConfig) -> impl Iterator<Item = DVec3> {
    (0..sensor.columns).flat_map(move |column| {
        let azimuth = column as f64 * (TAU / sensor.columns as f64) - PI;
        (0..sensor.rings).map(move |ring| beam(azimuth, sensor.ring_elevation_rad(ring)))
    })
}

/// Slightly undulating level ground with a rise ahead: five whole rings within 7 m and 23 columns of the
/// sixth, which makes 1823 occupied cells.
pub(crate) fn level_scan() -> Vec<Vec3> {
    scan(|azimuth, ring| {
        let downward = -libm::sin(SensorConfig::default().ring_elevation_rad(ring));
        if downward <= 0.0 {
            return None;
        }
        if ring == 5 && RISE.contains(&column_of(azimuth)) {
            return Some(6.9);
        }
        let undulation = 1.0 + 0.02 * libm::sin(3.0 * azimuth + ring as f64);
        Some(undulation * SENSOR_HEIGHT_M / downward)
    })
}

/// Level ground in an undulating round wall, 6 m away: all 28 800 beams return within 7 m and occupy all 5760
/// cells.
pub(crate) fn full_scan() -> Vec<Vec3> {
    scan(|azimuth, ring| {
        let elevation = SensorConfig::default().ring_elevation_rad(ring);
        let wall = 6.0 * (1.0 + 0.02 * libm::sin(5.0 * azimuth)) / libm::cos(elevation);
        let downward = -libm::sin(elevation);
        Some(if downward > 0.0 { wall.min(SENSOR_HEIGHT_M / downward) } else { wall })
    })
}

/// The training data of a scan: directions of its occupied cells, radians, and their occupancy, metres.
pub(crate) fn regression(points_m: &[Vec3]) -> (Vec<DVec2>, Vec<f64>) {
    let config = PlannerConfig::default();
    let mut observed =
        OccupancySurface::new(config.perception.surface_radius_m, BeamGrid::new(&config.sensor));
    observed.project(points_m);
    observed.cells().iter().map(|cell| (cell.direction_rad(), cell.occupancy_m)).unzip()
}

/// The cells of a surface of 360 columns and 30 rows, from -15° upward, one degree apart; radians.
pub(crate) fn queries() -> Vec<DVec2> {
    (0..COLUMNS)
        .flat_map(|column| {
            (0..QUERY_ROWS).map(move |row| {
                DVec2::new(column_azimuth_rad(column), (f64::from(row) - 15.0) * (PI / 180.0))
            })
        })
        .collect()
}

/// At most `count` of the inputs, each the farthest from those before it in length-scales (farthest-point
/// sampling); the first input comes first.
pub(crate) fn farthest_points(inputs: &[DVec2], count: usize) -> Vec<DVec2> {
    let [azimuth, elevation] = hyperparameters().kernel.length_scales_rad;
    let scale = DVec2::new(azimuth, elevation);
    let mut distances = vec![f64::INFINITY; inputs.len()];
    let mut chosen = Vec::with_capacity(count);
    let mut next = 0;
    while chosen.len() < count.min(inputs.len()) {
        let latest = inputs[next];
        chosen.push(latest);
        let mut farthest = 0.0;
        for (index, (input, distance)) in inputs.iter().zip(&mut distances).enumerate() {
            *distance = distance.min(((*input - latest) / scale).length_squared());
            if *distance > farthest {
                (next, farthest) = (index, *distance);
            }
        }
    }
    chosen
}

/// Square ground of `samples` × `samples` heights: hills with a centimetre of roughness.
pub(crate) fn rugged_field(samples: usize) -> Result<HeightField, BenchError> {
    let height_m = |column: usize, row: usize| {
        let (x, y) = (column as f64 * CELL_M, row as f64 * CELL_M);
        1.5 * libm::sin(x / 5.0) * libm::cos(y / 6.0)
            + 0.3 * libm::sin(1.3 * x + y)
            + 0.01 * random::gaussian(random::key(column as u64, row as u64))
    };
    let heights = (0..samples).flat_map(|row| (0..samples).map(move |column| height_m(column, row) as f32));
    Ok(HeightField::new(samples, samples, CELL_M, heights.collect())?)
}

/// Level ground of `samples` × `samples` heights.
pub(crate) fn level_field(samples: usize) -> Result<HeightField, BenchError> {
    Ok(HeightField::new(samples, samples, CELL_M, vec![0.0; samples * samples])?)
}

/// Objects on the ground.
const OBJECTS: u64 = 100;
/// They stand so far from the sensor, metres: out of its own place, and where a robot meets them.
const OBJECTS_FROM_M: [f64; 2] = [2.5, 30.0];

/// A hundred posts, boxes, rocks, walls and gates about the sensor, in turn.
pub(crate) fn objects(caster: &Caster) -> Objects {
    let middle = sensor_pose(caster).position.truncate();
    let object = |index: u64| {
        let share = |purpose| random::uniform(random::key(index, purpose));
        let [near, far] = OBJECTS_FROM_M.map(|from_m| from_m * from_m);
        // As many on every square metre.
        let away = beam(TAU * share(0), 0.0).truncate();
        let place = middle + away * (near + share(1) * (far - near)).sqrt();
        let (at, yaw_rad, size) = (place.to_array(), TAU * share(2), 0.5 + share(3));
        match index % 5 {
            0 => Object::Post { at, radius_m: 0.2 * size, height_m: 2.0 * size, walk: None },
            1 => {
                Object::Box { at, size_m: [size, 0.7 * size, 0.6 * size], yaw_rad, raised_m: 0.0, walk: None }
            }
            2 => Object::Rock { at, radius_m: 0.4 * size, sunk_m: 0.1 * size },
            3 => {
                let to = (place + 3.0 * size * away.perp()).to_array();
                Object::Wall { from: at, to, height_m: size, thickness_m: 0.2 }
            }
            _ => Object::Gate { at, yaw_rad, width_m: 1.2 * size, height_m: 1.2 * size },
        }
    };
    Objects::new((0..OBJECTS).map(object).collect(), caster.field())
}

/// An upright sensor near the middle of the terrain, facing east.
pub(crate) fn sensor_pose(caster: &Caster) -> SensorPose {
    let place = (0.5 * caster.field().extent_m()).floor() + DVec2::new(0.03, -0.02);
    let ground_m = caster.field().height_m(place).unwrap_or_default();
    SensorPose { position: place.extend(ground_m + SENSOR_HEIGHT_M), world_from_sensor: DMat3::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_fill_the_cells_they_promise() {
        assert_eq!(regression(&level_scan()).0.len(), 1823);
        let full = full_scan();
        assert_eq!(full.len(), 28_800);
        assert_eq!(regression(&full).0.len(), 5760);
        assert_eq!(queries().len(), 360 * 30);
    }

    #[test]
    fn farthest_points_differ_and_spread() {
        let (inputs, _) = regression(&level_scan());
        let chosen = farthest_points(&inputs, 200);
        assert_eq!(chosen.len(), 200);
        let [azimuth, elevation] = hyperparameters().kernel.length_scales_rad;
        let scale = DVec2::new(azimuth, elevation);
        let nearest = |point: &DVec2, others: &[DVec2]| {
            let distances = others.iter().map(|other| ((*point - *other) / scale).length());
            distances.fold(f64::INFINITY, f64::min)
        };
        let apart = (1..200).map(|k| nearest(&chosen[k], &chosen[..k])).fold(f64::INFINITY, f64::min);
        let covered = inputs.iter().map(|input| nearest(input, &chosen)).fold(0.0, f64::max);
        assert!(covered <= apart && apart > 0.5, "{covered} {apart}");
        assert_eq!(farthest_points(&inputs[..3], 9).len(), 3);
    }
}
