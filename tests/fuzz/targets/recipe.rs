//! The reader of `toml` terrains.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut read =
        |_: &str, _: &_| Err(mapless_terrain::Fault::Read { reason: "nothing to import".to_owned() });
    if let Ok(terrain) = mapless_terrain::load_recipe("recipe.toml", bytes, &mut read) {
        assert!(terrain.field.heights_m().iter().all(|height| height.is_finite()));
    }
});
