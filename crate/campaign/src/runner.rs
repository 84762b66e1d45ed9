//! Runs the remaining trials of a campaign on several cores.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::thread;
use std::time::Duration;

use crate::error::CampaignError;
use crate::hash::Hash;
use crate::journal::{self, Entry, Header, Journal};
use crate::pace::Pace;
use crate::plan::{Plan, Shard, TrialSpec};
use crate::results;
use crate::trial::{self, Finished};

/// How to run a campaign.
#[derive(Clone, Debug)]
pub struct Options {
    /// The results' folder, made when missing.
    pub folder: PathBuf,
    /// Trials at a time.
    pub jobs: usize,
    /// Run only this part of the trials.
    pub shard: Option<Shard>,
}

/// Progress of a run, reported after every trial.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Trials to run in this process, those that had run before included.
    pub trials: usize,
    /// How many of them have run.
    pub done: usize,
    /// Time left, estimated from each planner's trials so far.
    pub left: Duration,
    /// The last trial's entry.
    pub last: &'a Entry,
}

/// The outcome of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Done {
    /// Trials of the whole campaign.
    pub trials: usize,
    /// Trials that have run, in this process or another. Once all have, the final files are there.
    pub done: usize,
    /// Trials that ended in an error.
    pub errors: usize,
}

/// Runs the trials of `plan` that no journal has yet, and writes the final files when that makes the campaign
/// complete.
///
/// `show` is told of every trial, `tell` of what people should know besides.
///
/// # Errors
/// [`CampaignError`] when the folder holds something else or cannot be written. What went wrong in a trial is
/// in its row.
pub fn run(
    plan: &Plan,
    options: &Options,
    show: impl Fn(Progress<'_>) + Sync,
    tell: impl Fn(&str),
) -> Result<Done, CampaignError> {
    let folder = &options.folder;
    std::fs::create_dir_all(folder).map_err(|error| CampaignError::write(folder, error))?;
    let header = Header { campaign: plan.hash.clone(), build: this_build()? };
    // Existing journals must match before anything is added to them.
    journal::read_all(folder, &header)?;
    let journal = Journal::open(folder, options.shard, &header, &tell)?;
    let before = journal::read_all(folder, &header)?;

    let mut mine: Vec<&TrialSpec> = (plan.trials.iter().enumerate())
        .filter(|(index, _)| options.shard.is_none_or(|shard| shard.holds(*index)))
        .map(|(_, spec)| spec)
        .collect();
    // Every planner runs soon, so that the time left is known early.
    mine.sort_by_key(|spec| (spec.seed, spec.route));
    let mut pace = Pace::default();
    for spec in &mine {
        match before.get(&spec.id) {
            Some(entry) => pace.know(&spec.planner, entry.timing.wall_s),
            None => pace.expect(&spec.planner),
        }
    }
    let left: Vec<&TrialSpec> = mine.iter().copied().filter(|spec| !before.contains_key(&spec.id)).collect();
    let queue = Queue {
        plan,
        options,
        left: Mutex::new(left.iter().copied()),
        desk: Mutex::new(Desk { journal, done: mine.len() - left.len(), pace }),
        trials: mine.len(),
    };
    let failed = thread::scope(|scope| {
        let workers: Vec<_> = (0..options.jobs.clamp(1, left.len().max(1)))
            .map(|_| scope.spawn(|| queue.work(&show)))
            .collect();
        let ends: Vec<_> = workers.into_iter().map(std::thread::ScopedJoinHandle::join).collect();
        ends.into_iter().find_map(|end| match end {
            Ok(result) => result.err(),
            Err(_) => Some(CampaignError::write(folder, "a worker panicked outside of a trial")),
        })
    });
    if let Some(error) = failed {
        return Err(error);
    }
    drop(queue);
    let entries = journal::read_all(folder, &header)?;
    if entries.len() == plan.trials.len() {
        tell(&format!(
            "every trial has run; looking for the shortest safe path of {} routes",
            plan.routes.len()
        ));
        results::write(plan, &entries, folder, options.jobs)?;
    }
    let errors = entries.values().filter(|entry| entry.result.error.is_some()).count();
    Ok(Done { trials: plan.trials.len(), done: entries.len(), errors })
}

/// Runs the trial `id` alone; returns its entry and its trajectory as CSV. No journal is read or written.
///
/// # Errors
/// A text when the plan has no such trial.
pub fn run_one(plan: &Plan, id: &str) -> Result<(Entry, String), String> {
    let Some(spec) = plan.trials.iter().find(|trial| trial.id == id) else {
        return Err(format!("\"{id}\": expected the id of a trial of campaign {}", plan.campaign.name));
    };
    let spec = TrialSpec { keeps_trajectory: true, ..spec.clone() };
    let Finished { entry, trajectory } = trial::run(&spec, &plan.routes[spec.route]);
    Ok((entry, trajectory.unwrap_or_default()))
}

/// State shared by the workers.
struct Queue<'a, I> {
    plan: &'a Plan,
    options: &'a Options,
    left: Mutex<I>,
    desk: Mutex<Desk<'a>>,
    trials: usize,
}

/// Results of the workers, behind one lock.
struct Desk<'a> {
    journal: Journal,
    /// Trials that have run, those before this process included.
    done: usize,
    pace: Pace<'a>,
}

impl<'a, I: Iterator<Item = &'a TrialSpec>> Queue<'a, I> {
    /// Takes trials until none are left, or nothing can be written any more.
    fn work(&self, show: &impl Fn(Progress<'_>)) -> Result<(), CampaignError> {
        while let Some(spec) = self.next() {
            let finished = trial::run(spec, &self.plan.routes[spec.route]);
            let handed_in = self.hand_in(spec, &finished, show);
            if handed_in.is_err() {
                while self.next().is_some() {}
            }
            handed_in?;
        }
        Ok(())
    }

    fn next(&self) -> Option<&'a TrialSpec> {
        self.left.lock().ok()?.next()
    }

    fn hand_in(
        &self,
        spec: &'a TrialSpec,
        finished: &Finished,
        show: &impl Fn(Progress<'_>),
    ) -> Result<(), CampaignError> {
        let (Finished { entry, trajectory }, Options { folder, jobs, .. }) = (finished, self.options);
        // Before the journal's line, which says that the whole trial is on disk.
        if let Some(trajectory) = trajectory {
            results::write_trajectory(folder, &entry.result.id, trajectory)?;
        }
        let Ok(mut desk) = self.desk.lock() else {
            return Err(CampaignError::write(folder, "another worker panicked"));
        };
        desk.journal.append(entry)?;
        desk.done += 1;
        desk.pace.finish(&spec.planner, entry.timing.wall_s);
        let (done, left) = (desk.done, desk.pace.left(*jobs));
        show(Progress { trials: self.trials, done, left, last: entry });
        Ok(())
    }
}

/// Identity of the running program's file.
fn this_build() -> Result<String, CampaignError> {
    let path = std::env::current_exe()
        .map_err(|error| CampaignError::read(Path::new("the running program"), error))?;
    let mut hash = Hash::default();
    hash.add(&std::fs::read(&path).map_err(|error| CampaignError::read(&path, error))?);
    Ok(hash.hex())
}
