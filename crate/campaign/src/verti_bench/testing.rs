//! A small benchmark for tests.

#[path = "../../../verti-bench/src/testing.rs"]
mod image;

use std::fs;
use std::path::Path;

use image::bmp;

/// Sides of the image of a small world, and its middle.
const SIDE: usize = 41;

/// Writes a small benchmark: one world of ground that rises to the north, with a rock north-east of its
/// middle and a tree, two pairs of start and goal, and one world of ground that gives.
pub(crate) fn write(folder: &Path) {
    fs::create_dir(folder.join("worlds")).unwrap();
    let levels: Vec<u8> = (0..SIDE * SIDE).map(|at| 100 - (at / SIDE) as u8).collect();
    fs::write(folder.join("worlds/3.bmp"), bmp(SIDE, &levels)).unwrap();
    fs::write(folder.join("tasks.json"), TASKS).unwrap();
}

/// What [`write()`] says of the worlds.
pub(crate) const TASKS: &str = r#"{
"3": {"difficulty":"mid","terrain_type":"rigid","max_height_m":10.2,
  "rocks":[[10.0,5.0,0.5]],"trees":[[-15.0,-15.0,1.0]],
  "pairs":[[[-15.0,5.0],[15.0,-10.0]],[[-15.0,-5.0],[-15.0,14.5]]]},
"7": {"difficulty":"low","terrain_type":"mixed","max_height_m":4.8,"rocks":[],"trees":[],"pairs":[]}
}"#;
