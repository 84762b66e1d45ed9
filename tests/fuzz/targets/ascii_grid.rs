//! The reader of `asc` files, with every choice for holes.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mapless_heights::{Holes, Import, read};

fuzz_target!(|bytes: &[u8]| {
    for (_, holes) in Holes::NAMES {
        if let Ok(grid) = read("heights.asc", bytes, &Import { holes, ..Import::default() }) {
            assert_eq!(grid.heights_m.len(), grid.columns * grid.rows);
            assert!(grid.heights_m.iter().all(|height| height.is_finite()));
        }
    }
});
