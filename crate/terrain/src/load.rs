//! Loading a terrain from a file of any supported format.

use crate::recipe;
use crate::terrain::{Terrain, TerrainError, TerrainFault};
use mapless_heights::{Fault, Grid, Import};

/// Builds the terrain of a recipe; see [`crate::recipe`] for its tables.
///
/// `read` reads the file that a recipe imports, given its path relative to the recipe and how to read it.
///
/// # Errors
/// [`TerrainError`] names the file, the place in it, the value and what was expected.
pub fn load_recipe(
    file: &str,
    bytes: &[u8],
    read: &mut dyn FnMut(&str, &Import) -> Result<Grid, Fault>,
) -> Result<Terrain, TerrainError> {
    let text = std::str::from_utf8(bytes).map_err(|error| TerrainFault::damaged("recipe", error).of(file))?;
    recipe::load(file, text, read)
}

/// Loads a terrain file from disk: a recipe (`.toml`), or heights in a format of [`mapless_heights`].
///
/// # Errors
/// [`TerrainError`] names the file, the place in it, the value and what was expected.
#[cfg(not(target_arch = "wasm32"))]
pub fn load_terrain(path: &std::path::Path) -> Result<Terrain, TerrainError> {
    let file = path.display().to_string();
    let bytes = read_file(path).map_err(|fault| TerrainFault::from(fault).of(&file))?;
    let (stem, extension) = mapless_heights::split_name(&file);
    if extension == "toml" {
        return load_recipe(&file, &bytes, &mut |relative, import| {
            mapless_heights::read(relative, &read_file(&path.with_file_name(relative))?, import)
        });
    }
    let grid = mapless_heights::read(&file, &bytes, &Import::default());
    let grid = grid.map_err(|fault| TerrainFault::from(fault).of(&file))?;
    let (field, warnings) = crate::terrain::ground(&file, grid)?;
    Ok(Terrain { name: stem.to_owned(), description: String::new(), field, objects: Vec::new(), warnings })
}

#[cfg(not(target_arch = "wasm32"))]
fn read_file(path: &std::path::Path) -> Result<Vec<u8>, Fault> {
    /// An ESRI grid of the largest size, at 16 characters a sample.
    const MAX_BYTES: u64 = 256 << 20;
    let fault = |reason: String| Fault::Read { reason };
    let length = std::fs::metadata(path).map_err(|error| fault(error.to_string()))?.len();
    if length > MAX_BYTES {
        return Err(fault(format!("{length} bytes: expected at most {MAX_BYTES}")));
    }
    std::fs::read(path).map_err(|error| fault(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::path::{Path, PathBuf};

    fn no_import(_: &str, _: &Import) -> Result<Grid, Fault> {
        Err(Fault::Read { reason: "no such file".to_owned() })
    }

    #[test]
    fn extension_decides_the_format() {
        let folder = std::env::temp_dir().join(format!("mapless-load-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let load = |file: &str| {
            let path = folder.join(file);
            std::fs::write(&path, "x").unwrap();
            let error = load_terrain(&path).unwrap_err();
            assert_eq!(error.file, path.display().to_string());
            error.fault.to_string()
        };
        assert_eq!(
            load("b.xyz"),
            "extension \"xyz\": expected .png, .asc, .tif or .tiff, or .toml for a recipe"
        );
        assert!(load("noextension").contains("extension \"\""));
        assert!(load("a.PNG").starts_with("not a valid PNG file"));
        assert!(load("a.toml").starts_with("not a valid recipe file"));
        std::fs::write(folder.join("g.asc"), "ncols 2\nnrows 2\ncellsize 0,5\n1 2 3 4").unwrap();
        let terrain = load_terrain(&folder.join("g.asc")).unwrap();
        assert_eq!((terrain.name.as_str(), terrain.field.cell_m()), ("g", 0.5));
        assert!(terrain.warnings[0].ends_with("g.asc: decimal commas are read as decimal points"));
        std::fs::write(folder.join("g.asc"), "ncols 2\nnrows 2\ncellsize 2000\n1 2 3 4").unwrap();
        assert!(load_terrain(&folder.join("g.asc")).unwrap_err().to_string().contains("spacing of 2000 m"));
        std::fs::remove_dir_all(&folder).unwrap();
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
                drop(mapless_heights::read(file, &whole[..length], &Import::default()));
            }
            for at in (0..whole.len().min(3000)).step_by(7) {
                let mut bytes = whole.clone();
                bytes[at] ^= 0xa5;
                drop(mapless_heights::read(file, &bytes, &Import::default()));
            }
        }
    }

    proptest! {
        #[test]
        fn garbage_is_an_error(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            prop_assert!(load_recipe("a.toml", &bytes, &mut no_import).is_err());
            for file in ["a.png", "a.asc", "a.tif"] {
                prop_assert!(mapless_heights::read(file, &bytes, &Import::default()).is_err());
            }
        }

        #[test]
        fn garbage_text_is_an_error(text in "[a-z0-9 =\\[\\].\"\n-]{0,200}") {
            prop_assert!(load_recipe("a.toml", text.as_bytes(), &mut no_import).is_err());
            prop_assert!(mapless_heights::read("a.asc", text.as_bytes(), &Import::default()).is_err());
        }
    }
}
