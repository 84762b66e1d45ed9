//! One loaded scenario.

use glam::DVec2;
use js_sys::{Float32Array, Uint8Array};
use mapless::learning::LearningMode;
use mapless::occupancy::{COLUMNS, RINGS};
use mapless::perception::ROWS;
use mapless::{Navigator as _, Status, StopReason};
use mapless_trials::{History, Preset, Scenario, StartPose, Trial, parameters};
use mapless_world::{HeightField, SensorPose};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::{encode, ground};

/// A copy of the trial is kept this often, and farther apart once there are more than this many.
const COPY_EVERY_TICKS: u64 = 10;
const MOST_COPIES: usize = 96;

/// A running trial and the places where its numbers are gathered.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Session {
    pub(crate) now: Moment,
    /// Where the trial has been since its start or since the ground changed; there is none before the first decision.
    pub(crate) history: Option<History<Moment>>,
    seed: u64,
    preset: Preset,
    learning: Option<LearningMode>,
    /// The scenario as its file has it.
    file: Scenario,
    /// Every parameter with the value of the file, as JSON.
    parameters: String,
    scratch: Vec<f32>,
}

/// All that belongs to one point in time.
#[derive(Clone, Debug)]
pub(crate) struct Moment {
    pub(crate) trial: Trial,
    /// Where the last scan was taken: the robot has moved on since.
    scanned_from: SensorPose,
}

impl Moment {
    fn new(trial: Trial) -> Self {
        let scanned_from = sensor_pose(&trial);
        let mut moment = Self { trial, scanned_from };
        moment.look();
        moment
    }

    fn look(&mut self) {
        self.scanned_from = sensor_pose(&self.trial);
        self.trial.look_far();
    }
}

