//! `mapless trials` through the real binary: resumed after kills, in shards and with several jobs, always the
//! same bytes.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

use serde_json::Value;
use tempfile::TempDir;

const RECIPE: &str = "name = \"Meadow\"\nsize_m = [16.0, 10.0]\ncell_m = 0.2\nseed = 5\n\n\
    [[noise]]\namplitude_m = 0.2\nwavelength_m = 6.0\noctaves = 2\n";
/// Six metres, with few beams and a small surface, so that a trial takes a fraction of a second.
const EAST: &str = "terrain = \"../meadow.toml\"\nstart = [4.0, 5.0, 0.3]\ngoal = [10.0, 5.0]\nseed = 1\n\n\
    [sensor]\ncolumns = 450\n\n[planner.perception]\nsurface_radius_m = 4.0\n";
const WEST: &str = "terrain = \"../meadow.toml\"\nstart = [12.0, 5.0, 2.8]\ngoal = [6.0, 4.0]\nseed = 1\n\n\
    [sensor]\ncolumns = 450\n\n[planner.perception]\nsurface_radius_m = 4.0\n";
const CAMPAIGN: &str = "planners = [\"default\"]\nroutes = [\"routes/*.toml\"]\nseeds = { from = 1, to = 6 }\n\
    trajectories = true\n\n[[parameters]]\npath = \"planner.decision.steepness_weight\"\nvalues = [0.0, -1.0]\n";
