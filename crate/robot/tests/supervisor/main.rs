//! Tests of the supervisor as a whole: its states, every fault at random moments, and random sequences.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod faults;
mod rig;
mod sequences;
mod states;
