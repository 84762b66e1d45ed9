//! The same inputs as files, for the peers.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec2;
use mapless::gp::hyperparameters::Hyperparameters;
use mapless_world::{Caster, RING_COUNT, SensorConfig, ring_elevation_rad};

use crate::BenchError;
use crate::data::{
    CELL_M, farthest_points, hyperparameters, level_field, level_scan, queries, regression, rugged_field,
    sensor_pose,
};

/// Numbers of inducing inputs that the peers are asked for.
const INDUCING: [usize; 2] = [200, 400];
/// Samples along each side of the fields that the peers scan.
const SAMPLES: usize = 1000;

/// `inputs.json`.
#[derive(serde::Serialize)]
struct Inputs {
    hyperparameters: Hyperparameters,
    /// (azimuth, elevation), radians.
    inputs: Vec<[f64; 2]>,
    /// Occupancy, metres.
    targets: Vec<f64>,
    queries: Vec<[f64; 2]>,
    /// By their number.
    inducing: BTreeMap<usize, Vec<[f64; 2]>>,
    samples: usize,
    cell_m: f64,
    max_range_m: f64,
    /// Where the sensor is on each field, by name of the work.
    sensors_m: BTreeMap<String, [f64; 3]>,
}

/// Writes `inputs.json`, and as little-endian single precision the directions of the beams, `directions.f32`,
/// and the heights of each field, row by row from the south-west, `NAME.f32`.
///
/// # Errors
/// [`BenchError`] when a file cannot be written.
pub fn write_inputs(folder: &Path) -> Result<(), BenchError> {
    let (inputs, targets) = regression(&level_scan());
    let arrays = |points: &[DVec2]| points.iter().map(DVec2::to_array).collect::<Vec<_>>();
    let inducing = INDUCING.map(|count| (count, arrays(&farthest_points(&inputs, count))));
    let mut sensors_m = BTreeMap::new();
    for (name, field) in [("scan-rugged", rugged_field(SAMPLES)?), ("scan-level", level_field(SAMPLES)?)] {
        let name = format!("{name}-{SAMPLES}");
        write_f32(folder, &name, field.heights_m())?;
        sensors_m.insert(name, sensor_pose(&Caster::new(field)).position.to_array());
    }
    let sensor = SensorConfig::default();
    write_f32(folder, "directions", &directions(sensor.columns))?;
    let inputs = Inputs {
        hyperparameters: hyperparameters(),
        inputs: arrays(&inputs),
        targets,
        queries: arrays(&queries()),
        inducing: inducing.into(),
        samples: SAMPLES,
        cell_m: CELL_M,
        max_range_m: sensor.max_range_m,
        sensors_m,
    };
    let text = serde_json::to_string(&inputs).unwrap_or_default();
    write(folder, "inputs.json", text.as_bytes())
}

/// Unit vectors of the beams of an upright sensor that faces east, in the order of a scan's ranges.
fn directions(columns: usize) -> Vec<f32> {
    let mut numbers = Vec::with_capacity(3 * RING_COUNT * columns);
    for column in 0..columns {
        let azimuth = column as f64 * (std::f64::consts::TAU / columns as f64) - std::f64::consts::PI;
        for ring in 0..RING_COUNT {
            numbers.extend(crate::data::beam(azimuth, ring_elevation_rad(ring)).as_vec3().to_array());
        }
    }
    numbers
}

fn write_f32(folder: &Path, name: &str, numbers: &[f32]) -> Result<(), BenchError> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    write(folder, &format!("{name}.f32"), &bytes)
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), BenchError> {
    let path = folder.join(name);
    let wrong = |error: std::io::Error| BenchError::Write {
        file: path.display().to_string(),
        reason: error.to_string(),
    };
    std::fs::create_dir_all(folder).and_then(|()| std::fs::write(&path, bytes)).map_err(wrong)
}
