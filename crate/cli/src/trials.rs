//! `mapless trials`: a campaign.

use std::io::{IsTerminal as _, Write as _};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use anyhow::Context as _;
use indicatif::{ProgressBar, ProgressStyle};
use mapless_campaign::{Done, Options, Plan, Progress, Shard};
use mapless_trials::Outcome;

use crate::setup;

/// Without a terminal, a line of progress is written this often.
const LINE_EVERY: Duration = Duration::from_secs(30);

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Campaign file (TOML): planners, routes, seeds, parameters.
    campaign: PathBuf,
    /// Trials at a time; as many as there are processors when absent.
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Run only the I-th of N equal parts; the last one to finish in the same folder writes the final files.
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Folder of the results, results/NAME when absent. Trials of this campaign that are in it are not run
    /// again.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Run the trial with this id alone, and print its result as JSON; with --out, also write DIR/ID.csv, its
    /// trajectory.
    #[arg(long, value_name = "ID", conflicts_with_all = ["jobs", "shard"])]
    only: Option<String>,
}

/// Runs the campaign, or the rest of it.
pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let plan = Plan::read(&args.campaign)?;
    plan.routes.iter().for_each(|route| setup::show_warnings(&route.loaded.terrain.warnings));
    if let Some(id) = &args.only {
        return replay(&plan, id, args.out.as_deref());
    }
    let folder = args.out.clone().unwrap_or_else(|| Path::new("results").join(&plan.campaign.name));
    let cores = || std::thread::available_parallelism().map_or(1, NonZero::get);
    let jobs = args.jobs.map_or_else(cores, NonZero::get);
    let options = Options { folder, jobs, shard: args.shard };
    let shown = Shown::new();
    let tell = |word: &str| shown.bar.suspend(|| eprintln!("{word}"));
    let done = mapless_campaign::run(&plan, &options, |progress| shown.show(&progress), tell)?;
    shown.bar.finish_and_clear();
    writeln!(std::io::stdout(), "{}", summary(&plan, &options.folder, done)).context("standard output")
}

fn summary(plan: &Plan, folder: &Path, Done { trials, done, errors }: Done) -> String {
    let (name, folder) = (&plan.campaign.name, folder.display());
    let errors = if errors == 0 { String::new() } else { format!(", {errors} of them with an error") };
    if done == trials {
        format!(
            "campaign {name} ({}): {trials} trials{errors} in {folder}/trials.csv and trials.parquet",
            plan.hash
        )
    } else {
        format!("campaign {name} ({}): {done} of {trials} trials{errors} so far in {folder}", plan.hash)
    }
}

fn replay(plan: &Plan, id: &str, out: Option<&Path>) -> anyhow::Result<()> {
    let (entry, trajectory) =
        mapless_campaign::run_one(plan, id).map_err(|reason| anyhow::anyhow!("--only: {reason}"))?;
    if let Some(folder) = out {
        std::fs::create_dir_all(folder).with_context(|| format!("--out: {}", folder.display()))?;
        let path = folder.join(format!("{id}.csv"));
        std::fs::write(&path, trajectory).with_context(|| format!("--out: {}", path.display()))?;
    }
    writeln!(std::io::stdout(), "{}", serde_json::to_string(&entry.result)?).context("standard output")
}

/// Progress of the campaign, on standard error: a bar on a terminal, a line now and then elsewhere.
struct Shown {
    bar: ProgressBar,
    last_line: Option<Mutex<Instant>>,
}

impl Shown {
    fn new() -> Self {
        let bar = ProgressBar::no_length();
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}") {
            bar.set_style(style);
        }
        let last_line = (!std::io::stderr().is_terminal()).then(|| Mutex::new(Instant::now()));
        Self { bar, last_line }
    }

    fn show(&self, progress: &Progress<'_>) {
        let Progress { trials, done, left, last } = *progress;
        let outcome = last.result.outcome.map_or("error", Outcome::name);
        let message = format!("trials, {} left, the last one: {outcome}", duration(left));
        let Some(last_line) = &self.last_line else {
            self.bar.set_length(trials as u64);
            self.bar.set_position(done as u64);
            self.bar.set_message(message);
            return;
        };
        if let Ok(mut last_line) = last_line.lock()
            && last_line.elapsed() >= LINE_EVERY
        {
            *last_line = Instant::now();
            eprintln!("{done}/{trials} {message}");
        }
    }
}

/// A duration in words: `40 s`, `5 min`, `3 h 20 min`.
fn duration(duration: Duration) -> String {
    let seconds = duration.as_secs();
    match (seconds / 3600, seconds / 60 % 60) {
        (0, 0) => format!("{seconds} s"),
        (0, minutes) => format!("{minutes} min"),
        (hours, minutes) => format!("{hours} h {minutes} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_as_people_say_them() {
        for (seconds, text) in [(59, "59 s"), (60, "1 min"), (3599, "59 min"), (12_000, "3 h 20 min")] {
            assert_eq!(duration(Duration::from_secs(seconds)), text);
        }
    }
}
