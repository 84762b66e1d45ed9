//! Shared parts of the tests that span crates.

pub mod gpflow;
pub mod learned_bits;
pub mod scenarios_text;
