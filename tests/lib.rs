//! What the tests that span crates share.

pub mod gpflow;
pub mod scenarios_text;
