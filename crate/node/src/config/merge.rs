//! A configuration with what a section of a file sets.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// `config` with the entries of `section`; `Null` sets nothing.
pub(crate) fn merged<C: Serialize + DeserializeOwned>(
    config: &C,
    section: &Value,
) -> Result<C, serde_json::Error> {
    let mut value = serde_json::to_value(config)?;
    merge(&mut value, section);
    serde_json::from_value(value)
}

fn merge(base: &mut Value, over: &Value) {
    match (base, over) {
        (_, Value::Null) => {}
        (Value::Object(base), Value::Object(over)) => {
            for (key, value) in over {
                merge(base.entry(key.clone()).or_insert(Value::Null), value);
            }
        }
        (base, over) => *base = over.clone(),
    }
}
