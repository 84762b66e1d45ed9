//! A world as the files of a terrain and its scenarios.

use std::fmt::Write as _;

use crate::bmp::GreyImage;
use crate::fault::Fault;
use crate::scale::Scale;
use crate::world::World;

/// The robot has reached a goal within this distance at full scale, metres.
const GOAL_TOLERANCE_M: f64 = 8.0;
/// Length, width and height of a rock of scale 1, and of a tree, metres.
const ROCK_M: [f64; 3] = [4.4, 4.4, 3.8];
const TREE_M: [f64; 3] = [1.0, 1.0, 5.0];
/// Spacing of the pixels at full scale, metres.
const PIXEL_M: f64 = 1.0;

/// A world with its heights, and the factor for its lengths.
#[derive(Clone, Copy, Debug)]
pub struct ScaledWorld<'a> {
    /// The world.
    pub world: &'a World,
    /// Its heights, from black to white.
    pub heights: &'a GreyImage,
    /// The factor.
    pub scale: Scale,
}

impl ScaledWorld<'_> {
    /// The levels of the heights as a PNG image, the first row north.
    ///
    /// # Errors
    /// An image that PNG cannot hold.
    pub fn heights_png(&self) -> Result<Vec<u8>, Fault> {
        let GreyImage { columns, rows, levels } = self.heights;
        let fault = |error: png::EncodingError| Fault(error.to_string());
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, *columns as u32, *rows as u32);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header().map_err(fault)?.write_image_data(levels).map_err(fault)?;
        Ok(bytes)
    }

    /// The recipe of the terrain, which imports the heights by [`World::heights_name`].
    ///
    /// # Errors
    /// A rock or tree off the map, with its place and what was expected.
    pub fn recipe(&self) -> Result<String, Fault> {
        let World { number, max_height_m, .. } = self.world;
        let difficulty = self.world.difficulty.name();
        let mut text = format!(
            "name = \"Verti-Bench {number}\"\n\
             description = \"World {number} of Verti-Bench, {difficulty}, times {}\"\n\n\
             [import]\nfile = \"{}\"\ncell_m = {:?}\nheight_min_m = 0.0\nheight_max_m = {:?}\n",
            self.scale,
            self.world.heights_name(),
            self.scale.factor() * PIXEL_M,
            self.scale.factor() * max_height_m,
        );
        for (kind, obstacles, size_m) in
            [("rocks", &self.world.rocks, ROCK_M), ("trees", &self.world.trees, TREE_M)]
        {
            for (index, &[east_m, north_m, scale]) in obstacles.iter().enumerate() {
                let place = format!("{kind}[{}]", index + 1);
                let at = self.on_map(&place, [east_m, north_m])?;
                let size_m = size_m.map(|side_m| self.scaled_m(scale * side_m));
                // Writing to a string cannot fail.
                let _ = write!(text, "\n[[objects]]\nkind = \"box\"\nat = {at:?}\nsize_m = {size_m:?}\n");
            }
        }
        Ok(text)
    }

    /// The scenario of a pair, counted from 0, on the recipe in the folder `worlds` beside the scenario's
    /// own.
    ///
    /// # Errors
    /// A pair that the world does not have.
    pub fn scenario(&self, pair: usize) -> Result<String, Fault> {
        let World { number, pairs, .. } = self.world;
        let ends = pairs.get(pair).ok_or_else(|| {
            Fault(format!("world {number}, pair {}: expected 1 to {}", pair.wrapping_add(1), pairs.len()))
        })?;
        let [start, goal] = ends.map(|place| self.place_m(place));
        let heading_rad = libm::atan2(goal[1] - start[1], goal[0] - start[0]);
        Ok(format!(
            "# Verti-Bench, world {number}, pair {} of {}, times {}.\n\
             terrain = \"../worlds/{}\"\n\
             start = [{:?}, {:?}, {heading_rad:.4}]\n\
             goal = {goal:?}\n\
             seed = 1\n\n\
             [planner]\ngoal_tolerance_m = {:?}\n",
            pair + 1,
            pairs.len(),
            self.scale,
            self.world.recipe_name(),
            start[0],
            start[1],
            self.scaled_m(GOAL_TOLERANCE_M),
        ))
    }

    /// A place from the south-west corner.
    fn place_m(&self, [east_m, north_m]: [f64; 2]) -> [f64; 2] {
        let [east_reach_m, north_reach_m] = self.reach_m();
        [self.scaled_m(east_reach_m + east_m), self.scaled_m(north_reach_m + north_m)]
    }

    /// How far the map reaches from its middle, east and north, at full scale.
    fn reach_m(&self) -> [f64; 2] {
        [self.heights.columns, self.heights.rows].map(|pixels| (pixels as f64 - 1.0) / 2.0 * PIXEL_M)
    }

    /// A length times the scale, to a tenth of a millimetre.
    fn scaled_m(&self, length_m: f64) -> f64 {
        (self.scale.factor() * length_m * 1e4).round() / 1e4
    }

    /// A place from the south-west corner, which must be on the map.
    fn on_map(&self, place: &str, from_middle_m: [f64; 2]) -> Result<[f64; 2], Fault> {
        let reach_m = self.reach_m();
        if from_middle_m.into_iter().zip(reach_m).all(|(at_m, reach_m)| at_m.abs() <= reach_m) {
            return Ok(self.place_m(from_middle_m));
        }
        let number = self.world.number;
        Err(Fault(format!(
            "world {number}, {place} at {from_middle_m:?}: expected a place on the map, at most {reach_m:?} m \
             from its middle"
        )))
    }
}
