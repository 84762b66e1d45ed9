//! Terrains and what shapes them: reading, generating, sculpting.

use js_sys::{Array, Object, Reflect};
use mapless_trials::Scenario;
use mapless_world::generate::{Difficulty, terrain_recipe};
use mapless_world::{SampleRect, Stroke, Terrain, load_terrain_bytes};
use toml::{Table, Value};
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

use crate::Session;

/// Loads a terrain; `imported` is the file that a recipe imports, empty when it imports none.
pub(crate) fn load(file: &str, bytes: &[u8], imported: &[u8]) -> Result<Terrain, JsError> {
    Ok(load_terrain_bytes(file, bytes, &mut |wanted| {
        if imported.is_empty() {
            return Err(format!("expected the file {wanted} beside the recipe"));
        }
        Ok(imported.to_vec())
    })?)
}

/// A checked scenario file as an object: `terrain`, `start` as x, y, heading, `waypoints` and `goal` as x, y, `seed`, and the tables `planner`,
/// `sensor` and `robot` as written, where they are there.
///
/// # Errors
/// The scenario's fault, with file, place, value and expectation.
#[wasm_bindgen]
pub fn read_scenario(file: &str, text: &str) -> Result<Object, JsError> {
    let scenario = Scenario::parse(file, text)?;
    let written: Table = mapless_toml::from_str(text)?;
    let numbers = |values: &[f64]| values.iter().map(|&value| JsValue::from_f64(value)).collect::<Array>();
    let result = Object::new();
    let (start, goal_m) = (scenario.start, scenario.goal_m);
    set(&result, "terrain", &JsValue::from_str(&scenario.terrain));
    set(&result, "start", &numbers(&[start.position_m.x, start.position_m.y, start.heading_rad]));
    let waypoints: Array = scenario.waypoints_m.iter().map(|place| numbers(&place.to_array())).collect();
    set(&result, "waypoints", &waypoints);
    set(&result, "goal", &numbers(&[goal_m.x, goal_m.y]));
    set(&result, "seed", &JsValue::from_f64(scenario.seed as f64));
    for (key, value) in &written {
        if ["planner", "sensor", "robot"].contains(&key.as_str()) {
            set(&result, key, &plain(value));
        }
    }
    Ok(result)
}

fn set(object: &Object, key: &str, value: &JsValue) {
    // An object of one's own takes every key.
    let _ = Reflect::set(object, &JsValue::from_str(key), value);
}

/// A value of a configuration as plain data.
fn plain(value: &Value) -> JsValue {
    match value {
        Value::String(text) => JsValue::from_str(text),
        Value::Integer(number) => JsValue::from_f64(*number as f64),
        Value::Float(number) => JsValue::from_f64(*number),
        Value::Boolean(truth) => JsValue::from_bool(*truth),
        Value::Datetime(time) => JsValue::from_str(&time.to_string()),
        Value::Array(items) => items.iter().map(plain).collect::<Array>().into(),
        Value::Table(table) => {
            let object = Object::new();
            for (key, value) in table {
                set(&object, key, &plain(value));
            }
            object.into()
        }
    }
}

/// The recipe of a generated terrain; `difficulty` is `easy`, `moderate` or `hard`.
///
/// # Errors
/// An unknown difficulty.
#[wasm_bindgen]
pub fn generated_recipe(difficulty: &str, seed: u32) -> Result<String, JsError> {
    let difficulty: Difficulty = difficulty.parse()?;
    Ok(terrain_recipe(&format!("{difficulty} {seed}"), difficulty, seed.into()))
}

/// Two level places of a terrain far from each other, for a start and a goal: x, y, x, y.
///
/// # Errors
/// A fault of the terrain, with place, value and expectation.
#[wasm_bindgen]
pub fn level_places(file: &str, terrain: &[u8], imported: &[u8]) -> Result<Vec<f64>, JsError> {
    let [start, goal] = load(file, terrain, imported)?.field.level_places();
    Ok(vec![start.x, start.y, goal.x, goal.y])
}

/// A terrain as a coarse grid for a picture: columns, rows, spacing, then the heights row by row from the south-west, with at
/// most `most` samples along a side.
///
/// # Errors
/// A fault of the terrain, with place, value and expectation.
#[wasm_bindgen]
pub fn terrain_preview(file: &str, terrain: &[u8], imported: &[u8], most: u32) -> Result<Vec<f32>, JsError> {
    let field = load(file, terrain, imported)?.field;
    let longer = field.columns().max(field.rows()) - 1;
    let stride = longer.div_ceil(most.max(2) as usize - 1).max(1);
    let every = |count: usize| (0..count).step_by(stride);
    let head = [every(field.columns()).count() as f32, every(field.rows()).count() as f32];
    let spacing_m = stride as f64 * field.cell_m();
    let rows = every(field.rows()).map(|row| row * field.columns());
    let heights = rows.flat_map(|row| every(field.columns()).map(move |column| row + column));
    Ok(head.into_iter().chain([spacing_m as f32]).chain(heights.map(|at| field.heights_m()[at])).collect())
}

#[wasm_bindgen]
impl Session {
    /// Applies a stroke, written as the keys of a recipe's `[[stroke]]`. Returns first column, first row, columns and rows of the
    /// samples that changed, or nothing when the stroke is off the terrain.
    ///
    /// # Errors
    /// A stroke that makes no sense; nothing then changes.
    pub fn sculpt(&mut self, stroke: &str) -> Result<Option<Vec<u32>>, JsError> {
        let mut changed: Option<SampleRect> = None;
        for brush in Stroke::parse(stroke)?.brushes() {
            if let Some(rect) = self.now.trial.sculpt(brush)? {
                changed = Some(changed.map_or(rect, |all| all.union(rect)));
            }
        }
        if changed.is_some() {
            self.history = None;
        }
        Ok(changed.map(|r| {
            [r.column_begin, r.row_begin, r.column_end - r.column_begin, r.row_end - r.row_begin]
                .map(|n| n as u32)
                .to_vec()
        }))
    }

    /// Puts heights, row by row from the south-west, in place of those in a rectangle.
    ///
    /// # Errors
    /// Heights that do not fit; nothing then changes.
    pub fn replace_ground(
        &mut self,
        column: usize,
        row: usize,
        columns: usize,
        heights_m: &[f32],
    ) -> Result<(), JsError> {
        let rows = heights_m.len().checked_div(columns).unwrap_or_default();
        let rect = SampleRect {
            column_begin: column,
            column_end: column.saturating_add(columns),
            row_begin: row,
            row_end: row.saturating_add(rows),
        };
        self.now.trial.replace_ground(rect, heights_m)?;
        self.history = None;
        Ok(())
    }
}
