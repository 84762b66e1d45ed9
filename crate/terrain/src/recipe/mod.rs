//! Terrain recipes: a readable TOML file that adds up features.
//!
//! ```toml
//! name = "two hills"
//! description = "A trail between two hills."
//! size_m = [60.0, 40.0]          # east, north; multiples of cell_m
//! cell_m = 0.2
//! seed = 7                       # for [[noise]]
//! base_m = 10.0                  # height before any feature, default 0
//! tilt = [0.01, 0.0]             # dz/dx, dz/dy, default level
//!
//! [[hill]]                       # Gaussian
//! centre = [20.0, 20.0]
//! height_m = 4.0                 # negative: a hollow
//! radius_m = 5.0                 # one standard deviation; the steepest slope is 0.61 height_m / radius_m
//! stretch = 2.0                  # this much longer along ...
//! heading_rad = 0.5              # ... this direction, counter-clockwise from east
//!
//! [[plateau]]                    # flat top, smooth-step flank (steepest slope 1.5 height_m / flank_m)
//! centre = [40.0, 10.0]
//! height_m = 3.0
//! top_radius_m = 4.0
//! flank_m = 6.0
//!
//! [[ridge]]                      # Gaussian across a smooth line through the points
//! points = [[5.0, 5.0], [20.0, 8.0], [35.0, 5.0]]
//! height_m = [2.0, 3.0, 1.0]     # one for all, or one per point
//! width_m = 2.0                  # one standard deviation
//!
//! [[valley]]                     # the same downwards, with depth_m
//! points = [[0.0, 30.0], [60.0, 30.0]]
//! depth_m = 1.5
//! width_m = 3.0
//!
//! [[crater]]                     # smooth bowl; the rim fades out over about its radius
//! centre = [50.0, 30.0]
//! radius_m = 5.0                 # of the rim
//! depth_m = 1.5                  # of the middle, below the ground around
//! rim_height_m = 0.5
//!
//! [[noise]]                      # gradient noise; each octave halves the wavelength and the amplitude
//! amplitude_m = 0.3
//! wavelength_m = 8.0
//! octaves = 4
//!
//! [[trail]]                      # after all other features, in order
//! points = [[2.0, 20.0], [30.0, 22.0], [58.0, 20.0]]
//! height_m = [10.0, 12.0, 10.0]  # optional, for all or per point; default: the ground along the line
//! width_m = 2.0                  # level across
//! shoulder_m = 2.0               # blends into the ground over this on each side
//! smoothing_m = 8.0              # the height along the line is averaged over this, default 4 width_m
//!
//! [[stroke]]                     # by hand, last of all, in order; see [`crate::Stroke`]
//! kind = "raise"
//! radius_m = 2.0
//! strength_m = 0.1
//! points = [[10.0, 12.0], [10.5, 12.0]]
//!
//! [[objects]]                    # stands on the ground and is not ground; see [`mapless_world::Object`]
//! kind = "post"                  # or box, rock, wall, gate, roof
//! at = [20.0, 22.0]
//! radius_m = 0.1
//! height_m = 1.5
//! ```
//!
//! In place of `size_m` and `cell_m` a recipe may start from a grid in another file:
//!
//! ```toml
//! [import]
//! file = "island.png"            # .png, .asc, .tif or .tiff, relative to the recipe
//! cell_m = 0.2                   # in place of the file's own spacing
//! holes = "fill"                 # from the heights around, or "crop" to the largest part without; default
//!                                # "refuse"
//! height_min_m = -2.0            # of black, and of white; PNG only, both or neither
//! height_max_m = 8.0
//! ```
//!
//! Every other key is an error, and so is a value outside its range; messages count tables and points from 1.

mod canvas;
mod check;
mod features;
mod line;
mod trail;

