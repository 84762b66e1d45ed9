//! A grid of heights, and how it is wanted.

use crate::Fault;
use std::str::FromStr;

/// A regular grid of heights.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Samples from west to east.
    pub columns: usize,
    /// Samples from south to north.
    pub rows: usize,
    /// Spacing of the samples, in metres.
    pub cell_m: f64,
    /// Heights in metres: row by row from the south, each from west to east.
    pub heights_m: Vec<f32>,
    /// What was done to the file's numbers that its owner should know, in sentences without a full stop.
    pub warnings: Vec<String>,
}

/// How a file is to be read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Import {
    /// Spacing in metres, in place of the file's own.
    pub cell_m: Option<f64>,
    /// Heights in metres of black and white, for images.
    pub range_m: Option<(f64, f64)>,
    /// What becomes of holes.
    pub holes: Holes,
}

/// What becomes of samples without a height.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Holes {
    /// The file is refused.
    #[default]
    Refuse,
    /// Each hole gets a height from around it: the solution of Laplace's equation, which has neither pits nor
    /// peaks. At most half of the samples may be holes.
    Fill,
    /// The largest rectangle without a hole is taken.
    Crop,
}

impl Holes {
    /// The words for it in a recipe.
    pub const NAMES: [(&str, Self); 3] =
        [("refuse", Self::Refuse), ("fill", Self::Fill), ("crop", Self::Crop)];

    /// The word for it in a recipe.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, holes)| *holes == self).map_or("", |(name, _)| name)
    }
}

impl FromStr for Holes {
    type Err = Fault;

    fn from_str(text: &str) -> Result<Self, Fault> {
        let found = Self::NAMES.iter().find(|(name, _)| *name == text);
        let unknown =
            || Fault::value("import.holes", format!("\"{text}\""), "\"refuse\", \"fill\" or \"crop\"");
        found.map(|(_, holes)| *holes).ok_or_else(unknown)
    }
}