/// Routes × (base and two values) × seeds.
const TRIALS: usize = 2 * 3 * 6;
/// Those with the value that no planner takes.
const ERRORS: usize = 2 * 6;
/// What must be the same bytes however a campaign has run.
const FILES: [&str; 3] = ["trials.csv", "trials.parquet", "campaign.json"];

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::create_dir(folder.path("routes")).unwrap();
        for (name, text) in [
            ("meadow.toml", RECIPE),
            ("routes/east.toml", EAST),
            ("routes/west.toml", WEST),
            ("small.toml", CAMPAIGN),
        ] {
            folder.write(name, text);
        }
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mapless"));
        command.args(args).current_dir(self.0.path());
        command
    }

    /// Runs the campaign to its end; gives what it prints.
    fn trials(&self, args: &[&str]) -> String {
        let output = self.command(&[&["trials", "small.toml"], args].concat()).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        assert!(!String::from_utf8_lossy(&output.stderr).contains("panicked"), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    fn refused(&self, args: &[&str]) -> String {
        let output: Output = self.command(args).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        assert!(output.stdout.is_empty(), "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    }

    /// The final files and the trajectories, with their names.
    fn results(&self, out: &str) -> Vec<(String, Vec<u8>)> {
        let mut names: Vec<String> = FILES.map(str::to_owned).to_vec();
        let kept = fs::read_dir(self.path(out).join("trajectories")).unwrap();
        names.extend(
            kept.map(|file| format!("trajectories/{}", file.unwrap().file_name().into_string().unwrap())),
        );
        names.sort();
        names.into_iter().map(|name| (name.clone(), fs::read(self.path(out).join(name)).unwrap())).collect()
    }

    /// Lines of the journals, without their headers.
    fn journalled(&self, out: &str) -> usize {
        let Ok(files) = fs::read_dir(self.path(out)) else { return 0 };
        let is_journal = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "jsonl");
        let lines = |path: PathBuf| fs::read_to_string(path).unwrap().lines().count().saturating_sub(1);
        files.map(|file| file.unwrap().path()).filter(is_journal).map(lines).sum()
    }
}

fn assert_same(one: &[(String, Vec<u8>)], other: &[(String, Vec<u8>)], how: &str) {
    let names =
        |results: &[(String, Vec<u8>)]| results.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(names(one), names(other), "{how}");
    for ((name, one), (_, other)) in one.iter().zip(other) {
        assert!(one == other, "{name} differs: {how}");
    }
}

#[test]
fn jobs_shards_and_kills_change_no_byte() {
    let folder = Folder::new();
    let printed = folder.trials(&["--jobs", "1", "--out", "alone"]);
    assert!(
        printed.contains(&format!("{TRIALS} trials, {ERRORS} of them with an error in alone/trials.csv")),
        "{printed}"
    );
    let alone = folder.results("alone");
    // One trajectory on each route.
    assert_eq!(alone.len(), FILES.len() + 2);

    // No machine has so many threads.
    folder.trials(&["--jobs", "1000000", "--out", "jobs"]);
    assert_same(&alone, &folder.results("jobs"), "as many jobs as trials");

    let mut shards: Vec<_> = ["2/3", "1/3", "3/3"]
        .map(|shard| folder.command(&["trials", "small.toml", "--out", "shards", "--shard", shard]))
        .into_iter()
        .map(|mut command| command.stdout(Stdio::null()).spawn().unwrap())
        .collect();
    for shard in &mut shards {
        assert!(shard.wait().unwrap().success());
    }
    assert_same(&alone, &folder.results("shards"), "three shards at a time");
    assert_eq!(folder.journalled("shards"), TRIALS);

    kill_ten_times(&folder);
    folder.trials(&["--jobs", "2", "--out", "killed"]);
    assert_same(&alone, &folder.results("killed"), "killed ten times");
    assert_eq!(folder.journalled("killed"), TRIALS, "a trial ran twice or was lost");

    // A finished campaign runs nothing again, and writes the same.
    folder.trials(&["--out", "alone"]);
    assert_eq!(folder.journalled("alone"), TRIALS);
    assert_same(&alone, &folder.results("alone"), "run again");
    let timing = fs::read_to_string(folder.path("alone/timing.csv")).unwrap();
    assert_eq!(timing.lines().count(), TRIALS + 1);
}

/// Starts the campaign ten times and kills it each time before its end: in turn at any moment of its first
/// 100 ms and soon after the next trial was written, the last times with pieces of a line behind it as a
/// power failure may leave them.
fn kill_ten_times(folder: &Folder) {
    // A small generator of its own, so that a failure can be repeated.
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    for round in 0..10 {
        let before = folder.journalled("killed");
        let mut child = folder
            .command(&["trials", "small.toml", "--jobs", "2", "--out", "killed"])
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        if round % 2 == 0 {
            thread::sleep(Duration::from_millis(random() % 100));
        } else {
            while folder.journalled("killed") <= before {
                assert_eq!(child.try_wait().unwrap(), None, "round {round} wrote no trial");
                thread::sleep(Duration::from_millis(5));
            }
            thread::sleep(Duration::from_millis(random() % 20));
        }
        assert_eq!(child.try_wait().unwrap(), None, "round {round} ended before it could be killed");
        child.kill().unwrap();
        child.wait().unwrap();
        if round >= 7 {
            let path = folder.path("killed/journal.jsonl");
            let mut text = fs::read(&path).unwrap();
            text.extend_from_slice(&b"{\"result\":{\"id\":\"torn"[..(random() % 20) as usize + 1]);
            fs::write(path, text).unwrap();
        }
    }
    assert!((1..TRIALS).contains(&folder.journalled("killed")), "nothing was left, or all");
}

#[test]
fn rows_say_what_ran_and_each_can_be_run_again() {
    let folder = Folder::new();
    folder.trials(&["--out", "out"]);
    let mut reader = csv_rows(&folder.path("out/trials.csv"));
    assert_eq!(reader.len(), TRIALS);
    let failed: Vec<Value> = reader.extract_if(.., |row| row["outcome"] == "error").collect();
    assert_eq!(failed.len(), ERRORS);
    for row in &failed {
        assert_eq!(row["parameters"], "planner.decision.steepness_weight=-1.0");
        assert!(row["error"].as_str().unwrap().contains("steepness_weight = -1"), "{row}");
        assert_eq!((row["distance_m"].as_str(), row["digest"].as_str()), (Some(""), Some("")));
    }
    let first = &reader[0];
    assert_eq!((first["route"].as_str(), first["seed"].as_str()), (Some("east"), Some("1")));
    assert_eq!(first["straight_m"], "6.0");
    // The ground is gentle: the oracle drives straight, up to where it counts as there.
    for row in &reader {
        let metres = |name: &str| row[name].as_str().unwrap().parse::<f64>().unwrap();
        let (straight_m, oracle_m) = (metres("straight_m"), metres("oracle_length_m"));
        assert!((oracle_m - straight_m).abs() < 0.03, "{oracle_m} m for {straight_m} m");
    }
    // Each route and seed is another drive.
    let digests: BTreeSet<&str> = reader.iter().map(|row| row["digest"].as_str().unwrap()).collect();
    assert!(digests.len() >= 2 * 6, "{digests:?}");
    let configuration: Value = serde_json::from_str(first["configuration"].as_str().unwrap()).unwrap();
    assert_eq!(configuration["decision"]["steepness_weight"], 1.0);

    // A single trial is the same as `mapless run`, and as the campaign's.
    let output = folder.command(&["run", "routes/east.toml", "--seed", "1", "--json"]).output().unwrap();
    let run: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(run["digest"], first["digest"]);
    let id = first["id"].as_str().unwrap();
    let again: Value = serde_json::from_str(&folder.trials(&["--only", id, "--out", "again"])).unwrap();
    assert_eq!(again["digest"], first["digest"]);
    assert_eq!(again["metrics"], run["metrics"]);
    let trajectory = fs::read(folder.path("again").join(format!("{id}.csv"))).unwrap();
    assert_eq!(trajectory, fs::read(folder.path("out/trajectories").join(format!("{id}.csv"))).unwrap());
    assert_eq!(
        trajectory.iter().filter(|&&byte| byte == b'\n').count() as u64,
        run["ticks"].as_u64().unwrap() + 2
    );
}

/// Every row as an object of strings. No cell of these campaigns has a line break.
fn csv_rows(path: &Path) -> Vec<Value> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(cells);
    let names = lines.next().unwrap();
    lines.map(|cells| names.iter().cloned().zip(cells.into_iter().map(Value::String)).collect()).collect()
}

/// The cells of a line; those in quotation marks may hold commas, and quotation marks as pairs of them.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for letter in line.replace("\"\"", "\u{1}").chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            '\u{1}' => cells.last_mut().unwrap().push('"'),
            _ => cells.last_mut().unwrap().push(letter),
        }
    }
    cells
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let folder = Folder::new();
    folder.write("small.toml", &CAMPAIGN.replace("to = 6", "to = 1"));
    folder.trials(&["--out", "out"]);
    let before = folder.results("out");
    folder.write("other.toml", &CAMPAIGN.replace("to = 6", "to = 3"));
    let error = folder.refused(&["trials", "other.toml", "--out", "out"]);
    assert!(error.starts_with("error: out/journal.jsonl: holds trials of another campaign ("), "{error}");
    let error = folder.refused(&["trials", "other.toml", "--out", "out", "--shard", "1/2"]);
    assert!(error.contains("choose another --out"), "{error}");
    assert_same(&before, &folder.results("out"), "after refusals");

    let error = folder.refused(&["trials", "none.toml"]);
    assert!(error.starts_with("error: none.toml: cannot be read"), "{error}");
    folder.write(
        "bad.toml",
        "planners = [\"default\"]\nroutes = [\"routes/*.toml\"]\nseeds = [1]\ncolour = 1\n",
    );
    let error = folder.refused(&["trials", "bad.toml"]);
    assert!(error.starts_with("error: bad.toml: TOML parse error at line 4, column 1"), "{error}");
    let error = folder.refused(&["trials", "small.toml", "--only", "0"]);
    assert!(error.contains("--only: \"0\": expected the id of a trial of campaign small"), "{error}");
    let error = folder.refused(&["trials", "small.toml", "--shard", "3/2"]);
    assert!(error.contains("\"3/2\": expected I/N"), "{error}");
    let error = folder.refused(&["trials", "small.toml", "--jobs", "0"]);
    assert!(error.contains("--jobs"), "{error}");
    folder.write("taken", "");
    let error = folder.refused(&["trials", "small.toml", "--out", "taken"]);
    assert!(error.starts_with("error: taken: cannot be written"), "{error}");
}

