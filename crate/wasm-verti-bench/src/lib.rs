//! Worlds of Verti-Bench, for the page. A module of its own: the page opens without it, and asks for it when
//! somebody opens such a world.

#[path = "../../wasm/src/shared/panic.rs"]
mod panic;

use mapless_verti_bench::{GreyImage, Scale, ScaledWorld, World};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// Runs once when the page loads the module.
#[wasm_bindgen(start)]
pub fn start() {
    panic::install_hook();
}

/// A world with its heights.
#[wasm_bindgen]
#[derive(Debug)]
pub struct VertiBenchWorld {
    config_name: String,
    world: World,
    heights: GreyImage,
}

/// Names and contents of the files of a task: scenario and recipe are text, the heights a PNG image.
#[wasm_bindgen(getter_with_clone)]
#[derive(Clone, Debug)]
pub struct VertiBenchTask {
    /// Of the scenario.
    pub scenario_name: String,
    /// The scenario.
    pub scenario: String,
    /// Of the recipe.
    pub recipe_name: String,
    /// The recipe of the terrain, with rocks and trees.
    pub recipe: String,
    /// Of the heights.
    pub heights_name: String,
    /// The heights.
    pub heights: Vec<u8>,
}

/// Reads a world's description, `config3_mid.yaml` and its like, and its heights, `3.bmp`.
///
/// # Errors
/// A fault of a file, with its name, place, value and expectation; ground that gives.
#[wasm_bindgen]
pub fn read_verti_bench(
    config_name: &str,
    config: &str,
    image_name: &str,
    image: &[u8],
) -> Result<VertiBenchWorld, JsError> {
    let of_config = |fault: &dyn std::fmt::Display| JsError::new(&format!("{config_name}: {fault}"));
    let world = World::from_config(config_name, config).map_err(|fault| of_config(&fault))?;
    if !world.is_rigid {
        let number = world.number;
        return Err(of_config(&format!(
            "the ground of world {number} gives: expected terrain_type: rigid, since no ground gives here"
        )));
    }
    let heights = GreyImage::from_bmp(image);
    let heights = heights.map_err(|fault| JsError::new(&format!("{image_name}: {fault}")))?;
    Ok(VertiBenchWorld { config_name: config_name.to_owned(), world, heights })
}

#[wasm_bindgen]
impl VertiBenchWorld {
    /// Its number.
    #[wasm_bindgen(getter)]
    pub fn number(&self) -> u32 {
        self.world.number
    }

    /// How steep and how dense it is: `low`, `mid` or `high`.
    #[wasm_bindgen(getter)]
    pub fn difficulty(&self) -> String {
        self.world.difficulty.name().to_owned()
    }

    /// How many pairs of start and goal it has.
    #[wasm_bindgen(getter)]
    pub fn pairs(&self) -> usize {
        self.world.pairs.len()
    }

    /// The files of a pair, counted from 1, with all lengths times `scale`, such as `1/5`.
    ///
    /// # Errors
    /// A rock or tree off the map, a pair that the world does not have, or what is no scale.
    pub fn task(&self, pair: usize, scale: &str) -> Result<VertiBenchTask, JsError> {
        let named =
            |fault: mapless_verti_bench::Fault| JsError::new(&format!("{}: {fault}", self.config_name));
        let scale: Scale = scale.parse()?;
        let Self { world, heights, .. } = self;
        let scaled = ScaledWorld { world, heights, scale };
        let index = pair.wrapping_sub(1);
        Ok(VertiBenchTask {
            scenario: scaled.scenario(index).map_err(named)?,
            scenario_name: world.scenario_name(index),
            recipe_name: world.recipe_name(),
            recipe: scaled.recipe().map_err(named)?,
            heights_name: world.heights_name(),
            heights: scaled.heights_png().map_err(named)?,
        })
    }
}
