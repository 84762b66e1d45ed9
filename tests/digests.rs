//! Every scenario gives the recorded trajectory, to the bit. The browser tests of `mapless-wasm` compare with
//! the same file, so a pass of both shows that native and wasm agree.
//!
//! After a change that is meant to change trajectories, `MAPLESS_RECORD_DIGESTS=1 cargo test -p mapless-tests
//! --test digests` records them again.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeMap;

use mapless_tests::scenarios_text::{Bundled, SCENARIOS};
use mapless_trials::{Outcome, RealityPreset};
use rayon::prelude::*;

#[test]
fn every_scenario_reaches_its_goal_with_the_recorded_digest() {
    let record = std::env::var_os("MAPLESS_RECORD_DIGESTS").is_some();
    if !record {
        let differences: Vec<_> =
            SCENARIOS.par_iter().filter_map(|scenario| scenario.check().err()).collect();
        assert!(differences.is_empty(), "{differences:#?}");
    } else {
        let drive = |scenario: &Bundled| {
            let trial = scenario.drive().unwrap();
            assert_eq!(trial.outcome(), Some(Outcome::Reached), "{}", scenario.name);
            (scenario.name, trial.digest())
        };
        let digests: BTreeMap<_, _> = SCENARIOS.par_iter().map(drive).collect();
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/digests.toml");
        std::fs::write(path, toml::to_string(&digests).unwrap()).unwrap();
    }
}

/// In the browser, too.
#[test]
fn in_the_field_two_routes_give_the_recorded_digest() {
    let record = std::env::var_os("MAPLESS_RECORD_DIGESTS").is_some();
    let routes = SCENARIOS.par_iter().filter(|scenario| ["gsb", "ht"].contains(&scenario.name));
    if !record {
        let differences: Vec<_> = routes.filter_map(|scenario| scenario.check_in_the_field().err()).collect();
        assert!(differences.is_empty(), "{differences:#?}");
    } else {
        let drive =
            |scenario: &Bundled| (scenario.name, scenario.drive_in(RealityPreset::Field).unwrap().digest());
        let digests: BTreeMap<_, _> = routes.map(drive).collect();
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/field_digests.toml");
        std::fs::write(path, toml::to_string(&digests).unwrap()).unwrap();
    }
}
