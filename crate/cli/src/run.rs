//! `mapless run`: one trial from a scenario file.

use std::io::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::Context as _;
use mapless_trials::{LoadedScenario, Outcome, Trial};

use crate::log::Log;
use crate::progress::Progress;
use crate::report::{Report, Subject};
use crate::setup::Setup;

#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    setup: Setup,
    /// Seed of the sensor's noise, instead of the scenario's own.
    #[arg(long)]
    seed: Option<u64>,
    /// Write trajectory.csv, path.svg and result.json to this folder, which is made when missing.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the trial and shows how it ended.
pub(crate) fn run(args: &Args) -> anyhow::Result<Outcome> {
    let (LoadedScenario { scenario, terrain }, planner) = args.setup.load()?;
    let seed = args.seed.unwrap_or(scenario.seed);
    let mut trial =
        Trial::with_planner(terrain.field, &scenario, planner, seed).with_context(|| args.setup.file())?;
    let mut log = args.out.as_deref().map(Log::create).transpose()?;

    let (outcome, planner_times) = drive(&mut trial, &mut log)?;
    let subject = Subject {
        scenario: args.setup.scenario.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        terrain: terrain.name,
        preset: args.setup.planner.preset,
        seed,
        roll_limit_rad: scenario.robot.roll_limit_rad,
        pitch_limit_rad: scenario.robot.pitch_limit_rad,
    };
    let report = Report::new(subject, &trial, outcome, planner_times);
    if let Some(log) = log {
        log.finish(&trial, &report)?;
    }

    let text = if args.json { serde_json::to_string(&report)? } else { report.table() };
    writeln!(std::io::stdout(), "{text}").context("standard output")?;
    Ok(outcome)
}

/// Drives until the trial ends, and says how long each planner step took.
fn drive(trial: &mut Trial, log: &mut Option<Log>) -> anyhow::Result<(Outcome, Vec<Duration>)> {
    let progress = Progress::new(trial);
    let mut planner_times = Vec::new();
    loop {
        trial.look();
        let start = Instant::now();
        trial.plan();
        planner_times.push(start.elapsed());
        if let Some(log) = log {
            log.decided(trial)?;
        }
        let outcome = trial.act();
        progress.show(trial);
        if let Some(outcome) = outcome {
            return Ok((outcome, planner_times));
        }
    }
}
