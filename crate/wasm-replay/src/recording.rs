//! A recording that is open in the page.

use core::time::Duration;

use js_sys::{Float32Array, Float64Array};
use mapless_recording::{Difference, Options, Player};
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::crossing::{give, read};
use crate::file::{File, RecordingFile, refused};
use crate::frame::{RecordedFrame, frame};
use crate::scene::RecordedScene;
use crate::sight::FrameBuffers;
use crate::topics::NamedTopics;

/// How far the recording was decided again.
#[derive(Debug, Serialize, Tsify)]
pub struct Decided {
    /// Until when.
    until_s: f64,
    /// When the recording ends, as far as that is known.
    end_s: f64,
    /// Whether everything was decided.
    has_ended: bool,
    /// Why the file cannot be read to its end, if so.
    fault: Option<String>,
    /// Whether the file ends before its end was marked.
    is_cut: bool,
    answers: u64,
    different_answers: u64,
    different_ticks: u64,
    /// Entries that could not be recorded.
    lost: u64,
    /// Goals in it.
    goals: u64,
    /// What was wrong with messages: about what, how often, and the last word on it.
    #[tsify(type = "readonly (readonly [string, number, string])[]")]
    complaints: Vec<(&'static str, u64, String)>,
}

/// A change of the supervisor's state, or of the goal.
#[derive(Debug, Serialize, Tsify)]
pub struct Change {
    at_s: f64,
    text: String,
}

/// Changes, in their order.
#[derive(Debug, Serialize, Tsify)]
#[serde(transparent)]
pub struct ChangeList(Vec<Change>);

/// A recording, and where in it somebody looks.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Recording {
    player: Player<File>,
    name: String,
}

#[wasm_bindgen]
impl Recording {
    /// Opens a recording of the node, or a robot's own with the topics that must be named. `faults` go wrong
    /// beyond what went wrong on the robot, as `no_scan@1.5+0.4`: kind, begin and length in seconds.
    ///
    /// # Errors
    /// A file that is neither, with its name and what was expected; a fault that is none.
    #[wasm_bindgen(constructor)]
    pub fn new(file: RecordingFile, topics: Ts<NamedTopics>, faults: Vec<String>) -> Result<Self, JsError> {
        let (name, file) = File::new(file);
        let faults = faults.iter().map(|fault| fault.parse()).collect::<Result<_, String>>();
        let faults = faults.map_err(|error| JsError::new(&error))?;
        let options = Options { topics: read(topics)?.by_role(), faults, ..Options::default() };
        let player = Player::open(file, options).map_err(|error| refused(&name, &error))?;
        Ok(Self { player, name })
    }

    /// What it was made with, where somebody looks.
    ///
    /// # Errors
    /// A recording without a single entry.
    pub fn scene(&self) -> Result<Ts<RecordedScene>, JsError> {
        let moment = self.player.moment().ok_or_else(|| JsError::new("the recording is empty"))?;
        give(&RecordedScene::of(&self.player, moment.config))
    }

    /// Decides so many more entries again; how far that is.
    ///
    /// # Errors
    /// None that is known.
    pub fn decide_on(&mut self, entries: usize) -> Result<Ts<Decided>, JsError> {
        self.player.decide_on(entries);
        let found = self.player.found();
        let report = self.player.report().unwrap_or_default();
        let complaints = report.complaints.into_iter();
        give(&Decided {
            until_s: found.until.as_secs_f64(),
            end_s: self.player.until().as_secs_f64(),
            has_ended: found.has_ended,
            fault: found.fault.as_ref().map(|fault| format!("{}: {fault}", self.name)),
            is_cut: self.player.is_cut(),
            answers: report.answers,
            different_answers: report.different_answers,
            different_ticks: report.different_ticks,
            lost: report.lost,
            goals: report.goals,
            complaints: complaints.map(|(what, (count, last))| (what, count, last)).collect(),
        })
    }

    /// Times of the planner's answers and, while it had no goal, of scans, seconds, after the first `known`.
    pub fn scans_s(&self, known: usize) -> Float64Array {
        seconds(self.player.found().scans.iter().skip(known))
    }

    /// Times of decisions that differ from the recorded ones, seconds, after the first `known`.
    pub fn differences_s(&self, known: usize) -> Float64Array {
        seconds(self.player.found().differences.iter().skip(known).map(|difference| &difference.at))
    }

    /// Changes of the supervisor's state and of the goal, after the first `known`.
    ///
    /// # Errors
    /// None that is known.
    pub fn changes(&self, known: usize) -> Result<Ts<ChangeList>, JsError> {
        let changes = self.player.found().changes.iter().skip(known);
        let change = |(at, text): &(Duration, String)| Change { at_s: at.as_secs_f64(), text: text.clone() };
        give(&ChangeList(changes.map(change).collect()))
    }

    /// The trajectory as far as it was decided, after its first `known` places: the time of each, seconds.
    pub fn trail_s(&self, known: usize) -> Float64Array {
        seconds(self.player.found().trail.iter().skip(known).map(|(at, _)| at))
    }

    /// The places that belong to those times: x, y, z, metres.
    pub fn trail_m(&self, known: usize) -> Float32Array {
        let places = self.player.found().trail.iter().skip(known);
        let axes: Vec<f32> = places.flat_map(|(_, place_m)| place_m.as_vec3().to_array()).collect();
        Float32Array::from(&axes[..])
    }

    /// Goes to a moment, or to where everything was decided again if that is earlier, and shows it. Decisions
    /// that differ are told of the time from `since_s` to there.
    ///
    /// # Errors
    /// A file that cannot be read any more, or without a single entry.
    pub fn show(
        &mut self,
        at_s: f64,
        since_s: f64,
        buffers: Ts<FrameBuffers>,
        surfaces: bool,
    ) -> Result<Ts<RecordedFrame>, JsError> {
        let at = Duration::try_from_secs_f64(at_s.max(0.0)).unwrap_or(Duration::MAX);
        let since = Duration::try_from_secs_f64(since_s.max(0.0)).unwrap_or_default();
        let at = at.min(self.player.found().until);
        self.player.go_to(at).map_err(|error| JsError::new(&format!("{}: {error}", self.name)))?;
        let buffers = read(buffers)?;
        let empty = || JsError::new("the recording is empty");
        let moment = self.player.moment().ok_or_else(empty)?;
        let differences = self.player.found().differences.iter();
        let differences: Vec<&Difference> =
            differences.filter(|difference| difference.at > since && difference.at <= at).collect();
        let shown = frame(at, &moment, &differences, &buffers);
        let is_decided = moment.seen.is_some_and(|seen| seen.step.is_some());
        let predicted =
            surfaces && is_decided && self.player.ask(|planner| fill(planner, &buffers)).unwrap_or_default();
        give(&if predicted || !is_decided { shown.with_surfaces() } else { shown })
    }
}

/// Predicts the surfaces; without a posterior there are none.
fn fill(planner: &mut mapless::Planner, buffers: &FrameBuffers) -> bool {
    let surface = planner.predicted_surface();
    surface.map(|surface| buffers.fill_predicted(surface, &mut Vec::new())).is_ok()
}

fn seconds<'a>(times: impl Iterator<Item = &'a Duration>) -> Float64Array {
    let times_s: Vec<f64> = times.map(Duration::as_secs_f64).collect();
    Float64Array::from(&times_s[..])
}
