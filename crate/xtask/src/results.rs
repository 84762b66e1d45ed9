//! The campaigns under `terrains/campaigns/` and the report of them, `docs/RESULTS.md`.

use std::env::consts::EXE_EXTENSION;

use xshell::{Shell, cmd};

use crate::setup;

const QUICK: &[&str] = &["quick"];
const ALL: &[&str] = &["paper", "generated", "faults", "ablation"];
/// Generated tasks: how many of each difficulty.
const TASKS: [(&str, u32); 3] = [("easy", 50), ("moderate", 50), ("hard", 50)];

/// Runs the campaigns, or what is left of them after an interruption, and writes the report.
pub(crate) fn run(sh: &Shell, quick: bool) -> anyhow::Result<()> {
    cmd!(sh, "cargo build --release --package mapless-cli").run()?;
    let target = setup::target_dir(sh);
    let program = target.join("release/mapless").with_extension(EXE_EXTENSION);
    if !quick {
        for (difficulty, count) in TASKS {
            let (folder, count) = (target.join("generated").join(difficulty), count.to_string());
            cmd!(sh, "{program} generate --seed 1 --difficulty {difficulty} --count {count} --out {folder}")
                .run()?;
        }
    }
    let mut folders = Vec::new();
    for campaign in if quick { QUICK } else { ALL } {
        let folder = target.join("results").join(campaign);
        cmd!(sh, "{program} trials terrains/campaigns/{campaign}.toml --out {folder}").run()?;
        folders.push(folder);
    }
    cmd!(sh, "{program} report {folders...} --out docs").run()?;
    Ok(())
}
