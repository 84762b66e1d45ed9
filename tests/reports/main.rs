//! Inputs that people have, with the right answer to each: the folder `data/reports` of the data that
//! `MAPLESS_DATA` names. `cargo xtask test reports` runs them alone.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod captures;
mod clouds;
mod scans;
mod terrains;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use rayon::prelude::*;
use serde_json::Value;

/// Reports whose answer is still wrong, and why.
const KNOWN_WRONG: &[(&str, &str)] = &[(
    "step-0.35m",
    "in a grid of 0.2 m the step is a ramp of 41°, within the pitch limit; only faces of 70° or more are steps",
)];

/// Checks the answer to one report.
type Check = fn(&Report) -> Result<(), String>;

/// A report: a folder with the input.
struct Report {
    folder: PathBuf,
}

/// What the program answered.
#[derive(Debug)]
struct Answer {
    code: Option<i32>,
    /// Standard output as JSON; null if it is none.
    json: Value,
    /// Warnings, and the error if there was one.
    stderr: String,
}

impl Report {
    /// `mapless perceive` with `--json` on a file of the report.
    fn perceive(&self, file: &str, options: &[&str]) -> Answer {
        run(&self.folder, &[&["perceive", file, "--json"], options].concat())
    }

    /// `mapless perceive` on a file of the folder `GOOD`, which holds what right answers are compared to.
    fn perceive_good(&self, file: &str) -> Answer {
        run(&self.folder.with_file_name("GOOD"), &["perceive", file, "--json"])
    }

    /// `mapless run` with `--json` on the scenario of the report.
    fn run(&self, options: &[&str]) -> Answer {
        run(&self.folder, &[&["run", "scenario.toml", "--json"], options].concat())
    }
}

fn run(folder: &Path, arguments: &[&str]) -> Answer {
    let output =
        Command::new(env!("CARGO_BIN_EXE_mapless")).args(arguments).current_dir(folder).output().unwrap();
    Answer {
        code: output.status.code(),
        json: serde_json::from_slice(&output.stdout).unwrap_or(Value::Null),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// An error unless `holds`, which says what was found.
fn expect(holds: bool, answer: &Answer) -> Result<(), String> {
    if holds { Ok(()) } else { Err(format!("{answer:?}").chars().take(600).collect()) }
}

#[test]
#[ignore = "reads the data that MAPLESS_DATA names"]
fn every_report_gets_its_right_answer() {
    let reports = Path::new(&std::env::var_os("MAPLESS_DATA").unwrap()).join("data/reports");
    let table = fs::read_to_string(reports.join("reports.tsv")).unwrap();
    let names: Vec<&str> = table.lines().skip(1).filter_map(|line| line.split('\t').next()).collect();
    let checks: BTreeMap<&str, Check> =
        [captures::CHECKS, clouds::CHECKS, scans::CHECKS, terrains::CHECKS].concat().into_iter().collect();
    let wrong = |name: &&str| {
        let report = Report { folder: reports.join(name) };
        let answer = checks.get(name).map_or(Err("no check".to_owned()), |check| check(&report));
        match (answer, KNOWN_WRONG.iter().any(|(known, _)| known == name)) {
            (Err(found), false) => Some(format!("{name}: {found}")),
            (Ok(()), true) => Some(format!("{name}: is right now; it stands among the wrong ones")),
            _ => None,
        }
    };
    let wrong: Vec<String> = names.par_iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{} wrong answers:\n{}", wrong.len(), wrong.join("\n"));
}
