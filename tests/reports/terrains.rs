//! Terrain files.

use super::{Answer, Check, Report, expect, run};
use std::fs;
use std::path::Path;

/// The check of each report, by its name.
pub(crate) const CHECKS: &[(&str, Check)] = &[
    ("asc-hole-no-key", |report| refused(report, &["row", "column", "= -9999", "holes = \"fill\""])),
    ("asc-void-32768", |report| refused(report, &["row", "column", "= -32768", "holes = \"fill\""])),
    ("asc-nodata-border", border),
    ("asc-dx-dy", same_run),
    ("asc-bom", same_run),
    ("asc-degrees", |report| refused(report, &["degrees", "cell_m"])),
    ("asc-comma-decimals", same_run),
    ("tif-tiled-lzw", |report| starts_at(report, 1.0)),
    ("tif-feet", |report| {
        same_ground(report)?;
        warned(report, "US survey foot")
    }),
    ("tif-scale-offset", same_ground),
    ("tif-nearly-square", same_ground),
    ("tif-south-up", same_ground),
    ("tif-south-up-cell_m", same_ground),
    ("tif-min-is-white", |report| starts_at(report, 1.0)),
    ("tif-zstd", same_ground),
    ("tif-alpha-band", same_ground),
    ("png-72-dpi", |report| {
        warned(report, "pHYs")?;
        // At 0.25 m the grid of 41 × 31 samples holds start and goal, which it does not at 0.35 mm.
        expect_reached(&report.run(&[]))
    }),
    ("png-8-bit-recipe", |report| {
        // White is the recipe's 2 m, so that no height is above it.
        let z_m = start_z_m(&report.folder)?;
        if (0.0..=2.0).contains(&z_m) { Ok(()) } else { Err(format!("start at z = {z_m}")) }
    }),
];

/// A refusal with these words.
fn refused(report: &Report, words: &[&str]) -> Result<(), String> {
    let answer = report.run(&[]);
    let stderr = &answer.stderr;
    let is_named = stderr.contains("g.asc") && words.iter().all(|word| stderr.contains(word));
    expect(answer.code == Some(1) && is_named, &answer)
}

fn expect_reached(answer: &Answer) -> Result<(), String> {
    expect(answer.code == Some(0) && answer.json["outcome"] == "reached", answer)
}

/// A warning with this word, on standard error and as data.
fn warned(report: &Report, word: &str) -> Result<(), String> {
    let answer = report.run(&[]);
    let said = |text: &str| text.contains(word);
    let listed = answer.json["warnings"]
        .as_array()
        .is_some_and(|warnings| warnings.iter().any(|warning| warning.as_str().is_some_and(said)));
    expect(listed && said(&answer.stderr), &answer)
}

/// The very run of the good file.
fn same_run(report: &Report) -> Result<(), String> {
    let good = run(&report.folder.with_file_name("GOOD"), &["run", "plain.toml", "--json"]);
    let answer = report.run(&[]);
    expect_reached(&answer)?;
    expect(answer.json["digest"] == good.json["digest"], &answer)
}

/// The ground of the good file, to the millimetre that it is written to.
fn same_ground(report: &Report) -> Result<(), String> {
    let answer = report.run(&[]);
    expect_reached(&answer)?;
    starts_at(report, start_z_of(&report.folder.with_file_name("GOOD"), "plain.toml")?)?;
    // The whole way, within a centimetre.
    let good = run(&report.folder.with_file_name("GOOD"), &["run", "plain.toml", "--json"]);
    let length = |answer: &Answer| answer.json["metrics"]["distance_m"].as_f64().unwrap_or(f64::NAN);
    expect((length(&answer) - length(&good)).abs() < 0.05, &answer)
}

fn starts_at(report: &Report, z_m: f64) -> Result<(), String> {
    let found = start_z_m(&report.folder)?;
    if (found - z_m).abs() < 2e-3 { Ok(()) } else { Err(format!("start at z = {found}, expected {z_m}")) }
}

fn start_z_m(folder: &Path) -> Result<f64, String> {
    start_z_of(folder, "scenario.toml")
}

/// The height of the first pose of a run.
fn start_z_of(folder: &Path, scenario: &str) -> Result<f64, String> {
    let out = tempfile::tempdir().map_err(|error| error.to_string())?;
    let path = out.path().display().to_string();
    let answer = run(folder, &["run", scenario, "--json", "--out", &path]);
    let table = fs::read_to_string(out.path().join("trajectory.csv"));
    let table = table.map_err(|error| format!("{error}: {answer:?}"))?;
    let mut lines = table.lines().map(|line| line.split(','));
    let column = lines.next().and_then(|mut names| names.position(|name| name == "z_m"));
    let value = column.zip(lines.next()).and_then(|(column, mut values)| values.nth(column));
    value.and_then(|value| value.parse().ok()).ok_or(format!("no z_m: {answer:?}"))
}

/// Refused without an option, and the ground of the good file with either.
fn border(report: &Report) -> Result<(), String> {
    refused(
        report,
        &["row 1, column 1 = -9999", "140 of 1271 samples are holes", "holes = \"fill\" or \"crop\""],
    )?;
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let write = |name: &str, text: &[u8]| {
        fs::write(folder.path().join(name), text).map_err(|error| error.to_string())
    };
    write("g.asc", &fs::read(report.folder.join("g.asc")).map_err(|error| error.to_string())?)?;
    let good = start_z_of(&report.folder.with_file_name("GOOD"), "plain.toml")?;
    // The frame is one sample wide: half a metre to the west and to the south is cut off.
    for (holes, start) in [("fill", "5, 5"), ("crop", "4.5, 4.5")] {
        write(
            "r.toml",
            format!("name = \"r\"\n[import]\nfile = \"g.asc\"\nholes = \"{holes}\"\n").as_bytes(),
        )?;
        let scenario = format!("terrain = \"r.toml\"\nstart = [{start}, 0.8]\ngoal = [7.5, 7.5]\nseed = 1\n");
        write("scenario.toml", scenario.as_bytes())?;
        let z_m = start_z_m(folder.path())?;
        if (z_m - good).abs() > 2e-3 {
            return Err(format!("{holes}: start at z = {z_m}, expected {good}"));
        }
    }
    Ok(())
}
