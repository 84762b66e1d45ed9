//! `mapless-physics drive TASK SIMULATOR COMMAND…`: the planner drives a scenario's task, its robot moved by
//! a physics engine or by the trial's own kinematics. `mapless-physics over-ros TASK … COMMAND…`: the node
//! for robots drives it over DDS. The result is printed as a line of JSON.

mod engine;
mod measures;
mod motion;
mod over_ros;
mod simulator;

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context as _, ensure};
use clap::{Parser, Subcommand};
use mapless_trials::{LoadedScenario, Outcome, Preset, Trial};

use engine::Engine;
use measures::{Before, Measures};
use motion::Motion;
use simulator::Simulator;

/// Drive one task and print the result as a line of JSON.
#[derive(Debug, Parser)]
#[command(name = "mapless-physics")]
struct Args {
    #[command(subcommand)]
    form: Form,
}

#[derive(Debug, Subcommand)]
enum Form {
    /// The planner drives, in a physics engine or in the kinematic world.
    Drive(DriveArgs),
    /// The node for robots drives in the physics engine, over DDS.
    OverRos(over_ros::OverRosArgs),
}

#[derive(Debug, clap::Args)]
struct DriveArgs {
    /// Scenario file: terrain, objects that stand, start, goal and seed. Its [reality] does not count.
    task: PathBuf,
    /// What moves the robot, and what goes wrong.
    simulator: Simulator,
    /// The program of the physics engine, with its arguments, for the simulators that need one.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    command: Vec<String>,
}

/// What is printed.
#[derive(Debug, serde::Serialize)]
struct Driven {
    outcome: Outcome,
    /// Why the trial ended, if there is a reason.
    reason: Option<String>,
    time_s: f64,
    /// Length in space.
    path_m: f64,
    max_abs_roll_rad: f64,
    max_abs_pitch_rad: f64,
    /// From where the robot truly is, seen from above.
    distance_to_goal_m: f64,
    /// Turned over commanded.
    turn_ratio: f64,
    /// Slid to the sides, in all.
    aside_m: f64,
    /// Roll and pitch less those of the plane of four contacts, 99 % of the time at most.
    off_plane_roll_rad: f64,
    off_plane_pitch_rad: f64,
    /// How long anything but the wheels touched anything; 0 in the kinematic world, which does not know.
    body_touched_s: f64,
}

fn main() -> anyhow::Result<()> {
    let driven = match Args::parse().form {
        Form::Drive(args) => serde_json::to_string(&drive(&args)?)?,
        Form::OverRos(args) => serde_json::to_string(&over_ros::drive(&args)?)?,
    };
    writeln!(std::io::stdout(), "{driven}").context("standard output")
}

fn drive(args: &DriveArgs) -> anyhow::Result<Driven> {
    let file = || args.task.display().to_string();
    let LoadedScenario { mut scenario, terrain } = LoadedScenario::read(&args.task)?;
    scenario.reality = args.simulator.reality();
    let mut trial =
        Trial::new(terrain.field, &scenario, Preset::Default, scenario.seed).with_context(file)?;
    let robot = &scenario.robot;
    let mut engine = if args.simulator.is_physical() {
        let (engine, rest) =
            Engine::start(&args.command, &trial, robot, simulator::friction()).with_context(file)?;
        Some((engine, Motion::new(rest)))
    } else {
        ensure!(args.command.is_empty(), "COMMAND: expected none, as {:?} needs no engine", args.simulator);
        None
    };

    let mut measures = Measures::default();
    let mut body_touched_s = 0.0;
    let outcome = loop {
        trial.look();
        let command = trial.plan().command;
        let before = Before::of(&trial);
        let outcome = match &mut engine {
            None => trial.act(),
            Some((engine, motion)) => trial
                .act_by(|command, seconds| {
                    let state = engine.drive(command, seconds)?;
                    body_touched_s += if state.body_touches { seconds } else { 0.0 };
                    anyhow::Ok(motion.moved(state, seconds))
                })
                .with_context(file)?,
        };
        measures.add(before, command, &trial, robot);
        if let Some(outcome) = outcome {
            break outcome;
        }
    };
    let metrics = trial.metrics();
    let [off_plane_roll_rad, off_plane_pitch_rad] = measures.off_plane_rad();
    Ok(Driven {
        outcome,
        reason: trial.end_reason(),
        time_s: trial.time_s(),
        path_m: metrics.distance_m,
        max_abs_roll_rad: metrics.max_abs_roll_rad,
        max_abs_pitch_rad: metrics.max_abs_pitch_rad,
        distance_to_goal_m: trial.true_distance_to_goal_m(),
        turn_ratio: measures.turn_ratio(),
        aside_m: measures.aside_m(),
        off_plane_roll_rad,
        off_plane_pitch_rad,
        body_touched_s,
    })
}
