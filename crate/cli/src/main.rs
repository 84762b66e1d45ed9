//! `mapless`: drives trials from scenario files.
//!
//! Exit code 0 when the goal was reached, 2 for any other outcome, 1 for an error.

mod log;
mod picture;
mod profile;
mod progress;
mod report;
mod run;

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
    /// Compare the elevation profile with the true skyline at random poses.
    Profile(profile::Args),
}

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(message) => return usage(&message),
    };
    let done = match args.command {
        Command::Run(args) => run::run(&args).map(|outcome| match outcome {
            Outcome::Reached => ExitCode::SUCCESS,
            _ => ExitCode::from(2),
        }),
        Command::Profile(args) => profile::run(&args).map(|()| ExitCode::SUCCESS),
    };
    match done {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// Shows clap's help or what is wrong with the arguments: an error has exit code 1 here, since 2 is an outcome.
fn usage(message: &clap::Error) -> ExitCode {
    let shown = message.print();
    if message.use_stderr() || shown.is_err() { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