use crate::stroke::{Stroke, StrokeTable};
use crate::terrain::{Terrain, TerrainError, TerrainFault, ground};
use canvas::{Canvas, Effort};
use check::Table;
use features::{Crater, Feature, Hill, Noise, Plateau, Ridge, Valley};
use mapless_heights::{Fault, Grid, Holes, split_name};
use mapless_toml::Located;
use mapless_world::{HeightField, Object, check_grid};
use serde::Deserialize;
use trail::Trail;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Recipe {
    name: String,
    #[serde(default)]
    description: String,
    size_m: Option<[f64; 2]>,
    cell_m: Option<f64>,
    #[serde(default)]
    seed: u64,
    #[serde(default)]
    base_m: f64,
    #[serde(default)]
    tilt: [f64; 2],
    import: Option<Import>,
    #[serde(default)]
    hill: Vec<Located<Hill>>,
    #[serde(default)]
    plateau: Vec<Located<Plateau>>,
    #[serde(default)]
    ridge: Vec<Located<Ridge>>,
    #[serde(default)]
    valley: Vec<Located<Valley>>,
    #[serde(default)]
    crater: Vec<Located<Crater>>,
    #[serde(default)]
    noise: Vec<Located<Noise>>,
    #[serde(default)]
    trail: Vec<Located<Trail>>,
    #[serde(default)]
    stroke: Vec<Located<StrokeTable>>,
    #[serde(default)]
    objects: Vec<Located<Object>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Import {
    file: String,
    cell_m: Option<f64>,
    height_min_m: Option<f64>,
    height_max_m: Option<f64>,
    holes: Option<String>,
}

/// The file that a recipe imports.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Its path relative to the recipe.
    pub file: String,
    /// How to read it.
    pub import: mapless_heights::Import,
}

/// What a recipe imports, if it does.
///
/// # Errors
/// [`TerrainError`] names the place in the recipe, the value and what was expected.
pub fn import_of(file: &str, text: &str) -> Result<Option<Imported>, TerrainError> {
    let Some(import) = parse(file, text)?.import else { return Ok(None) };
    import.checked().map(Some).map_err(|fault| fault.of(file))
}

fn parse(file: &str, text: &str) -> Result<Recipe, TerrainError> {
    mapless_toml::from_str(text).map_err(|error| TerrainFault::damaged("recipe", error).of(file))
}

/// Reads a file, given its path relative to the recipe and how to read it.
type Read<'a> = &'a mut dyn FnMut(&str, &mapless_heights::Import) -> Result<Grid, Fault>;

/// Builds the terrain of a recipe.
pub(crate) fn load(file: &str, text: &str, read: Read<'_>) -> Result<Terrain, TerrainError> {
    let recipe = parse(file, text)?;
    let (mut canvas, warnings) = recipe.ground(file, read)?;
    let field = recipe.shape(text, &mut canvas).and_then(|()| {
        let heights_m = canvas.heights_m.iter().map(|&height| height as f32).collect();
        let mut field = HeightField::new(canvas.columns, canvas.rows, canvas.cell_m, heights_m)?;
        recipe.sculpt(text, &mut field, canvas.effort)?;
        Ok(field)
    });
    let field = field.map_err(|fault| fault.of(file))?;
    recipe.check_objects(text).map_err(|fault| fault.of(file))?;
    let objects = recipe.objects.into_iter().map(|object| object.value).collect();
    Ok(Terrain { name: recipe.name, description: recipe.description, field, objects, warnings })
}

impl Recipe {
    fn check_objects(&self, text: &str) -> Result<(), TerrainFault> {
        self.objects.iter().enumerate().try_for_each(|(index, object)| {
            let table = Table::at(text, object.begin, "objects", index);
            object.value.validate("").map_err(|error| table.fault(error.name, error.value, error.expected))
        })
    }

    /// The ground before any feature, and what is to be said of it.
    fn ground(&self, file: &str, read: Read<'_>) -> Result<(Canvas, Vec<String>), TerrainError> {
        let Some(import) = &self.import else {
            return self.level_ground().map(|canvas| (canvas, Vec::new())).map_err(|fault| fault.of(file));
        };
        if self.size_m.is_some() || self.cell_m.is_some() {
            let expected = "none of them beside [import], whose file has its own size";
            return Err(TerrainFault::value("size_m, cell_m", "present", expected).of(file));
        }
        let Imported { file: wanted, import } = import.checked().map_err(|fault| fault.of(file))?;
        let grid = read(&wanted, &import).map_err(|fault| TerrainFault::from(fault).of(&wanted))?;
        let (field, warnings) = ground(&wanted, grid)?;
        Ok((Canvas::from_field(&field), warnings))
    }

    fn level_ground(&self) -> Result<Canvas, TerrainFault> {
        let missing = |key: &str| TerrainFault::value(key, "absent", "a value, or an [import] table");
        let size_m = self.size_m.ok_or_else(|| missing("size_m"))?;
        let cell_m = self.cell_m.ok_or_else(|| missing("cell_m"))?;
        let mut samples = [0; 2];
        for (count, side_m) in samples.iter_mut().zip(size_m) {
            let cells = (side_m / cell_m).round();
            if !(side_m > 0.0 && (cells * cell_m - side_m).abs() <= 1e-6 * cell_m) {
                let expected = format!("positive multiples of cell_m = {cell_m}");
                return Err(TerrainFault::value("size_m", format!("{size_m:?}"), expected));
            }
            // The cast stops at the largest integer, beyond which there is no other.
            *count = (cells as usize).saturating_add(1);
        }
        let [columns, rows] = samples;
        let count = check_grid(columns, rows, cell_m)?;
        Ok(Canvas { columns, rows, cell_m, heights_m: vec![0.0; count], effort: Effort::default() })
    }

