//! A piece of work: what is done once per repetition, and what came of it.

use std::collections::BTreeMap;

use crate::BenchError;
use crate::drive::{Drive, WholeTrial};
use crate::gaussian::{Bound, Posterior};
use crate::peak::Peak;
use crate::sensing::{Scanning, Tick};

/// What a piece of work gave, by name. What does not exist, such as the range of a beam without a return, is NaN.
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

/// Makes the piece of work called `name`.
pub(crate) fn make(name: &str) -> Result<Box<dyn Work>, BenchError> {
    let unknown = || BenchError::Unknown(name.to_owned());
    let number = |text: &str| text.parse::<usize>().ok().filter(|&n| n > 0).ok_or_else(unknown);
    Ok(match name.rsplit_once('-').unwrap_or((name, "")) {
        ("posterior", inducing) => Box::new(Posterior::of_level_scan(number(inducing)?)?),
        ("posterior-inputs", stride) => Box::new(Posterior::of_full_scan(number(stride)?)?),
        ("bound", inducing) => Box::new(Bound::of_level_scan(number(inducing)?)?),
        ("tick", "level") => Box::new(Tick::on_level_scan()?),
        ("tick", "full") => Box::new(Tick::on_full_scan()?),
        ("tick-columns", columns) => Box::new(Tick::on_rugged_ground(number(columns)?)?),
        ("drive", "") => Box::new(Drive::new()?),
        ("scan-rugged", samples) => Box::new(Scanning::rugged(number(samples)?)?),
        ("scan-level", samples) => Box::new(Scanning::level(number(samples)?)?),
        ("peak", "") => Box::new(Peak),
        _ => match name.strip_prefix("trial-") {
            Some(scenario) => Box::new(WholeTrial::new(scenario)?),
            None => return Err(unknown()),
        },
    })
}
