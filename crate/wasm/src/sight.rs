//! What a frame shows of a scan, and of what the planner made of it.

use glam::{DMat3, DVec3, Vec3};
use js_sys::{Float32Array, Uint8Array};
use mapless::skyline::beam_grid::BeamGrid;
use mapless::skyline::columns::COLUMNS;
use mapless::skyline::occupancy::OccupancySurface;
use mapless::skyline::profile::Column;
use mapless::skyline::scan_filter::ReturnKind;
use mapless::skyline::surface::PredictedSurface;
use mapless::{PlannerConfig, RobotModel, SensorModel};
use serde::{Deserialize, Serialize};
use tsify::Tsify;

use crate::{decision, returns};

/// Typed arrays that a frame fills, each as far as it goes.
#[derive(Debug, Deserialize, Tsify)]
pub struct FrameBuffers {
    /// LiDAR returns in the world frame: x, y, z of `Frame.returns` points.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    pub(crate) points: Float32Array,
    /// What the planner took each of them for: 0 surface, 1 invalid, 2 far, 3 the robot itself, 4 stray,
    /// 5 overhead.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Uint8Array<ArrayBuffer>")]
    pub(crate) return_kinds: Uint8Array,
    /// Observed occupancy in metres, azimuth-major from straight behind over the right, lowest ring first;
    /// NaN without a return.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    pub(crate) observed: Float32Array,
    /// Predicted occupancy in metres, azimuth-major likewise, the lowest row first.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    pub(crate) occupancy: Float32Array,
    /// Predictive variance as a share of the prior's, on the same lattice.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    pub(crate) variance: Float32Array,
    /// Elevation of the skyline in each column; NaN where there is none.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    pub(crate) profile: Float32Array,
    /// The skyline before somebody made the planner think again, likewise; NaN throughout where nobody did.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    pub(crate) former: Float32Array,
    /// The true skyline where it was asked for, NaN elsewhere: what endlessly many beams would show of
    /// the bare ground.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    pub(crate) truth: Float32Array,
    /// What each column shows: 0 ground, 1 unknown, 2 wall.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Uint8Array<ArrayBuffer>")]
    pub(crate) kinds: Uint8Array,
}

impl FrameBuffers {
    /// Places of the points in the world; returns how many fit.
    pub(crate) fn fill_points(
        &self,
        points_m: &[Vec3],
        sensor_m: DVec3,
        world_from_sensor: DMat3,
        scratch: &mut Vec<f32>,
    ) -> usize {
        let fit = self.points.length() as usize / 3;
        scratch.clear();
        for point_m in points_m.iter().take(fit) {
            let world_m = sensor_m + world_from_sensor * point_m.as_dvec3();
            scratch.extend(world_m.as_vec3().to_array());
        }
        send(scratch, &self.points);
        scratch.len() / 3
    }

    /// What no planner has seen yet counts as a surface.
    pub(crate) fn fill_return_kinds(&self, kinds: &[ReturnKind]) {
        let out = &self.return_kinds;
        let codes: Vec<u8> =
            kinds.iter().take(out.length() as usize).map(|&kind| returns::code(kind)).collect();
        out.fill(0, codes.len() as u32, out.length());
        out.subarray(0, codes.len() as u32).copy_from(&codes);
    }

    pub(crate) fn forget_profile(&self) {
        self.profile.fill(f32::NAN, 0, self.profile.length());
        self.kinds.fill(0, 0, self.kinds.length());
    }

    pub(crate) fn fill_profile(&self, columns: &[Column], scratch: &mut Vec<f32>) {
        scratch.clear();
        let elevations = columns.iter().take(self.profile.length() as usize);
        scratch.extend(elevations.map(decision::column_elevation_rad));
        send(scratch, &self.profile);
        let codes: Vec<u8> =
            columns.iter().take(self.kinds.length() as usize).map(decision::column_kind).collect();
        self.kinds.subarray(0, codes.len() as u32).copy_from(&codes);
    }

    /// Nothing was observed: occupancy 0 and variance 1.
    pub(crate) fn forget_surfaces(&self) {
        self.observed.fill(f32::NAN, 0, self.observed.length());
        self.occupancy.fill(0.0, 0, self.occupancy.length());
        self.variance.fill(1.0, 0, self.variance.length());
    }

