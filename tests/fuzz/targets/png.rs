//! The reader of `png` files, with every choice for holes.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mapless_heights::{Holes, Import, read};

fuzz_target!(|bytes: &[u8]| {
    for (_, holes) in Holes::NAMES {
        for range_m in [None, Some((-1.0, 2.0))] {
            if let Ok(grid) = read("heights.png", bytes, &Import { cell_m: None, range_m, holes }) {
                assert_eq!(grid.heights_m.len(), grid.columns * grid.rows);
                assert!(grid.heights_m.iter().all(|height| height.is_finite()));
            }
        }
    }
});
