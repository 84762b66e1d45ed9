//! One loaded scenario.

mod frame;
mod inside;
mod place;
mod scene;
mod tick;
mod what_if;

pub use frame::{Frame, Timeline};
pub use inside::{ClimbStep, Inside, InsideQuestion, Placement};
pub use place::{HeadingThere, PlaceReport};
pub use scene::Scene;
pub use tick::{Standing, Tick};
pub use what_if::{ThinkingWith, Thought};

use what_if::Rethought;

use glam::{DMat3, DVec2};
use mapless::gp::learning::LearningMode;
use mapless::skyline::scan_filter::ReturnKind;
use mapless::terrain::mount_misfit::MountMisfit;
use mapless_terrain::{Stroke as Brushes, StrokeTable};
use mapless_trials::{History, Preset, Scenario, StartPose, Trial};
use mapless_world::{HeightField, SampleRect};
use tsify::Ts;
use wasm_bindgen::prelude::{JsError, wasm_bindgen};
use web_sys::Performance;

use crate::objects::{ObjectList, Solid, SolidList};
use crate::opening::SessionOptions;
use crate::parameters::{self, ParameterGroup};
use crate::places::{Heading, Route};
use crate::shared::{Overrides, changed, give, read};
use crate::stroke::Stroke;
use crate::terrain::{Ground, GroundPatch};

/// A running trial.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Session {
    now: Moment,
    /// Where the trial has been since its start or since the ground changed; there is none before the first
    /// decision.
    history: Option<History<Moment>>,
    /// Whether the ground has changed since the last scan.
    ground_changed: bool,
    /// What is shown in place of what the run decided, until that goes on.
    rethought: Option<Rethought>,
    /// The true skyline as it was last asked for; none on other ground.
    truth: Option<Truth>,
    seed: u64,
    preset: Preset,
    learning: Option<LearningMode>,
    /// The scenario as its file has it.
    file: Scenario,
    /// The scenario with its overrides.
    running: Scenario,
    scratch: Vec<f32>,
    clock: Option<Performance>,
}

/// The true skyline in each column.
#[derive(Debug)]
struct Truth {
    view: TrueView,
    elevations: Vec<f32>,
}

/// What a true skyline depends on beside the ground.
#[derive(Debug, PartialEq)]
struct TrueView {
    /// Of the sensor's place, along the robot's axes.
    pose: mapless_world::SensorPose,
    radius_m: f64,
    between_rad: [f64; 2],
}

/// All that belongs to one point in time.
#[derive(Clone, Debug)]
struct Moment {
    trial: Trial,
    /// Where the last scan was taken: the robot has moved on since.
    scanned_from: mapless_world::SensorPose,
    /// The robot's axes there.
    world_from_robot: DMat3,
    /// Whether the planner has seen the last scan.
    is_planned: bool,
    /// What is wrong with the mount of the sensor, by the first scan.
    mount_misfit: Option<String>,
}

impl Moment {
    fn new(trial: Trial) -> Self {
        let scanned_from = sensor_pose(&trial);
        let world_from_robot = trial.pose().world_from_robot();
        let mut moment =
            Self { trial, scanned_from, world_from_robot, is_planned: false, mount_misfit: None };
        moment.begin();
        moment
    }

    /// Takes the first scan. The robot is more likely to stand on level ground here than farther on.
    fn begin(&mut self) {
        self.sense();
        let (scan, sensor) = (self.trial.scan(), &self.trial.planner_config().sensor);
        self.mount_misfit = MountMisfit::of(&scan.points, sensor).map(|misfit| misfit.to_string());
    }

    fn sense(&mut self) {
        self.scanned_from = sensor_pose(&self.trial);
        self.world_from_robot = self.trial.pose().world_from_robot();
        self.trial.look_far();
        self.is_planned = false;
    }

    fn plan(&mut self) {
        self.trial.plan();
        self.is_planned = true;
    }

    /// What the planner took each point of the last scan for; empty if it has not seen that scan.
    fn return_kinds(&self) -> &[ReturnKind] {
        if self.is_planned { self.trial.step().return_kinds } else { &[] }
    }
}

#[wasm_bindgen]
impl Session {
    /// Loads a scenario.
    ///
    /// # Errors
    /// A fault in one of the files or of an option, with place, value and expectation.
    #[wasm_bindgen(constructor)]
    pub fn new(options: Ts<SessionOptions>) -> Result<Session, JsError> {
        let options = read(options)?;
        let terrain = options.terrain.load()?;
        let file =
            Scenario::parse(&options.scenario.name, &options.scenario.text)?.on_terrain(&terrain.objects);
        let running = changed(&file, &options.overrides.unwrap_or_default())?;
        let (preset, learning) = (options.preset.into(), options.learning.map(LearningMode::from));
        let seed = options.seed.unwrap_or(file.seed);
        let trial = trial(terrain.field, &running, preset, learning, seed)?;
        Ok(Session {
            now: Moment::new(trial),
            history: None,
            ground_changed: false,
            rethought: None,
            truth: None,
            seed,
            preset,
            learning,
            file,
            running,
            scratch: Vec::new(),
            clock: tick::clock(),
        })
    }

    /// Begins anew with these overrides in place of all others. Ground, start and route stay as they are, and
    /// so does the seed unless another is given.
    ///
    /// # Errors
    /// A value that makes no sense, with its place and what was expected; nothing then changes.
    pub fn set_parameters(&mut self, overrides: Ts<Overrides>, seed: Option<u32>) -> Result<(), JsError> {
        let running = changed(&self.file, &read(overrides)?)?;
        let (now, seed) = (&self.now.trial, seed.map_or(self.seed, u64::from));
        let mut trial = trial(now.field().clone(), &running, self.preset, self.learning, seed)?;
        trial.set_start(now.start())?;
        trial.set_route(now.waypoints_m().to_vec(), now.goal_m(), now.goal_heading_rad())?;
        (self.now, self.history, self.ground_changed) = (Moment::new(trial), None, false);
        (self.running, self.seed, self.rethought) = (running, seed, None);
        Ok(())
    }

