//! The campaigns under `terrains/campaigns/` and the report of them, `docs/RESULTS.md`.

use std::env::consts::EXE_EXTENSION;

use anyhow::ensure;
use xshell::{Shell, cmd};

use crate::setup;

const FOLDER: &str = "terrains/campaigns";
/// The short form.
pub(crate) const QUICK: [&str; 2] = ["quick", "quick-generated"];
/// The full form. `docs/RESULTS.md` shows every page in `docs/results`, those of other commands too.
pub(crate) const ALL: [&str; 7] =
    ["paper", "generated", "thousand", "faults", "ablation", "reality", "reality-effects"];
/// Generated tasks: their folder under `target/`, as campaign files name it, their seed, and their number for
/// each family.
const TASKS: [(&str, u32, u32); 3] =
    [("generated/quick", 1, 10), ("generated/thousand", 500, 334), ("generated/reality", 700, 20)];
/// The families, which are the folders in those.
const FAMILIES: [&str; 9] =
    ["easy", "moderate", "hard", "rocks", "posts", "walls", "ditches", "mixed", "movers"];

/// Runs the named campaigns, or all of the full form if none is named, or the rest of them after an
/// interruption; then writes the report.
pub(crate) fn run(sh: &Shell, names: &[String]) -> anyhow::Result<()> {
    let names: Vec<&str> =
        if names.is_empty() { ALL.to_vec() } else { names.iter().map(String::as_str).collect() };
    let known = known(sh)?;
    for name in &names {
        ensure!(
            known.iter().any(|known| known == name),
            "{name:?}: expected names of campaigns in {FOLDER}: {}",
            known.join(", ")
        );
    }
    let files: Vec<String> = names.iter().map(|name| format!("{FOLDER}/{name}.toml")).collect();
    let texts = files.iter().map(|file| sh.read_file(file)).collect::<Result<Vec<String>, _>>()?;

    cmd!(sh, "cargo build --release --package mapless-cli").run()?;
    let target = setup::target_dir(sh);
    let program = target.join("release/mapless").with_extension(EXE_EXTENSION);
    for (folder, seed, count) in TASKS {
        for family in FAMILIES {
            let folder = format!("{folder}/{family}");
            if !texts.iter().any(|text| text.contains(&format!("{folder}/"))) {
                continue;
            }
            // Campaign files name this folder, wherever cargo builds.
            let folder = sh.current_dir().join("target").join(folder);
            let (seed, count) = (seed.to_string(), count.to_string());
            cmd!(sh, "{program} generate --seed {seed} --family {family} --count {count} --out {folder}")
                .run()?;
        }
    }
    let mut folders = Vec::new();
    for (name, file) in names.iter().zip(&files) {
        let folder = target.join("results").join(name);
        cmd!(sh, "{program} trials {file} --out {folder}").run()?;
        folders.push(folder);
    }
    cmd!(sh, "{program} report {folders...} --out docs").run()?;
    Ok(())
}

/// The campaigns there are, by name.
fn known(sh: &Shell) -> anyhow::Result<Vec<String>> {
    let files = sh.read_dir(FOLDER)?;
    let names = files.iter().filter_map(|file| file.file_stem()?.to_str());
    Ok(names.map(str::to_owned).collect())
}