/// The quick form's planners, as its file names them, on the shortest of the paper's routes.
#[test]
fn every_planner_drives_in_a_campaign_and_stands_in_its_report() {
    let folder = Folder::new();
    let terrains = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrains");
    let quick = mapless_campaign::Plan::read(&terrains.join("campaigns/quick.toml")).unwrap();
    let planners = quick.campaign.planners;
    let route = terrains.join("scenarios/ht.toml");
    folder.write(
        "small.toml",
        &format!("planners = {planners:?}\nroutes = ['{}']\nseeds = [1]\n", route.display()),
    );
    folder.trials(&["--out", "out"]);
    let output = folder.command(&["report", "out", "--out", "docs"]).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let page = fs::read_to_string(folder.path("docs/results/small.md")).unwrap();
    assert_eq!(planners.len(), 8);
    for planner in &planners {
        let reaches = !matches!(planner.as_str(), "flat" | "direct");
        let success = format!("| `{planner}` | {} of 1 (", u8::from(reaches));
        assert!(page.contains(&success), "{success}\n{page}");
        let against = format!("- `default` against `{planner}`, on 1 route:");
        assert_eq!(page.contains(&against), reaches && planner != "default", "{against}\n{page}");
    }
    assert!(!page.contains("error"), "{page}");
}

