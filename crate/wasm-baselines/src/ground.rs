//! The ground that trials run on.

use mapless_world::HeightField;
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// The ground that trials run on, as the page has it now.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Ground {
    pub(crate) field: HeightField,
}

#[wasm_bindgen]
impl Ground {
    /// A height field, row by row from the south-west.
    ///
    /// # Errors
    /// Heights that make no field.
    #[wasm_bindgen(constructor)]
    pub fn new(columns: usize, rows: usize, cell_m: f64, heights_m: Vec<f32>) -> Result<Ground, JsError> {
        Ok(Ground { field: HeightField::new(columns, rows, cell_m, heights_m)? })
    }
}
