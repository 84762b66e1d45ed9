//! What the page shows of a tick.

use glam::DVec3;
use js_sys::{Float32Array, Uint8Array};
use mapless_trials::PoseConfig;
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::Session;
use super::tick::{Activity, Velocity};
use crate::decision::{self, PathPoint, Segment, Subgoal};
use crate::objects::Solid;
use crate::returns::{self, SetAside};
use crate::shared::{Metrics, Outcome, Pose, give, read};

/// Everything that one tick saw, decided and did. At tick 0 there is a scan but no decision yet.
#[derive(Debug, Serialize, Tsify)]
pub struct Frame {
    tick: u64,
    time_s: f64,
    outcome: Outcome,
    activity: Activity,
    /// Why the planner stopped, or what the body touched, where the trial ended so.
    stop_reason: Option<String>,
    pose: Pose,
    /// Where the robot believes to be; absent where nothing is wrong with that.
    believed: Option<Pose>,
    v_m_s: f64,
    omega_rad_s: f64,
    command: Velocity,
    /// Points in `FrameBuffers.points`.
    returns: usize,
    set_aside: SetAside,
    /// Where the ground in the first scan does not fit the mount of the sensor: what to do about it.
    mount_misfit: Option<String>,
    /// Where the scan was taken.
    sensor: SensorPose,
    /// Share of the prior variance above which space counts as free.
    threshold: f64,
    segments: Vec<Segment>,
    subgoals: Vec<Subgoal>,
    /// The path to the chosen subgoal, from where the robot stands; empty without one, and where subgoals are
    /// judged by the paper's height alone.
    path: Vec<PathPoint>,
    metrics: Metrics,
    /// From where the robot truly is, seen from above.
    distance_to_goal_m: f64,
    /// Digest of the whole trajectory so far; the command line prints the same one.
    digest: String,
    timeline: Timeline,
    waypoints_passed: usize,
    /// The shapes that walk, where they are now.
    movers: Vec<Solid>,
}

/// Typed arrays that a frame fills, each as far as it goes.
#[derive(Debug, Deserialize, Tsify)]
pub struct FrameBuffers {
    /// LiDAR returns in the world frame: x, y, z of `Frame.returns` points.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    points: Float32Array,
    /// What the planner took each of them for: 0 surface, 1 invalid, 2 far, 3 the robot itself, 4 stray,
    /// 5 overhead.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Uint8Array<ArrayBuffer>")]
    return_kinds: Uint8Array,
    /// Observed occupancy in metres, azimuth-major from straight behind over the right, lowest ring first;
    /// NaN without a return.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    observed: Float32Array,
    /// Predicted occupancy in metres, azimuth-major likewise, the lowest row first.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    occupancy: Float32Array,
    /// Predictive variance as a share of the prior's, on the same lattice.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    variance: Float32Array,
    /// Elevation of the skyline in each column; NaN where there is none.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    profile: Float32Array,
    /// What each column shows: 0 ground, 1 unknown, 2 wall.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Uint8Array<ArrayBuffer>")]
    kinds: Uint8Array,
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

impl From<mapless_world::SensorPose> for SensorPose {
    fn from(pose: mapless_world::SensorPose) -> Self {
        let axes = pose.world_from_sensor;
        Self {
            position: pose.position.into(),
            x_axis: axes.x_axis.into(),
            y_axis: axes.y_axis.into(),
            z_axis: axes.z_axis.into(),
        }
    }
}

/// Where in time one can go, in ticks.
#[derive(Debug, Serialize, Tsify)]
pub struct Timeline {
    first: u64,
    end: u64,
    /// Where the route was changed.
    #[tsify(type = "readonly number[]")]
    changes: Vec<u64>,
}

#[wasm_bindgen]
impl Session {
    /// The present state. Fills `buffers`; the surfaces only where `surfaces` is set, since predicting them
    /// takes longer than deciding.
    ///
    /// # Errors
    /// A start whose ground has gone.
    pub fn frame(&mut self, buffers: Ts<FrameBuffers>, surfaces: bool) -> Result<Ts<Frame>, JsError> {
        self.look_again()?;
        let buffers = read(buffers)?;
        let returns = self.fill_points(&buffers.points);
        self.fill_return_kinds(&buffers.return_kinds);
        self.fill_profile(&buffers);
        if surfaces {
            self.fill_surfaces(&buffers);
        }
        let trial = &self.now.trial;
        let (step, robot) = (trial.step(), trial.robot());
        let decided = trial.ticks() > 0;
        give(&Frame {
            tick: trial.ticks(),
            time_s: trial.time_s(),
            outcome: Outcome::of(trial),
            activity: step.status.into(),
            stop_reason: trial.end_reason(),
            pose: Pose::of(trial),
            believed: self.may_err_in_pose().then(|| trial.believed_pose().into()),
            v_m_s: robot.speed_m_s,
            omega_rad_s: robot.turn_rate_rad_s,
            command: step.command.into(),
            returns,
            set_aside: SetAside::of(self.now.return_kinds()),
            mount_misfit: self.now.mount_misfit.clone(),
            sensor: self.now.scanned_from.into(),
            threshold: trial.planner_config().perception.variance_threshold,
            segments: if decided { decision::segments(&step) } else { Vec::new() },
            subgoals: if decided { decision::subgoals(&step) } else { Vec::new() },
            path: if decided { decision::path(&step) } else { Vec::new() },
            metrics: Metrics::of(trial),
            distance_to_goal_m: trial.true_distance_to_goal_m(),
            digest: self.digest(),
            timeline: self.timeline(),
            waypoints_passed: trial.waypoints_passed(),
            movers: trial.objects().moving().map(Solid::from).collect(),
        })
    }

