//! `mapless run` through the real binary: exit codes, streams, JSON and files.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use glam::DVec2;
use serde_json::Value;
use tempfile::TempDir;

const RECIPE: &str = "name = \"Meadow\"\nsize_m = [20.0, 10.0]\ncell_m = 0.2\nseed = 5\n\n\
    [[noise]]\namplitude_m = 0.2\nwavelength_m = 6.0\noctaves = 2\n";
/// A drive of 12 m.
const SCENARIO: &str = "terrain = \"meadow.toml\"\nstart = [4.0, 5.0, 0.3]\ngoal = [16.0, 5.0]\nseed = 1\n";

/// A folder with the meadow, its scenario, and broken ones as tests add them.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        folder.write("meadow.toml", RECIPE);
        folder.write("meadow-drive.toml", SCENARIO);
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).unwrap();
    }

    /// `mapless run` on the scenario `name`, from within the folder.
    fn run(&self, name: &str, options: &[&str]) -> Output {
        mapless(self.0.path(), &[&["run", name], options].concat())
    }

    /// The trial's JSON; the goal must have been reached.
    fn json(&self, options: &[&str]) -> Value {
        let output = self.run("meadow-drive.toml", &[&["--json"], options].concat());
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert!(output.stderr.is_empty(), "progress without a terminal: {output:?}");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// Runs a scenario that cannot run: code 1, nothing on stdout, a message that begins as given and says
    /// more.
    fn refuses(&self, text: &str, begin: &str, needles: &[&str]) {
        self.write("bad.toml", text);
        refused(&self.run("bad.toml", &["--json"]), begin, needles);
    }
}

fn mapless(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mapless")).args(args).current_dir(folder).output().unwrap()
}

fn refused(output: &Output, begin: &str, needles: &[&str]) {
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(output.stdout.is_empty(), "{output:?}");
    assert!(message.starts_with(begin), "not at the beginning: {begin}\n{message}");
    for needle in needles {
        assert!(message.contains(needle), "not in the message: {needle}\n{message}");
    }
    assert!(!message.contains("panicked") && !message.contains("backtrace"), "{message}");
}

/// Every name of the object, sorted, nested ones with a dot.
fn names(prefix: &str, value: &Value) -> Vec<String> {
    let Value::Object(entries) = value else { return vec![prefix.to_owned()] };
    let name = |key: &str| if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") };
    let mut names: Vec<String> = entries.iter().flat_map(|(key, value)| names(&name(key), value)).collect();
    names.sort();
    names
}

#[test]
fn json_has_every_name_and_the_same_seed_gives_the_same_digest() {
    let folder = Folder::new();
    let first = folder.json(&[]);
    let expected = [
        "digest",
        "distance_to_goal_m",
        "metrics.curvature_change_rad_m",
        "metrics.distance_m",
        "metrics.max_abs_pitch_rad",
        "metrics.max_abs_roll_rad",
        "metrics.mean_elevation_rate_cm_s",
        "metrics.mean_vibration_rad_s",
        "outcome",
        "planner_ms.p50",
        "planner_ms.p99",
        "reason",
        "sim_time_s",
        "ticks",
        "warnings",
    ];
    assert_eq!(names("", &first), expected);
    assert_eq!(first["outcome"], "reached");
    assert!(first["reason"].is_null());
    for (name, metric) in first["metrics"].as_object().unwrap() {
        assert!(metric.as_f64().unwrap() > 0.0, "{name} = {metric}");
    }
    let distance_m = first["metrics"]["distance_m"].as_f64().unwrap();
    assert!((11.0..20.0).contains(&distance_m), "{distance_m} m for a drive of 12 m");
    assert!(
        (first["sim_time_s"].as_f64().unwrap() - 0.1 * first["ticks"].as_u64().unwrap() as f64).abs() < 1e-9
    );
    let [p50, p99] = ["p50", "p99"].map(|name| first["planner_ms"][name].as_f64().unwrap());
    assert!(0.0 < p50 && p50 <= p99);
    let digest = first["digest"].as_str().unwrap();
    assert!(digest.len() == 32 && digest.bytes().all(|byte| byte.is_ascii_hexdigit()), "{digest}");

    let second = folder.json(&["--seed", "1", "--planner", "default"]);
    for name in ["digest", "metrics", "ticks", "outcome"] {
        assert_eq!(first[name], second[name], "{name}");
    }
    assert_ne!(first["digest"], folder.json(&["--seed", "2"])["digest"]);
}

