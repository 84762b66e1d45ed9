//! A small benchmark for tests.

use std::fs;
use std::path::Path;

/// A grey BMP image of these levels, from the north-west, row by row.
pub(crate) fn bmp(columns: usize, levels: &[u8]) -> Vec<u8> {
    let rows = levels.len() / columns;
    let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    let mut bytes = b"BM".to_vec();
    bytes.extend(words(&[0, 0, 1078, 40, columns as u32, rows as u32, (8 << 16) | 1, 0, 0, 0, 0, 0, 0]));
    bytes.extend((0..=255).flat_map(|grey| [grey, grey, grey, 0]));
    for line in levels.chunks_exact(columns).rev() {
        bytes.extend(line);
        bytes.extend(&[0; 3][..columns.next_multiple_of(4) - columns]);
    }
    bytes
}

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
