//! What stands and walks on the ground, for the page.

use mapless_world::{Object, Shape};
use serde::{Deserialize, Serialize};
use tsify::Tsify;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen(typescript_custom_section)]
const OBJECT: &str = r"
/** A walk from the object's place along points and back again, over and over. */
export interface Walk {
    path: [number, number][];
    speed_m_s: number;
    /** It stands until the robot is this near. */
    starts_within_m?: number;
}

/** Something that stands on the ground and is not ground, as in scenario files. */
export type WorldObject =
    | { kind: 'post'; at: [number, number]; radius_m: number; height_m: number; walk?: Walk }
    | { kind: 'box'; at: [number, number]; size_m: [number, number, number]; yaw_rad?: number; raised_m?: number; walk?: Walk }
    | { kind: 'rock'; at: [number, number]; radius_m: number; sunk_m?: number }
    | { kind: 'wall'; from: [number, number]; to: [number, number]; height_m: number; thickness_m?: number }
    | { kind: 'gate'; at: [number, number]; yaw_rad: number; width_m: number; height_m: number }
    | { kind: 'roof'; at: [number, number]; size_m: [number, number, number]; yaw_rad?: number; height_m: number };
";

/// Objects, as in scenario files.
#[derive(Debug, Serialize, Deserialize, Tsify)]
pub struct ObjectList(#[tsify(type = "WorldObject[]")] pub(crate) Vec<Object>);

/// A shape that an object is made of.
#[derive(Debug, Serialize, Tsify)]
pub struct Solid {
    /// Index of the object.
    object: usize,
    /// `box`, `cylinder` or `ball`.
    #[tsify(type = "'box' | 'cylinder' | 'ball'")]
    shape: &'static str,
    /// Centre in the world.
    #[tsify(type = "[number, number, number]")]
    centre_m: [f64; 3],
    /// Length, width and height; of a cylinder and of a ball, the diameter stands for the first two.
    #[tsify(type = "[number, number, number]")]
    size_m: [f64; 3],
    /// Sine and cosine of the direction of its length, counter-clockwise from east.
    #[tsify(type = "[number, number]")]
    sin_cos_yaw: [f64; 2],
}

/// Shapes.
#[derive(Debug, Serialize, Tsify)]
pub struct SolidList(pub(crate) Vec<Solid>);

impl From<&mapless_world::Solid> for Solid {
    fn from(solid: &mapless_world::Solid) -> Self {
        let (shape, size_m, sin_cos_yaw) = match solid.shape {
            Shape::Cuboid { half_m, sin_cos_yaw: (sin, cos) } => {
                ("box", (2.0 * half_m).to_array(), [sin, cos])
            }
            Shape::Cylinder { radius_m, half_height_m } => {
                ("cylinder", [2.0 * radius_m, 2.0 * radius_m, 2.0 * half_height_m], [0.0, 1.0])
            }
            Shape::Ball { radius_m } => ("ball", [2.0 * radius_m; 3], [0.0, 1.0]),
        };
        Self { object: solid.object, shape, centre_m: solid.centre_m.to_array(), size_m, sin_cos_yaw }
    }
}
