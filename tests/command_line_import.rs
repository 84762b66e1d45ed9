//! `mapless import verti-bench` through the real binary: from a small benchmark to a trial, a campaign and
//! its report.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

#[path = "../crate/verti-bench/src/testing.rs"]
mod image;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use image::bmp;
use serde_json::Value;
use tempfile::TempDir;

/// Pixels along a side of the image: 100 m, or 20 m at a fifth.
const SIDE: usize = 101;

/// One world of gentle ground with a rock off the straight line, and a pair whose goal is over the border.
const TASKS: &str = r#"{"12": {"difficulty":"low","terrain_type":"rigid","max_height_m":4.8,
"rocks":[[0.0,8.0,1.0]],"trees":[],
"pairs":[[[-40.0,0.0],[40.0,0.0]],[[40.0,0.0],[-49.0,0.0]]]}}"#;

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("bench")).unwrap();
    fs::create_dir(folder.path().join("bench/worlds")).unwrap();
    fs::write(folder.path().join("bench/tasks.json"), TASKS).unwrap();
    fs::write(folder.path().join("bench/worlds/12.bmp"), heights()).unwrap();
    folder
}

/// They rise to the east.
fn heights() -> Vec<u8> {
    let levels: Vec<u8> = (0..SIDE * SIDE).map(|at| (at % SIDE) as u8).collect();
    bmp(SIDE, &levels)
}

fn mapless(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mapless")).args(args).current_dir(folder).output().unwrap()
}

fn import(folder: &Path, options: &[&str]) -> Output {
    mapless(folder, &[&["import", "verti-bench", "bench", "--out", "out"], options].concat())
}

#[test]
fn an_imported_task_is_driven_and_reported_by_the_benchmark_s_rules() {
    let folder = folder();
    let output = import(folder.path(), &["--scale", "1/5"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(said, "worlds: 1, tasks: 2; `mapless trials out/verti-bench.toml` drives them all\n");
    let warnings = String::from_utf8(output.stderr).unwrap();
    let expected = "warning: out/tasks/low-012-02.toml: goal at [0.2, 10] m: a wheel is off the map";
    assert!(warnings.starts_with(expected) && warnings.lines().count() == 1, "{warnings}");

    let output = mapless(folder.path(), &["run", "out/tasks/low-012-01.toml", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    let distance_m = result["metrics"]["distance_m"].as_f64().unwrap();
    assert!((14.0..16.0).contains(&distance_m), "{distance_m} m of 16 m, to within 1.6 m");

    let campaign = fs::read_to_string(folder.path().join("out/verti-bench.toml")).unwrap();
    assert!(campaign.contains("\"default\", \"oracle\", \"vgf_tuned\", \"putn\""), "{campaign}");
    let short = campaign
        .replace("\"default\", \"oracle\", \"vgf_tuned\", \"putn\"", "\"default\"")
        .replace("tasks/*.toml\"]", "tasks/*-01.toml\"]");
    fs::write(folder.path().join("out/short.toml"), short).unwrap();
    for args in [
        ["trials", "out/short.toml", "--out", "results", "--jobs", "1"].as_slice(),
        &["report", "results", "--out", "docs"],
    ] {
        let output = mapless(folder.path(), args);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
    let page = fs::read_to_string(folder.path().join("docs/results/short.md")).unwrap();
    let (_, rules) = page.split_once("## By Verti-Bench's rules").unwrap_or_else(|| panic!("{page}"));
    assert!(rules.contains("| `default` | all | 100.0 | 1 |"), "{rules}");
}

#[test]
fn what_cannot_be_imported_is_named() {
    let folder = folder();
    let refused = |options: &[&str], needles: &[&str]| {
        let output = import(folder.path(), options);
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(output.stdout.is_empty(), "{output:?}");
        for needle in needles {
            assert!(message.contains(needle), "not in the message: {needle}\n{message}");
        }
    };
    refused(&["--scale", "1/0"], &["--scale", "\"1/0\": expected 0.01 to 100, such as 1/5 or 0.2"]);
    fs::write(folder.path().join("bench/worlds/12.bmp"), &heights()[..2000]).unwrap();
    let cut =
        "bench/worlds/12.bmp: it ends after 2000 bytes: expected 101 rows of 104 bytes from byte 1078 on";
    refused(&["--scale", "1"], &[cut]);
}