#[test]
fn the_paper_preset_drives_another_path_to_a_named_outcome() {
    let folder = Folder::new();
    let output = folder.run("meadow-drive.toml", &["--json", "--planner", "paper"]);
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    let code = if result["outcome"] == "reached" { 0 } else { 2 };
    assert_eq!(output.status.code(), Some(code), "{output:?}");
    assert_ne!(result["digest"], folder.json(&[])["digest"]);
}

#[test]
fn any_planner_drives_with_the_same_report_and_log() {
    let folder = Folder::new();
    let route = |planner: &str| folder.json(&["--planner", planner, "--out", planner]);
    let vgf = route("vgf");
    assert_eq!(names("", &vgf), names("", &folder.json(&[])));
    assert_ne!(vgf["digest"], route("direct")["digest"]);
    let trajectory = fs::read_to_string(folder.path("vgf/trajectory.csv")).unwrap();
    let rows: Vec<Vec<&str>> = trajectory.lines().skip(1).map(|row| row.split(',').collect()).collect();
    assert_eq!(rows.len() as u64, vgf["ticks"].as_u64().unwrap() + 1);
    // A route has no subgoals.
    assert!(rows.iter().all(|row| row.len() == 14 && row[11].is_empty()));
    assert!(fs::read_to_string(folder.path("vgf/path.svg")).unwrap().contains("planner vgf"));
    refused(
        &folder.run("meadow-drive.toml", &["--planner", "vgf", "--learning", "once"]),
        "error: --learning: planner vgf learns nothing",
        &[],
    );
}

#[test]
fn ground_truth_replaces_perception() {
    let folder = Folder::new();
    let perceived = folder.json(&[]);
    let overridden = folder.json(&["--truth", "both"]);
    assert_ne!(overridden["digest"], perceived["digest"]);
    assert_eq!(folder.json(&["--truth", "none"])["digest"], perceived["digest"]);
    refused(
        &folder.run("meadow-drive.toml", &["--planner", "putn", "--truth", "ground"]),
        "error: meadow-drive.toml: planner putn has no perception to override",
        &["default"],
    );
}

#[test]
fn a_map_without_a_path_is_an_outcome_with_its_reason() {
    let folder = Folder::new();
    let wall = "[[ridge]]\npoints = [[10.0, -5.0], [10.0, 15.0]]\nheight_m = 4.0\nwidth_m = 1.5\n";
    folder.write("walled.toml", format!("{RECIPE}\n{wall}"));
    folder.write("walled-drive.toml", SCENARIO.replace("meadow.toml", "walled.toml"));
    let output = folder.run("walled-drive.toml", &["--json", "--planner", "vgf"]);
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.status.code(), result["outcome"].as_str().unwrap()), (Some(2), "no_subgoal"));
    assert_eq!(result["reason"], "no path to the goal on the map");
}

