//! `mapless terrain`: a point cloud as a terrain, a grid of heights beside the recipe that imports it.

mod height_grid;

use std::fs;
use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Context as _;
use height_grid::HeightGrid;
use mapless_heights::MIN_CELL_M;
use mapless_scans::{ScanChoice, is_capture, read_scan};
use mapless_terrain::{Holes, Terrain, load_recipe};

use crate::output::write_new;
use crate::{parsers, setup};

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Point cloud of a map, x east, y north, z up, in metres: .pcd, .ply, or text with a point a line.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Spacing of the heights, metres.
    #[arg(long, value_name = "M", default_value = "0.1", value_parser = cell_m)]
    cell: f64,
    /// What becomes of cells without a point: refuse them, fill them from around, or crop to the largest
    /// rectangle without one.
    #[arg(long, value_name = "WORD", default_value = "refuse", value_parser = parsers::holes())]
    holes: Holes,
    /// Write NAME.toml, the terrain, and NAME.asc, its heights, to this folder, which is made when missing.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

fn cell_m(text: &str) -> Result<f64, String> {
    let cell_m = text.parse().ok().filter(|cell_m| (MIN_CELL_M..=1000.0).contains(cell_m));
    cell_m.ok_or_else(|| format!("expected metres, from {MIN_CELL_M} to 1000"))
}

/// Reads the cloud, writes both files, and says where the terrain's origin is.
pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let file = args.file.display();
    anyhow::ensure!(!is_capture(&args.file), "{file}: expected a point cloud, not a capture");
    let scan = read_scan(&args.file, ScanChoice::default())?;
    let grid =
        HeightGrid::of(&scan.points_m, args.cell).map_err(|reason| anyhow::anyhow!("{file}: {reason}"))?;
    let name = args.file.file_stem().unwrap_or_default().to_string_lossy();
    let (heights_file, heights) = (format!("{name}.asc"), grid.ascii());
    let recipe_file = format!("{name}.toml");
    // A JSON string is one of TOML, too.
    let word = |text: &str| serde_json::to_string(text);
    let (x_m, y_m) = (grid.origin_m.x, grid.origin_m.y);
    let recipe = format!(
        "# The median height of the points of each cell. The south-west sample of the grid is at\n\
         # ({x_m:.3}, {y_m:.3}) m of the cloud.\n\
         name = {}\n\n[import]\nfile = {}\nholes = \"{}\"\n",
        word(&name)?,
        word(&heights_file)?,
        args.holes.name()
    );
    let terrain = load_recipe(&recipe_file, recipe.as_bytes(), &mut |file, import| {
        mapless_heights::read(file, heights.as_bytes(), import)
    });
    let Terrain { field, warnings, .. } = terrain.with_context(|| {
        format!("{file}: {} points in cells of {} m (--cell, --holes)", scan.points_m.len(), grid.cell_m)
    })?;
    fs::create_dir_all(&args.out).with_context(|| format!("--out: {}", args.out.display()))?;
    write_new(&args.out.join(&heights_file), &heights)?;
    write_new(&args.out.join(&recipe_file), &recipe)?;
    for warning in &scan.warnings {
        eprintln!("warning: {file}: {warning}");
    }
    setup::show_warnings(&warnings);
    let extent_m = field.extent_m();
    writeln!(
        std::io::stdout(),
        "{}: {:.1} × {:.1} m of {} points; the south-west sample of {heights_file} is at ({x_m:.3}, {y_m:.3}) m of \
         the cloud",
        args.out.join(&recipe_file).display(),
        extent_m.x,
        extent_m.y,
        scan.points_m.len()
    )
    .context("standard output")
}
