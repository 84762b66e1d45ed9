//! `mapless terrain` through the real binary: from a point cloud to a trial on its ground.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn mapless(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mapless")).args(args).current_dir(folder).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A map as a mapping package writes it: a point in each square of 0.1 m over 20 × 16 m, in a frame whose
/// origin is in the middle, of ground that rises by a tenth to the east, with a gap of 1 m.
fn cloud(folder: &Path) {
    let mut points = String::new();
    let mut count = 0;
    for row in 0..160 {
        for column in 0..200 {
            let (x, y) = (-10.0 + 0.1 * f64::from(column), -8.0 + 0.1 * f64::from(row));
            if (2.0..3.0).contains(&x) && (5.0..6.0).contains(&y) {
                continue;
            }
            writeln!(points, "{x:.2} {y:.2} {:.3}", 3.0 + 0.1 * x).unwrap();
            count += 1;
        }
    }
    let header = format!(
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {count}\nHEIGHT 1\n\
         VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA ascii\n"
    );
    fs::write(folder.join("hill map.pcd"), header + &points).unwrap();
}

#[test]
fn a_cloud_becomes_ground_that_is_driven_on() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    cloud(folder);
    let terrain = ["terrain", "hill map.pcd", "--cell", "0.3", "--out", "ground"];

    let refused = mapless(folder, &terrain);
    let error = text(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{error}");
    for part in
        ["hill map.pcd: ", "cells of 0.3 m (--cell, --holes)", "= -9999: expected a height", "\"fill\""]
    {
        assert!(error.contains(part), "{part}: {error}");
    }
    assert!(!folder.join("ground").exists(), "nothing is written of a cloud that is refused");

    let made = mapless(folder, &[&terrain[..], &["--holes", "fill"]].concat());
    assert!(made.status.success(), "{}", text(&made.stderr));
    assert!(text(&made.stdout).contains("ground/hill map.toml: 19.8 × 15.9 m of "), "{}", text(&made.stdout));
    assert!(text(&made.stdout).contains("at (-10.000, -8.000) m of the cloud"), "{}", text(&made.stdout));
    assert!(
        text(&made.stderr).contains("hill map.asc: ") && text(&made.stderr).contains("filled from"),
        "{made:?}"
    );
    let again = mapless(folder, &[&terrain[..], &["--holes", "fill"]].concat());
    assert!(again.status.success(), "the same files are left as they are: {}", text(&again.stderr));
    let other =
        mapless(folder, &["terrain", "hill map.pcd", "--cell", "0.4", "--holes", "fill", "--out", "ground"]);
    assert!(text(&other.stderr).contains("hill map.asc: expected no file"), "{}", text(&other.stderr));

    // From (-7, -3) to (7, -3) of the cloud.
    let scenario =
        "terrain = \"ground/hill map.toml\"\nstart = [3.0, 5.0, 0.0]\ngoal = [17.0, 5.0]\nseed = 1\n";
    fs::write(folder.join("drive.toml"), scenario).unwrap();
    let run = mapless(folder, &["run", "drive.toml", "--json"]);
    assert!(run.status.success(), "{} {}", text(&run.stdout), text(&run.stderr));
    let result: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    let pitch_rad = result["metrics"]["max_abs_pitch_rad"].as_f64().unwrap();
    // The arc tangent of a tenth.
    assert!((pitch_rad - 0.0997).abs() < 0.02, "{pitch_rad}");
}

#[test]
fn what_makes_no_terrain_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("line.xyz"), "0 0 0\n1 0 0\n").unwrap();
    let error = |args: &[&str]| {
        let output = mapless(folder, &[&["terrain"], args, &["--out", "ground"]].concat());
        assert_eq!(output.status.code(), Some(1));
        text(&output.stderr)
    };
    assert!(error(&["line.xyz"]).contains("line.xyz: points over 1.00 × 0.00 m, which are 11 × 1 samples"));
    assert!(error(&["line.xyz", "--cell", "0"]).contains("expected metres, from 0.01 to 1000"));
    assert!(error(&["drive.pcap"]).contains("drive.pcap: expected a point cloud, not a capture"));
    assert!(error(&["none.pcd"]).contains("none.pcd"));
}
