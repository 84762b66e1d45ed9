//! A piece of work: what is done once per repetition, and what came of it.

use std::collections::BTreeMap;

use crate::BenchError;

/// What a piece of work gave, by name. What does not exist, such as the range of a beam without a return, is
/// NaN.
pub(crate) type Values = BTreeMap<&'static str, Vec<f64>>;

/// A piece of work that can be repeated.
pub(crate) trait Work {
    /// What has to be done first and is not timed.
    fn prepare(&mut self) -> Result<(), BenchError> {
        Ok(())
    }

    /// What is timed.
    fn run(&mut self) -> Result<(), BenchError>;

    /// What the last run gave.
    fn values(&mut self) -> Values;
}
