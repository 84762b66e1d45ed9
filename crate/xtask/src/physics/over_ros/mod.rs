//! The node for robots in closed loop with MuJoCo over DDS, written to `docs/results/physics-over-ros.md`.

mod report;

use std::collections::BTreeMap;
use std::env::consts::EXE_EXTENSION;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, ensure};
use xshell::{Shell, cmd};

use crate::count::Count;
use crate::setup;
use crate::work::run_all;

const REPORT: &str = "docs/results/physics-over-ros.md";
/// A group of hills, a gentle slope, and a climb of some 30°.
const ROUTES: [&str; 3] = ["ht", "gsb", "vta"];
const SEEDS: u16 = 10;
/// DDS domains of the drives, in turn: those that the tests of the node leave. Drives at the same time have
/// different ones.
const DOMAINS: std::ops::Range<u16> = 51..76;
/// The short form: the begin of a route (its place among [`ROUTES`]), and a place some metres along it.
const SHORT_ROUTE: usize = 0;
const SHORT_GOAL: [&str; 2] = ["14", "14"];
/// The node's own limit on the distance at arrival is 0.5 m; the estimate may be off by as much again.
const SHORT_WITHIN_M: f64 = 1.0;

/// One drive.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Job {
    /// In the order of [`ROUTES`].
    index: usize,
    seed: u16,
    domain: u16,
    goal: &'static [&'static str],
}

impl Job {
    fn route(&self) -> &'static str {
        ROUTES[self.index]
    }
}

/// What `mapless-physics over-ros` prints of a drive.
#[derive(Clone, Debug, PartialEq, serde::Deserialize)]
struct Driven {
    outcome: String,
    reason: Option<String>,
    time_s: f64,
    took_s: f64,
    path_m: f64,
    max_abs_roll_rad: f64,
    max_abs_pitch_rad: f64,
    distance_to_goal_m: f64,
    odometry_off_m: f64,
    odometry_off_rad: f64,
    estimate_off_m: f64,
    estimate_off_rad: f64,
    feedback_off_m: f64,
    recoveries: u32,
    unanswered: u64,
}

impl Driven {
    fn has_reached(&self) -> bool {
        self.outcome == "reached"
    }
}

type Drives = BTreeMap<Job, Driven>;

/// Drives three routes with ten seeds each and writes the page; the short form prints it.
pub(crate) fn run(sh: &Shell, is_short: bool) -> anyhow::Result<()> {
    if is_short {
        println!("{}", report::page(&drive(sh, short())?)?);
        return Ok(());
    }
    sh.write_file(REPORT, report::page(&drive(sh, all())?)?)?;
    println!("{REPORT} written");
    Ok(())
}

/// The node must reach the goal of the short form, in truth.
pub(crate) fn test(sh: &Shell) -> anyhow::Result<Count> {
    for (job, driven) in drive(sh, short())? {
        let Driven { outcome, reason, distance_to_goal_m, .. } = &driven;
        ensure!(
            driven.has_reached() && *distance_to_goal_m < SHORT_WITHIN_M,
            "{} over ROS: {outcome} ({reason:?}), in truth {distance_to_goal_m:.2} m from the goal: expected reached, \
             within {SHORT_WITHIN_M} m",
            job.route()
        );
    }
    Ok(Count { passed: 1, ..Count::default() })
}

fn all() -> Vec<Job> {
    let jobs = (0..ROUTES.len()).flat_map(|index| (1..=SEEDS).map(move |seed| (index, seed)));
    jobs.zip(DOMAINS.cycle()).map(|((index, seed), domain)| Job { index, seed, domain, goal: &[] }).collect()
}

fn short() -> Vec<Job> {
    vec![Job { index: SHORT_ROUTE, seed: 1, domain: DOMAINS.start, goal: &SHORT_GOAL }]
}

fn drive(sh: &Shell, jobs: Vec<Job>) -> anyhow::Result<Drives> {
    let python = super::python(sh)?;
    // As the tests build them: without a second build of all they depend on.
    cmd!(sh, "cargo build --package mapless-physics --package mapless-node").run()?;
    let built = |name: &str| setup::target_dir(sh).join("debug").join(name).with_extension(EXE_EXTENSION);
    let programs = Programs {
        physics: built("mapless-physics"),
        node: built("mapless-node"),
        python,
        engine: sh.current_dir().join(super::ENGINE),
        routes: sh.current_dir().join(super::tasks::ROUTES),
    };
    run_all(
        jobs,
        |job| programs.drive(job),
        |job, Driven { outcome, path_m, distance_to_goal_m, took_s, .. }| {
            format!(
                "{} with seed {}: {outcome} after {path_m:.1} m, in truth {distance_to_goal_m:.2} m from the goal; \
                 took {took_s:.0} s",
                job.route(),
                job.seed
            )
        },
    )
}

/// What drives.
struct Programs {
    physics: PathBuf,
    node: PathBuf,
    python: PathBuf,
    engine: PathBuf,
    /// The folder of the routes.
    routes: PathBuf,
}

impl Programs {
    fn drive(&self, job: &Job) -> anyhow::Result<Driven> {
        let task: &Path = &self.routes.join(job.route()).with_extension("toml");
        let mut command = Command::new(&self.physics);
        command.args(["over-ros", "--seed", &job.seed.to_string(), "--domain", &job.domain.to_string()]);
        command.arg("--node").arg(&self.node);
        if !job.goal.is_empty() {
            command.arg("--goal").args(job.goal);
        }
        command.args([task, &self.python, &self.engine]);
        let output = command.output().with_context(|| self.physics.display().to_string())?;
        ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr).trim());
        serde_json::from_slice(&output.stdout).context("the result of mapless-physics")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_drive_is_listed_once_and_neighbours_have_different_domains() {
        let jobs = all();
        assert_eq!(jobs.len(), 30);
        assert!(jobs.windows(2).all(|pair| pair[0] < pair[1] && pair[0].domain != pair[1].domain));
        assert!(jobs.iter().all(|job| DOMAINS.contains(&job.domain)));
        assert_eq!(short()[0].route(), "ht");
    }
}