#[test]
fn out_writes_the_trajectory_a_picture_and_the_result() {
    let folder = Folder::new();
    let result = folder.json(&["--out", "new/trial"]);
    let file = |name: &str| fs::read_to_string(folder.path("new/trial").join(name)).unwrap();

    assert_eq!(serde_json::from_str::<Value>(&file("result.json")).unwrap(), result);

    let trajectory = file("trajectory.csv");
    let mut rows = trajectory.lines();
    assert_eq!(
        rows.next().unwrap(),
        "time_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,speed_m_s,turn_rate_rad_s,\
         command_speed_m_s,command_turn_rate_rad_s,subgoal_x_m,subgoal_y_m,status"
    );
    let rows: Vec<Vec<&str>> = rows.map(|row| row.split(',').collect()).collect();
    assert_eq!(rows.len() as u64, result["ticks"].as_u64().unwrap() + 1);
    let number = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    for (index, row) in rows.iter().enumerate() {
        assert_eq!(row.len(), 14);
        assert!((0..9).all(|column| number(index, column).is_finite()), "row {index}");
    }
    let last = rows.len() - 1;
    assert_eq!((number(0, 1), number(0, 2), number(0, 6)), (4.0, 5.0, 0.3));
    assert!(
        DVec2::new(number(last, 1), number(last, 2)).distance(DVec2::new(16.0, 5.0)) <= 0.5,
        "ends at the goal"
    );
    assert!((number(last, 0) - result["sim_time_s"].as_f64().unwrap()).abs() < 1e-9);
    assert!(rows[..last].iter().any(|row| row[13] == "driving" && row[11].parse::<f64>().is_ok()));
    assert_eq!(rows[last][9..], ["", "", "", "", "reached"]);

    let picture = file("path.svg");
    assert!(picture.starts_with("<svg ") && picture.ends_with("</svg>\n"));
    let path = picture.split("<polyline").nth(1).unwrap().split("points=\"").nth(1).unwrap();
    let places = path.split('"').next().unwrap().split_whitespace().count();
    assert_eq!(places, rows.len(), "the picture shows the whole path");
}

#[test]
fn the_table_names_units_and_limits() {
    let folder = Folder::new();
    let output = folder.run("meadow-drive.toml", &[]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let table = String::from_utf8(output.stdout).unwrap();
    for needle in [
        "meadow-drive on Meadow, planner default, seed 1",
        "reached",
        "limit 30.0°",
        "limit 45.0°",
        "cm/s",
        "rad/m",
    ] {
        assert!(table.contains(needle), "not in the table: {needle}\n{table}");
    }
}

#[test]
fn a_trial_that_does_not_reach_its_goal_exits_with_2_and_says_why() {
    let folder = Folder::new();
    // No return comes from so near, so there is no ground to drive on.
    folder.write("blind.toml", format!("{SCENARIO}[sensor]\nmax_range_m = 1.0\n"));
    let output = folder.run("blind.toml", &["--json", "--out", "blind"]);
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.status.code(), result["outcome"].as_str().unwrap()), (Some(2), "no_subgoal"));
    assert!(!result["reason"].as_str().unwrap().is_empty());
    assert!(fs::read_to_string(folder.path("blind/path.svg")).unwrap().contains("no_subgoal"));

    let table = String::from_utf8(folder.run("blind.toml", &[]).stdout).unwrap();
    assert!(
        table.contains(&format!("The planner stopped: {}.", result["reason"].as_str().unwrap())),
        "{table}"
    );
}

#[test]
fn a_bad_scenario_is_refused_by_file_and_place() {
    let folder = Folder::new();
    let place = "error: bad.toml: TOML parse error at line";
    folder.refuses(&SCENARIO.replace("goal", "gaol"), place, &["line 3", "gaol", "goal"]);
    folder.refuses(&format!("{SCENARIO}[planner.decision]\nnosuch = 1\n"), place, &["nosuch"]);
    folder.refuses(&SCENARIO.replace("4.0, 5.0", "nan, 5.0"), place, &["line 2", "x = NaN", "finite"]);
    folder.refuses(&SCENARIO.replace("seed = 1", "seed = -1"), place, &["line 4", "-1"]);
    folder.refuses(
        &SCENARIO.replace("4.0, 5.0", "4.0, 55.0"),
        "error: bad.toml: start = (4.000, 55.000) m",
        &["(20.000, 10.000) m"],
    );
    folder.refuses(
        &SCENARIO.replace("16.0", "-16.0"),
        "error: bad.toml: goal = (-16.000, 5.000) m",
        &["(20.000, 10.000) m"],
    );
    folder.refuses(
        &format!("{SCENARIO}[robot]\nwidth_m = -1.0\n"),
        "error: bad.toml: robot.width_m = -1",
        &[],
    );
    folder.refuses("\u{0}", "error: bad.toml: ", &["line 1"]);
}

