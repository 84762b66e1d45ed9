//! Point clouds.

use super::{Answer, Check, Report, expect};

/// The check of each report, by its name.
pub(crate) const CHECKS: &[(&str, Check)] = &[
    ("pcd-viewpoint-world", |report| same(report, "scan.pcd")),
    ("pcd-viewpoint-tilt", tilted),
    ("pcd-count-0", |report| same(report, "scan.pcd")),
    ("pcd-compressed-stored", |report| same(report, "scan.pcd")),
    ("xyzi-header", |report| same(report, "scan.csv")),
    ("comment-lines", |report| same(report, "scan.xyz")),
    ("veloview-csv", |report| same(report, "scan.csv")),
    ("semicolons", |report| same(report, "scan.csv")),
    ("quoted-header", |report| same(report, "scan.csv")),
    ("nan-rows", |report| same(report, "scan.csv")),
    ("count-first", |report| same(report, "scan.txt")),
    ("millimetres", out_of_reach),
    ("kitti-bin", |report| same(report, "scan.bin")),
    ("ply-ascii", |report| same(report, "scan.ply")),
];

/// The same returns, status and columns as the reference, and nothing to warn of.
fn same(report: &Report, file: &str) -> Result<(), String> {
    let (answer, good) = (report.perceive(file, &[]), report.perceive_good("hilly.csv"));
    let is_same = ["returns", "status"].iter().all(|name| answer.json[name] == good.json[name]);
    let holds = is_same && good.code == Some(0) && kinds(&answer) == kinds(&good) && answer.stderr.is_empty();
    expect(holds, &answer)
}

/// The kind of each column of the profile.
fn kinds(answer: &Answer) -> Vec<&str> {
    let profile = answer.json["profile"].as_array().map(Vec::as_slice).unwrap_or_default();
    profile.iter().filter_map(|column| column["kind"].as_str()).collect()
}

/// About the reference's profile: no walls, and nothing known of what lies behind, where the sensor looks
/// over the ground.
fn tilted(report: &Report) -> Result<(), String> {
    let (answer, good) = (report.perceive("scan.pcd", &[]), report.perceive_good("hilly.csv"));
    let about = |(found, good): (&&str, &&str)| found == good || *found == "unknown";
    let fits = kinds(&answer).iter().zip(&kinds(&good)).all(about);
    let ground = kinds(&answer).iter().filter(|kind| **kind == "ground").count();
    expect(fits && ground > 180 && answer.json["status"] == good.json["status"], &answer)
}

/// A word with the nearest return, in the warnings of the answer too.
fn out_of_reach(report: &Report) -> Result<(), String> {
    let answer = report.perceive("scan.csv", &[]);
    let said = "no return within 7 m, the nearest is ";
    let in_json = answer.json["warnings"][0].as_str().is_some_and(|warning| warning.contains(said));
    let words = answer.stderr.contains(said) && answer.stderr.contains("millimetres");
    expect(in_json && words, &answer)
}
