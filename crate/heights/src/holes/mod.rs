//! Ways to make ground of a grid with holes.

mod crop;
mod fill;

pub(crate) use crop::largest_whole;
pub(crate) use fill::fill;
