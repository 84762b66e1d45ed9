//! Kernel, sparse and exact Gaussian process, bound and gradients against gpflow's own numbers.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
use std::path::Path;

use mapless_tests::gpflow;

#[test]
fn gpflow_fixtures_of_the_repository_agree() {
    assert_eq!(gpflow::compare(gpflow::SCENE).unwrap(), 5);
    assert_eq!(gpflow::compare(gpflow::KERNELS).unwrap(), 6);
}

/// More scenes than the repository holds.
#[test]
#[ignore = "reads the data that MAPLESS_DATA names"]
fn gpflow_fixtures_of_the_data_agree() {
    let folder = Path::new(&std::env::var_os("MAPLESS_DATA").unwrap()).join("reference/gpflow");
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let fixtures = files.filter(|path| path.extension().is_some_and(|extension| extension == "json"));
    let cases: usize = fixtures
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            gpflow::compare(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        })
        .sum();
    assert!(cases >= 30, "{cases} cases in {}", folder.display());
}
