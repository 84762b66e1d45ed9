//! The same inputs as files, for the peers.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec2;
use mapless::gp::hyperparameters::Hyperparameters;
use mapless_world::{Caster, SensorConfig, Shape, Solid};

use crate::BenchError;
use crate::data::{
    CELL_M, directions, farthest_points, hyperparameters, level_field, level_scan, objects, queries,
    regression, rugged_field, sensor_pose,
};

/// Numbers of inducing inputs that the peers use.
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
    /// Position of the sensor on each field, by name of the benchmark.
    sensors_m: BTreeMap<String, [f64; 3]>,
    /// What stands on each field.
    solids: BTreeMap<String, Vec<PeerSolid>>,
}

/// A solid, with its centre in the world; metres and radians.
#[derive(serde::Serialize)]
#[serde(tag = "shape", rename_all = "snake_case")]
enum PeerSolid {
    Cuboid { centre_m: [f64; 3], half_m: [f64; 3], sin_cos_yaw: (f64, f64) },
    Cylinder { centre_m: [f64; 3], radius_m: f64, half_height_m: f64 },
    Ball { centre_m: [f64; 3], radius_m: f64 },
}

impl PeerSolid {
    fn of(solid: &Solid) -> Self {
        let centre_m = solid.centre_m.to_array();
        match solid.shape {
            Shape::Cuboid { half_m, sin_cos_yaw } => {
                Self::Cuboid { centre_m, half_m: half_m.to_array(), sin_cos_yaw }
            }
            Shape::Cylinder { radius_m, half_height_m } => {
                Self::Cylinder { centre_m, radius_m, half_height_m }
            }
            Shape::Ball { radius_m } => Self::Ball { centre_m, radius_m },
        }
    }
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
    let mut solids = BTreeMap::new();
    for (name, field) in [
        ("scan-rugged", rugged_field(SAMPLES)?),
        ("scan-level", level_field(SAMPLES)?),
        ("scan-objects", rugged_field(SAMPLES)?),
    ] {
        let name = format!("{name}-{SAMPLES}");
        write_f32(folder, &name, field.heights_m())?;
        let caster = Caster::new(field);
        sensors_m.insert(name.clone(), sensor_pose(&caster).position.to_array());
        if name.starts_with("scan-objects") {
            solids.insert(name, objects(&caster).solids().iter().map(PeerSolid::of).collect());
        }
    }
    let sensor = SensorConfig::default();
    let beams: Vec<f32> = directions(&sensor).flat_map(|beam| beam.as_vec3().to_array()).collect();
    write_f32(folder, "directions", &beams)?;
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
        solids,
    };
    let text = serde_json::to_string(&inputs).unwrap_or_default();
    write(folder, "inputs.json", text.as_bytes())
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
