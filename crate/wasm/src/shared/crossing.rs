//! Crossing between the module and JavaScript.

use serde::Serialize;
use serde::de::DeserializeOwned;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, JsValue};

/// Reads what JavaScript gave.
pub(crate) fn read<T: Tsify + DeserializeOwned>(given: Ts<T>) -> Result<T, JsError> {
    Ok(T::from_js(JsValue::from(given))?)
}

/// Gives something to JavaScript.
pub(crate) fn give<T: Tsify + Serialize>(value: &T) -> Result<Ts<T>, JsError> {
    Ok(Ts::new_unchecked(value.into_js()?.into()))
}
