//! The benchmarks by name.

use mapless_trials::RealityPreset;

use crate::BenchError;
use crate::drive::{Drive, WholeTrial};
use crate::gaussian::{Bound, Posterior};
use crate::peak::Peak;
use crate::sensing::{Scanning, Tick};
use crate::work::Work;

/// Makes the benchmark `name`.
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
        ("scan-objects", samples) => Box::new(Scanning::rugged(number(samples)?)?.among_objects()),
        ("scan-near", samples) => Box::new(Scanning::rugged(number(samples)?)?.within_sight()?),
        ("scan-near-objects", samples) => {
            Box::new(Scanning::rugged(number(samples)?)?.among_objects().within_sight()?)
        }
        ("peak", "") => Box::new(Peak),
        _ => match (name.strip_prefix("trial-"), name.strip_prefix("field-trial-")) {
            (Some(scenario), _) => Box::new(WholeTrial::new(scenario, RealityPreset::Ideal)?),
            (_, Some(scenario)) => Box::new(WholeTrial::new(scenario, RealityPreset::Field)?),
            _ => return Err(unknown()),
        },
    })
}
