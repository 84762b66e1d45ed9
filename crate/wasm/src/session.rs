//! One loaded scenario.

use glam::DVec2;
use js_sys::{Float32Array, Uint8Array};
use mapless::occupancy::COLUMNS;
use mapless::perception::ROWS;
use mapless::{Status, StopReason};
use mapless_trials::{Preset, Scenario, StartPose, Trial};
use mapless_world::{Brush, BrushKind, SensorPose, load_terrain_bytes};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::encode;

/// The terrain file that a scenario names, relative to the scenario's own folder.
///
/// # Errors
/// The scenario's fault, with file, place, value and expectation.
#[wasm_bindgen]
pub fn terrain_of(scenario_file: &str, scenario_toml: &str) -> Result<String, JsError> {
    Ok(Scenario::parse(scenario_file, scenario_toml)?.terrain)
}

/// A running trial and the places where its numbers are gathered.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Session {
    trial: Trial,
    seed: u64,
    /// Where the last scan was taken: the robot has moved on since.
    scanned_from: SensorPose,
    scratch: Vec<f32>,
}

#[wasm_bindgen]
impl Session {
    /// Loads a scenario. `learning` is `fixed`, `once` or `every_scan`; without it, or a `seed`, it is the scenario's own.
    ///
    /// # Errors
    /// A fault in one of the files, or an unknown preset or mode of learning, with place, value and expectation.
    #[wasm_bindgen(constructor)]
    pub fn new(
        scenario_file: &str,
        scenario_toml: &str,
        terrain_file: &str,
        terrain: &[u8],
        preset: &str,
        learning: Option<String>,
        seed: Option<u64>,
    ) -> Result<Session, JsError> {
        let scenario = Scenario::parse(scenario_file, scenario_toml)?;
        let preset: Preset = preset.parse().map_err(|reason: String| JsError::new(&reason))?;
        let terrain = load_terrain_bytes(terrain_file, terrain, &mut |file| {
            Err(format!("{file}: the page holds no files that a recipe imports"))
        })?;
        let seed = seed.unwrap_or(scenario.seed);
        let mut planner = scenario.planner_config(preset)?;
        if let Some(mode) = learning {
            planner.perception.learning.mode =
                mode.parse().map_err(|reason: String| JsError::new(&reason))?;
        }
        let trial = Trial::with_planner(terrain.field, &scenario, planner, seed)?;
        let scanned_from = sensor_pose(&trial);
        let mut session = Session { trial, seed, scanned_from, scratch: Vec::new() };
        session.look();
        Ok(session)
    }

    /// The seed of the sensor's noise.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// What changes only between trials: start x, y, heading; goal x, y; limits of roll and pitch; radius of the occupancy
    /// surface; height of the sensor; columns and rows of the variance image.
    pub fn scene(&self) -> Vec<f64> {
        let config = self.trial.planner_config();
        let StartPose { position_m, heading_rad } = self.trial.start();
        let goal_m = self.trial.goal_m();
        vec![
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
        ]
    }

    /// Columns of the height field, west to east.
    pub fn columns(&self) -> usize {
        self.trial.field().columns()
    }

    /// Rows of the height field, south to north.
    pub fn rows(&self) -> usize {
        self.trial.field().rows()
    }

    /// Spacing of the height field.
    pub fn cell_m(&self) -> f64 {
        self.trial.field().cell_m()
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
        let field = self.trial.field();
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
        self.begin_from(self.trial.start())
    }

    /// Begins anew from another start.
    ///
    /// # Errors
    /// A start off the terrain; nothing then changes.
    pub fn set_start(&mut self, x: f64, y: f64, heading_rad: f64) -> Result<(), JsError> {
        self.begin_from(StartPose { position_m: DVec2::new(x, y), heading_rad })
    }

    fn begin_from(&mut self, start: StartPose) -> Result<(), JsError> {
        self.trial.set_start(start)?;
        self.look();
        Ok(())
    }

    /// Sets another goal and drives on.
    ///
    /// # Errors
    /// A goal off the terrain; nothing then changes.
    pub fn set_goal(&mut self, x: f64, y: f64) -> Result<(), JsError> {
        Ok(self.trial.set_goal(DVec2::new(x, y))?)
    }

    /// One dab of a brush (`raise`, `lower` or `smooth`). Returns first column, first row, columns and rows of the samples
    /// that changed, or nothing when the brush is off the terrain.
    ///
    /// # Errors
    /// A brush that makes no sense.
    pub fn sculpt(
        &mut self,
        x: f64,
        y: f64,
        radius_m: f64,
        strength_m: f64,
        kind: &str,
    ) -> Result<Option<Vec<u32>>, JsError> {
        let kind = match kind {
            "raise" => BrushKind::Raise,
            "lower" => BrushKind::Lower,
            "smooth" => BrushKind::Smooth,
            _ => return Err(JsError::new(&format!("brush \"{kind}\": expected raise, lower or smooth"))),
        };
        let changed = self.trial.sculpt(&Brush { centre: DVec2::new(x, y), radius_m, strength_m, kind })?;
        Ok(changed.map(|r| {
            [r.column_begin, r.row_begin, r.column_end - r.column_begin, r.row_end - r.row_begin]
                .map(|n| n as u32)
                .to_vec()
        }))
    }