    /// Adds every feature to the ground.
    fn shape(&self, text: &str, canvas: &mut Canvas) -> Result<(), TerrainFault> {
        let top = Table::top_level();
        top.finite("base_m", self.base_m)?;
        top.finite("tilt", self.tilt[0])?;
        top.finite("tilt", self.tilt[1])?;
        let lift =
            canvas.each(|at, height_m| *height_m += self.base_m + self.tilt[0] * at.x + self.tilt[1] * at.y);
        lift.map_err(|much| top.too_much(much))?;
        add(text, "hill", &self.hill, self.seed, canvas)?;
        add(text, "plateau", &self.plateau, self.seed, canvas)?;
        add(text, "ridge", &self.ridge, self.seed, canvas)?;
        add(text, "valley", &self.valley, self.seed, canvas)?;
        add(text, "crater", &self.crater, self.seed, canvas)?;
        add(text, "noise", &self.noise, self.seed, canvas)?;
        add(text, "trail", &self.trail, self.seed, canvas)
    }

    /// Repeats the strokes. They work on the finished field, as they did when they were made.
    fn sculpt(&self, text: &str, field: &mut HeightField, mut effort: Effort) -> Result<(), TerrainFault> {
        for (index, table) in self.stroke.iter().enumerate() {
            let at = Table::at(text, table.begin, "stroke", index);
            let stroke = Stroke::try_from(&table.value).map_err(|error| at.stroke_fault(error))?;
            effort.spend(stroke.samples(field)).map_err(|much| at.too_much(much))?;
            for brush in stroke.brushes() {
                field.sculpt(brush).map_err(|fault| at.fault(fault.name, fault.value, fault.expected))?;
            }
        }
        Ok(())
    }
}

/// Checks all tables of one kind, then applies them in their order.
fn add<F: Feature>(
    text: &str,
    kind: &'static str,
    features: &[Located<F>],
    seed: u64,
    canvas: &mut Canvas,
) -> Result<(), TerrainFault> {
    for (index, feature) in features.iter().enumerate() {
        let table = Table::at(text, feature.begin, kind, index);
        feature.value.check(&table, canvas)?;
        let applied = feature.value.apply(canvas, mapless_world::random::key(seed, index as u64));
        applied.map_err(|much| table.too_much(much))?;
    }
    Ok(())
}

impl Import {
    fn checked(&self) -> Result<Imported, TerrainFault> {
        let is_absolute = self.file.starts_with(['/', '\\']) || self.file.contains(':');
        if is_absolute || split_name(&self.file).1 == "toml" {
            let expected = "an image or grid, by its path relative to the recipe";
            return Err(TerrainFault::value("import.file", format!("\"{}\"", self.file), expected));
        }
        let range_m = match (self.height_min_m, self.height_max_m) {
            (None, None) => None,
            (Some(low), Some(high)) if low < high && low.is_finite() && high.is_finite() => Some((low, high)),
            (low, high) => {
                let show =
                    |height: Option<f64>| height.map_or("absent".to_owned(), |height| height.to_string());
                let found = format!("{}, {}", show(low), show(high));
                let expected = "two finite heights, the smaller first, or neither";
                return Err(TerrainFault::value("import.height_min_m, height_max_m", found, expected));
            }
        };
        if range_m.is_some() && split_name(&self.file).1 != "png" {
            let expected = "no heights beside a grid that has its own";
            return Err(TerrainFault::value("import.height_min_m, height_max_m", "present", expected));
        }
        let holes = self.holes.as_ref().map_or(Ok(Holes::default()), |holes| holes.parse())?;
        let import = mapless_heights::Import { cell_m: self.cell_m, range_m, holes };
        Ok(Imported { file: self.file.clone(), import })
    }
}

// What a file may hold, a field may hold.
const _: () = assert!(mapless_heights::MAX_SAMPLES == mapless_world::MAX_SAMPLES);
const _: () = assert!(mapless_heights::MIN_CELL_M == mapless_world::MIN_CELL_M);

#[cfg(test)]
mod tests;
