//! Writes a recording of ten minutes with the scans of a VLP-16 at 10 Hz: 1.3 GB, and needs as much memory.
//!
//! `cargo run --release -p mapless-recording --example ten_minutes -- FILE.mcap`. `npm run recording`
//! opens it in the page.

#[allow(clippy::unwrap_used, reason = "it is the tests' own")]
#[path = "../tests/recordings/drive.rs"]
mod drive;

use drive::{Plan, drive, write};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: ten_minutes FILE.mcap")?;
    let plan = Plan { rings: 16, columns: 1800, seconds: 600.0, pressed_s: 590.0, changed_s: 1e9 };
    let out = std::fs::File::create(&file).map_err(|error| format!("{file}: {error}"))?;
    write(out, &drive(plan));
    Ok(())
}