#[wasm_bindgen]
impl Session {
    /// Loads a scenario. `imported` is the file that the terrain's recipe imports, empty when it imports none. `learning` is
    /// `fixed`, `once` or `every_scan`; without it, or a `seed`, it is the scenario's own.
    ///
    /// # Errors
    /// A fault in one of the files, or an unknown preset or mode of learning, with place, value and expectation.
    #[wasm_bindgen(constructor)]
    #[expect(
        clippy::too_many_arguments,
        reason = "JavaScript hands over plain values: two files, what one imports, and settings"
    )]
    pub fn new(
        scenario_file: &str,
        scenario_toml: &str,
        terrain_file: &str,
        terrain: &[u8],
        imported: &[u8],
        preset: &str,
        learning: Option<String>,
        seed: Option<u64>,
    ) -> Result<Session, JsError> {
        let file = Scenario::parse(scenario_file, scenario_toml)?;
        let preset: Preset = preset.parse().map_err(|reason: String| JsError::new(&reason))?;
        let terrain = ground::load(terrain_file, terrain, imported)?;
        let learning: Option<LearningMode> =
            learning.map(|mode| mode.parse()).transpose().map_err(|reason: String| JsError::new(&reason))?;
        let seed = seed.unwrap_or(file.seed);
        let trial = trial(terrain.field, &file, preset, learning, seed)?;
        let parameters = parameters::json(&parameters::values(&file, &file, preset)?);
        Ok(Session {
            now: Moment::new(trial),
            history: None,
            seed,
            preset,
            learning,
            file,
            parameters,
            scratch: Vec::new(),
        })
    }

    /// Begins anew with other parameters: `sections` is TOML with nothing but `[planner]`, `[sensor]` and `[robot]`. Ground,
    /// start and route stay as they are, and so does the seed unless another is given.
    ///
    /// # Errors
    /// A value that makes no sense, with its place and what was expected; nothing then changes.
    pub fn set_parameters(&mut self, sections: &str, seed: Option<u64>) -> Result<(), JsError> {
        let running = self.file.with_parameters("settings", sections)?;
        let parameters = parameters::json(&parameters::values(&self.file, &running, self.preset)?);
        let (now, seed) = (&self.now.trial, seed.unwrap_or(self.seed));
        let mut trial = trial(now.field().clone(), &running, self.preset, self.learning, seed)?;
        trial.set_start(now.start())?;
        trial.set_route(now.waypoints_m().to_vec(), now.goal_m())?;
        (self.now, self.history) = (Moment::new(trial), None);
        (self.parameters, self.seed) = (parameters, seed);
        Ok(())
    }

    /// Every parameter as JSON, with the value of the scenario file: see [`mapless_trials::parameters::json`].
    pub fn parameters(&self) -> String {
        self.parameters.clone()
    }

    /// The seed of the sensor's noise.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// What changes only between trials: start x, y, heading; goal x, y; limits of roll and pitch; radius of the occupancy
    /// surface; height of the sensor; columns and rows of the variance image; rings of the sensor; robot width and safety
    /// margin on it; steepest slope of a segment; whether unknown segments may carry subgoals (0 or 1); time between two
    /// ticks; then x, y of each waypoint.
    pub fn scene(&self) -> Vec<f64> {
        let config = self.now.trial.planner_config();
        let StartPose { position_m, heading_rad } = self.now.trial.start();
        let goal_m = self.now.trial.goal_m();
        let mut values = vec![
            position_m.x,
            position_m.y,
            heading_rad,
            goal_m.x,
            goal_m.y,
            config.limits.roll_rad,
            config.limits.pitch_rad,
            config.perception.surface_radius_m,
            config.mount.height_m,
            COLUMNS as f64,
            ROWS as f64,
            RINGS as f64,
            config.robot_width_m,
            config.segments.safety_margin_m,
            config.segments.max_slope_rad,
            f64::from(u8::from(config.segments.subgoals_on_unknown)),
            config.period_s,
        ];
        values.extend(self.now.trial.waypoints_m().iter().flat_map(|place| place.to_array()));
        values
    }

    /// Columns of the height field, west to east.
    pub fn columns(&self) -> usize {
        self.now.trial.field().columns()
    }

    /// Rows of the height field, south to north.
    pub fn rows(&self) -> usize {
        self.now.trial.field().rows()
    }

    /// Spacing of the height field.
    pub fn cell_m(&self) -> f64 {
        self.now.trial.field().cell_m()
    }

    /// The height field's samples within a rectangle, row by row from the south-west.
    ///
    /// # Errors
    /// A rectangle that is not within the field.
    pub fn heights(
        &self,
        column: usize,
        row: usize,
        columns: usize,
        rows: usize,
    ) -> Result<Vec<f32>, JsError> {
        let field = self.now.trial.field();
        let inside = |begin: usize, length: usize, end: usize| begin <= end && length <= end - begin;
        if !(inside(column, columns, field.columns()) && inside(row, rows, field.rows())) {
            return Err(JsError::new("the rectangle of heights: expected one within the field"));
        }
        let lines = field.heights_m().chunks_exact(field.columns()).skip(row).take(rows);
        Ok(lines.flat_map(|line| &line[column..column + columns]).copied().collect())
    }

    /// Back to the start, with ground, start and goal as they are now.
    ///
    /// # Errors
    /// A start whose ground has gone.
    pub fn restart(&mut self) -> Result<(), JsError> {
        self.begin_from(self.now.trial.start())
    }

    /// Begins anew from another start.
    ///
    /// # Errors
    /// A start off the terrain; nothing then changes.
    pub fn set_start(&mut self, x: f64, y: f64, heading_rad: f64) -> Result<(), JsError> {
        self.begin_from(StartPose { position_m: DVec2::new(x, y), heading_rad })
    }

    fn begin_from(&mut self, start: StartPose) -> Result<(), JsError> {
        self.now.trial.set_start(start)?;
        self.history = None;
        self.look();
        Ok(())
    }

    /// Sets another goal, with waypoints (x, y of each) before it, and drives on.
    ///
    /// # Errors
    /// A place off the terrain; nothing then changes.
    pub fn set_route(&mut self, waypoints: &[f64], x: f64, y: f64) -> Result<(), JsError> {
        let waypoints_m = waypoints.chunks_exact(2).map(DVec2::from_slice).collect();
        self.now.trial.set_route(waypoints_m, DVec2::new(x, y))?;
        if let Some(history) = &mut self.history {
            history.changed(self.now.trial.ticks(), &self.now);
        }
        Ok(())
    }

    /// Goes back to `tick` or shortly before it; running forward from there repeats what happened. Later ticks than were
    /// ever reached are not gone to.
    pub fn go_back(&mut self, tick: u64) {
        let Some(history) = &self.history else { return };
        let Some(copy) = history.at_or_before(tick) else { return };
        let now = self.now.trial.ticks();
        if now > tick || copy.trial.ticks() > now {
            self.now.clone_from(copy);
        }
    }

    /// First and last tick that can be gone to, then the ticks at which the route was changed.
    pub fn timeline(&self) -> Vec<f64> {
        let now = self.now.trial.ticks();
        let Some(history) = &self.history else { return vec![now as f64, now as f64] };
        let ends = [history.first_tick(), history.end_tick()];
        ends.into_iter().chain(history.changes()).map(|tick| tick as f64).collect()
    }

    /// First part of a tick: takes a scan from where the robot stands.
    pub fn look(&mut self) {
        self.now.look();
    }

    /// Second part: the planner decides. Apart from the others so that the page can time it.
    pub fn plan(&mut self) {
        let tick = self.now.trial.ticks();
        self.history.get_or_insert_with(|| History::new(COPY_EVERY_TICKS, MOST_COPIES, tick, &self.now));
        self.now.trial.plan();
    }

    /// What the record of a run keeps of a tick, read between [`Session::plan`] and [`Session::act`]: tick, time; x, y, z,
    /// roll, pitch, yaw; speed, turn rate; the commanded speed and turn rate; the subgoal's x and y, NaN without one; what
    /// the planner does (0 driving, 1 arrived, 2 looking, 3 stopped); mean vibration and mean elevation rate so far.
    pub fn row(&self) -> Vec<f64> {
        let (trial, step) = (&self.now.trial, self.now.trial.step());
        let metrics = trial.metrics();
        let subgoal_m = trial.navigator().subgoal_m().unwrap_or(DVec2::NAN);
        let activity = match step.status {
            Status::Driving => 0.0,
            Status::Arrived => 1.0,
            Status::Looking => 2.0,
            Status::Stopped(_) => 3.0,
        };
        let mut values = vec![trial.ticks() as f64, trial.time_s()];
        values.extend(trial.motion());
        values.extend([
            step.command.linear_m_s,
            step.command.angular_rad_s,
            subgoal_m.x,
            subgoal_m.y,
            activity,
            metrics.mean_vibration_rad_s,
            metrics.mean_elevation_rate_cm_s,
        ]);
        values
    }

    /// Third part: the robot moves. Returns whether the trial goes on.
    pub fn act(&mut self) -> bool {
        self.now.trial.act();
        let tick = self.now.trial.ticks();
        if let Some(changed) = self.history.as_mut().and_then(|history| history.reached(tick, &self.now)) {
            self.now.clone_from(changed);
        }
        self.now.trial.outcome().is_none()
    }

    /// Tick, time; x, y, z, roll, pitch, yaw; speed, turn rate; the commanded speed and turn rate; variance threshold; the
    /// six metrics in the order of [`mapless_trials::Metrics`]; how many waypoints the robot has been to.
    pub fn status(&self) -> Vec<f64> {
        let trial = &self.now.trial;
        let (command, metrics) = (trial.step().command, trial.metrics());
        let mut values = vec![trial.ticks() as f64, trial.time_s()];
        values.extend(trial.motion());
        values.extend([
            command.linear_m_s,
            command.angular_rad_s,
            trial.planner_config().perception.variance_threshold,
            metrics.distance_m,
            metrics.max_abs_roll_rad,
            metrics.max_abs_pitch_rad,
            metrics.mean_vibration_rad_s,
            metrics.mean_elevation_rate_cm_s,
            metrics.curvature_change_rad_m,
            trial.waypoints_passed() as f64,
        ]);
        values
    }

    /// How the trial ended, or `running`.
    pub fn outcome(&self) -> String {
        self.now.trial.outcome().map_or("running", |outcome| outcome.name()).to_owned()
    }

    /// What the planner does: `driving`, `arrived`, `looking` or `stopped`.
    pub fn activity(&self) -> String {
        match self.now.trial.step().status {
            Status::Driving => "driving",
            Status::Arrived => "arrived",
            Status::Looking => "looking",
            Status::Stopped(_) => "stopped",
        }
        .to_owned()
    }

    /// Why the planner stopped, where it did.
    pub fn stop_reason(&self) -> Option<String> {
        self.now.trial.stop_reason().map(|reason: StopReason| reason.to_string())
    }

    /// Digest of the trajectory so far.
    pub fn digest(&self) -> String {
        self.now.trial.digest()
    }

    /// The last scan's returns in the world frame, x, y, z of each, as many as `out` holds. Returns how many points.
    pub fn points(&mut self, out: &Float32Array) -> usize {
        let SensorPose { position, world_from_sensor } = self.now.scanned_from;
        let fit = out.length() as usize / 3;
        self.scratch.clear();
        for point in self.now.trial.scan().points.iter().take(fit) {
            let world = position + world_from_sensor * point.as_dvec3();
            self.scratch.extend(world.as_vec3().to_array());
        }
        self.send(out);
        self.scratch.len() / 3
    }

    /// Where the last scan was taken: the sensor's world position, then the world directions of its x, y and z axes.
    pub fn world_from_sensor(&self) -> Vec<f64> {
        let SensorPose { position, world_from_sensor } = self.now.scanned_from;
        let axes = world_from_sensor.to_cols_array();
        position.to_array().into_iter().chain(axes).collect()
    }

    /// Both surfaces that the Gaussian process predicts, column by column from straight behind over the right, lowest row
    /// first, as much as each `out` holds: the reconstructed occupancy in metres, and the variance as a share of the signal
    /// variance. Predicted only now, since a step needs no more than the variance's edge. Where there is no posterior, nothing
    /// was observed: 0 and 1.
    pub fn surfaces(&mut self, occupancy_out: &Float32Array, variance_out: &Float32Array) {
        let sizes = [occupancy_out, variance_out].map(|out| out.length() as usize);
        self.scratch.clear();
        self.scratch.resize(sizes[0], 0.0);
        let mut variance = vec![1.0; sizes[1]];
        if let Ok(surface) = self.now.trial.predicted_surface() {
            narrow(&surface.mean_m, &mut self.scratch);
            narrow(&surface.relative_variance, &mut variance);
        }
        self.send(occupancy_out);
        variance_out.copy_from(&variance);
    }

    /// The observed occupancy surface in metres, column by column from straight behind over the right, lowest ring first, NaN
    /// where there was no return within its radius; as much as `out` holds.
    pub fn observed(&mut self, out: &Float32Array) {
        self.scratch.clear();
        self.scratch.resize(out.length() as usize, f32::NAN);
        for cell in self.now.trial.step().observed.cells() {
            if let Some(place) = self.scratch.get_mut(cell.column * RINGS + cell.ring) {
                *place = cell.occupancy_m as f32;
            }
        }
        self.send(out);
    }

    /// Elevation of the skyline in each column, NaN where there is none; as much as `out` holds.
    pub fn profile(&mut self, out: &Float32Array) {
        self.scratch.clear();
        let profile = self.now.trial.step().profile;
        self.scratch.extend(profile.iter().take(out.length() as usize).map(encode::column_elevation_rad));
        self.send(out);
    }

    fn send(&self, out: &Float32Array) {
        out.subarray(0, self.scratch.len() as u32).copy_from(&self.scratch);
    }

    /// What each column shows: 0 ground, 1 unknown, 2 wall; as much as `out` holds.
    pub fn kinds(&self, out: &Uint8Array) {
        let profile = self.now.trial.step().profile;
        let kinds: Vec<u8> = profile.iter().take(out.length() as usize).map(encode::column_kind).collect();
        out.subarray(0, kinds.len() as u32).copy_from(&kinds);
    }

    /// Six numbers for each segment: begin and end azimuth (the end beyond π where the segment crosses it), elevation,
    /// height, width; verdict (0 valid, 1 too narrow, 2 too steep, 3 unknown, 4 wall). What is unknown is NaN.
    pub fn segments(&self) -> Vec<f64> {
        self.now.trial.step().segments.iter().flat_map(encode::segment).collect()
    }

    /// The way to the chosen subgoal, from where the robot stands: world x, y and whether in reverse (0 or 1) for each place.
    /// Empty without one, and where subgoals are judged by the paper's height alone.
    pub fn way(&self) -> Vec<f64> {
        let places = self.now.trial.step().way.iter();
        places
            .flat_map(|one| [one.position_m.x, one.position_m.y, f64::from(u8::from(one.reverse))])
            .collect()
    }

    /// Eighteen numbers for each subgoal: azimuth and elevation in the sensor frame; world x, y, z; chosen (0 or 1); refusal
    /// (0 none, 1 tilt, 2 unseen); index of its segment (-1 for a place that is not on the skyline); the forecast's reach, mean risk, largest
    /// roll and pitch, and why it ends (0 whole, 1 tilt, 2 unseen), NaN without one; the weighted costs of direction,
    /// distance, steepness, commitment, dead_end. The goal itself, once in sight, is a subgoal without cost: NaN.
    pub fn subgoals(&self) -> Vec<f64> {
        let step = self.now.trial.step();
        let numbered = step.subgoals.iter().enumerate();
        numbered.flat_map(|(index, one)| encode::subgoal(one, step.chosen == Some(index))).collect()
    }
}

/// Copies as many values as fit, in single precision.
fn narrow(from: &[f64], to: &mut [f32]) {
    for (to, &from) in to.iter_mut().zip(from) {
        *to = from as f32;
    }
}

fn trial(
    field: HeightField,
    scenario: &Scenario,
    preset: Preset,
    learning: Option<LearningMode>,
    seed: u64,
) -> Result<Trial, JsError> {
    let mut planner = scenario.planner_config(preset)?;
    if let Some(mode) = learning {
        planner.perception.learning.mode = mode;
    }
    Ok(Trial::with_planner(field, scenario, planner, seed)?)
}

fn sensor_pose(trial: &Trial) -> SensorPose {
    let state = trial.robot();
    trial.sensor().config().pose_on(state.position, state.yaw_rad, &state.attitude)
}
