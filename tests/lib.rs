//! What the tests that span crates share.

pub mod gpflow;
pub mod learned_bits;
pub mod scenarios_text;
