//! The campaigns under `terrains/campaigns/` and the report of them, `docs/RESULTS.md`.

use std::env::consts::EXE_EXTENSION;

use xshell::{Shell, cmd};

use crate::setup;

const QUICK: Form = Form { campaigns: &["quick", "quick-generated"], tasks: 10, folder: "generated/quick" };
const ALL: Form =
    Form { campaigns: &["paper", "generated", "faults", "ablation"], tasks: 40, folder: "generated/all" };
const DIFFICULTIES: [&str; 3] = ["easy", "moderate", "hard"];

/// What is run.
struct Form {
    campaigns: &'static [&'static str],
    /// Generated tasks of each difficulty, and where they are written, under `target/`.
    tasks: u32,
    folder: &'static str,
}

/// Runs the campaigns, or what is left of them after an interruption, and writes the report.
pub(crate) fn run(sh: &Shell, quick: bool) -> anyhow::Result<()> {
    cmd!(sh, "cargo build --release --package mapless-cli").run()?;
    let target = setup::target_dir(sh);
    let program = target.join("release/mapless").with_extension(EXE_EXTENSION);
    let form = if quick { QUICK } else { ALL };
    for difficulty in DIFFICULTIES {
        let (folder, count) = (target.join(form.folder).join(difficulty), form.tasks.to_string());
        cmd!(sh, "{program} generate --seed 1 --difficulty {difficulty} --count {count} --out {folder}")
            .run()?;
    }
    let mut folders = Vec::new();
    for campaign in form.campaigns {
        let folder = target.join("results").join(campaign);
        cmd!(sh, "{program} trials terrains/campaigns/{campaign}.toml --out {folder}").run()?;
        folders.push(folder);
    }
    cmd!(sh, "{program} report {folders...} --out docs").run()?;
    Ok(())
}
