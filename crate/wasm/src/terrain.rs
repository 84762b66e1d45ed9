//! Terrains: reading them, generating them, and their heights as a grid.

use js_sys::{Float32Array, Uint8Array};
use mapless_terrain::generate::{Family, terrain_recipe};
use mapless_terrain::{Fault, Grid, Import, Imported, Terrain, load_recipe};
use mapless_world::{HeightField, Objects, SampleRect};
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::objects::{Solid, SolidList};
use crate::places::Place;
use crate::shared::{give, read};

/// A terrain by the file that describes it.
#[derive(Debug, Deserialize, Tsify)]
pub struct TerrainFiles {
    name: String,
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Uint8Array")]
    bytes: Uint8Array,
    /// The heights of the file that the recipe imports, where it imports one: read as `import_of` says.
    #[tsify(optional)]
    imported: Option<Ground>,
}

/// The file that a recipe imports, and how to read it.
#[derive(Debug, Serialize, Tsify)]
pub struct ImportRequest {
    file: String,
    /// In place of the file's own.
    #[tsify(optional)]
    cell_m: Option<f64>,
    /// Of black and white.
    #[tsify(optional)]
    height_min_m: Option<f64>,
    #[tsify(optional)]
    height_max_m: Option<f64>,
    /// `refuse`, `fill` or `crop`.
    holes: String,
}

impl TerrainFiles {
    pub(crate) fn load(&self) -> Result<Terrain, JsError> {
        // A module of its own has read the file: this one is what every visitor loads.
        let mut imported = |wanted: &str, _: &Import| {
            let missing = || Fault::Read { reason: format!("expected the file {wanted} beside the recipe") };
            self.imported.as_ref().map(Ground::grid).ok_or_else(missing)
        };
        Ok(load_recipe(&self.name, &self.bytes.to_vec(), &mut imported)?)
    }
}

/// A regular grid of heights: row by row, each from west to east, the southern row first.
#[derive(Debug, Serialize, Deserialize, Tsify)]
pub struct Ground {
    columns: usize,
    rows: usize,
    cell_m: f64,
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    heights_m: Float32Array,
}

impl Ground {
    pub(crate) fn of(field: &HeightField) -> Self {
        Self {
            columns: field.columns(),
            rows: field.rows(),
            cell_m: field.cell_m(),
            heights_m: Float32Array::from(field.heights_m()),
        }
    }

    fn grid(&self) -> Grid {
        let Self { columns, rows, cell_m, heights_m } = self;
        let heights_m = heights_m.to_vec();
        Grid { columns: *columns, rows: *rows, cell_m: *cell_m, heights_m, warnings: Vec::new() }
    }

    /// Every so many samples, so that there are at most `most` along a side.
    fn coarse(field: &HeightField, most: u32) -> Self {
        let longer = field.columns().max(field.rows()) - 1;
        let stride = longer.div_ceil(most.max(2) as usize - 1).max(1);
        let every = |count: usize| (0..count).step_by(stride);
        let rows = every(field.rows()).map(|row| row * field.columns());
        let samples = rows.flat_map(|row| every(field.columns()).map(move |column| row + column));
        let heights_m: Vec<f32> = samples.map(|at| field.heights_m()[at]).collect();
        Self {
            columns: every(field.columns()).count(),
            rows: every(field.rows()).count(),
            cell_m: stride as f64 * field.cell_m(),
            heights_m: Float32Array::from(heights_m.as_slice()),
        }
    }
}

/// The heights of a rectangle of the grid, row by row from its south-western corner.
#[derive(Debug, Serialize, Deserialize, Tsify)]
pub struct GroundPatch {
    column: usize,
    row: usize,
    columns: usize,
    rows: usize,
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    heights_m: Float32Array,
}

impl GroundPatch {
    pub(crate) fn of(field: &HeightField, rect: SampleRect) -> Self {
        let columns = rect.column_begin..rect.column_end;
        let lines = field.heights_m().chunks_exact(field.columns());
        let lines = lines.skip(rect.row_begin).take(rect.row_end - rect.row_begin);
        let heights_m: Vec<f32> = lines.flat_map(|line| &line[columns.clone()]).copied().collect();
        Self {
            column: rect.column_begin,
            row: rect.row_begin,
            columns: columns.len(),
            rows: rect.row_end - rect.row_begin,
            heights_m: Float32Array::from(heights_m.as_slice()),
        }
    }

    pub(crate) fn rect(&self) -> SampleRect {
        SampleRect {
            column_begin: self.column,
            column_end: self.column.saturating_add(self.columns),
            row_begin: self.row,
            row_end: self.row.saturating_add(self.rows),
        }
    }

    pub(crate) fn heights_m(&self) -> Vec<f32> {
        self.heights_m.to_vec()
    }
}

/// A terrain for a picture.
#[derive(Debug, Serialize, Tsify)]
pub struct TerrainPreview {
    /// Coarsely.
    ground: Ground,
    /// The shapes of what stands and walks on it.
    solids: SolidList,
}

/// Two level places of a terrain far from each other.
#[derive(Debug, Serialize, Tsify)]
pub struct LevelPlaces {
    start: Place,
    goal: Place,
}

/// The recipe of a generated terrain of a family, such as `hard` or `rocks`.
///
/// # Errors
/// An unknown family.
#[wasm_bindgen]
pub fn generated_recipe(family: &str, seed: u32) -> Result<String, JsError> {
    let family: Family = family.parse()?;
    Ok(terrain_recipe(&format!("{family} {seed}"), family, seed.into()))
}

/// What a recipe imports; nothing where it imports nothing.
///
/// # Errors
/// A fault of the recipe, with place, value and expectation.
#[wasm_bindgen]
pub fn import_of(file: &str, recipe: &str) -> Result<Option<Ts<ImportRequest>>, JsError> {
    let Some(Imported { file, import }) = mapless_terrain::import_of(file, recipe)? else { return Ok(None) };
    let Import { cell_m, range_m, holes } = import;
    let (height_min_m, height_max_m) = range_m.unzip();
    let holes = holes.name().to_owned();
    give(&ImportRequest { file, cell_m, height_min_m, height_max_m, holes }).map(Some)
}

/// Two level places of a terrain far from each other and from its objects, for a start and a goal.
///
/// # Errors
/// A fault of the terrain, with place, value and expectation.
#[wasm_bindgen]
pub fn level_places(terrain: Ts<TerrainFiles>) -> Result<Ts<LevelPlaces>, JsError> {
    let Terrain { field, objects, .. } = read(terrain)?.load()?;
    let [start, goal] = field.level_places(Objects::new(objects, &field).solids());
    give(&LevelPlaces { start: start.into(), goal: goal.into() })
}

/// A terrain for a picture: its objects, and a coarse grid with at most `most` samples along a side.
///
/// # Errors
/// A fault of the terrain, with place, value and expectation.
#[wasm_bindgen]
pub fn terrain_preview(terrain: Ts<TerrainFiles>, most: u32) -> Result<Ts<TerrainPreview>, JsError> {
    let Terrain { field, objects, .. } = read(terrain)?.load()?;
    let objects = Objects::new(objects, &field);
    let solids = SolidList(objects.solids().iter().map(Solid::from).collect());
    give(&TerrainPreview { ground: Ground::coarse(&field, most), solids })
}
