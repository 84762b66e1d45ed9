//! A panic by itself is a trap without a word.

use js_sys::WebAssembly::RuntimeError;

/// Throws a panic's message as what a trap throws: a `WebAssembly.RuntimeError`, after which the module is
/// not to be used.
pub(crate) fn install_hook() {
    std::panic::set_hook(Box::new(|info| {
        wasm_bindgen::throw_val(RuntimeError::new(&info.to_string()).into())
    }));
}
