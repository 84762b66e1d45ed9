//! Terrains from files and by seed: recipes, imported grids of heights, and what generates recipes.
//!
//! Everything here is a pure function of its arguments, apart from [`load_terrain`], which reads files.

// Tests state exact values where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

pub mod generate;
mod import;
mod load;
pub mod recipe;
mod stroke;
mod terrain;

#[cfg(not(target_arch = "wasm32"))]
pub use load::load_terrain;
pub use load::load_terrain_bytes;
pub use stroke::{Stroke, StrokeError, StrokeKind, StrokeTable};
pub use terrain::{Terrain, TerrainError, TerrainFault};
