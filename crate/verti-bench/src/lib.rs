//! Worlds of [Verti-Bench](https://github.com/RobotiXX/verti_bench) (RSS 2025, arXiv 2502.11426) as terrains
//! and scenarios: steep ground with rocks and trees, each with several pairs of start and goal.
//!
//! The benchmark's heights are images of 8 bits with one pixel a metre. Their levels are kept, in PNG images
//! of 8 bits, and a recipe gives them their range. Nothing is smoothed: the benchmark's own simulator spans
//! triangles between the pixels, this one bilinear patches through the same points. So a step between two
//! levels is a slope of one cell: 1.1° where the highest ground is 4.8 m, 3.6° where it is 16 m, at any
//! scale.
//!
//! Rocks and trees are boxes, as the benchmark's collision shapes are. They stand on the ground; the
//! benchmark's own heights of them do not fit its ground.
//!
//! ```
//! # let config = "obstacles: {rocks: [], trees: []}\npositions: [{start: [-1, 0, 1], goal: [1, 0, 1]}]\n\
//! #     terrain: {difficulty: mid, max_height: 9.6}\nterrain_type: rigid\n";
//! use mapless_verti_bench::{GreyImage, Scale, ScaledWorld, World};
//!
//! let world = World::from_config("config3_mid.yaml", config)?;
//! let heights = GreyImage { columns: 3, rows: 3, levels: vec![0, 0, 0, 128, 128, 128, 255, 255, 255] };
//! let world = ScaledWorld { world: &world, heights: &heights, scale: "1/5".parse()? };
//! assert!(world.recipe()?.contains("cell_m = 0.2\nheight_min_m = 0.0\nheight_max_m = 1.92"));
//! assert!(world.scenario(0)?.contains("goal = [0.4, 0.2]"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bmp;
mod fault;
mod scale;
mod scaled;
#[cfg(test)]
mod testing;
mod world;

pub use bmp::GreyImage;
pub use fault::Fault;
pub use scale::Scale;
pub use scaled::ScaledWorld;
pub use world::{Difficulty, World, number_of_config};
