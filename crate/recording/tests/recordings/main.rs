//! Recordings of a drive in the world, by the parts of the node.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod drive;
mod files;
mod foreign;
mod injected;
mod kept;
mod player;
mod replaying;
mod soak;

use std::io::Cursor;

use mapless_recording::{Entry, Head};

use crate::drive::{Plan, write};

/// A short drive with a thin sensor.
const SHORT: Plan = Plan { rings: 8, columns: 90, seconds: 2.5, pressed_s: 2.1, changed_s: 9.0 };

/// The recording of a drive as a file.
fn file(recorded: &(Head, Vec<Entry>)) -> Vec<u8> {
    write(Cursor::new(Vec::new()), recorded).into_inner()
}
