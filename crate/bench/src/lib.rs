//! What `cargo xtask bench` measures of mapless: pieces of work with inputs made by rule, the same natively,
//! in Node and in Chromium, and written to files for the peers.
//!
//! A line asks for a piece of work and a line answers; [`Bench::answer`] has the words. Both sides of a
//! comparison are asked in turn, so that what else the machine does falls on both.

mod answer;
mod clock;
mod data;
mod drive;
mod error;
mod gaussian;
#[cfg(not(target_arch = "wasm32"))]
mod inputs;
mod peak;
mod registry;
mod sensing;
#[cfg(target_arch = "wasm32")]
mod wasm;
mod work;

pub use answer::Bench;
pub use error::BenchError;
#[cfg(not(target_arch = "wasm32"))]
pub use inputs::write_inputs;
#[cfg(target_arch = "wasm32")]
pub use wasm::answer;
