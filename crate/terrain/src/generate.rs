//! Terrains by seed, not shaped for any planner: recipes of a named difficulty.
//!
//! A terrain is a square of 50 to 80 m with one to three kinds of landform: hills and basins, ridges with
//! passes, valleys with fords, terraces with ramps, craters and ditches, rough ground. A difficulty sets the
//! slope of their flanks, their number and the roughness. A bank too steep to climb closes the terrain,
//! because no planner can see that a world ends. The same seed and difficulty give the same recipe, to the
//! byte.

mod landforms;
mod writer;

use glam::DVec2;
use landforms::{LANDFORMS, Site};
use mapless_world::random::{Sequence, key};
use std::fmt::{self, Write as _};
use std::str::FromStr;
use writer::Writer;

/// The bank along the border: Gaussian, half of it inside.
const BANK_HEIGHT_M: f64 = 2.5;
const BANK_WIDTH_M: f64 = 0.6;
/// Within this distance of the border the ground belongs to the bank, metres.
pub const BANK_REACH_M: f64 = 2.0;

/// How hard a generated terrain is to cross.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Difficulty {
    /// Little is steeper than a Husky may roll.
    Easy,
    /// Many flanks have to be gone around.
    Moderate,
    /// Most flanks have to be gone around, and the ground between is rough.
    Hard,
}

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

impl Difficulty {
    /// All of them, easy first.
    pub const ALL: [Self; 3] = [Self::Easy, Self::Moderate, Self::Hard];

    /// The name in files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Easy => "easy",
            Self::Moderate => "moderate",
            Self::Hard => "hard",
        }
    }

    fn level(self) -> &'static Level {
        match self {
            Self::Easy => &LEVELS[0],
            Self::Moderate => &LEVELS[1],
            Self::Hard => &LEVELS[2],
        }
    }
}

impl fmt::Display for Difficulty {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that is no difficulty.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("difficulty \"{name}\": expected easy, moderate or hard")]
pub struct UnknownDifficulty {
    /// The name.
    pub name: String,
}

impl FromStr for Difficulty {
    type Err = UnknownDifficulty;

    fn from_str(name: &str) -> Result<Self, UnknownDifficulty> {
        let found = Self::ALL.into_iter().find(|difficulty| difficulty.name() == name);
        found.ok_or_else(|| UnknownDifficulty { name: name.to_owned() })
    }
}

/// A recipe for [`crate::load_recipe`], with a name of one's own.
#[must_use]
pub fn terrain_recipe(name: &str, difficulty: Difficulty, seed: u64) -> String {
    let level = difficulty.level();
    let mut draw = Sequence::new(key(seed, difficulty as u64));
    let side_m = f64::from(draw.whole([50, 80]));
    let cell_m = if draw.happens(0.5) { 0.2 } else { 0.25 };

    let mut left: Vec<usize> = (0..LANDFORMS.len()).collect();
    let count = draw.whole(level.kinds);
    let chosen: Vec<usize> =
        (0..count).map(|_| left.remove(draw.whole([0, left.len() as u32 - 1]) as usize)).collect();
    let mut tables = Writer::default();
    let site = Site { side_m, flank: level.flank, share: level.density / f64::from(count) };
    for &index in &chosen {
        (LANDFORMS[index].shape)(&site, &mut draw, &mut tables);
    }
    tables.noise(draw.between(level.swell_m), draw.between([25.0, 40.0]), 2);
    tables.noise(draw.between(level.roughness_m), draw.between([2.5, 4.0]), 2);

    let corners = [[0.0, 0.0], [side_m, 0.0], [side_m, side_m], [0.0, side_m]].map(DVec2::from_array);
    for index in 0..4 {
        tables.ridge(&[corners[index], corners[(index + 1) % 4]], &[BANK_HEIGHT_M; 2], BANK_WIDTH_M);
    }

    let kinds: Vec<&str> = chosen.iter().map(|&index| LANDFORMS[index].name).collect();
    let mut recipe = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        recipe,
        "name = {name:?}\ndescription = \"Generated, {difficulty}: {}.\"\nsize_m = [{side_m:.1}, {side_m:.1}]\n\
         cell_m = {cell_m}\nseed = {}\n",
        kinds.join(", "),
        key(seed, 0) >> 32
    );
    recipe + &tables.into_text()
}

#[cfg(test)]
mod tests;
