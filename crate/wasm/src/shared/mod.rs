//! What both modules of the page say to it in the same words. Every name is the same on both sides, with its
//! unit.

mod crossing;
mod motion;
mod overrides;
pub(crate) mod panic;
mod pose;

pub(crate) use crossing::{give, read};
pub use motion::{Metrics, Outcome};
pub(crate) use overrides::changed;
pub use overrides::{OverrideValue, Overrides};
pub use pose::Pose;
