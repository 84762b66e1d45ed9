//! A tick: what the record of a run keeps of it.

use js_sys::global;
use mapless_trials::Navigator as _;
use mapless_trials::{History, Trial};
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::JsCast as _;
use wasm_bindgen::prelude::{JsError, wasm_bindgen};
use web_sys::{Performance, WorkerGlobalScope};

use super::Session;
use crate::decision::{Activity, Velocity};
use crate::places::Place;
use crate::shared::{Metrics, Outcome, Pose, give};

/// A copy of the trial is kept this often, and farther apart once there are more than this many.
const COPY_EVERY_TICKS: u64 = 10;
const MOST_COPIES: usize = 96;

/// One tick: where the robot was when the scan was taken, what the planner decided on it, and what came of
/// it.
#[derive(Debug, Serialize, Tsify)]
pub struct Tick {
    tick: u64,
    time_s: f64,
    pose: Pose,
    v_m_s: f64,
    omega_rad_s: f64,
    command: Velocity,
    /// Where the planner heads, if it does.
    subgoal: Option<Place>,
    activity: Activity,
    /// From the start to this tick.
    metrics: Metrics,
    /// How long scanning, planning and moving took; NaN outside a worker.
    scan_ms: f64,
    planner_ms: f64,
    motion_ms: f64,
    after: Standing,
    /// Whether the route is another one now: what was changed at this tick before is changed again as it is
    /// repeated.
    rerouted: bool,
}

/// Where the robot stands, and whether the trial goes on: it does while the outcome is `running`.
#[derive(Debug, Serialize, Tsify)]
pub struct Standing {
    tick: u64,
    x: f64,
    y: f64,
    z: f64,
    outcome: Outcome,
}

impl Standing {
    fn of(trial: &Trial) -> Self {
        let [x, y, z] = trial.pose().position_m.to_array();
        Self { tick: trial.ticks(), x, y, z, outcome: Outcome::of(trial) }
    }
}

/// The clock of the worker, where there is one.
pub(super) fn clock() -> Option<Performance> {
    global().dyn_into::<WorkerGlobalScope>().ok()?.performance()
}

#[wasm_bindgen]
impl Session {
    /// Runs one tick: senses, plans, acts.
    ///
    /// # Errors
    /// A start whose ground has gone.
    pub fn tick(&mut self) -> Result<Ts<Tick>, JsError> {
        self.rethought = None;
        self.look_again()?;
        let began_ms = self.now_ms();
        self.now.sense();
        let scanned_ms = self.now_ms();
        self.plan();
        let planned_ms = self.now_ms();
        let (trial, step) = (&self.now.trial, self.now.trial.step());
        let robot = trial.robot();
        let mut tick = Tick {
            tick: trial.ticks(),
            time_s: trial.time_s(),
            pose: Pose::of(trial),
            v_m_s: robot.speed_m_s,
            omega_rad_s: robot.turn_rate_rad_s,
            command: step.command.into(),
            subgoal: trial.navigator().subgoal_m().map(Place::from),
            activity: step.status.into(),
            metrics: Metrics::of(trial),
            scan_ms: scanned_ms - began_ms,
            planner_ms: planned_ms - scanned_ms,
            motion_ms: f64::NAN,
            after: Standing::of(trial),
            rerouted: false,
        };
        let recorded_ms = self.now_ms();
        tick.rerouted = self.act();
        tick.motion_ms = self.now_ms() - recorded_ms;
        tick.after = Standing::of(&self.now.trial);
        give(&tick)
    }

    /// Where the robot stands.
    ///
    /// # Errors
    /// None, unless JavaScript runs out of memory.
    pub fn standing(&self) -> Result<Ts<Standing>, JsError> {
        give(&Standing::of(&self.now.trial))
    }

    fn now_ms(&self) -> f64 {
        self.clock.as_ref().map_or(f64::NAN, Performance::now)
    }

    fn plan(&mut self) {
        let tick = self.now.trial.ticks();
        self.history.get_or_insert_with(|| History::new(COPY_EVERY_TICKS, MOST_COPIES, tick, &self.now));
        self.now.plan();
    }

    /// Moves the robot. In the recorded past what was changed then is changed again; says whether it was.
    fn act(&mut self) -> bool {
        self.now.trial.act();
        let tick = self.now.trial.ticks();
        let changed = self.history.as_mut().and_then(|history| history.reached(tick, &self.now));
        if let Some(changed) = changed {
            self.now.clone_from(changed);
        }
        changed.is_some()
    }
}
