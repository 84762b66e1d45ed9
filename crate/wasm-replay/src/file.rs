//! A file of the page, of which any part can be read.

use std::io::{Error, Result};

use js_sys::Uint8Array;
use mapless_recording::{RecordingError, Source};
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

const EXPECTED: &str =
    "Expected an MCAP recording of mapless-node or of a robot (rosbag2), with scan, odometry and IMU";

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r"
/** A file of which any part can be read at once. */
export interface RecordingFile {
    readonly name: string;
    /** In bytes. */
    readonly size: number;
    /** So many bytes from there on, or fewer at the end. */
    read(at: number, bytes: number): Uint8Array;
}
";

#[wasm_bindgen]
extern "C" {
    /// A file of which any part can be read at once.
    #[wasm_bindgen(typescript_type = "RecordingFile")]
    #[derive(Debug)]
    pub type RecordingFile;

    #[wasm_bindgen(method, getter)]
    fn name(this: &RecordingFile) -> String;

    #[wasm_bindgen(method, getter)]
    fn size(this: &RecordingFile) -> f64;

    #[wasm_bindgen(method, catch)]
    fn read(this: &RecordingFile, at: f64, bytes: f64) -> std::result::Result<Uint8Array, JsValue>;
}

/// What the replay reads.
#[derive(Debug)]
pub(crate) struct File(RecordingFile);

impl File {
    pub(crate) fn new(file: RecordingFile) -> (String, Self) {
        (file.name(), Self(file))
    }
}

impl Source for File {
    fn length(&self) -> u64 {
        self.0.size() as u64
    }

    fn read_at(&self, at: u64, into: &mut [u8]) -> Result<usize> {
        let failed = |error: JsValue| Error::other(format!("{error:?}"));
        let bytes = self.0.read(at as f64, into.len() as f64).map_err(failed)?;
        let read = (bytes.length() as usize).min(into.len());
        bytes.subarray(0, read as u32).copy_to(&mut into[..read]);
        Ok(read)
    }
}

/// Why a file is no recording, and what was expected.
pub(crate) fn refused(name: &str, error: &RecordingError) -> JsError {
    JsError::new(&format!("{name}: {error}. {EXPECTED}"))
}
