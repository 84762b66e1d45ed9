//! In the browser, kernel, mean, variance, bound and gradients agree with gpflow, and every scenario gives
//! the trajectory recorded natively, to the bit.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::panic, clippy::unwrap_used)]

use mapless_tests::{gpflow, learned_bits, scenarios_text::SCENARIOS};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};

// As the page does: a trial takes minutes, and the driver gives up on a page that does not answer for half of
// one.
wasm_bindgen_test_configure!(run_in_dedicated_worker);

#[wasm_bindgen_test]
fn gpflow_fixtures_agree() {
    assert_eq!(gpflow::compare(gpflow::SCENE).unwrap(), 5);
    assert_eq!(gpflow::compare(gpflow::KERNELS).unwrap(), 6);
}

#[wasm_bindgen_test]
fn learning_gives_the_native_bits() {
    assert_eq!(learned_bits::digest().unwrap(), learned_bits::RECORDED);
}

fn check(name: &str) {
    let scenario = SCENARIOS.iter().find(|scenario| scenario.name == name).unwrap();
    scenario.check().unwrap();
}

#[wasm_bindgen_test]
fn cht_ab_gives_the_native_digest() {
    check("cht-ab");
}

#[wasm_bindgen_test]
fn cht_ac_gives_the_native_digest() {
    check("cht-ac");
}

#[wasm_bindgen_test]
fn cht_ad_gives_the_native_digest() {
    check("cht-ad");
}

#[wasm_bindgen_test]
fn cht_ae_gives_the_native_digest() {
    check("cht-ae");
}

#[wasm_bindgen_test]
fn cht_ba_gives_the_native_digest() {
    check("cht-ba");
}

#[wasm_bindgen_test]
fn cht_bd_gives_the_native_digest() {
    check("cht-bd");
}

#[wasm_bindgen_test]
fn gsb_gives_the_native_digest() {
    check("gsb");
}

#[wasm_bindgen_test]
fn ht_gives_the_native_digest() {
    check("ht");
}

#[wasm_bindgen_test]
fn ml_gives_the_native_digest() {
    check("ml");
}

#[wasm_bindgen_test]
fn vta_gives_the_native_digest() {
    check("vta");
}

fn check_in_the_field(name: &str) {
    let scenario = SCENARIOS.iter().find(|scenario| scenario.name == name).unwrap();
    scenario.check_in_the_field().unwrap();
}

#[wasm_bindgen_test]
fn gsb_in_the_field_gives_the_native_digest() {
    check_in_the_field("gsb");
}

#[wasm_bindgen_test]
fn ht_in_the_field_gives_the_native_digest() {
    check_in_the_field("ht");
}
