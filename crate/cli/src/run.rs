//! `mapless run`: one trial from a scenario file.

use std::io::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::{Context as _, ensure};
use mapless::gp::learning::LearningMode;
use mapless_baselines::{NavigatorKind, Truth};
use mapless_trials::{LoadedScenario, Outcome, Trial};

use crate::any_trial::AnyTrial;
use crate::log::Log;
use crate::parsers;
use crate::progress::Progress;
use crate::setup;
use crate::trial_report::{Report, Subject};

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scenario file (TOML): terrain, start, goal, seed and what differs from the defaults.
    scenario: PathBuf,
    /// What drives: default, paper and flat are configurations of the mapless planner, from which a
    /// scenario's [planner] section starts; the others know the map.
    #[arg(long, default_value = "default", value_parser = parsers::planner(), value_name = "NAME")]
    planner: NavigatorKind,
    /// When the mapless planner learns hyperparameters, instead of what the configuration says.
    #[arg(long, value_parser = parsers::learning(), value_name = "MODE")]
    learning: Option<LearningMode>,
    /// Ground truth in place of perception, for the mapless planner.
    #[arg(long, default_value = "none", value_parser = parsers::truth(), value_name = "WHAT")]
    truth: Truth,
    /// Seed of the sensor's noise and of a planner's random numbers, instead of the scenario's own.
    #[arg(long)]
    seed: Option<u64>,
    /// Write trajectory.csv, path.svg and result.json to this folder, which is made when missing.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

/// Runs the trial and shows its result.
pub(crate) fn run(args: &Args) -> anyhow::Result<Outcome> {
    let LoadedScenario { scenario, terrain } = LoadedScenario::read(&args.scenario)?;
    setup::show_warnings(&terrain.warnings);
    let file = || args.scenario.display().to_string();
    let seed = args.seed.unwrap_or(scenario.seed);
    let mut config = args.planner.planner_config(&scenario).with_context(file)?;
    if let Some(mode) = args.learning {
        let learns = matches!(args.planner, NavigatorKind::Mapless(_));
        ensure!(learns, "--learning: planner {} learns nothing: expected a mapless one", args.planner);
        config.perception.learning.mode = mode;
    }
    let goal_tolerance_m = config.goal_tolerance_m;
    let navigator =
        args.planner.build_with(config, args.truth, &terrain.field, &scenario, seed).with_context(file)?;
    let mut trial = Trial::with_navigator(terrain.field, &scenario, navigator, seed).with_context(file)?;
    let mut log = args.out.as_deref().map(|out| Log::create(out, goal_tolerance_m)).transpose()?;

    let (outcome, planner_times) = drive(&mut trial, &mut log)?;
    let subject = Subject {
        scenario: args.scenario.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        terrain: terrain.name,
        planner: args.planner_name(),
        seed,
        roll_limit_rad: scenario.robot.roll_limit_rad,
        pitch_limit_rad: scenario.robot.pitch_limit_rad,
    };
    let report = Report::new(subject, &trial, outcome, planner_times, terrain.warnings);
    if let Some(log) = log {
        log.finish(&trial, &report)?;
    }

    let text = if args.json { serde_json::to_string(&report)? } else { report.table() };
    writeln!(std::io::stdout(), "{text}").context("standard output")?;
    Ok(outcome)
}

impl Args {
    fn planner_name(&self) -> String {
        match self.truth {
            Truth::None => self.planner.name().to_owned(),
            truth => format!("{}, truth {truth}", self.planner),
        }
    }
}

/// Drives until the trial ends; returns the time of each planner step.
fn drive(trial: &mut AnyTrial, log: &mut Option<Log>) -> anyhow::Result<(Outcome, Vec<Duration>)> {
    let progress = Progress::new(trial);
    let mut planner_times = Vec::new();
    loop {
        trial.look_far();
        let start = Instant::now();
        let decision = trial.plan();
        planner_times.push(start.elapsed());
        if let Some(log) = log {
            log.decided(trial, &decision)?;
        }
        let outcome = trial.act();
        progress.show(trial);
        if let Some(outcome) = outcome {
            return Ok((outcome, planner_times));
        }
    }
}
