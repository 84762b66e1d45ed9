//! Every scenario with both presets and several seeds, written up in `docs/SCENARIOS.md`.

use std::collections::BTreeMap;
use std::env::consts::EXE_EXTENSION;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, ensure};
use xshell::{Shell, cmd};

use crate::setup;
use crate::work::run_all;

const PRESETS: [&str; 2] = ["default", "paper"];
const REPORT: &str = "docs/SCENARIOS.md";

/// The six metrics: name in the JSON, heading, decimals.
const METRICS: [(&str, &str, usize); 6] = [
    ("distance_m", "distance, m", 1),
    ("max_abs_roll_rad", "max \\|roll\\|, rad", 3),
    ("max_abs_pitch_rad", "max \\|pitch\\|, rad", 3),
    ("mean_vibration_rad_s", "vibration, rad/s", 3),
    ("mean_elevation_rate_cm_s", "elevation rate, cm/s", 2),
    ("curvature_change_rad_m", "curvature change, rad/m", 2),
];

/// What is read of the JSON that `mapless run` prints.
#[derive(Clone, Debug, serde::Deserialize)]
struct Trial {
    outcome: String,
    metrics: BTreeMap<String, f64>,
}

/// One trial to run.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Job {
    preset: &'static str,
    scenario: String,
    seed: u64,
}

/// Runs every scenario with the seeds from 1 to the preset's number of them (in the order of [`PRESETS`]), and writes the report.
pub(crate) fn run(sh: &Shell, seeds: [u64; 2]) -> anyhow::Result<()> {
    cmd!(sh, "cargo build --release --package mapless-cli").run()?;
    let program = setup::target_dir(sh).join("release/mapless").with_extension(EXE_EXTENSION);
    let folder = sh.current_dir().join("terrains/scenarios");
    let names = scenario_names(sh, &folder)?;
    let mut jobs = Vec::new();
    for (preset, seeds) in PRESETS.into_iter().zip(seeds) {
        for scenario in &names {
            jobs.extend((1..=seeds).map(|seed| Job { preset, scenario: scenario.clone(), seed }));
        }
    }
    let trials = run_all(
        jobs,
        |job| run_one(&program, &folder, job),
        |Job { preset, scenario, seed }, trial: &Trial| {
            format!("{scenario}, preset {preset}, seed {seed}: {}", trial.outcome)
        },
    )?;
    sh.write_file(REPORT, report(&names, &trials, seeds)?)?;
    println!("{REPORT} written");
    Ok(())
}

fn scenario_names(sh: &Shell, folder: &Path) -> anyhow::Result<Vec<String>> {
    let files = sh.read_dir(folder)?.into_iter();
    let scenarios = files.filter(|file| file.extension().is_some_and(|extension| extension == "toml"));
    let name = |file: PathBuf| Some(file.file_stem()?.to_str()?.to_owned());
    let mut names: Vec<String> = scenarios.filter_map(name).collect();
    names.sort();
    ensure!(!names.is_empty(), "{} has no scenarios", folder.display());
    Ok(names)
}

fn run_one(program: &Path, folder: &Path, job: &Job) -> anyhow::Result<Trial> {
    let scenario = folder.join(&job.scenario).with_extension("toml");
    let output = Command::new(program)
        .arg("run")
        .arg(scenario)
        .args(["--json", "--planner", job.preset, "--seed", &job.seed.to_string()])
        .output()
        .with_context(|| program.display().to_string())?;
    ensure!(
        matches!(output.status.code(), Some(0 | 2)),
        "{}",
        String::from_utf8_lossy(&output.stderr).trim_start_matches("error: ")
    );
    serde_json::from_slice(&output.stdout).context("output of mapless run --json")
}

