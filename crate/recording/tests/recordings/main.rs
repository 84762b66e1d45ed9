//! Recordings of a drive in the world, by the parts of the node.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod drive;
mod files;
mod foreign;
mod kept;
mod player;
mod replaying;
