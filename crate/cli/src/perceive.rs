//! `mapless perceive`: one recorded scan through one step of the planner, and its command once it drives.
//!
//! A scan has no pose: the robot is level at the origin, faces along +x, has not driven yet, and its goal is
//! 50 m ahead. The sensor is as high above the ground as configured.

mod report;
mod rows;

use core::time::Duration;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use glam::{DVec2, DVec3, Vec3};
use mapless::skyline::surface::PredictedSurface;
use mapless::terrain::mount_misfit::MountMisfit;
use mapless::{Command, Goal, Planner, PlannerConfig, Pose, Status, Step};
use mapless_scans::{ScanChoice, SourceAddress, is_capture, read_scan};
use mapless_trials::planner_config_for;

use crate::picture::{OccupancyPicture, VarianceImage};
use crate::setup::PlannerChoice;
use report::PerceptionReport;
use rows::CommandRow;

const POSE: Pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0);
const GOAL_M: DVec2 = DVec2::new(50.0, 0.0);
/// Time between two scans.
const PERIOD: Duration = Duration::from_millis(100);
/// Within so many scans a robot from rest has taken up its speed.
const STARTING_SCANS: usize = 15;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scan: .pcd, .ply, KITTI's .bin, text with x y z a line or where a header names them (.csv, .txt, .xyz,
    /// .asc, .pts), all in the sensor frame in metres: x forward, y left, z up; or a capture of a Velodyne
    /// VLP-16, Puck Hi-Res or VLP-32C (.pcap, .pcapng). The robot stands level at the origin with its goal
    /// 50 m ahead.
    file: PathBuf,
    /// Which whole revolution of a capture, from 0.
    #[arg(long, value_name = "K", default_value_t = 0)]
    revolution: usize,
    /// Which sensor of a capture with several, by the address it sends from: 192.168.1.201 or
    /// 192.168.1.201:2368.
    #[arg(long, value_name = "ADDRESS")]
    source: Option<SourceAddress>,
    #[command(flatten)]
    planner: PlannerChoice,
    /// Parameters (TOML): the sections [sensor] with its mount, [robot] and [planner] of a scenario.
    #[arg(long, value_name = "FILE")]
    parameters: Option<PathBuf>,
    /// Write variance_image.svg and occupancy_surface.svg to this folder, which is made when missing.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object instead of tables.
    #[arg(long)]
    json: bool,
}

/// The command of a robot that has started from rest and goes on driving, with the same scan again and again:
/// limits of acceleration decide the first one, and a scan does not say how fast the robot already drives.
fn command_once_started(planner: &mut Planner, points_m: &[Vec3]) -> Command {
    let mut command = planner.last_step().command;
    for _ in 1..STARTING_SCANS {
        let step = planner.step(points_m, &POSE, PERIOD);
        if step.status != Status::Driving {
            break;
        }
        command = step.command;
    }
    command
}

/// Perceives the scan and shows what was seen and decided.
pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let scan = read_scan(&args.file, ScanChoice { revolution: args.revolution, source: args.source })?;
    let config = args.planner.apply(config(args)?);
    let mut warnings: Vec<String> = scan.warnings.iter().map(ToString::to_string).collect();
    let reach_m = config.perception.surface_radius_m;
    let out_of_reach = scan.out_of_reach(config.sensor.min_range_m, reach_m);
    warnings.extend(out_of_reach.into_iter().map(|warning| warning.to_string()));
    let misfit = MountMisfit::of(&scan.points_m, &config.sensor);
    warnings.extend(misfit.map(|misfit| misfit.to_string()));
    for warning in &warnings {
        writeln!(std::io::stderr(), "warning: {}: {warning}", args.file.display())?;
    }
    let mut planner = Planner::new(config)?;
    let variance_threshold = planner.config().perception.variance_threshold;
    planner.set_goal(Goal::at(GOAL_M));
    let step = planner.step(&scan.points_m, &POSE, PERIOD);
    let is_driving = step.status == Status::Driving;
    let mut report = PerceptionReport::new(subject(args), scan.points_m.len(), warnings, &step);
    if let Some(folder) = &args.out {
        let predicted = planner.predicted_surface()?.clone();
        draw(folder, &report, &planner.last_step(), &predicted, variance_threshold)?;
    }
    if is_driving {
        report.command = CommandRow::of(command_once_started(&mut planner, &scan.points_m));
    }
    let text = if args.json { serde_json::to_string(&report)? } else { report.tables() };
    writeln!(std::io::stdout(), "{text}").context("standard output")
}

/// The preset with the parameters of the file, if one is given.
fn config(args: &Args) -> anyhow::Result<PlannerConfig> {
    let preset = args.planner.planner;
    let Some(path) = &args.parameters else { return Ok(preset.planner_config()) };
    let sections = fs::read_to_string(path).with_context(|| path.display().to_string())?;
    Ok(planner_config_for(&path.display().to_string(), &sections, preset)?)
}

/// File, revolution and planner; the title of the tables and pictures.
fn subject(args: &Args) -> String {
    let file = args.file.file_name().unwrap_or_default().to_string_lossy();
    let revolution =
        if is_capture(&args.file) { format!(", revolution {}", args.revolution) } else { String::new() };
    format!("{file}{revolution}, planner {}", args.planner.planner.name())
}

fn draw(
    folder: &Path,
    report: &PerceptionReport,
    step: &Step<'_>,
    predicted: &PredictedSurface,
    variance_threshold: f64,
) -> anyhow::Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("--out: {}", folder.display()))?;
    let write = |name: &str, svg: String| {
        let path = folder.join(name);
        fs::write(&path, svg).with_context(|| format!("--out: {}", path.display()))
    };
    let (title, subtitle) = (report.subject(), report.headline());
    let image = VarianceImage { title, subtitle: &subtitle, step, predicted, variance_threshold };
    write("variance_image.svg", image.svg()?)?;
    let surfaces = OccupancyPicture { title, subtitle: &subtitle, observed: step.observed, predicted };
    write("occupancy_surface.svg", surfaces.svg()?)
}
