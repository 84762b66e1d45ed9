//! The interface of a benchmark.

use std::collections::BTreeMap;

use crate::BenchError;

/// The values of a run, by name. A value that does not exist, such as the range of a beam without a return,
/// is NaN.
pub(crate) type Values = BTreeMap<&'static str, Vec<f64>>;

/// A piece of work that can be repeated.
pub(crate) trait Work {
    /// Preparation of a run, not timed.
    fn prepare(&mut self) -> Result<(), BenchError> {
        Ok(())
    }

    /// The timed run.
    fn run(&mut self) -> Result<(), BenchError>;

    /// The values of the last run.
    fn values(&mut self) -> Values;
}
