//! A panic traps without a word; its message is left where the worker that catches the trap finds it.

use wasm_bindgen::JsValue;

/// Property of the global object that holds the last panic's message.
const MESSAGE_PROPERTY: &str = "maplessPanic";

/// Keeps the message of a panic in the global object.
pub(crate) fn install_hook() {
    std::panic::set_hook(Box::new(|info| {
        let message = JsValue::from_str(&info.to_string());
        // A global object that takes no properties leaves only the bare trap, which is shown all the same.
        let _ = js_sys::Reflect::set(&js_sys::global(), &JsValue::from_str(MESSAGE_PROPERTY), &message);
    }));
}
