//! What may be wrong with a file of the benchmark.

/// What is wrong with a file of the benchmark: the place, the value and what was expected, without the file's
/// name.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct Fault(pub(crate) String);