#[test]
fn a_report_is_the_same_twice_and_names_every_route() {
    let folder = Folder::new();
    // One route has the name of one of the paper's, so that its numbers stand beside ours.
    fs::rename(folder.path("routes/east.toml"), folder.path("routes/cht-ad.toml")).unwrap();
    folder.write(
        "small.toml",
        &CAMPAIGN
            .replace("-1.0", "0.7")
            .replace("\"default\"", "\"default\", \"paper\"")
            .replace("to = 6", "to = 1"),
    );
    folder.trials(&["--out", "out"]);
    let report = |out: &str| -> Vec<(PathBuf, Vec<u8>)> {
        let output = folder.command(&["report", "out", "--out", out]).output().unwrap();
        assert!(output.status.success(), "{output:?}");
        let files = String::from_utf8(output.stdout).unwrap();
        files.lines().map(|file| (PathBuf::from(file), fs::read(folder.path(file)).unwrap())).collect()
    };
    let (first, second) = (report("docs"), report("again"));
    assert_eq!(first.len(), second.len());
    for ((path, text), (other, again)) in first.iter().zip(&second) {
        assert_eq!(path.file_name(), other.file_name());
        assert!(text == again, "{} differs", path.display());
    }
    let text = |name: &str| {
        let (_, bytes) = first.iter().find(|(path, _)| path.ends_with(name)).unwrap();
        str::from_utf8(bytes).unwrap()
    };
    let success = "| `default` | 2 of 2 (34–100 %) |";
    let index = text("RESULTS.md");
    assert!(index.contains("## [Campaign `small`](results/small.md)") && index.contains(success), "{index}");
    assert_eq!(
        fs::read(folder.path("out/trials.parquet")).unwrap(),
        fs::read(folder.path("docs/results/small.parquet")).unwrap()
    );
    let page = text("small.md");
    for needle in [
        "# Campaign `small`",
        success,
        "(small.parquet)",
        "| cht-ad |",
        "west",
        "| AD (cht-ad) | *published: VGF* | | *46.6* |",
        "| AD (cht-ad) | `default` | 1 of 1 (21–100 %) | ",
        "`default` against the published numbers of VGF, on 1 route:",
        "## Against the shortest safe path",
        "### `planner.decision.steepness_weight`",
        "| `default` | **1.0** | ",
        "| `paper` | 0.7 | ",
        "mapless trials small.toml --only ",
    ] {
        assert!(page.contains(needle), "not in the report: {needle}\n{page}");
    }
    // Every figure that the report shows is there, and is a picture.
    let figures: Vec<&str> = page
        .split("](")
        .skip(1)
        .map(|rest| rest.split(')').next().unwrap())
        .filter(|file| file.ends_with(".svg"))
        .collect();
    assert_eq!(figures.len(), 2 + 3 + 2, "{figures:?}");
    // With the page, the index, its figure and the rows.
    assert_eq!(figures.len() + 4, first.len());
    for figure in figures {
        let svg = text(figure);
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{figure}");
    }
    let error = folder.refused(&["report", "routes"]);
    assert!(
        error.starts_with("error: routes/trials.csv: cannot be read") && error.contains("has finished"),
        "{error}"
    );
}