    /// First part of a tick: takes a scan from where the robot stands.
    pub fn look(&mut self) {
        self.scanned_from = sensor_pose(&self.trial);
        self.trial.look();
    }

    /// Second part: the planner decides. Apart from the others so that the page can time it.
    pub fn plan(&mut self) {
        self.trial.plan();
    }

    /// Third part: the robot moves. Returns whether the trial goes on.
    pub fn act(&mut self) -> bool {
        self.trial.act().is_none()
    }

    /// Tick, time; x, y, z, roll, pitch, yaw; speed, turn rate; the commanded speed and turn rate; variance threshold; the
    /// six metrics in the order of [`mapless_trials::Metrics`].
    pub fn status(&self) -> Vec<f64> {
        let trial = &self.trial;
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
        ]);
        values
    }

    /// How the trial ended, or `running`.
    pub fn outcome(&self) -> String {
        self.trial.outcome().map_or("running", |outcome| outcome.name()).to_owned()
    }

    /// What the planner does: `driving`, `arrived`, `looking` or `stopped`.
    pub fn activity(&self) -> String {
        match self.trial.step().status {
            Status::Driving => "driving",
            Status::Arrived => "arrived",
            Status::Looking => "looking",
            Status::Stopped(_) => "stopped",
        }
        .to_owned()
    }

    /// Why the planner stopped, where it did.
    pub fn stop_reason(&self) -> Option<String> {
        self.trial.stop_reason().map(|reason: StopReason| reason.to_string())
    }

    /// Digest of the trajectory so far.
    pub fn digest(&self) -> String {
        self.trial.digest()
    }

    /// The last scan's returns in the world frame, x, y, z of each, as many as `out` holds. Returns how many points.
    pub fn points(&mut self, out: &Float32Array) -> usize {
        let SensorPose { position, world_from_sensor } = self.scanned_from;
        let fit = out.length() as usize / 3;
        self.scratch.clear();
        for point in self.trial.scan().points.iter().take(fit) {
            let world = position + world_from_sensor * point.as_dvec3();
            self.scratch.extend(world.as_vec3().to_array());
        }
        self.send(out);
        self.scratch.len() / 3
    }

    /// The variance surface as a share of the signal variance, column by column from straight behind over the right, lowest
    /// row first; as much as `out` holds. Predicted only now, since a step needs no more than its edge. Where there is no
    /// posterior, nothing was observed: 1.
    pub fn variance(&mut self, out: &Float32Array) {
        self.scratch.clear();
        let size = out.length() as usize;
        if let Ok(surface) = self.trial.predicted_surface() {
            self.scratch.extend(surface.relative_variance.iter().take(size).map(|&v| v as f32));
        }
        self.scratch.resize(size, 1.0);
        self.send(out);
    }

    /// Elevation of the skyline in each column, NaN where there is none; as much as `out` holds.
    pub fn profile(&mut self, out: &Float32Array) {
        self.scratch.clear();
        let profile = self.trial.step().profile;
        self.scratch.extend(profile.iter().take(out.length() as usize).map(encode::column_elevation_rad));
        self.send(out);
    }

    fn send(&self, out: &Float32Array) {
        out.subarray(0, self.scratch.len() as u32).copy_from(&self.scratch);
    }

    /// What each column shows: 0 ground, 1 unknown, 2 wall; as much as `out` holds.
    pub fn kinds(&self, out: &Uint8Array) {
        let profile = self.trial.step().profile;
        let kinds: Vec<u8> = profile.iter().take(out.length() as usize).map(encode::column_kind).collect();
        out.subarray(0, kinds.len() as u32).copy_from(&kinds);
    }

    /// Six numbers for each segment: begin and end azimuth (the end beyond π where the segment crosses it), elevation,
    /// height, width; verdict (0 valid, 1 too narrow, 2 too steep, 3 unknown, 4 wall). What is unknown is NaN.
    pub fn segments(&self) -> Vec<f64> {
        self.trial.step().segments.iter().flat_map(encode::segment).collect()
    }

    /// Twelve numbers for each subgoal: azimuth and elevation in the sensor frame; world x, y, z; chosen (0 or 1); refusal
    /// (0 none, 1 tilt, 2 unseen); the weighted costs of direction, distance, steepness, commitment, dead_end. The goal
    /// itself, once in sight, is a subgoal without cost: NaN.
    pub fn subgoals(&self) -> Vec<f64> {
        let step = self.trial.step();
        let numbered = step.subgoals.iter().enumerate();
        numbered.flat_map(|(index, one)| encode::subgoal(one, step.chosen == Some(index))).collect()
    }
}

fn sensor_pose(trial: &Trial) -> SensorPose {
    let state = trial.robot();
    trial.sensor().config().pose_on(state.position, state.yaw_rad, &state.attitude)
}
