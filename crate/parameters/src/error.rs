//! What can be wrong with a configuration.

/// A configuration value that makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}{}{name} = {value}: expected {expected}", if place.is_empty() { "" } else { "." })]
pub struct ConfigError {
    /// Table that holds the value, such as `planner.perception`; empty where there is none.
    pub place: String,
    /// Name of the value.
    pub name: &'static str,
    /// The value as given.
    pub value: String,
    /// What was expected instead.
    pub expected: String,
}

impl ConfigError {
    /// Fails unless `ok`: for what relates several parameters.
    ///
    /// # Errors
    /// This error, unless `ok`.
    pub fn require(
        ok: bool,
        place: &str,
        name: &'static str,
        value: impl ToString,
        expected: &str,
    ) -> Result<(), Self> {
        if ok {
            return Ok(());
        }
        Err(Self { place: place.to_owned(), name, value: value.to_string(), expected: expected.to_owned() })
    }
}
