//! Errors of input.

/// A configuration value outside its meaning.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}.{name} = {value}: expected {expected}")]
pub struct ConfigError {
    /// Table that holds the value, such as `planner.perception`.
    pub place: String,
    /// Name of the value.
    pub name: &'static str,
    /// The value as given.
    pub value: String,
    /// What was expected instead.
    pub expected: &'static str,
}

/// Fails with a [`ConfigError`] unless `ok`.
pub(crate) fn require(
    ok: bool,
    place: &str,
    name: &'static str,
    value: impl ToString,
    expected: &'static str,
) -> Result<(), ConfigError> {
    if ok {
        Ok(())
    } else {
        Err(ConfigError { place: place.to_owned(), name, value: value.to_string(), expected })
    }
}
