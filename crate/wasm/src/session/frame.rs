//! What the page shows of a tick.

use js_sys::Float32Array;
use mapless::skyline::columns::{COLUMNS, column_azimuth_rad};
use mapless_trials::PoseConfig;
use mapless_world::{Caster, Skyline, true_skyline};
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::what_if::Thought;
use super::{Moment, Session, TrueView, Truth};
use crate::decision::{self, Activity, PathPoint, Segment, Subgoal, Velocity};
use crate::objects::Solid;
use crate::returns::SetAside;
use crate::shared::{Metrics, Outcome, Pose, give, read};
use crate::sight::{FrameBuffers, SensorPose};

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
        let returns = self.fill_points(&buffers);
        buffers.fill_return_kinds(self.shown().return_kinds());
        self.fill_profile(&buffers);
        if surfaces {
            self.fill_surfaces(&buffers);
        }
        buffers.truth.fill(f32::NAN, 0, buffers.truth.length());
        if truth {
            self.fill_truth(&buffers.truth);
        }
        let decided = self.has_decided();
        let &Moment { ref trial, scanned_from, .. } = self.shown();
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
            sensor: SensorPose::new(scanned_from.position, scanned_from.world_from_sensor),
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
    fn fill_points(&mut self, buffers: &FrameBuffers) -> usize {
        let mut scratch = std::mem::take(&mut self.scratch);
        let Moment { trial, scanned_from, .. } = self.shown();
        let returns = buffers.fill_points(
            &trial.scan().points,
            scanned_from.position,
            scanned_from.world_from_sensor,
            &mut scratch,
        );
        self.scratch = scratch;
        returns
    }

    /// Whether there is a decision to show.
    fn has_decided(&self) -> bool {
        self.shown().trial.ticks() > 0 || self.rethought.is_some()
    }

    fn fill_profile(&mut self, buffers: &FrameBuffers) {
        buffers.former.fill(f32::NAN, 0, buffers.former.length());
        if let Some(rethought) = &self.rethought {
            let fit = rethought.former.len().min(buffers.former.length() as usize);
            buffers.former.subarray(0, fit as u32).copy_from(&rethought.former[..fit]);
        }
        if !self.has_decided() {
            buffers.forget_profile();
            return;
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        buffers.fill_profile(self.shown().trial.step().profile, &mut scratch);
        self.scratch = scratch;
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
        buffers.forget_surfaces();
        if !self.has_decided() {
            return;
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        buffers.fill_observed(self.shown().trial.step().observed, &mut scratch);
        if let Ok(surface) = self.shown_mut().trial.predicted_surface() {
            buffers.fill_predicted(surface, &mut scratch);
        }
        self.scratch = scratch;
    }
}
