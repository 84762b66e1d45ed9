//! `mapless replay` through the real binary, on the recording that is kept for the tests.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../recording/tests/kept");

fn replay(file: &Path, options: &[&str]) -> Output {
    let program = env!("CARGO_BIN_EXE_mapless");
    Command::new(program).arg("replay").arg(file).args(options).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn the_same_decisions_are_told_and_others_one_by_one() {
    let file = Path::new(KEPT).join("drive.mcap");
    let same = replay(&file, &[]);
    let (shown, digest) =
        (text(&same.stdout), fs::read_to_string(Path::new(KEPT).join("drive.digest")).unwrap());
    assert_eq!(same.status.code(), Some(0), "{shown}");
    assert!(shown.contains("Driving\n") && shown.contains("no decision differs from the recorded one\n"));
    assert!(shown.ends_with(&format!("digest of all decisions: {digest}")), "{shown}");

    let other = replay(&file, &["--set", "supervisor.max_speed_m_s=0.05"]);
    let shown = text(&other.stdout);
    assert_eq!(other.status.code(), Some(2), "{shown}");
    assert_eq!(shown.matches("  supervisor differs: command ").count(), 20, "{shown}");
    assert!(shown.contains(" more differences: --all shows them\n"), "{shown}");
    let all = text(&replay(&file, &["--set", "supervisor.max_speed_m_s=0.05", "--all"]).stdout);
    assert!(all.matches(" differs: ").count() > 20 && !all.contains("--all"), "{all}");
}

#[test]
fn a_cut_file_is_replayed_and_others_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = fs::read(Path::new(KEPT).join("drive.mcap")).unwrap();
    let cut = folder.path().join("cut.mcap");
    fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    let output = replay(&cut, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stdout));
    assert!(text(&output.stderr).contains("cut.mcap: cut off; replayed up to there"));

    let none = folder.path().join("none.mcap");
    fs::write(&none, "no recording").unwrap();
    for (file, options, expected) in [
        (&*none, &[][..], "none.mcap: after message 0 (byte 8): Bad magic number: expected an MCAP file\n"),
        (Path::new("no-such.mcap"), &[], "no-such.mcap: "),
        (&*cut, &["--set", "planner.speed=3"], "--set planner.speed=3: no key speed: expected one of "),
        (&*cut, &["--goal", "3"], "expected two numbers, as 10,-2.5"),
        (&*cut, &["--topic", "camera=/a"], "expected ROLE=TOPIC with one of scan, odometry,"),
    ] {
        let output = replay(file, options);
        let told = text(&output.stderr);
        assert!(output.status.code() == Some(1) && told.contains(expected), "{told}");
    }
}