fn report(names: &[String], trials: &BTreeMap<Job, Trial>, seeds: [u64; 2]) -> anyhow::Result<String> {
    let [default, paper] = seeds;
    let mut text = format!(
        "# What the scenarios show\n\n\
         Written by `cargo xtask scenarios --seeds {default} --paper-seeds {paper}`: each scenario of `terrains/scenarios/` with the seeds \
         from 1 on, two trials at a time.\n\n\
         Metrics are those of the paper, mean ± standard deviation over the trials that reached the goal. A trial ends \
         as `tilt_limit` when |roll| passes 0.524 rad or |pitch| 0.785 rad.\n"
    );
    for preset in PRESETS {
        let of_preset: Vec<&Trial> = select(trials, |job| job.preset == preset);
        let reached = of_preset.iter().filter(|trial| trial.has_reached()).count();
        writeln!(text, "\n## Preset `{preset}`: {reached} of {} reached\n", of_preset.len())?;
        let headings = METRICS.map(|(_, heading, _)| heading).join(" | ");
        writeln!(text, "| scenario | reached | other outcomes | {headings} |")?;
        writeln!(text, "|---|---|---|{}", "---:|".repeat(METRICS.len()))?;
        for name in names {
            let of_scenario = select(trials, |job| job.preset == preset && &job.scenario == name);
            writeln!(text, "{}", row(name, &of_scenario))?;
        }
    }
    Ok(text)
}

fn select(trials: &BTreeMap<Job, Trial>, wanted: impl Fn(&Job) -> bool) -> Vec<&Trial> {
    trials.iter().filter(|(job, _)| wanted(job)).map(|(_, trial)| trial).collect()
}

fn row(name: &str, trials: &[&Trial]) -> String {
    let (reached, others): (Vec<&Trial>, Vec<&Trial>) = trials.iter().partition(|trial| trial.has_reached());
    let mut counts: BTreeMap<&str, u64> = BTreeMap::new();
    for other in others {
        *counts.entry(&other.outcome).or_default() += 1;
    }
    let outcomes: Vec<String> = counts.iter().map(|(outcome, count)| format!("{count} {outcome}")).collect();
    let metrics = METRICS.map(|(metric, _, decimals)| {
        let values: Vec<f64> =
            reached.iter().filter_map(|trial| trial.metrics.get(metric).copied()).collect();
        mean_and_deviation(&values, decimals)
    });
    format!(
        "| {name} | {} of {} | {} | {} |",
        reached.len(),
        trials.len(),
        outcomes.join(", "),
        metrics.join(" | ")
    )
}

/// Mean ± sample standard deviation; only the mean of a single value, nothing of none.
fn mean_and_deviation(values: &[f64], decimals: usize) -> String {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    match values {
        [] => String::new(),
        [_] => format!("{mean:.decimals$}"),
        _ => format!("{mean:.decimals$} ± {:.decimals$}", (squares / (count - 1.0)).sqrt()),
    }
}

impl Trial {
    fn has_reached(&self) -> bool {
        self.outcome == "reached"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(outcome: &str, distance_m: f64) -> Trial {
        let metrics = METRICS.iter().map(|(name, ..)| (*name).to_owned());
        Trial { outcome: outcome.to_owned(), metrics: metrics.map(|name| (name, distance_m)).collect() }
    }

    #[test]
    fn a_row_counts_outcomes_and_averages_what_reached() {
        let trials = [
            trial("reached", 10.0),
            trial("timeout", 99.0),
            trial("reached", 14.0),
            trial("stuck", 99.0),
            trial("timeout", 99.0),
        ];
        let row = row("ml", &trials.iter().collect::<Vec<_>>());
        assert!(
            row.starts_with("| ml | 2 of 5 | 1 stuck, 2 timeout | 12.0 ± 2.8 | 12.000 ± 2.828 |"),
            "{row}"
        );
        assert!(row.ends_with("| 12.00 ± 2.83 |"), "{row}");
    }

    #[test]
    fn one_value_has_no_deviation_and_none_no_mean() {
        assert_eq!(mean_and_deviation(&[1.25], 1), "1.2");
        assert_eq!(mean_and_deviation(&[], 1), "");
    }

    #[test]
    fn the_report_has_a_row_for_each_scenario_and_preset() {
        let names = ["a".to_owned(), "b".to_owned()];
        let mut trials = BTreeMap::new();
        for preset in PRESETS {
            for (scenario, outcome) in names.iter().zip(["reached", preset]) {
                trials.insert(Job { preset, scenario: scenario.clone(), seed: 1 }, trial(outcome, 1.0));
            }
        }
        let report = report(&names, &trials, [1, 1]).unwrap();
        assert!(report.contains("## Preset `default`: 1 of 2 reached"), "{report}");
        assert!(report.contains("| b | 0 of 1 | 1 paper |  |  |  |  |  |  |"), "{report}");
    }
}