    pub(crate) fn fill_observed(&self, seen: &OccupancySurface, scratch: &mut Vec<f32>) {
        scratch.clear();
        scratch.resize(self.observed.length() as usize, f32::NAN);
        for cell in seen.cells() {
            if let Some(place) = scratch.get_mut(cell.column * seen.rings() + cell.ring) {
                *place = cell.occupancy_m as f32;
            }
        }
        send(scratch, &self.observed);
    }

    pub(crate) fn fill_predicted(&self, surface: &PredictedSurface, scratch: &mut Vec<f32>) {
        for (values, out) in
            [(&surface.mean_m, &self.occupancy), (&surface.relative_variance, &self.variance)]
        {
            let fit = values.iter().take(out.length() as usize);
            scratch.clear();
            scratch.extend(fit.map(|&value| value as f32));
            send(scratch, out);
        }
    }
}

fn send(numbers: &[f32], out: &Float32Array) {
    out.subarray(0, numbers.len() as u32).copy_from(numbers);
}

/// A point or a direction in the world: x east, y north, z up.
#[derive(Debug, Serialize, Tsify)]
pub struct Point {
    x: f64,
    y: f64,
    z: f64,
}

impl From<DVec3> for Point {
    fn from(point: DVec3) -> Self {
        Self { x: point.x, y: point.y, z: point.z }
    }
}

/// Where the sensor is, and the directions of its axes: x forward, y to the left, z up.
#[derive(Debug, Serialize, Tsify)]
pub struct SensorPose {
    position: Point,
    x_axis: Point,
    y_axis: Point,
    z_axis: Point,
}

impl SensorPose {
    pub(crate) fn new(position: DVec3, axes: DMat3) -> Self {
        Self {
            position: position.into(),
            x_axis: axes.x_axis.into(),
            y_axis: axes.y_axis.into(),
            z_axis: axes.z_axis.into(),
        }
    }
}

/// Where the sensor sits on the robot and how it is turned there, as the planner is told.
#[derive(Debug, Serialize, Tsify)]
pub struct Mount {
    /// Ahead of the point on the ground between the wheels.
    forward_m: f64,
    left_m: f64,
    /// Above the ground contact, along the body's z axis.
    height_m: f64,
    /// Left side up; π upside down. The mount is turned by yaw, pitch, roll.
    roll_rad: f64,
    /// Nose-up.
    pitch_rad: f64,
    yaw_rad: f64,
}

impl From<&SensorModel> for Mount {
    fn from(sensor: &SensorModel) -> Self {
        Self {
            forward_m: sensor.forward_m,
            left_m: sensor.left_m,
            height_m: sensor.height_m,
            roll_rad: sensor.roll_rad,
            pitch_rad: sensor.pitch_rad,
            yaw_rad: sensor.yaw_rad,
        }
    }
}

/// How far the robot may tilt.
#[derive(Debug, Serialize, Tsify)]
pub struct TiltLimits {
    roll_rad: f64,
    pitch_rad: f64,
}

impl From<&RobotModel> for TiltLimits {
    fn from(robot: &RobotModel) -> Self {
        Self { roll_rad: robot.roll_limit_rad, pitch_rad: robot.pitch_limit_rad }
    }
}

/// Lattice of the predicted surfaces; the observed one has a row for each ring of the sensor.
#[derive(Debug, Serialize, Tsify)]
pub struct ImageSize {
    columns: usize,
    rows: usize,
    rings: usize,
}

impl From<&BeamGrid> for ImageSize {
    fn from(grid: &BeamGrid) -> Self {
        Self { columns: COLUMNS, rows: grid.rows(), rings: grid.rings() }
    }
}

/// What a segment must be to carry subgoals.
#[derive(Debug, Serialize, Tsify)]
pub struct SegmentDemands {
    /// Wider than the robot's width and the margin on it together.
    robot_width_m: f64,
    safety_margin_m: f64,
    /// The skyline no higher and no lower than this, seen from the sensor's foot.
    max_slope_rad: f64,
    /// Whether columns without a return may carry subgoals, on ground that earlier scans saw.
    subgoals_on_unknown: bool,
}

impl From<&PlannerConfig> for SegmentDemands {
    fn from(config: &PlannerConfig) -> Self {
        Self {
            robot_width_m: config.robot.width_m,
            safety_margin_m: config.segments.safety_margin_m,
            max_slope_rad: config.segments.max_slope_rad,
            subgoals_on_unknown: config.segments.subgoals_on_unknown,
        }
    }
}
