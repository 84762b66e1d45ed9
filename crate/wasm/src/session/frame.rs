//! What the page shows of a tick.

use glam::DVec3;
use js_sys::{Float32Array, Uint8Array};
use mapless::skyline::columns::{COLUMNS, column_azimuth_rad};
use mapless_trials::PoseConfig;
use mapless_world::{Caster, Skyline, true_skyline};
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::tick::{Activity, Velocity};
use super::what_if::Thought;
use super::{Moment, Session, TrueView, Truth};
use crate::decision::{self, PathPoint, Segment, Subgoal};
use crate::objects::Solid;
use crate::returns::{self, SetAside};
use crate::shared::{Metrics, Outcome, Pose, give, read};

/// Everything that one tick saw, decided and did. At tick 0 there is a scan but no decision yet.
#[derive(Debug, Serialize, Tsify)]
pub struct Frame {
    tick: u64,
    time_s: f64,
    /// Whether what is sensed and decided here is the run's.
    thought: Thought,
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
    /// The skyline before somebody made the planner think again, likewise; NaN throughout where nobody did.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    former: Float32Array,
    /// The true skyline where it was asked for, NaN elsewhere: what endlessly many beams would show of
    /// the bare ground.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    truth: Float32Array,
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

impl TrueView {
    fn elevations_rad(&self, caster: &Caster) -> Vec<f32> {
        let &Self { ref pose, radius_m, between_rad } = self;
        let at = |column| match true_skyline(caster, pose, radius_m, column_azimuth_rad(column), between_rad)
        {
            Skyline::Ground { elevation_rad } => elevation_rad as f32,
            Skyline::Unknown | Skyline::Wall => f32::NAN,
        };
        (0..COLUMNS).map(at).collect()
    }
}

#[wasm_bindgen]
impl Session {
    /// The present state. Fills `buffers`; the surfaces only where `surfaces` is set, since predicting them
    /// takes longer than deciding, and the true skyline only where `truth` is.
    ///
    /// # Errors
    /// A start whose ground has gone.
    pub fn frame(
        &mut self,
        buffers: Ts<FrameBuffers>,
        surfaces: bool,
        truth: bool,
    ) -> Result<Ts<Frame>, JsError> {
        self.look_again()?;
        let buffers = read(buffers)?;
        let returns = self.fill_points(&buffers.points);
        self.fill_return_kinds(&buffers.return_kinds);
        self.fill_profile(&buffers);
        if surfaces {
            self.fill_surfaces(&buffers);
        }
        buffers.truth.fill(f32::NAN, 0, buffers.truth.length());
        if truth {
            self.fill_truth(&buffers.truth);
        }
        let decided = self.has_decided();
        let trial = &self.shown().trial;
        let (step, robot) = (trial.step(), trial.robot());
        give(&Frame {
            tick: trial.ticks(),
            time_s: trial.time_s(),
            thought: self.thought(),
            outcome: Outcome::of(trial),
            activity: step.status.into(),
            stop_reason: trial.end_reason(),
            pose: Pose::of(trial),
            believed: self.may_err_in_pose().then(|| trial.believed_pose().into()),
            v_m_s: robot.speed_m_s,
            omega_rad_s: robot.turn_rate_rad_s,
            command: step.command.into(),
            returns,
            set_aside: SetAside::of(self.shown().return_kinds()),
            mount_misfit: self.now.mount_misfit.clone(),
            sensor: self.shown().scanned_from.into(),
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
        let mapless_world::SensorPose { position, world_from_sensor } = self.shown().scanned_from;
        let fit = out.length() as usize / 3;
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.clear();
        for point in self.shown().trial.scan().points.iter().take(fit) {
            let world = position + world_from_sensor * point.as_dvec3();
            scratch.extend(world.as_vec3().to_array());
        }
        self.scratch = scratch;
        self.send(out);
        self.scratch.len() / 3
    }

    fn fill_return_kinds(&self, out: &Uint8Array) {
        let kinds = self.shown().return_kinds().iter().take(out.length() as usize);
        let codes: Vec<u8> = kinds.map(|&kind| returns::code(kind)).collect();
        // What no planner has seen yet counts as a surface.
        out.fill(0, codes.len() as u32, out.length());
        out.subarray(0, codes.len() as u32).copy_from(&codes);
    }

    /// Whether there is a decision to show.
    fn has_decided(&self) -> bool {
        self.shown().trial.ticks() > 0 || self.rethought.is_some()
    }

    fn fill_profile(&mut self, buffers: &FrameBuffers) {
        let (profile, kinds) = (&buffers.profile, &buffers.kinds);
        buffers.former.fill(f32::NAN, 0, buffers.former.length());
        if let Some(rethought) = &self.rethought {
            let fit = rethought.former.len().min(buffers.former.length() as usize);
            buffers.former.subarray(0, fit as u32).copy_from(&rethought.former[..fit]);
        }
        if !self.has_decided() {
            profile.fill(f32::NAN, 0, profile.length());
            kinds.fill(0, 0, kinds.length());
            return;
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        let columns = self.shown().trial.step().profile;
        scratch.clear();
        let elevations = columns.iter().take(profile.length() as usize);
        scratch.extend(elevations.map(decision::column_elevation_rad));
        let codes: Vec<u8> =
            columns.iter().take(kinds.length() as usize).map(decision::column_kind).collect();
        self.scratch = scratch;
        self.send(profile);
        kinds.subarray(0, codes.len() as u32).copy_from(&codes);
    }

    fn fill_truth(&mut self, out: &Float32Array) {
        let view = self.true_view();
        if self.truth.as_ref().is_none_or(|truth| truth.view != view) {
            let elevations = view.elevations_rad(self.shown().trial.caster());
            self.truth = Some(Truth { view, elevations });
        }
        let elevations = self.truth.as_ref().map_or(&[][..], |truth| &truth.elevations);
        let fit = elevations.len().min(out.length() as usize);
        out.subarray(0, fit as u32).copy_from(&elevations[..fit]);
    }

    /// From the place of the last scan, along the robot's axes as the planner sees it.
    fn true_view(&self) -> TrueView {
        let &Moment { ref trial, scanned_from, world_from_robot, .. } = self.shown();
        let config = trial.planner_config();
        let sensor = &config.sensor;
        TrueView {
            pose: mapless_world::SensorPose { world_from_sensor: world_from_robot, ..scanned_from },
            radius_m: config.perception.surface_radius_m,
            between_rad: [sensor.lowest_elevation_rad, sensor.highest_elevation_rad],
        }
    }

    /// Where there is no posterior, nothing was observed: 0 and 1.
    fn fill_surfaces(&mut self, buffers: &FrameBuffers) {
        let FrameBuffers { observed, occupancy, variance, .. } = buffers;
        observed.fill(f32::NAN, 0, observed.length());
        occupancy.fill(0.0, 0, occupancy.length());
        variance.fill(1.0, 0, variance.length());
        if !self.has_decided() {
            return;
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.clear();
        scratch.resize(observed.length() as usize, f32::NAN);
        let seen = self.shown().trial.step().observed;
        for cell in seen.cells() {
            if let Some(place) = scratch.get_mut(cell.column * seen.rings() + cell.ring) {
                *place = cell.occupancy_m as f32;
            }
        }
        observed.subarray(0, scratch.len() as u32).copy_from(&scratch);
        if let Ok(surface) = self.shown_mut().trial.predicted_surface() {
            for (values, out) in [(&surface.mean_m, occupancy), (&surface.relative_variance, variance)] {
                let fit = values.iter().take(out.length() as usize);
                scratch.clear();
                scratch.extend(fit.map(|&value| value as f32));
                out.subarray(0, scratch.len() as u32).copy_from(&scratch);
            }
        }
        self.scratch = scratch;
    }

    fn send(&self, out: &Float32Array) {
        out.subarray(0, self.scratch.len() as u32).copy_from(&self.scratch);
    }
}
