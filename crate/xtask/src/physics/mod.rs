//! The planner in closed loop with MuJoCo beside our own world, written to `docs/results/physics.md`.

pub(crate) mod over_ros;
mod report;
mod tasks;

use std::collections::BTreeMap;
use std::env::consts::EXE_EXTENSION;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, ensure};
use xshell::{Shell, cmd};

use crate::count::{Count, Runner, count};
use crate::python::Environment;
use crate::setup;
use crate::work::run_all;
use tasks::Task;

const REPORT: &str = "docs/results/physics.md";
const REQUIREMENTS: &str = "crate/physics/requirements.txt";
const ENGINE: &str = "crate/physics/simulate.py";
const CHECKS: &str = "crate/physics/check.py";

/// What a task is driven in, as `mapless-physics` names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Simulator {
    Ideal,
    Field,
    Mujoco,
    MujocoField,
}

impl Simulator {
    const ALL: [Self; 4] = [Self::Ideal, Self::Field, Self::Mujoco, Self::MujocoField];

    fn name(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::Field => "field",
            Self::Mujoco => "mujoco",
            Self::MujocoField => "mujoco-field",
        }
    }
}

/// One drive.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Job {
    task: Task,
    simulator: Simulator,
}

/// What `mapless-physics drive` prints.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
struct Driven {
    outcome: String,
    reason: Option<String>,
    time_s: f64,
    path_m: f64,
    max_abs_roll_rad: f64,
    max_abs_pitch_rad: f64,
    distance_to_goal_m: f64,
    turn_ratio: f64,
    aside_m: f64,
    off_plane_roll_rad: f64,
    off_plane_pitch_rad: f64,
    body_touched_s: f64,
}

type Drives = BTreeMap<Job, Driven>;

/// Drives all tasks, or the two of the short form, in every simulator, and writes the report; the short form
/// prints it.
pub(crate) fn run(sh: &Shell, is_short: bool) -> anyhow::Result<()> {
    if is_short {
        println!("{}", report::page(&drive_short(sh)?)?);
        return Ok(());
    }
    cmd!(sh, "cargo build --release --package mapless-cli").run()?;
    let program = release(sh, "mapless");
    let tasks = tasks::all(sh, &program, &setup::target_dir(sh).join("physics"))?;
    let drives = drive(sh, tasks)?;
    sh.write_file(REPORT, report::page(&drives)?)?;
    println!("{REPORT} written");
    Ok(())
}

/// Checks the physics on ground whose answers are known; then every simulator must reach the goals of the
/// short form.
pub(crate) fn test(sh: &Shell) -> anyhow::Result<Count> {
    let mut count = check(sh)?;
    for (Job { task, simulator }, driven) in drive_short(sh)? {
        let Driven { outcome, path_m, .. } = driven;
        let name = simulator.name();
        ensure!(
            outcome == "reached",
            "{} in {name}: {outcome} after {path_m:.1} m: expected reached",
            task.name
        );
        count.passed += 1;
    }
    Ok(count)
}

/// Installs MuJoCo; returns the Python that has it.
pub(crate) fn python(sh: &Shell) -> anyhow::Result<PathBuf> {
    let environment = Environment {
        folder: &setup::target_dir(sh).join("physics-venv"),
        requirements: REQUIREMENTS,
        pythons: &["python3", "python3.13", "python3.12", "python3.11", "python"],
        fits: |version| version >= (3, 11),
        missing: "The physics engine needs Python 3.11 or newer with pip, and none is on PATH. Install one, for example with \
            `sudo apt-get install python3 python3-venv`.",
    };
    environment.set_up(sh)
}

fn check(sh: &Shell) -> anyhow::Result<Count> {
    let python = python(sh)?;
    count(cmd!(sh, "{python} {CHECKS}"), Runner::Playwright)
}

fn drive_short(sh: &Shell) -> anyhow::Result<Drives> {
    drive(sh, tasks::short(sh)?)
}

/// Drives the tasks in every simulator.
fn drive(sh: &Shell, tasks: Vec<Task>) -> anyhow::Result<Drives> {
    let python = python(sh)?;
    cmd!(sh, "cargo build --release --package mapless-physics").run()?;
    let program = release(sh, "mapless-physics");
    let engine = sh.current_dir().join(ENGINE);
    let jobs =
        tasks.iter().flat_map(|task| Simulator::ALL.map(|simulator| Job { task: task.clone(), simulator }));
    run_all(
        jobs.collect(),
        |job| drive_one(&program, &python, &engine, job),
        |Job { task, simulator }, Driven { outcome, path_m, .. }| {
            format!("{} in {}: {outcome} after {path_m:.1} m", task.name, simulator.name())
        },
    )
}

fn drive_one(program: &Path, python: &Path, engine: &Path, job: &Job) -> anyhow::Result<Driven> {
    let mut command = Command::new(program);
    command.arg("drive").arg(&job.task.file).arg(job.simulator.name());
    if matches!(job.simulator, Simulator::Mujoco | Simulator::MujocoField) {
        command.arg(python).arg(engine);
    }
    let output = command.output().with_context(|| program.display().to_string())?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
    serde_json::from_slice(&output.stdout).context("the result of mapless-physics")
}

fn release(sh: &Shell, program: &str) -> PathBuf {
    setup::target_dir(sh).join("release").join(program).with_extension(EXE_EXTENSION)
}
