//! The reader of `png` terrains.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut resolve = |_: &str| Err("nothing to import".to_owned());
    if let Ok(terrain) = mapless_terrain::load_terrain_bytes("heights.png", bytes, &mut resolve) {
        assert!(terrain.field.heights_m().iter().all(|height| height.is_finite()));
    }
});