#[test]
fn a_bad_terrain_is_refused_by_scenario_and_terrain() {
    let folder = Folder::new();
    let on = |terrain: &str| SCENARIO.replace("meadow.toml", terrain);
    folder.refuses(&on("none.toml"), "error: bad.toml: terrain: none.toml: cannot be read", &[]);
    folder.refuses(&on("."), "error: bad.toml: terrain: ", &["cannot be read"]);
    folder.write("meadow.jpg", "");
    folder.refuses(&on("meadow.jpg"), "error: bad.toml: terrain: meadow.jpg: ", &[".png"]);

    let header = "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
    folder.write("one.asc", format!("{header}3.5\n"));
    folder.refuses(&on("one.asc"), "error: bad.toml: terrain: one.asc: ", &["1 × 1", "at least 2 × 2"]);

    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 64, 64);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let noise: Vec<u8> =
        (0..64 * 64 * 2_u32).map(|index| (index.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    encoder.write_header().unwrap().write_image_data(&noise).unwrap();
    folder.write("cut.png", &bytes[..bytes.len() / 2]);
    folder.refuses(&on("cut.png"), "error: bad.toml: terrain: cut.png: ", &["PNG"]);

    folder.write("typo.toml", RECIPE.replace("cell_m", "cel_m"));
    folder.refuses(&on("typo.toml"), "error: bad.toml: terrain: typo.toml: ", &["cel_m", "line 3"]);
}

#[test]
fn what_was_done_to_a_file_of_heights_is_said_as_text_and_as_data() {
    let folder = Folder::new();
    // A meadow of 20 m by 10 m with decimal commas, and a frame without heights.
    let line = |row: i32| match row {
        0 | 20 => "-9999 ".repeat(41),
        _ => format!("-9999 {}-9999", "1,25 ".repeat(39)),
    };
    let lines: Vec<String> = (0..21).map(line).collect();
    folder.write("framed.asc", format!("ncols 41\nnrows 21\ncellsize 0,5\n{}\n", lines.join("\n")));
    let on = |terrain: &str| SCENARIO.replace("meadow.toml", terrain);
    let refusal = ["row 1, column 1 = -9999", "120 of 861 samples are holes", "holes = \"fill\" or \"crop\""];
    folder.refuses(&on("framed.asc"), "error: bad.toml: terrain: framed.asc: line 4, ", &refusal);

    let recipe = "name = \"framed\"\n[import]\nfile = \"framed.asc\"\nholes = ";
    for (holes, done) in
        [("fill", "filled from the heights around"), ("crop", "columns 2 to 40, rows 2 to 20")]
    {
        folder.write("framed.toml", format!("{recipe}\"{holes}\"\n"));
        folder.write("meadow-drive.toml", on("framed.toml"));
        let output = folder.run("meadow-drive.toml", &["--json"]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let json: Value = serde_json::from_slice(&output.stdout).unwrap();
        let warnings: Vec<&str> =
            json["warnings"].as_array().unwrap().iter().map(|warning| warning.as_str().unwrap()).collect();
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        assert_eq!(warnings[0], "framed.asc: decimal commas are read as decimal points");
        assert!(warnings[1].starts_with("framed.asc: 120 of 861 samples were holes: "), "{warnings:?}");
        assert!(warnings[1].contains(done), "{warnings:?}");
        let said: String = warnings.iter().map(|warning| format!("warning: {warning}\n")).collect();
        assert_eq!(String::from_utf8_lossy(&output.stderr), said);
    }
    folder.write("framed.toml", format!("{recipe}\"dig\"\n"));
    folder.refuses(
        &on("framed.toml"),
        "error: bad.toml: terrain: framed.toml: import.holes = \"dig\"",
        &["\"crop\""],
    );
}

#[test]
fn bad_arguments_are_refused_with_code_1() {
    let folder = Folder::new();
    let run = |options: &[&str]| folder.run("meadow-drive.toml", options);
    refused(&folder.run("none.toml", &[]), "error: none.toml: cannot be read", &[]);
    refused(&folder.run(".", &[]), "error: .: cannot be read", &["irectory"]);
    refused(&run(&["--seed", "one"]), "error: ", &["--seed", "one"]);
    refused(&run(&["--planner", "best"]), "error: ", &["--planner", "best", "paper"]);
    refused(&run(&["--fast"]), "error: ", &["--fast"]);
    refused(&mapless(folder.0.path(), &[]), "", &["Usage"]);
    // A folder cannot be made below a file.
    let below = run(&["--json", "--out", "meadow.toml/trial"]);
    refused(&below, "error: --out: meadow.toml/trial: ", &[]);
    fs::create_dir_all(folder.path("taken/trajectory.csv")).unwrap();
    refused(&run(&["--out", "taken"]), "error: --out: taken/trajectory.csv: ", &[]);
}

#[test]
fn help_is_no_error() {
    let output = mapless(Path::new("."), &["run", "--help"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8(output.stdout).unwrap().contains("--planner"));
}

/// Real ground, sampled every metre: from one corner, down a scarp of five metres, to the opposite one.
#[test]
#[ignore = "reads the data that MAPLESS_DATA names"]
fn a_trial_on_a_real_elevation_model_ends_in_a_named_outcome() {
    let data = std::env::var_os("MAPLESS_DATA").unwrap();
    let grid = Path::new(&data).join("data/dem/kootenai_37x50_1m_mit.asc");
    let folder = Folder::new();
    fs::copy(grid, folder.path("kootenai.asc")).unwrap();
    folder.write(
        "kootenai.toml",
        "terrain = \"kootenai.asc\"\nstart = [2.0, 34.0, -0.6]\ngoal = [47.0, 2.0]\nseed = 1\n",
    );
    let output = folder.run("kootenai.toml", &["--json"]);
    let result: Value = serde_json::from_slice(&output.stdout).unwrap();
    let outcome = result["outcome"].as_str().unwrap();
    let named = ["reached", "tilt_limit", "stuck", "no_subgoal", "left_terrain", "timeout"];
    assert!(named.contains(&outcome), "{outcome}");
    assert_eq!(output.status.code(), Some(if outcome == "reached" { 0 } else { 2 }));
    assert_eq!(result["reason"].is_null(), outcome != "no_subgoal", "{result}");
    println!("kootenai corner to corner: {result}");
}

#[test]
fn profile_compares_with_the_truth() {
    let folder = Folder::new();
    let args = ["profile", "meadow-drive.toml", "--poses", "3", "--json"];
    let output = mapless(folder.0.path(), &args);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let accuracy: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(accuracy["poses"], 3);
    assert!(accuracy["mean_abs_error_rad"].as_f64().unwrap() < 0.01, "{accuracy}");
    let columns: u64 = (0..9).map(|cell| accuracy["confusion"][cell / 3][cell % 3].as_u64().unwrap()).sum();
    assert_eq!(columns, 3 * 360);
    let table = mapless(folder.0.path(), &args[..4]);
    assert!(String::from_utf8_lossy(&table.stdout).contains("mean absolute error"), "{table:?}");
    refused(
        &mapless(folder.0.path(), &["profile", "nowhere.toml"]),
        "error: nowhere.toml",
        &["cannot be read"],
    );
}

#[test]
fn every_mode_of_learning_drives() {
    let folder = Folder::new();
    let fixed = folder.json(&[]);
    let once = folder.json(&["--learning", "once"]);
    assert_eq!(folder.json(&["--learning", "fixed"])["digest"], fixed["digest"]);
    assert_ne!(once["digest"], fixed["digest"]);
    refused(
        &folder.run("meadow-drive.toml", &["--learning", "always"]),
        "error: invalid value 'always'",
        &["every_scan"],
    );
}