    /// Digest of the trajectory so far.
    pub fn digest(&self) -> String {
        self.now.trial.digest()
    }

    fn may_err_in_pose(&self) -> bool {
        self.running.reality.pose != PoseConfig::default()
    }

    fn timeline(&self) -> Timeline {
        let now = self.now.trial.ticks();
        self.history.as_ref().map_or(Timeline { first: now, end: now, changes: Vec::new() }, |history| {
            Timeline {
                first: history.first_tick(),
                end: history.end_tick(),
                changes: history.changes().collect(),
            }
        })
    }

    /// Returns how many points fit.
    fn fill_points(&mut self, out: &Float32Array) -> usize {
        let mapless_world::SensorPose { position, world_from_sensor } = self.now.scanned_from;
        let fit = out.length() as usize / 3;
        self.scratch.clear();
        for point in self.now.trial.scan().points.iter().take(fit) {
            let world = position + world_from_sensor * point.as_dvec3();
            self.scratch.extend(world.as_vec3().to_array());
        }
        self.send(out);
        self.scratch.len() / 3
    }

    fn fill_return_kinds(&self, out: &Uint8Array) {
        let kinds = self.now.return_kinds().iter().take(out.length() as usize);
        let codes: Vec<u8> = kinds.map(|&kind| returns::code(kind)).collect();
        // What no planner has seen yet counts as a surface.
        out.fill(0, codes.len() as u32, out.length());
        out.subarray(0, codes.len() as u32).copy_from(&codes);
    }

    fn fill_profile(&mut self, buffers: &FrameBuffers) {
        let (profile, kinds) = (&buffers.profile, &buffers.kinds);
        if self.now.trial.ticks() == 0 {
            profile.fill(f32::NAN, 0, profile.length());
            kinds.fill(0, 0, kinds.length());
            return;
        }
        let columns = self.now.trial.step().profile;
        self.scratch.clear();
        let elevations = columns.iter().take(profile.length() as usize);
        self.scratch.extend(elevations.map(decision::column_elevation_rad));
        let codes: Vec<u8> =
            columns.iter().take(kinds.length() as usize).map(decision::column_kind).collect();
        self.send(profile);
        kinds.subarray(0, codes.len() as u32).copy_from(&codes);
    }

    /// Where there is no posterior, nothing was observed: 0 and 1.
    fn fill_surfaces(&mut self, buffers: &FrameBuffers) {
        let FrameBuffers { observed, occupancy, variance, .. } = buffers;
        observed.fill(f32::NAN, 0, observed.length());
        occupancy.fill(0.0, 0, occupancy.length());
        variance.fill(1.0, 0, variance.length());
        if self.now.trial.ticks() == 0 {
            return;
        }
        self.scratch.clear();
        self.scratch.resize(observed.length() as usize, f32::NAN);
        let rings = self.now.trial.step().observed.grid().rings();
        for cell in self.now.trial.step().observed.cells() {
            if let Some(place) = self.scratch.get_mut(cell.column * rings + cell.ring) {
                *place = cell.occupancy_m as f32;
            }
        }
        self.send(observed);
        let Ok(surface) = self.now.trial.predicted_surface() else { return };
        for (values, out) in [(&surface.mean_m, occupancy), (&surface.relative_variance, variance)] {
            let fit = values.iter().take(out.length() as usize);
            self.scratch.clear();
            self.scratch.extend(fit.map(|&value| value as f32));
            out.subarray(0, self.scratch.len() as u32).copy_from(&self.scratch);
        }
    }

    fn send(&self, out: &Float32Array) {
        out.subarray(0, self.scratch.len() as u32).copy_from(&self.scratch);
    }
}
