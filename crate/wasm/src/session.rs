//! One loaded scenario.

mod shown;

use glam::DVec2;
use mapless::gp::learning::LearningMode;
use mapless::skyline::occupancy::COLUMNS;
use mapless_trials::{History, Preset, Scenario, StartPose, Trial, parameters};
use mapless_world::{HeightField, SensorPose};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::ground;

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
        let grid = self.now.trial.step().observed.grid();
        let StartPose { position_m, heading_rad } = self.now.trial.start();
        let goal_m = self.now.trial.goal_m();
        let mut values = vec![
            position_m.x,
            position_m.y,
            heading_rad,
            goal_m.x,
            goal_m.y,
            config.robot.roll_limit_rad,
            config.robot.pitch_limit_rad,
            config.perception.surface_radius_m,
            config.sensor.height_m,
            COLUMNS as f64,
            grid.rows() as f64,
            grid.rings() as f64,
            config.robot.width_m,
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

    /// Third part: the robot moves. Returns whether the trial goes on.
    pub fn act(&mut self) -> bool {
        self.now.trial.act();
        let tick = self.now.trial.ticks();
        if let Some(changed) = self.history.as_mut().and_then(|history| history.reached(tick, &self.now)) {
            self.now.clone_from(changed);
        }
        self.now.trial.outcome().is_none()
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
