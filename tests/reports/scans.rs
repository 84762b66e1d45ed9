//! Scans as sensors give them, and goals out of reach.

use std::fs;

use serde_json::Value;

use super::{Answer, Check, Report, expect};

/// The check of each report, by its name.
pub(crate) const CHECKS: &[(&str, Check)] = &[
    ("origin-returns", |report| decides_as("hilly.csv", report, &[])),
    ("all-at-origin", |report| {
        let answer = report.perceive("scan.csv", &[]);
        expect(answer.json["reason"] == "the scan has no returns", &answer)
    }),
    ("one-return-0.45m", |report| decides_as("flat.csv", report, &[])),
    // The posts hide ground behind them.
    ("four-posts", drives_ahead),
    ("rain-0.2-percent", drives_ahead),
    ("one-drop-2m-ahead", drives_ahead),
    ("mount-tilted-15", |report| {
        let answer = report.perceive("scan.csv", &[]);
        expect(answer.stderr.contains("tilted by 15°"), &answer)?;
        fits_with("[sensor]\npitch_rad = -0.2618\n", report).map(|_| ())
    }),
    ("mount-1.73m", |report| {
        let answer = report.perceive("scan.csv", &[]);
        expect(answer.stderr.contains("1.73 m below the sensor"), &answer)?;
        let answer = fits_with("[sensor]\nheight_m = 1.73\n", report)?;
        let subgoals = answer.json["subgoals"].as_array().unwrap();
        let heights = subgoals.iter().map(|subgoal| subgoal["position_m"][2].as_f64().unwrap());
        expect(heights.fold(0.0, |most: f64, z| most.max(z.abs())) < 0.1, &answer)
    }),
    ("upside-down", |report| {
        let answer = report.perceive("scan.csv", &[]);
        expect(answer.stderr.contains("upside down?"), &answer)?;
        fits_with("[sensor]\nroll_rad = 3.141592653589793\n", report).map(|_| ())
    }),
    ("roof-2m", drives_ahead),
    ("gate-1.5m", |report| {
        let answer = report.perceive("scan.csv", &[]);
        let chosen = &answer.json["subgoals"][answer.json["chosen"].as_u64().unwrap_or(0) as usize];
        let bearing_rad = chosen["bearing_rad"].as_f64().unwrap_or(9.0);
        expect(is_driving(&answer, 0.7) && bearing_rad.abs() < 0.15, &answer)
    }),
    ("step-0.35m", |report| {
        let answer = report.run(&[]);
        expect(answer.json["outcome"] != "reached", &answer)
    }),
    ("goal-at-border", |report| {
        let answer = report.run(&[]);
        let distance_m = answer.json["metrics"]["distance_m"].as_f64().unwrap_or(1e9);
        let names_reason = answer.json["reason"].as_str().is_some_and(|reason| reason.contains("goal"));
        expect(names_reason && distance_m < 100.0, &answer)
    }),
];

/// Whether the robot drives at this speed or faster.
fn is_driving(answer: &Answer, speed_m_s: f64) -> bool {
    let speed = answer.json["command"]["linear_m_s"].as_f64();
    answer.json["status"] == "driving" && speed.is_some_and(|speed| speed > speed_m_s)
}

/// Near the speed on level ground, straight on.
fn drives_ahead(report: &Report) -> Result<(), String> {
    let answer = report.perceive("scan.csv", &[]);
    let turn = answer.json["command"]["angular_rad_s"].as_f64().unwrap_or(9.0);
    expect(is_driving(&answer, 0.95 * 0.8) && turn.abs() < 0.25, &answer)
}

/// Decision and profile are those of a reference scan.
fn decides_as(good: &str, report: &Report, options: &[&str]) -> Result<(), String> {
    let (answer, good) = (report.perceive("scan.csv", options), report.perceive_good(good));
    let keys = ["status", "command", "occupied_cells", "profile", "subgoals"];
    expect(good.json != Value::Null && keys.iter().all(|key| answer.json[key] == good.json[key]), &answer)
}

/// With the mount of a parameters file nothing is doubtful, and the robot drives.
fn fits_with(parameters: &str, report: &Report) -> Result<Answer, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mount.toml");
    fs::write(&file, parameters).unwrap();
    let answer = report.perceive("scan.csv", &["--parameters", &file.display().to_string()]);
    expect(answer.stderr.is_empty() && is_driving(&answer, 0.5), &answer)?;
    Ok(answer)
}
