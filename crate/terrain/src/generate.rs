//! Terrains by seed, not shaped for any planner: recipes of a named difficulty.
//!
//! A terrain is a square of 50 to 80 m with one to three kinds of landform: hills and basins, ridges with
//! passes, valleys with fords, terraces with ramps, craters and ditches, rough ground. A difficulty sets the
//! slope of their flanks, their number and the roughness. A bank too steep to climb closes the terrain,
//! because no planner can see that a world ends. A [`Family`] is one of these difficulties, or has obstacles
//! on ground that is gentle, or on ground of any difficulty (`mixed`). The same seed and family give the same
//! recipe, to the byte.

mod family;
mod landforms;
mod obstacles;
mod writer;

pub use family::{Difficulty, Family, UnknownFamily};

use glam::DVec2;
use landforms::{LANDFORMS, Site};
use mapless_world::random::{Sequence, key};
use std::fmt::Write as _;
use writer::Writer;

/// The bank along the border: Gaussian, half of it inside.
const BANK_HEIGHT_M: f64 = 2.5;
const BANK_WIDTH_M: f64 = 0.6;
/// Within this distance of the border the ground belongs to the bank, metres.
pub const BANK_REACH_M: f64 = 2.0;

/// The parameters of a difficulty. Slopes are rise over run, drawn for every landform.
struct Level {
    /// Steepest slope of a landform's flank.
    flank: [f64; 2],
    /// Landforms compared with those of a moderate terrain.
    density: f64,
    /// Kinds of landform on one terrain.
    kinds: [u32; 2],
    /// Amplitude of the broad swell under everything, metres at a wavelength of 25 to 40 m.
    swell_m: [f64; 2],
    /// Amplitude of the roughness on everything, metres at a wavelength of 2.5 to 4 m.
    roughness_m: [f64; 2],
}

/// The levels, easy first. `mapless generate` prints the slopes that result.
const LEVELS: [Level; 3] = [
    Level {
        flank: [0.25, 0.75],
        density: 0.8,
        kinds: [1, 2],
        swell_m: [0.3, 1.2],
        roughness_m: [0.01, 0.05],
    },
    Level {
        flank: [0.45, 1.10],
        density: 1.2,
        kinds: [1, 3],
        swell_m: [0.5, 2.0],
        roughness_m: [0.03, 0.08],
    },
    Level {
        flank: [0.70, 1.50],
        density: 1.6,
        kinds: [2, 3],
        swell_m: [0.8, 3.0],
        roughness_m: [0.05, 0.13],
    },
];

/// Ground of gentle slopes under obstacles.
const GENTLE: Level =
    Level { flank: [0.0, 0.0], density: 0.0, kinds: [0, 0], swell_m: [0.3, 1.0], roughness_m: [0.01, 0.03] };
/// Side of the terrains with obstacles, metres.
const OBSTACLE_SIDE_M: [u32; 2] = [45, 55];
/// Spacing of samples where ditches have to be resolved, metres.
const DITCH_CELL_M: f64 = 0.1;

/// A recipe for [`crate::load_recipe`], with a name of one's own.
#[must_use]
pub fn terrain_recipe(name: &str, family: Family, seed: u64) -> String {
    let mut draw = Sequence::new(key(seed, family.index()));
    let level = match family {
        Family::Ground(difficulty) => &LEVELS[difficulty as usize],
        Family::Mixed => &LEVELS[draw.whole([0, LEVELS.len() as u32 - 1]) as usize],
        _ => &GENTLE,
    };
    let is_bare = matches!(family, Family::Ground(_));
    let side_m = f64::from(draw.whole(if is_bare { [50, 80] } else { OBSTACLE_SIDE_M }));
    let mut cell_m = if draw.happens(0.5) { 0.2 } else { 0.25 };
    if family == Family::Ditches {
        cell_m = DITCH_CELL_M;
    }

    let mut left: Vec<usize> = (0..LANDFORMS.len()).collect();
    let count = draw.whole(level.kinds);
    let chosen: Vec<usize> =
        (0..count).map(|_| left.remove(draw.whole([0, left.len() as u32 - 1]) as usize)).collect();
    let mut tables = Writer::default();
    let site = Site { side_m, flank: level.flank, share: level.density / f64::from(count.max(1)) };
    for &index in &chosen {
        (LANDFORMS[index].shape)(&site, &mut draw, &mut tables);
    }
    tables.noise(draw.between(level.swell_m), draw.between([25.0, 40.0]), 2);
    tables.noise(draw.between(level.roughness_m), draw.between([2.5, 4.0]), 2);
    let obstacles = obstacles::of(family, side_m, &mut draw, &mut tables);

    let corners = [[0.0, 0.0], [side_m, 0.0], [side_m, side_m], [0.0, side_m]].map(DVec2::from_array);
    for index in 0..4 {
        tables.ridge(&[corners[index], corners[(index + 1) % 4]], &[BANK_HEIGHT_M; 2], BANK_WIDTH_M);
    }

    let kinds: Vec<&str> = chosen.iter().map(|&index| LANDFORMS[index].name).chain(obstacles).collect();
    let mut recipe = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        recipe,
        "name = {name:?}\ndescription = \"Generated, {family}: {}.\"\nsize_m = [{side_m:.1}, {side_m:.1}]\n\
         cell_m = {cell_m}\nseed = {}\n",
        kinds.join(", "),
        key(seed, 0) >> 32
    );
    recipe + &tables.into_text()
}

#[cfg(test)]
mod tests;
