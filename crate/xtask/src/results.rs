//! The campaigns under `terrains/campaigns/` and the report of them, `docs/RESULTS.md`.

use std::env::consts::EXE_EXTENSION;

use xshell::{Shell, cmd};

use crate::setup;

const QUICK: &[&str] = &["quick"];
const ALL: &[&str] = &["paper", "ablation"];

/// Runs the campaigns, or what is left of them after an interruption, and writes the report.
pub(crate) fn run(sh: &Shell, quick: bool) -> anyhow::Result<()> {
    cmd!(sh, "cargo build --release --package mapless-cli").run()?;
    let target = setup::target_dir(sh);
    let program = target.join("release/mapless").with_extension(EXE_EXTENSION);
    let mut folders = Vec::new();
    for campaign in if quick { QUICK } else { ALL } {
        let folder = target.join("results").join(campaign);
        cmd!(sh, "{program} trials terrains/campaigns/{campaign}.toml --out {folder}").run()?;
        folders.push(folder);
    }
    cmd!(sh, "{program} report {folders...} --out docs").run()?;
    Ok(())
}