    /// Every parameter, with the value that holds unless it is overridden.
    ///
    /// # Errors
    /// A value that does not fit the preset.
    pub fn parameters(&self) -> Result<Vec<Ts<ParameterGroup>>, JsError> {
        let (running, preset) = self.setting();
        parameters::groups(&self.file, running, preset)?.iter().map(give).collect()
    }

    /// The whole ground.
    ///
    /// # Errors
    /// None, unless JavaScript runs out of memory.
    pub fn ground(&self) -> Result<Ts<Ground>, JsError> {
        give(&Ground::of(self.now.trial.field()))
    }

    /// Back to the start, with ground, start and route as they are now.
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
    pub fn set_start(&mut self, start: Ts<Heading>) -> Result<(), JsError> {
        self.begin_from(read(start)?.into())
    }

    fn begin_from(&mut self, start: StartPose) -> Result<(), JsError> {
        self.now.trial.set_start(start)?;
        (self.history, self.ground_changed, self.rethought) = (None, false, None);
        self.now.begin();
        Ok(())
    }

    /// Sets another route and drives on.
    ///
    /// # Errors
    /// A place off the terrain; nothing then changes.
    pub fn set_route(&mut self, route: Ts<Route>) -> Result<(), JsError> {
        let Route { waypoints, goal } = read(route)?;
        let waypoints_m = waypoints.into_iter().map(DVec2::from).collect();
        self.now.trial.set_route(waypoints_m, DVec2::new(goal.x, goal.y), goal.heading_rad)?;
        if let Some(history) = &mut self.history {
            history.changed(self.now.trial.ticks(), &self.now);
        }
        Ok(())
    }

    /// Goes back to `tick`, or to the nearest one that can be gone to; gives that. The session may stand
    /// shortly before it: running forward from there repeats what happened.
    pub fn go_back(&mut self, tick: f64) -> f64 {
        self.rethought = None;
        let now = self.now.trial.ticks();
        let Some(history) = &self.history else { return now as f64 };
        let tick = (tick as u64).clamp(history.first_tick(), history.end_tick());
        if let Some(copy) = history.at_or_before(tick)
            && (now > tick || copy.trial.ticks() > now)
        {
            self.now.clone_from(copy);
        }
        tick as f64
    }

    /// Applies a stroke; gives the rectangle that changed, or nothing when the stroke is off the terrain.
    ///
    /// # Errors
    /// A stroke that makes no sense; nothing then changes.
    pub fn sculpt(&mut self, stroke: Ts<Stroke>) -> Result<Option<Ts<GroundPatch>>, JsError> {
        let stroke = Brushes::try_from(&StrokeTable::from(read(stroke)?))?;
        let mut changed: Option<SampleRect> = None;
        for brush in stroke.brushes() {
            if let Some(rect) = self.now.trial.sculpt(brush)? {
                changed = Some(changed.map_or(rect, |all| all.union(rect)));
            }
        }
        let Some(rect) = changed else { return Ok(None) };
        (self.history, self.ground_changed, self.truth) = (None, true, None);
        give(&GroundPatch::of(self.now.trial.field(), rect)).map(Some)
    }

    /// Puts other heights in place of those in a rectangle.
    ///
    /// # Errors
    /// Heights that do not fit; nothing then changes.
    pub fn replace_ground(&mut self, patch: Ts<GroundPatch>) -> Result<(), JsError> {
        let patch = read(patch)?;
        self.now.trial.replace_ground(patch.rect(), &patch.heights_m())?;
        (self.history, self.ground_changed, self.truth) = (None, true, None);
        Ok(())
    }

    /// Puts other objects on the ground in place of all there are, with the same consequences as a stroke.
    ///
    /// # Errors
    /// An object that makes no sense, with its place and what was expected; nothing then changes.
    pub fn set_objects(&mut self, objects: Ts<ObjectList>) -> Result<(), JsError> {
        let ObjectList(objects) = read(objects)?;
        self.now.trial.set_objects(objects.clone())?;
        self.file.objects = Some(objects.clone());
        self.running.objects = Some(objects);
        (self.history, self.ground_changed) = (None, true);
        Ok(())
    }

    /// The objects on the ground.
    ///
    /// # Errors
    /// None, unless JavaScript runs out of memory.
    pub fn objects(&self) -> Result<Ts<ObjectList>, JsError> {
        give(&ObjectList(self.now.trial.objects().list().to_vec()))
    }

    /// The shapes that the objects are made of, where they are now.
    ///
    /// # Errors
    /// None, unless JavaScript runs out of memory.
    pub fn solids(&self) -> Result<Ts<SolidList>, JsError> {
        give(&SolidList(self.now.trial.objects().solids().iter().map(Solid::from).collect()))
    }

    /// Looks at new ground while nothing moves. Before the first tick the trial begins anew on it: the run is
    /// then that of the ground as it is.
    fn look_again(&mut self) -> Result<(), JsError> {
        if !std::mem::take(&mut self.ground_changed) {
            return Ok(());
        }
        if self.now.trial.ticks() == 0 {
            return self.restart();
        }
        self.now.sense();
        Ok(())
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

fn sensor_pose(trial: &Trial) -> mapless_world::SensorPose {
    let state = trial.robot();
    trial.sensor().config().pose_on(state.position, state.yaw_rad, &state.attitude)
}
