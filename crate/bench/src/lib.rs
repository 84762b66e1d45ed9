//! The benchmarks of `cargo xtask bench`: pieces of work with the same inputs natively, in Node and in
//! Chromium, and in files for the peers.
//!
//! Each request is a line and each answer a line; see [`Bench::answer`]. Both sides of a comparison are asked
//! in turn, so that other load on the machine affects both.

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
