//! Loading a terrain from a file of any supported format.

use crate::import::{self, split_name};
use crate::recipe;
use crate::terrain::{Terrain, TerrainError, TerrainFault};

/// Loads a terrain from the bytes of a file. The extension of `file` decides the format:
///
/// - `.toml`: a recipe; see [`crate::recipe`] for its tables.
/// - `.png`: 16-bit greyscale, first row north, one grey level = 1 mm; spacing from pHYs in metres, otherwise
///   0.25 m.
/// - `.asc`: ESRI ASCII grid.
/// - `.tif`, `.tiff`: GeoTIFF with one band of heights in metres.
///
/// `resolve` fetches the file a recipe imports, given its path relative to the recipe.
///
/// # Errors
/// [`TerrainError`] names the file, the place in it, the value and what was expected.
pub fn load_terrain_bytes(
    file: &str,
    bytes: &[u8],
    resolve: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Terrain, TerrainError> {
    let (stem, extension) = split_name(file);
    if extension == "toml" {
        let text =
            std::str::from_utf8(bytes).map_err(|error| TerrainFault::damaged("recipe", error).of(file))?;
        return recipe::load(file, text, resolve);
    }
    let field = import::read(file, bytes, &import::Scale::default())?;
    Ok(Terrain { name: stem.to_owned(), description: String::new(), field })
}

/// Loads a terrain file from disk; see [`load_terrain_bytes`].
///
/// # Errors
/// [`TerrainError`] names the file, the place in it, the value and what was expected.
#[cfg(not(target_arch = "wasm32"))]
pub fn load_terrain(path: &std::path::Path) -> Result<Terrain, TerrainError> {
    let file = path.display().to_string();
    let bytes = read_file(path).map_err(|reason| TerrainFault::Read { reason }.of(&file))?;
    load_terrain_bytes(&file, &bytes, &mut |relative| read_file(&path.with_file_name(relative)))
}

#[cfg(not(target_arch = "wasm32"))]
fn read_file(path: &std::path::Path) -> Result<Vec<u8>, String> {
    /// An ESRI grid of the largest size, at 16 characters a sample.
    const MAX_BYTES: u64 = 256 << 20;
    let length = std::fs::metadata(path).map_err(|error| error.to_string())?.len();
    if length > MAX_BYTES {
        return Err(format!("{length} bytes: expected at most {MAX_BYTES}"));
    }
    std::fs::read(path).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::path::{Path, PathBuf};

    fn no_import(_: &str) -> Result<Vec<u8>, String> {
        Err("no such file".to_owned())
    }

    #[test]
    fn extension_decides_the_format() {
        let load = |file| load_terrain_bytes(file, b"x", &mut no_import).unwrap_err().to_string();
        assert_eq!(load("a/b.xyz"), "a/b.xyz: extension \"xyz\": expected .toml, .png, .asc, .tif or .tiff");
        assert!(load("noextension").contains("extension \"\""));
        assert!(load("a.PNG").starts_with("a.PNG: not a valid PNG file"));
        assert!(load("a.toml").starts_with("a.toml: not a valid recipe file"));
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = load_terrain(Path::new("no/such.asc")).unwrap_err();
        assert!(error.to_string().starts_with("no/such.asc: cannot be read: "), "{error}");
    }

    /// Real elevation models.
    fn grids() -> PathBuf {
        Path::new(&std::env::var_os("MAPLESS_DATA").unwrap()).join("data/dem")
    }

    #[test]
    #[ignore = "reads the data that MAPLESS_DATA names"]
    fn real_elevation_grids_load() {
        let folder = grids();
        let bank = load_terrain(&folder.join("kootenai_37x50_1m_mit.asc")).unwrap();
        assert_eq!((bank.field.columns(), bank.field.rows()), (50, 37));
        assert!((bank.field.cell_m() - 1.0).abs() < 1e-12);
        // The first value of the file is the north-west sample.
        assert!((bank.field.heights_m()[36 * 50] - 543.34).abs() < 1e-3);
        let (low, high) = bank.field.height_range_m();
        assert!((high - low - 6.5).abs() < 0.1, "{low} {high}");

        let moon = load_terrain(&folder.join("moon_80x80m_apache2.tif")).unwrap();
        let extent = moon.field.extent_m();
        assert!((70.0..90.0).contains(&extent.x) && (70.0..90.0).contains(&extent.y), "{extent}");
        let (low, high) = moon.field.height_range_m();
        assert!((high - low - 6.9).abs() < 0.1, "{low} {high}");
    }

    #[test]
    #[ignore = "reads the data that MAPLESS_DATA names"]
    fn damaged_real_grids_never_panic() {
        let folder = grids();
        for file in ["kootenai_37x50_1m_mit.asc", "moon_80x80m_apache2.tif"] {
            let whole = std::fs::read(folder.join(file)).unwrap();
            for length in (0..whole.len()).step_by(101) {
                drop(load_terrain_bytes(file, &whole[..length], &mut no_import));
            }
            for at in (0..whole.len().min(3000)).step_by(7) {
                let mut bytes = whole.clone();
                bytes[at] ^= 0xa5;
                drop(load_terrain_bytes(file, &bytes, &mut no_import));
            }
        }
    }

    proptest! {
        #[test]
        fn garbage_is_an_error(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            for file in ["a.toml", "a.png", "a.asc", "a.tif"] {
                prop_assert!(load_terrain_bytes(file, &bytes, &mut no_import).is_err());
            }
        }

        #[test]
        fn garbage_text_is_an_error(text in "[a-z0-9 =\\[\\].\"\n-]{0,200}") {
            for file in ["a.toml", "a.asc"] {
                prop_assert!(load_terrain_bytes(file, text.as_bytes(), &mut no_import).is_err());
            }
        }
    }
}
