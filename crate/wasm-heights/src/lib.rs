//! Heights from files, for the page. A module of its own: the page opens without it, and asks for it when
//! somebody opens such a file.

#[path = "../../wasm/src/shared/panic.rs"]
mod panic;

use mapless_heights::{Grid, Import};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// Runs once when the page loads the module.
#[wasm_bindgen(start)]
pub fn start() {
    panic::install_hook();
}

/// A regular grid of heights: row by row, each from west to east, the southern row first.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Heights {
    file: String,
    grid: Grid,
}

#[wasm_bindgen]
impl Heights {
    /// Samples from west to east.
    #[wasm_bindgen(getter)]
    pub fn columns(&self) -> usize {
        self.grid.columns
    }

    /// Samples from south to north.
    #[wasm_bindgen(getter)]
    pub fn rows(&self) -> usize {
        self.grid.rows
    }

    /// Spacing of the samples, in metres.
    #[wasm_bindgen(getter)]
    pub fn cell_m(&self) -> f64 {
        self.grid.cell_m
    }

    /// What was done to the file's numbers that its owner should know, each with the file's name.
    #[wasm_bindgen(getter)]
    pub fn warnings(&self) -> Vec<String> {
        self.grid.warnings.iter().map(|warning| format!("{}: {warning}", self.file)).collect()
    }

    /// The heights in metres. They can be taken once.
    pub fn take_heights_m(&mut self) -> Vec<f32> {
        std::mem::take(&mut self.grid.heights_m)
    }
}

/// Reads a file in the format that its extension names, as a recipe's `[import]` says.
///
/// # Errors
/// A fault of the file, with its name, place, value and expectation.
#[wasm_bindgen]
pub fn read_heights(
    file: &str,
    bytes: &[u8],
    cell_m: Option<f64>,
    height_min_m: Option<f64>,
    height_max_m: Option<f64>,
    holes: &str,
) -> Result<Heights, JsError> {
    let named = |fault| JsError::new(&format!("{file}: {fault}"));
    let import =
        Import { cell_m, range_m: height_min_m.zip(height_max_m), holes: holes.parse().map_err(named)? };
    mapless_heights::read(file, bytes, &import)
        .map(|grid| Heights { file: file.to_owned(), grid })
        .map_err(named)
}
