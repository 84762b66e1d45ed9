//! The journal: one line of JSON for each trial that has run, on disk before the same worker begins the next.
//!
//! Every process of a campaign appends to a journal of its own, under a lock, and reads those of all others.
//! A process that is killed while it writes leaves at most one line without an end, which the next process
//! removes.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use mapless_trials::{Metrics, Outcome, Ride, statistics};
use serde::de::Error as _;
use serde::{Deserialize as _, Deserializer};

use crate::error::{CampaignError, CampaignFault};
use crate::plan::Shard;

/// The result of a trial; the same whenever and wherever it runs.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialResult {
    /// The trial's identity.
    pub id: String,
    /// How it ended; `None` for an error.
    pub outcome: Option<Outcome>,
    /// Why the planner stopped, if it did.
    pub stop_reason: Option<String>,
    /// Why there is no outcome.
    pub error: Option<String>,
    /// The paper's metrics.
    pub metrics: Option<Metrics>,
    /// What others measure of the drive.
    pub ride: Option<Ride>,
    /// Simulated time, seconds.
    pub sim_time_s: Option<f64>,
    /// Planning periods.
    pub ticks: Option<u64>,
    /// Digest of the trajectory.
    pub digest: Option<String>,
}

/// Wall-clock times of a trial. They differ from run to run.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// The whole trial, seconds.
    #[serde(deserialize_with = "read_wall_s")]
    pub wall_s: f64,
    /// Median of the planner's steps, milliseconds.
    pub planner_p50_ms: f64,
    /// 99th percentile of the planner's steps, milliseconds.
    pub planner_p99_ms: f64,
    /// The longest of the planner's steps, milliseconds.
    pub planner_max_ms: f64,
}

impl Timing {
    /// Nearest-rank quantiles of the planner's steps; zeros where there were none.
    pub(crate) fn of(wall: Duration, steps: Vec<Duration>) -> Self {
        let [planner_p50_ms, planner_p99_ms, planner_max_ms] =
            statistics::percentiles_ms(steps, [50, 99, 100]);
        Self { wall_s: wall.as_secs_f64(), planner_p50_ms, planner_p99_ms, planner_max_ms }
    }
}

/// Bound on a trial's time, some thirty years, so that the time left can be computed.
const LONGEST_WALL_S: f64 = 1e9;

fn read_wall_s<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let wall_s = f64::deserialize(deserializer)?;
    if !(0.0..=LONGEST_WALL_S).contains(&wall_s) {
        return Err(D::Error::custom(format_args!(
            "wall_s = {wall_s}: expected seconds, from 0 to {LONGEST_WALL_S:e}"
        )));
    }
    Ok(wall_s)
}

/// One line of a journal.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The result of the trial.
    pub result: TrialResult,
    /// Its wall-clock times.
    pub timing: Timing,
}

/// The first line of a journal.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Header {
    /// The campaign's identity.
    pub(crate) campaign: String,
    /// Identity of the program: another build may drive differently.
    pub(crate) build: String,
}

/// Results by the trial's identity.
pub(crate) type Entries = BTreeMap<String, Entry>;

/// A journal open for appending, locked until it is dropped.
#[derive(Debug)]
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens the journal of this shard in `folder`. While another process has it, says so through `tell` and
    /// waits.
    pub(crate) fn open(
        folder: &Path,
        shard: Option<Shard>,
        header: &Header,
        tell: impl Fn(&str),
    ) -> Result<Self, CampaignError> {
        let path = folder.join(format!("journal{}.jsonl", shard.map_or_else(String::new, Shard::suffix)));
        let fail = |error: std::io::Error| CampaignError::write(&path, error);
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(fail)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                tell(&format!("waiting for another process that writes {}", path.display()));
                file.lock().map_err(fail)?;
            }
            Err(TryLockError::Error(error)) => return Err(fail(error)),
        }
        let mut text = Vec::new();
        file.read_to_end(&mut text).map_err(fail)?;
        let whole = text.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        file.set_len(whole as u64).map_err(fail)?;
        file.seek(SeekFrom::End(0)).map_err(fail)?;
        let mut journal = Self { path, file };
        if whole == 0 {
            journal.line(header)?;
        }
        Ok(journal)
    }

    /// Appends a trial and waits until it is on disk.
    pub(crate) fn append(&mut self, entry: &Entry) -> Result<(), CampaignError> {
        self.line(entry)
    }

    fn line(&mut self, value: &impl serde::Serialize) -> Result<(), CampaignError> {
        let mut line =
            serde_json::to_string(value).map_err(|error| CampaignError::write(&self.path, error))?;
        line.push('\n');
        let written = self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data());
        written.map_err(|error| CampaignError::write(&self.path, error))
    }
}

