//! `mapless profile`: the perceived elevation profile against the true skyline, at random poses on a
//! scenario's terrain.

use std::io::Write as _;

use anyhow::Context as _;
use comfy_table::{CellAlignment, Table, presets};
use mapless_trials::{LoadedScenario, ProfileAccuracy, profile_accuracy};
use mapless_world::Caster;

use crate::setup::Setup;

#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    setup: Setup,
    /// Random poses at which the robot is safe.
    #[arg(long, default_value_t = 200, value_name = "N")]
    poses: usize,
    /// Seed of the poses and of the sensor's noise.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Print one JSON object instead of a table.
    #[arg(long)]
    json: bool,
}

/// Measures and prints.
pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let (LoadedScenario { scenario, terrain }, planner) = args.setup.load()?;
    let file = || args.setup.file();
    let caster = Caster::new(terrain.field);
    let accuracy =
        profile_accuracy(&caster, &scenario.sensor, &scenario.robot, &planner, args.poses, args.seed)
            .with_context(file)?;
    anyhow::ensure!(
        accuracy.poses == args.poses,
        "{}: the robot can stand at {} random poses only, expected {}",
        file(),
        accuracy.poses,
        args.poses
    );
    let text = if args.json { serde_json::to_string(&accuracy)? } else { table(&accuracy) };
    writeln!(std::io::stdout(), "{text}").context("standard output")
}

fn table(accuracy: &ProfileAccuracy) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    let degrees = |angle_rad: f64| format!("{:.3}°", angle_rad.to_degrees());
    table.add_row(["poses", &accuracy.poses.to_string()]);
    table.add_row(["mean absolute error", &degrees(accuracy.mean_abs_error_rad)]);
    table.add_row(["bias", &degrees(accuracy.bias_rad)]);
    table.add_row(["worst pose", &degrees(accuracy.worst_pose_error_rad)]);
    table.add_row(["holes", &accuracy.holes.to_string()]);
    table.add_row(["without perception", &accuracy.no_perception.to_string()]);
    let mut confusion = Table::new();
    confusion.load_preset(presets::NOTHING);
    confusion.set_header(["columns in truth", "ground", "unknown", "wall (perceived)"]);
    for (truth, row) in ["ground", "unknown", "wall"].into_iter().zip(accuracy.confusion) {
        confusion.add_row([truth.to_owned()].into_iter().chain(row.map(|count| count.to_string())));
    }
    for (table, columns) in [(&mut table, 1..2), (&mut confusion, 1..4)] {
        for column in columns {
            if let Some(values) = table.column_mut(column) {
                values.set_cell_alignment(CellAlignment::Right);
            }
        }
    }
    format!("{}\n\n{}", table.trim_fmt(), confusion.trim_fmt())
}
