//! The format of a file, by its name.

use crate::{Fault, Grid, Import, ascii_grid, geotiff, png_image};

/// Reads a grid in the format that the file's extension names.
///
/// # Errors
/// [`Fault`] names the place in the file, the value and what was expected, and the way out where there is
/// one.
pub fn read(file: &str, bytes: &[u8], import: &Import) -> Result<Grid, Fault> {
    let (_, extension) = split_name(file);
    match extension.as_str() {
        "png" => png_image::read(bytes, import),
        "asc" => ascii_grid::read(bytes, import),
        "tif" | "tiff" => geotiff::read(bytes, import),
        _ => Err(Fault::Extension { extension }),
    }
}

/// A file's name without folders and extension, and its extension in lower case.
pub fn split_name(file: &str) -> (&str, String) {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    match name.rsplit_once('.') {
        Some((stem, extension)) => (stem, extension.to_ascii_lowercase()),
        None => (name, String::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_split() {
        assert_eq!(split_name("a/b.c\\d.e.TIF"), ("d.e", "tif".to_owned()));
        assert_eq!(split_name("a.b/c"), ("c", String::new()));
    }
}
