//! The module's one function for Node and Chromium.

use std::cell::RefCell;

use wasm_bindgen::prelude::wasm_bindgen;

use crate::Bench;

thread_local! {
    static BENCH: RefCell<Bench> = RefCell::default();
}

/// Answers one request; see [`Bench::answer`].
#[wasm_bindgen]
pub fn answer(request: &str) -> String {
    BENCH.with_borrow_mut(|bench| bench.answer(request))
}
