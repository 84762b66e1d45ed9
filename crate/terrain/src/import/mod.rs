//! Height grids from other programs. Geographic origins are ignored: local coordinates begin at the
//! south-west sample.

mod ascii_grid;
mod geotiff;
mod png16;

use crate::terrain::{TerrainError, TerrainFault};
use mapless_world::HeightField;

/// What a recipe says about the file it imports.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Scale {
    /// Spacing in metres, in place of the file's own.
    pub(crate) cell_m: Option<f64>,
    /// Heights in metres of black and white, for images.
    pub(crate) range_m: Option<(f64, f64)>,
}

/// Reads a grid in the format that the file's extension names.
pub(crate) fn read(file: &str, bytes: &[u8], scale: &Scale) -> Result<HeightField, TerrainError> {
    let (_, extension) = split_name(file);
    let field = match extension.as_str() {
        "png" => png16::read(bytes, scale),
        "asc" => ascii_grid::read(bytes, scale.cell_m),
        "tif" | "tiff" => geotiff::read(bytes, scale.cell_m),
        _ => Err(TerrainFault::Extension { extension }),
    };
    field.map_err(|fault| fault.of(file))
}

/// The file's name without folders and extension, and its extension in lower case.
pub(crate) fn split_name(file: &str) -> (&str, String) {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    match name.rsplit_once('.') {
        Some((stem, extension)) => (stem, extension.to_ascii_lowercase()),
        None => (name, String::new()),
    }
}

/// Turns rows that begin in the north, as images and maps store them, into rows that begin in the south.
fn south_first(heights_m: &mut [f32], columns: usize) {
    let rows = heights_m.len() / columns;
    for row in 0..rows / 2 {
        let (south, north) = heights_m.split_at_mut((rows - 1 - row) * columns);
        south[row * columns..(row + 1) * columns].swap_with_slice(&mut north[..columns]);
    }
}