/// All entries of the campaign and build of `header` in the journals of `folder`.
pub(crate) fn read_all(folder: &Path, header: &Header) -> Result<Entries, CampaignError> {
    let mut entries = Entries::new();
    let files = fs::read_dir(folder).map_err(|error| CampaignError::read(folder, error))?;
    let mut paths = Vec::new();
    for file in files {
        paths.push(file.map_err(|error| CampaignError::read(folder, error))?.path());
    }
    paths.sort();
    let is_journal = |path: &&PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("journal") && name.ends_with(".jsonl")
    };
    for path in paths.iter().filter(is_journal) {
        read(path, header, &mut entries)?;
    }
    Ok(entries)
}

fn read(path: &Path, header: &Header, entries: &mut Entries) -> Result<(), CampaignError> {
    let bytes = fs::read(path).map_err(|error| CampaignError::read(path, error))?;
    let text = String::from_utf8_lossy(&bytes);
    // A line without an end is still being written.
    let mut lines = text.split_inclusive('\n').filter(|line| line.ends_with('\n')).enumerate();
    let bad = |line: usize, error: serde_json::Error| {
        CampaignError::content(
            path,
            format_args!("line {}: {error}: expected a line as `mapless trials` writes it", line + 1),
        )
    };
    let Some((number, first)) = lines.next() else { return Ok(()) };
    let found: Header = serde_json::from_str(first).map_err(|error| bad(number, error))?;
    let other = |what, found: &str, expected: &str| {
        let fault = CampaignFault::Other { what, found: found.to_owned(), expected: expected.to_owned() };
        CampaignError::new(path, fault)
    };
    if found.campaign != header.campaign {
        return Err(other("campaign", &found.campaign, &header.campaign));
    }
    if found.build != header.build {
        return Err(other("build of mapless", &found.build, &header.build));
    }
    for (number, line) in lines {
        let entry: Entry = serde_json::from_str(line).map_err(|error| bad(number, error))?;
        match entries.get(&entry.result.id) {
            Some(before) if before.result != entry.result => {
                let shown = |result: &TrialResult| {
                    let outcome = result.outcome.map_or("error", Outcome::name);
                    format!("{outcome} {}", result.digest.as_deref().unwrap_or_default())
                };
                let (first, second) = (shown(&before.result), shown(&entry.result));
                let fault = CampaignFault::Disagreement { id: entry.result.id, first, second };
                return Err(CampaignError::new(path, fault));
            }
            Some(_) => {}
            None => {
                entries.insert(entry.result.id.clone(), entry);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header() -> Header {
        Header { campaign: "c".to_owned(), build: "b".to_owned() }
    }

    fn entry(id: &str) -> Entry {
        let result = TrialResult {
            id: id.to_owned(),
            outcome: Some(Outcome::Reached),
            sim_time_s: Some(0.1 + 0.2),
            metrics: Some(Metrics { distance_m: 1.0 / 3.0, ..Metrics::default() }),
            ..TrialResult::default()
        };
        Entry { result, timing: Timing::of(Duration::from_secs(2), vec![Duration::from_millis(7); 3]) }
    }

    fn open(folder: &Path, shard: Option<Shard>) -> Journal {
        Journal::open(folder, shard, &header(), |_| {}).unwrap()
    }

    #[test]
    fn what_is_written_is_read_to_the_bit() {
        let folder = tempfile::tempdir().unwrap();
        let (one, two) = (entry("one"), entry("two"));
        open(folder.path(), None).append(&one).unwrap();
        open(folder.path(), Some("2/3".parse().unwrap())).append(&two).unwrap();
        open(folder.path(), None).append(&one).unwrap();
        let entries = read_all(folder.path(), &header()).unwrap();
        assert_eq!(entries.into_values().collect::<Vec<_>>(), [one, two]);
    }

    #[test]
    fn a_time_that_no_trial_takes_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        for wall_s in [-1.0, 1e300] {
            let timing = Timing { wall_s, ..entry("one").timing };
            let mut journal = open(folder.path(), None);
            journal.append(&Entry { timing, ..entry("one") }).unwrap();
            let error = read_all(folder.path(), &header()).unwrap_err().to_string();
            for part in ["journal.jsonl", "line 2", "wall_s = ", "expected seconds"] {
                assert!(error.contains(part), "{part} is not in: {error}");
            }
            fs::remove_file(journal.path).unwrap();
        }
    }

    #[test]
    fn a_torn_line_is_dropped_wherever_it_tore() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal.jsonl");
        let mut journal = open(folder.path(), None);
        journal.append(&entry("one")).unwrap();
        journal.append(&entry("two")).unwrap();
        drop(journal);
        let whole = fs::read(&path).unwrap();
        let ends: Vec<usize> = (0..whole.len()).filter(|&at| whole[at] == b'\n').map(|at| at + 1).collect();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            let left = ends[1..].iter().filter(|&&end| end <= length).count();
            assert_eq!(read_all(folder.path(), &header()).unwrap().len(), left, "cut to {length}");
            open(folder.path(), None).append(&entry("three")).unwrap();
            let entries = read_all(folder.path(), &header()).unwrap();
            assert_eq!(entries.len(), left + 1, "cut to {length}");
        }
    }

    #[test]
    fn another_campaign_another_build_and_nonsense_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        open(folder.path(), None).append(&entry("one")).unwrap();
        let refused = |header: &Header| read_all(folder.path(), header).unwrap_err().to_string();
        let error = refused(&Header { campaign: "d".to_owned(), ..header() });
        assert!(
            error.contains("journal.jsonl: holds trials of another campaign (c): expected d; choose"),
            "{error}"
        );
        let error = refused(&Header { build: "d".to_owned(), ..header() });
        assert!(error.contains("another build of mapless (b): expected d"), "{error}");

        let mut other = entry("one");
        other.result.digest = Some("0f".to_owned());
        open(folder.path(), Some("1/2".parse().unwrap())).append(&other).unwrap();
        let error = refused(&header());
        assert!(error.contains("trial one has run twice") && error.contains("reached 0f"), "{error}");

        fs::write(folder.path().join("journal-1-of-2.jsonl"), "{\"campaign\":\"c\",\"build\":\"b\"}\n{}\n")
            .unwrap();
        let error = refused(&header());
        assert!(error.contains("journal-1-of-2.jsonl: line 2: missing field"), "{error}");
    }

    #[test]
    fn a_second_writer_waits_for_the_first() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = open(folder.path(), None);
        let (told, tell) = std::sync::mpsc::channel();
        std::thread::scope(|scope| {
            let second = scope.spawn(|| {
                let told = |word: &str| told.send(word.to_owned()).unwrap();
                Journal::open(folder.path(), None, &header(), told).unwrap().append(&entry("two")).unwrap();
            });
            let word = tell.recv().unwrap();
            assert!(word.contains("waiting for another process"), "{word}");
            first.append(&entry("one")).unwrap();
            assert!(!second.is_finished());
            drop(first);
        });
        assert_eq!(read_all(folder.path(), &header()).unwrap().len(), 2);
    }
}
