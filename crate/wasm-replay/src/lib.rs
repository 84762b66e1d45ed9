//! Recorded drives for the page: decided again to the bit, and shown at any moment. A module of its own, so
//! that the page opens without it.

#[path = "../../wasm/src/shared/crossing.rs"]
mod crossing;
#[path = "../../wasm/src/decision.rs"]
mod decision;
mod file;
mod frame;
#[path = "../../wasm/src/shared/panic.rs"]
mod panic;
#[path = "../../wasm/src/shared/pose.rs"]
mod pose;
mod recording;
#[path = "../../wasm/src/returns.rs"]
mod returns;
mod scene;
#[path = "../../wasm/src/sight.rs"]
mod sight;
mod supervisor;
mod surroundings;
mod topics;

pub use decision::{
    Activity, Cost, Forecast, PathPoint, ReachEnd, Refusal, Segment, Subgoal, Velocity, Verdict,
};
pub use file::RecordingFile;
pub use frame::{RecordedFrame, RecordedGoal};
use mapless_recording::{Options, Report, replay};
pub use pose::Pose;
pub use recording::{Change, ChangeList, Decided, Recording};
pub use returns::SetAside;
pub use scene::RecordedScene;
pub use sight::{FrameBuffers, ImageSize, Mount, Point, SegmentDemands, SensorPose, TiltLimits};
pub use supervisor::{SupervisorTransition, SupervisorTransitions, fault_kinds, supervisor_transitions};
pub use surroundings::Surroundings;
pub use topics::{NamedTopics, TopicCandidate, TopicChoice, TopicChoices, topic_choices};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// Runs once when the page loads the module.
#[wasm_bindgen(start)]
pub fn start() {
    panic::install_hook();
}

/// What a replay found.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Replayed {
    report: Report,
}

#[wasm_bindgen]
impl Replayed {
    /// The time of the last entry, seconds.
    #[wasm_bindgen(getter)]
    pub fn until_s(&self) -> f64 {
        self.report.until.as_secs_f64()
    }

    /// Answers of the planner.
    #[wasm_bindgen(getter)]
    pub fn answers(&self) -> f64 {
        self.report.answers as f64
    }

    /// Decisions that differ from the recorded ones.
    #[wasm_bindgen(getter)]
    pub fn differences(&self) -> f64 {
        (self.report.different_ticks + self.report.different_answers) as f64
    }

    /// The digest of all decisions.
    #[wasm_bindgen(getter)]
    pub fn digest(&self) -> String {
        self.report.digest.clone()
    }
}

/// Replays a recording of the node.
///
/// # Errors
/// A fault of the file, with its name and place and what was expected there.
#[wasm_bindgen]
pub fn replay_recording(file: &str, bytes: &[u8]) -> Result<Replayed, JsError> {
    let report = replay(bytes, &Options::default(), |_| {});
    report.map(|report| Replayed { report }).map_err(|error| JsError::new(&format!("{file}: {error}")))
}
