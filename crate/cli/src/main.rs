//! `mapless`: drives trials from scenario files, and perceives recorded scans.
//!
//! Exit code of a trial: 0 when the goal was reached, 2 for any other outcome, 1 for an error. Exit code of a
//! scan: 0 when it was read, 1 for an error. Exit code of a replay: 0 when every decision is the recorded
//! one, 2 when one differs, 1 for an error.

mod any_trial;
mod generate;
mod import;
mod log;
mod output;
mod parsers;
mod perceive;
mod picture;
mod profile;
mod progress;
mod replay;
mod results;
mod run;
mod setup;
mod terrain;
mod trial_report;
mod trials;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use mapless_trials::Outcome;

/// Mapless navigation on uneven terrain: a simulated Husky with a VLP-16 drives to a goal.
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run one trial. Exit code: 0 = goal reached, 2 = another outcome, 1 = error.
    Run(run::Args),
    /// Run a campaign: planners × routes × seeds × parameter values, one row a trial. Exit code: 0 = every
    /// trial has its row, 1 = error.
    Trials(trials::Args),
    /// Write the tables and figures of finished campaigns.
    Report(results::Args),
    /// Compare the elevation profile with the true skyline at random poses.
    Profile(profile::Args),
    /// Write tasks on generated terrains, each of which the oracle has solved, as scenario files.
    Generate(generate::Args),
    /// Write another benchmark's worlds and tasks as terrains, scenarios and a campaign.
    Import(import::Args),
    /// Make a terrain of a point cloud: a grid of heights and the recipe that imports it.
    Terrain(terrain::Args),
    /// Show what the planner perceives in one recorded scan. Exit code: 0 = perceived or stopped with a
    /// reason, 1 = error.
    Perceive(perceive::Args),
    /// Run estimator, supervisor and planner of the node over a recording, and tell what they decide
    /// otherwise. Exit code: 0 = nothing, 2 = something, 1 = error.
    Replay(replay::Args),
}

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(message) => return usage(&message),
    };
    let result = match args.command {
        Command::Run(args) => run::run(&args).map(|outcome| match outcome {
            Outcome::Reached => ExitCode::SUCCESS,
            _ => ExitCode::from(2),
        }),
        Command::Trials(args) => trials::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Report(args) => results::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Profile(args) => profile::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Generate(args) => generate::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Import(args) => import::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Terrain(args) => terrain::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Perceive(args) => perceive::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Replay(args) => replay::run(&args).map(|is_same| match is_same {
            true => ExitCode::SUCCESS,
            false => ExitCode::from(2),
        }),
    };
    result.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}

/// Shows clap's help or its error about the arguments: an error has exit code 1 here, since 2 is an outcome.
fn usage(message: &clap::Error) -> ExitCode {
    let shown = message.print();
    if message.use_stderr() || shown.is_err() { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
