//! One error and two checks for the validated configurations of sensor and robot.

use thiserror::Error;

/// A configuration value outside its range.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{field} = {value}: expected {expected}")]
pub struct ConfigError {
    /// Name of the field.
    pub field: &'static str,
    /// The value found.
    pub value: f64,
    /// What is allowed there.
    pub expected: String,
}

/// Accepts a value in `low..=high`.
pub(crate) fn within(field: &'static str, value: f64, low: f64, high: f64) -> Result<(), ConfigError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(ConfigError { field, value, expected: format!("a number from {low} to {high}") })
}

/// Accepts a finite value above zero.
pub(crate) fn positive(field: &'static str, value: f64) -> Result<(), ConfigError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(ConfigError { field, value, expected: "a finite number above 0".to_owned() })
}
