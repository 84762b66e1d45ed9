//! `mapless generate`: tasks on generated terrains as scenario files, and measures of their difficulty.
//!
//! The folder gets `hard-1-0007.toml`, a scenario, and `terrain/hard-1-0007.toml`, its recipe. A second run
//! writes nothing new; a folder with other files in it, or a file with other contents, is refused.

mod summary;

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use indicatif::ProgressIterator as _;
use mapless_baselines::{Task, TaskName};
use mapless_terrain::generate::Family;
use summary::Summary;

use crate::output::write_new;
use crate::parsers;

/// The folder of the recipes, within that of the scenarios.
const TERRAIN: &str = "terrain";

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Seed of the tasks. Task K of a seed is the same whatever the count.
    #[arg(long)]
    seed: u64,
    /// What the terrains are like: bare ground from easy to hard, or obstacles.
    #[arg(long, alias = "difficulty", value_parser = parsers::family())]
    family: Family,
    /// Number of tasks.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=i64::from(TaskName::MOST)))]
    count: u32,
    /// Write the scenarios to this folder, which is made when missing, and their recipes to terrain/ in it.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Generates, writes and prints the table.
pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let terrains = args.out.join(TERRAIN);
    fs::create_dir_all(&terrains).with_context(|| format!("--out: {}", terrains.display()))?;
    refuse_other_files(&args.out)?;
    refuse_other_files(&terrains)?;
    let mut summary = Summary::default();
    // Indicatif draws only on a terminal.
    for index in (1..=args.count).progress_count(args.count.into()) {
        let task = Task::generate(TaskName { family: args.family, seed: args.seed, index })?;
        let file = format!("{}.toml", task.name);
        write_new(&terrains.join(&file), &task.recipe)?;
        write_new(&args.out.join(&file), &task.scenario(&format!("{TERRAIN}/{file}")))?;
        summary.add(&task);
    }
    writeln!(std::io::stdout(), "{}", summary.table()).context("standard output")
}

/// Fails if a folder holds files that are no tasks, so that none are mixed with other files.
fn refuse_other_files(folder: &Path) -> anyhow::Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("--out: {}", folder.display()))? {
        let name = entry.with_context(|| format!("--out: {}", folder.display()))?.file_name();
        let name = name.to_string_lossy();
        anyhow::ensure!(
            name == TERRAIN || is_task_file(&name),
            "--out: {}: expected an empty or new folder, or one with generated tasks alone",
            folder.join(&*name).display()
        );
    }
    Ok(())
}

/// Whether a name is like `hard-1-0007.toml`.
fn is_task_file(name: &str) -> bool {
    name.strip_suffix(".toml").is_some_and(|stem| stem.parse::<TaskName>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless_baselines::{KnownWorld, OracleConfig, PlanPose, shortest_path};
    use mapless_terrain::generate::Difficulty;
    use mapless_trials::LoadedScenario;

    fn args(out: &Path, count: u32) -> Args {
        Args { seed: 5, family: Family::Ground(Difficulty::Moderate), count, out: out.to_owned() }
    }

    /// Every file below a folder with its contents, in order of name.
    fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
        let mut found = Vec::new();
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                found.extend(contents(&path));
            } else {
                found.push((path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap()));
            }
        }
        found.sort();
        found
    }

    #[test]
    fn scenarios_load_have_a_path_and_do_not_depend_on_the_count() {
        let (one, three) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        run(&args(one.path(), 1)).unwrap();
        run(&args(three.path(), 3)).unwrap();
        for (index, scenario_file) in
            ["moderate-5-0001.toml", "moderate-5-0002.toml", "moderate-5-0003.toml"].into_iter().enumerate()
        {
            let LoadedScenario { scenario, terrain } =
                LoadedScenario::read(&three.path().join(scenario_file)).unwrap();
            assert_eq!(scenario.seed, index as u64 + 1);
            let start =
                PlanPose { position_m: scenario.start.position_m, yaw_rad: scenario.start.heading_rad };
            let config = OracleConfig::default();
            let path =
                shortest_path(&KnownWorld::new(&terrain.field, &scenario), start, scenario.goal_m, &config)
                    .unwrap();
            assert!(path.length_m >= start.position_m.distance(scenario.goal_m) - 1e-9);
        }
        let same = ["moderate-5-0001.toml", "terrain/moderate-5-0001.toml"];
        for file in same {
            assert_eq!(fs::read(one.path().join(file)).unwrap(), fs::read(three.path().join(file)).unwrap());
        }
        // A second time, and then from one to three.
        let before = contents(three.path());
        run(&args(three.path(), 2)).unwrap();
        run(&args(one.path(), 3)).unwrap();
        assert_eq!(contents(three.path()), before);
        assert_eq!(contents(one.path()), before);
    }

    #[test]
    fn other_files_are_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("notes.txt"), "mine").unwrap();
        let error = run(&args(folder.path(), 1)).unwrap_err().to_string();
        assert!(error.contains("notes.txt: expected an empty or new folder"), "{error}");
        assert_eq!(contents(folder.path()).len(), 1);

        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("moderate-5-0001.toml");
        fs::write(&file, "mine").unwrap();
        let error = run(&args(folder.path(), 1)).unwrap_err().to_string();
        assert!(error.contains("moderate-5-0001.toml: expected no file, or the generated one"), "{error}");
        assert_eq!(fs::read(&file).unwrap(), b"mine");
    }

    #[test]
    fn files_of_tasks_are_known() {
        let known = ["easy-1-0001.toml", "easy-1-0001", "easy-1-1.toml"].map(is_task_file);
        assert_eq!(known, [true, false, false]);
    }
}
