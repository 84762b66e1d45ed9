//! Gaussian process regression: the rational quadratic kernel, the sparse posterior (variational free
//! energy), the exact one to compare with, the collapsed bound and the learning of hyperparameters.

pub mod bound;
pub mod exact;
pub mod hyperparameters;
pub(crate) mod jitter;
pub mod kernel;
mod kernel_panels;
pub mod learning;
mod projection;
mod reduction;
pub mod sparse;

pub use jitter::GpError;
