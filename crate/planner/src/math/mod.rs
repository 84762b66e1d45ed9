//! Arithmetic that gives the same bits on every target: angles, elementary functions, dense linear algebra
//! and optimisers.

pub mod angle;
pub(crate) mod cholesky;
pub(crate) mod elementary;
pub(crate) mod linalg;
pub(crate) mod optimiser;
pub(crate) mod panels;
