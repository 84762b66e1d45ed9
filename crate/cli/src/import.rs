//! `mapless import`: worlds and tasks of other people's benchmarks.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Context as _;
use clap::Subcommand;
use mapless_campaign::verti_bench::{self, Scale};

use crate::setup;

#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    benchmark: Benchmark,
}

#[derive(Subcommand)]
enum Benchmark {
    /// Verti-Bench (RSS 2025): steep worlds with rocks and trees, of rigid ground.
    VertiBench {
        /// A checkout of its repository (RobotiXX/verti_bench), or a folder with tasks.json and worlds/.
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// Factor for all lengths, heights too. At 1/5 a rock is to the Husky what it was to the HMMWV.
        #[arg(long, default_value = "1/5")]
        scale: Scale,
        /// Write worlds/, tasks/ and the campaign verti-bench.toml to this folder, which is made when
        /// missing.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
}

/// Imports, prints what was written, and warns of odd tasks.
pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let Benchmark::VertiBench { folder, scale, out } = &args.benchmark;
    let imported = verti_bench::import(folder, *scale, out)?;
    let (worlds, tasks, campaign) = (imported.worlds, imported.tasks, imported.campaign.display());
    writeln!(
        std::io::stdout(),
        "worlds: {worlds}, tasks: {tasks}; `mapless trials {campaign}` drives them all"
    )
    .context("standard output")?;
    setup::show_warnings(&imported.warnings);
    Ok(())
}
