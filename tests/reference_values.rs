//! Kernel, sparse and exact Gaussian process, bound and gradients against gpflow's own numbers.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
use std::path::Path;

use mapless_tests::gpflow;

#[test]
fn gpflow_fixtures_of_the_repository_agree() {
    assert_eq!(gpflow::compare(gpflow::SCENE).unwrap(), 5);
    assert_eq!(gpflow::compare(gpflow::KERNELS).unwrap(), 6);
}

/// Every fixture in the folder named by `MAPLESS_GPFLOW_FIXTURES`, and in `../shared/reference/gpflow` where
/// it exists.
#[test]
fn gpflow_fixtures_of_other_folders_agree() {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/reference/gpflow");
    if beside.is_dir() {
        assert!(compare_folder(&beside) >= 30, "the shared fixtures have 30 cases");
    } else {
        println!("skipped: {} does not exist", beside.display());
    }
    if let Some(folder) = std::env::var_os("MAPLESS_GPFLOW_FIXTURES") {
        assert!(compare_folder(Path::new(&folder)) > 0, "{} has no fixtures", folder.display());
    }
}

fn compare_folder(folder: &Path) -> usize {
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .collect();
    paths.sort();
    paths
        .iter()
        .map(|path| {
            let text = std::fs::read_to_string(path).unwrap();
            gpflow::compare(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        })
        .sum()
}
