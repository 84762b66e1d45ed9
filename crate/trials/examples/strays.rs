//! What stray returns and returns on the robot itself cost on the ten routes, as a table in Markdown:
//!
//! `cargo run --release -p mapless-trials --example strays > docs/results/strays.md`
#![allow(clippy::print_stdout, reason = "the table")]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use mapless::skyline::scan_filter::ReturnKind;
use mapless_trials::{LoadedScenario, Outcome, Preset, Trial};

/// Share of beams that end early, and returns on the robot in each scan.
const SETTINGS: [(f64, usize); 7] =
    [(0.0, 0), (0.002, 0), (0.005, 0), (0.02, 0), (0.0, 1), (0.0, 10), (0.0, 50)];
const SEED: u64 = 1;

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// What came of one trial.
struct Driven {
    setting: usize,
    reached: bool,
    distance_m: f64,
    time_s: f64,
    tilt_rad: f64,
    /// Points of all its scans, and how many were taken for stray and for the robot's own.
    points: usize,
    stray: usize,
    body: usize,
}

fn main() -> Result<(), Failure> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../terrains/scenarios");
    let mut routes: Vec<PathBuf> =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_, Failure>>()?;
    routes.sort();
    let driven = drive_all(&routes)?;
    let of = |setting: usize| driven.iter().filter(move |one| one.setting == setting);
    let sum = |setting: usize, value: fn(&Driven) -> f64| of(setting).map(value).sum::<f64>();
    println!("# Stray returns and returns on the robot\n");
    println!(
        "The preset `default` on the ten routes, seed {SEED}, by `cargo run --release -p mapless-trials --example strays`. A share of the\n\
         beams ends early, anywhere before what they would hit; or a number of returns lies on the robot in every scan. Speed and path are\n\
         sums over the routes, relative to clean scans; tilt is the largest of roll and pitch anywhere.\n"
    );
    println!(
        "| beams that end early | returns on the robot | reached | speed | path | largest tilt | taken for stray | taken for the robot |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let speed = |setting: usize| sum(setting, |one| one.distance_m) / sum(setting, |one| one.time_s);
    for (setting, (share, on_body)) in SETTINGS.into_iter().enumerate() {
        let reached = of(setting).filter(|one| one.reached).count();
        let tilt_rad = of(setting).map(|one| one.tilt_rad).fold(0.0, f64::max);
        let points = sum(setting, |one| one.points as f64);
        println!(
            "| {} % | {on_body} | {reached} of {} | {:.3} | {:.3} | {:.1}° | {:.4} % | {:.4} % |",
            100.0 * share,
            routes.len(),
            speed(setting) / speed(0),
            sum(setting, |one| one.distance_m) / sum(0, |one| one.distance_m),
            tilt_rad.to_degrees(),
            100.0 * sum(setting, |one| one.stray as f64) / points,
            100.0 * sum(setting, |one| one.body as f64) / points,
        );
    }
    Ok(())
}

/// Every setting on every route, on all processors.
fn drive_all(routes: &[PathBuf]) -> Result<Vec<Driven>, Failure> {
    let (next, driven) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || -> Result<(), Failure> {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(route) = routes.get(index / SETTINGS.len()) else { return Ok(()) };
            let one = drive(route, index % SETTINGS.len())?;
            driven.lock().map_err(|error| error.to_string())?.push(one);
        }
    };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let threads: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        threads.into_iter().try_for_each(|thread| thread.join().map_err(|_| "a trial panicked")?)
    })?;
    Ok(driven.into_inner()?)
}

fn drive(route: &Path, setting: usize) -> Result<Driven, Failure> {
    let mut loaded = LoadedScenario::read(route)?;
    let sensing = &mut loaded.scenario.reality.sensing;
    (sensing.stray_probability, sensing.self_returns) = SETTINGS[setting];
    let mut trial = Trial::new(loaded.terrain.field, &loaded.scenario, Preset::Default, SEED)?;
    let (mut points, mut stray, mut body) = (0, 0, 0);
    let outcome = loop {
        let outcome = trial.tick();
        let kinds = trial.step().return_kinds;
        let count = |kind: ReturnKind| kinds.iter().filter(|one| **one == kind).count();
        points += kinds.len();
        stray += count(ReturnKind::Stray);
        body += count(ReturnKind::Body);
        if let Some(outcome) = outcome {
            break outcome;
        }
    };
    let metrics = trial.metrics();
    Ok(Driven {
        setting,
        reached: outcome == Outcome::Reached,
        distance_m: metrics.distance_m,
        time_s: trial.time_s(),
        tilt_rad: metrics.max_abs_roll_rad.max(metrics.max_abs_pitch_rad),
        points,
        stray,
        body,
    })
}
