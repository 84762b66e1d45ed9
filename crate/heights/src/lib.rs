//! Heights from files of other programs: ESRI ASCII grids, GeoTIFF and PNG, as one regular grid in metres.
//!
//! What a file says for certain is applied: its spacing, its units, which way is up, and which samples are
//! holes. What cannot be told is refused, with the place, the value and the way out; nothing is guessed in
//! silence. Origins are ignored: local coordinates begin at the south-west sample.
//!
//! ```
//! use mapless_heights::{Holes, Import, read};
//!
//! let file = b"ncols 3\nnrows 2\ncellsize 0.5\n1 -9999 3\n4 5 6\n";
//! let refused = read("hill.asc", file, &Import::default()).unwrap_err();
//! assert!(refused.to_string().contains("row 1, column 2 = -9999: expected a height in metres"));
//!
//! let grid = read("hill.asc", file, &Import { holes: Holes::Fill, ..Import::default() })?;
//! assert_eq!((grid.columns, grid.rows, grid.cell_m), (3, 2, 0.5));
//! assert_eq!(&grid.heights_m[..3], [4.0, 5.0, 6.0]);
//! assert!(grid.warnings[0].starts_with("1 of 6 samples was a hole"));
//! # Ok::<(), mapless_heights::Fault>(())
//! ```

// Tests state exact values where the arithmetic is exact.
#![cfg_attr(test, allow(clippy::float_cmp))]

mod ascii_grid;
mod fault;
mod geotiff;
mod holes;
mod png_image;
mod samples;
mod spacing;

pub use fault::Fault;
pub use samples::{MAX_SAMPLES, split_name};
pub use spacing::MIN_CELL_M;

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
    /// What was done to the file's numbers that its owner should know, in whole sentences without a full stop.
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

/// Reads a grid in the format that the file's extension names.
///
/// # Errors
/// [`Fault`] names the place in the file, the value and what was expected, and the way out where there is one.
pub fn read(file: &str, bytes: &[u8], import: &Import) -> Result<Grid, Fault> {
    let (_, extension) = split_name(file);
    match extension.as_str() {
        "png" => png_image::read(bytes, import),
        "asc" => ascii_grid::read(bytes, import),
        "tif" | "tiff" => geotiff::read(bytes, import),
        _ => Err(Fault::Extension { extension }),
    }
}
