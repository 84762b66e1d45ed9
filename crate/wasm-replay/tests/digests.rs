//! In the browser, a recording is decided as natively, to the bit.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used)]

use mapless_wasm_replay::replay_recording;
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};

wasm_bindgen_test_configure!(run_in_dedicated_worker);

#[wasm_bindgen_test]
fn a_recorded_drive_gives_the_native_digest() {
    let bytes = include_bytes!("../../recording/tests/kept/drive.mcap");
    let replayed = replay_recording("drive.mcap", bytes).ok().unwrap();
    assert!(replayed.answers() > 5.0 && replayed.differences() == 0.0);
    assert_eq!(replayed.digest(), include_str!("../../recording/tests/kept/drive.digest").trim());
    let cut = replay_recording("cut.mcap", &bytes[..bytes.len() / 2]).ok().unwrap();
    assert!(cut.differences() == 0.0 && cut.until_s() < replayed.until_s());
}
