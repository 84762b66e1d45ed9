//! Every scenario gives the recorded trajectory, to the bit. The browser tests of `mapless-wasm` compare with
//! the same file, so a pass of both shows that native and wasm agree.
//!
//! After a change that is meant to change trajectories, `MAPLESS_RECORD_DIGESTS=1 cargo test -p mapless-tests
//! --test digests` records them again.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use mapless_tests::scenarios_text::SCENARIOS;
use mapless_trials::{Outcome, RealityPreset};

#[test]
fn every_scenario_reaches_its_goal_with_the_recorded_digest() {
    let record = std::env::var_os("MAPLESS_RECORD_DIGESTS").is_some();
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some(scenario) = SCENARIOS.get(next.fetch_add(1, Ordering::Relaxed)) {
            if record {
                let trial = scenario.drive().unwrap();
                assert_eq!(trial.outcome(), Some(Outcome::Reached), "{}", scenario.name);
                done.push((scenario.name, trial.digest()));
            } else {
                scenario.check().unwrap_or_else(|difference| panic!("{difference}"));
            }
        }
        done
    };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let digests: BTreeMap<_, _> = thread::scope(|scope| {
        let threads: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
    });
    if record {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/digests.toml");
        std::fs::write(path, toml::to_string(&digests).unwrap()).unwrap();
    }
}

/// In the browser, too.
#[test]
fn in_the_field_two_routes_give_the_recorded_digest() {
    let record = std::env::var_os("MAPLESS_RECORD_DIGESTS").is_some();
    let mut digests = BTreeMap::new();
    for scenario in SCENARIOS.iter().filter(|scenario| ["gsb", "ht"].contains(&scenario.name)) {
        if record {
            digests.insert(scenario.name, scenario.drive_in(RealityPreset::Field).unwrap().digest());
        } else {
            scenario.check_in_the_field().unwrap_or_else(|difference| panic!("{difference}"));
        }
    }
    if record {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/field_digests.toml");
        std::fs::write(path, toml::to_string(&digests).unwrap()).unwrap();
    }
}
