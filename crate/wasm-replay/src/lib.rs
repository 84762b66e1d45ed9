//! Replays of recorded drives in the browser. A module of its own, so that the page opens without it.

#[path = "../../wasm/src/shared/panic.rs"]
mod panic;

use mapless_recording::{Options, Report, replay};
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
