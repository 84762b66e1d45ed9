//! The tasks of the comparison: the routes of the repository and generated ones.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use xshell::{Shell, cmd};

/// The folder of the routes.
pub(super) const ROUTES: &str = "terrains/scenarios";
/// Those of the short form.
const SHORT: [&str; 2] = ["gsb", "ht"];
/// Families of generated tasks with their number, and their seed.
const GENERATED: [(&str, u32); 5] = [("moderate", 5), ("hard", 6), ("rocks", 3), ("walls", 3), ("mixed", 3)];
const SEED: u32 = 35;

/// A scenario file by name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Task {
    /// In the order of the report: routes, then families.
    group: usize,
    pub(super) name: String,
    pub(super) file: PathBuf,
}

impl Task {
    fn new(group: usize, file: PathBuf) -> anyhow::Result<Self> {
        let name = file.file_stem().and_then(|stem| stem.to_str()).context("a file without a name")?;
        Ok(Self { group, name: name.to_owned(), file })
    }

    /// A task without a file.
    #[cfg(test)]
    pub(super) fn named(group: usize, name: &str) -> Self {
        Self { group, name: name.to_owned(), file: PathBuf::new() }
    }
}

/// The two routes of the short form.
pub(super) fn short(sh: &Shell) -> anyhow::Result<Vec<Task>> {
    let folder = sh.current_dir().join(ROUTES);
    SHORT.iter().map(|name| Task::new(0, folder.join(name).with_extension("toml"))).collect()
}

/// The ten routes, and twenty tasks that `program`, the command line, generates into `folder`.
pub(super) fn all(sh: &Shell, program: &Path, folder: &Path) -> anyhow::Result<Vec<Task>> {
    let mut tasks = in_folder(sh, 0, &sh.current_dir().join(ROUTES))?;
    let seed = SEED.to_string();
    for (index, (family, count)) in GENERATED.iter().enumerate() {
        let (folder, count) = (folder.join(family), count.to_string());
        cmd!(sh, "{program} generate --seed {seed} --family {family} --count {count} --out {folder}")
            .quiet()
            .ignore_stdout()
            .run()?;
        tasks.extend(in_folder(sh, index + 1, &folder)?);
    }
    Ok(tasks)
}

fn in_folder(sh: &Shell, group: usize, folder: &Path) -> anyhow::Result<Vec<Task>> {
    let files = sh.read_dir(folder)?;
    let files = files.into_iter().filter(|file| file.extension().is_some_and(|end| end == "toml"));
    files.map(|file| Task::new(group, file)).collect()
}
