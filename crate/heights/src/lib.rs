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
mod format;
mod geotiff;
mod grid;
mod holes;
mod png_image;
mod samples;
mod spacing;

pub use fault::Fault;
pub use format::{read, split_name};
pub use grid::{Grid, Holes, Import};
pub use samples::MAX_SAMPLES;
pub use spacing::MIN_CELL_M;
