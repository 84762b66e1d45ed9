//! Terrains from files and by seed: recipes, imported grids of heights, and what generates recipes.
//!
//! `mapless-heights` reads the grids. On wasm it does so in a module of its own, so that nothing here calls
//! its readers there.
//!
//! Everything here is a pure function of its arguments, apart from [`load_terrain`], which reads files.

// Tests state exact values where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

pub mod generate;
mod load;
pub mod recipe;
mod stroke;
mod terrain;

pub use load::load_recipe;
#[cfg(not(target_arch = "wasm32"))]
pub use load::load_terrain;
pub use mapless_heights::{Fault, Grid, Holes, Import};
pub use recipe::{Imported, import_of};
pub use stroke::{Stroke, StrokeError, StrokeKind, StrokeTable};
pub use terrain::{Terrain, TerrainError, TerrainFault};
