//! The closed loop for the page: [`Trial`](mapless_trials::Trial) behind typed arrays.
//!
//! Nothing is decided here. Numbers leave as flat arrays whose order is written at each function; the page's
//! `web/src/core/decode.ts` names them again. All are in SI units and radians, in the frames of `mapless-world`.

mod encode;
mod ground;
mod panic;
mod session;

pub use ground::{generated_recipe, level_places, read_scenario, terrain_preview};
pub use session::Session;

use wasm_bindgen::prelude::wasm_bindgen;

/// Runs once when the page loads the module.
#[wasm_bindgen(start)]
pub fn start() {
    panic::install_hook();
}
