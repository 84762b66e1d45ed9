//! The recording that is kept for the browser: `crate/wasm-replay/tests` replays the same bytes.

use std::path::Path;

use mapless_recording::{Options, replay};

use crate::drive::drive;
use crate::{SHORT, file};

/// Written anew by `MAPLESS_RECORD_DRIVE=1 cargo test -p mapless-recording --test recordings kept`.
const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/kept");

#[test]
fn the_kept_recording_is_decided_again_to_the_bit() {
    let (recording, digest) = (Path::new(KEPT).join("drive.mcap"), Path::new(KEPT).join("drive.digest"));
    if std::env::var_os("MAPLESS_RECORD_DRIVE").is_some() {
        let bytes = file(&drive(SHORT));
        let report = replay(&*bytes, &Options::default(), |_| {}).unwrap();
        std::fs::create_dir_all(KEPT).unwrap();
        std::fs::write(&recording, bytes).unwrap();
        std::fs::write(&digest, report.digest + "\n").unwrap();
    }
    let bytes = std::fs::read(&recording).unwrap();
    assert!(bytes.len() < 300_000, "{} bytes", bytes.len());
    let report = replay(&*bytes, &Options::default(), |_| {}).unwrap();
    assert_eq!((report.different_ticks, report.different_answers), (0, 0));
    assert!(report.answers > 5, "{} answers", report.answers);
    assert_eq!(report.digest, std::fs::read_to_string(&digest).unwrap().trim());
}
