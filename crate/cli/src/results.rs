//! `mapless report`: tables and figures of finished campaigns.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Context as _;

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folders of finished campaigns, as `mapless trials --out` has them.
    #[arg(required = true, value_name = "DIR")]
    campaigns: Vec<PathBuf>,
    /// Write RESULTS.md here and the campaigns' pages, figures and rows to its folder results/; pages of
    /// other campaigns stay.
    #[arg(long, value_name = "DIR", default_value = "docs")]
    out: PathBuf,
}

/// Writes the report and prints the names of its files.
pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    for path in mapless_campaign::report::write(&args.campaigns, &args.out)? {
        writeln!(std::io::stdout(), "{}", path.display()).context("standard output")?;
    }
    Ok(())
}
