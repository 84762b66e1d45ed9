//! The reader of scenarios, and the planner configurations they ask for.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mapless::Planner;
use mapless_trials::{Preset, Scenario};

fuzz_target!(|text: &str| {
    let Ok(scenario) = Scenario::parse("scenario.toml", text) else { return };
    for preset in [Preset::Default, Preset::Paper] {
        if let Ok(config) = scenario.planner_config(preset) {
            assert!(Planner::new(config).is_ok(), "a checked configuration is valid");
        }
    }
});
