//! The recording of a drive, in a thread of its own: nothing that drives the robot waits for the disk.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

use mapless_recording::{Content, Head, RecordingError, Writer};

use crate::config::RecordingConfig;
use crate::hub::Hub;
use crate::recorder::Waiting;

/// A crash loses no more.
const FLUSH_EVERY: Duration = Duration::from_secs(1);
/// How long a wait for an entry may be.
const WAIT: Duration = Duration::from_millis(100);
const WHAT: &str = "recording";

/// Why a recording ended before its drive.
#[derive(Debug, thiserror::Error)]
enum Ended {
    #[error("{}: {error}", file.display())]
    File { file: PathBuf, error: std::io::Error },
    #[error("{}: {error}", file.display())]
    Recording { file: PathBuf, error: Box<RecordingError> },
    #[error("{}: ended at its limit of {max_size_mb} MB (recording.max_size_mb)", file.display())]
    Full { file: PathBuf, max_size_mb: u64 },
}

/// Records until the node ends. What goes wrong ends the recording, not the drive, and is told in diagnostics
/// from then on.
pub(crate) fn record(hub: &Hub, config: &RecordingConfig, head: &Head, waiting: Waiting) {
    let file = config.folder.join(format!("mapless-{}.mcap", head.began_ns / 1_000_000_000));
    if let Err(ended) = write(hub, config, head, &file, waiting) {
        while !hub.is_ending() {
            hub.complain(WHAT, &ended);
            std::thread::sleep(WAIT);
        }
    }
}

fn write(
    hub: &Hub,
    config: &RecordingConfig,
    head: &Head,
    file: &Path,
    waiting: Waiting,
) -> Result<(), Ended> {
    let fail = |error| Ended::File { file: file.to_owned(), error };
    let failed = |error| Ended::Recording { file: file.to_owned(), error: Box::new(error) };
    std::fs::create_dir_all(&config.folder).map_err(fail)?;
    let out = BufWriter::new(File::create(file).map_err(fail)?);
    let mut writer = Writer::new(out, head).map_err(failed)?;
    log::info!("recording to {}", file.display());
    let mut flushed = hub.now();
    loop {
        match waiting.entries.recv_timeout(WAIT) {
            Ok(entry) => {
                waiting.bytes.fetch_sub(entry.content.bytes(), Ordering::Relaxed);
                if let Content::Lost(lost) = &entry.content {
                    hub.complain(WHAT, &format!("the disk is too slow: {} entries were lost", lost.entries));
                }
                writer.write(&entry).map_err(failed)?;
            }
            Err(RecvTimeoutError::Timeout) if !hub.is_ending() => {}
            Err(_) => break,
        }
        if writer.bytes() > config.max_size_mb << 20 {
            writer.finish().map_err(failed)?;
            return Err(Ended::Full { file: file.to_owned(), max_size_mb: config.max_size_mb });
        }
        let now = hub.now();
        if now >= flushed + FLUSH_EVERY {
            flushed = now;
            writer.flush().map_err(failed)?;
        }
    }
    writer.finish().map_err(failed).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recorder::{MOST_WAITING, Recorder};
    use mapless_recording::{Entry, Reader, Role};
    use mapless_robot::drive_config::DriveConfig;
    use mapless_robot::messages::Bool;
    use std::time::Instant;

    fn head() -> Head {
        let topics = [(Role::Reset, "/a/mapless/reset".to_owned())].into();
        Head { began_ns: 5_000_000_000, config: DriveConfig::default(), topics }
    }

    fn entry(hub: &Hub) -> Entry {
        Entry { arrival: hub.arrival(), content: Content::Reset(Bool { data: true }) }
    }

    /// Records `many` entries to `folder` with this limit; what diagnostics say then.
    fn recorded(folder: &Path, max_size_mb: u64, many: usize) -> Vec<(&'static str, String)> {
        let hub = Hub::new(false);
        let config = RecordingConfig { folder: folder.to_owned(), max_size_mb };
        let (recorder, waiting) = Recorder::new();
        std::thread::scope(|scope| {
            scope.spawn(|| record(&hub, &config, &head(), waiting));
            for _ in 0..many {
                let began = Instant::now();
                recorder.record(entry(&hub));
                assert!(began.elapsed() < Duration::from_millis(100), "who drives does not wait");
                std::thread::sleep(Duration::from_micros(50));
            }
            std::thread::sleep(FLUSH_EVERY + 3 * WAIT);
            hub.end();
        });
        hub.complaints()
    }

    #[test]
    fn what_is_recorded_is_read() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(recorded(folder.path(), 1, 300), []);
        let file = File::open(folder.path().join("mapless-5.mcap")).unwrap();
        let mut reader = Reader::new(file, Default::default()).unwrap();
        let mut read = 0;
        while let Some(entry) = reader.next_entry().unwrap() {
            assert_eq!(entry.content, Content::Reset(Bool { data: true }));
            read += 1;
        }
        assert!(read == 300 && !reader.is_cut() && reader.head() == Some(&head()));
    }

    #[test]
    fn a_full_disk_and_a_limit_are_told_and_hold_nobody_up() {
        let folder = tempfile::tempdir().unwrap();
        let told = recorded(folder.path(), 0, 300);
        assert!(told[0].1.contains("limit of 0 MB"), "{told:?}");
        // A disk without room, as Linux plays it.
        let file = folder.path().join("mapless-5.mcap");
        std::fs::remove_file(&file).unwrap();
        std::os::unix::fs::symlink("/dev/full", &file).unwrap();
        let told = recorded(folder.path(), 1, 300);
        assert!(told[0].1.contains("No space left"), "{told:?}");
        let told = recorded(&file, 1, 300);
        assert!(told[0].0 == WHAT && told[0].1.contains("mapless-5.mcap"), "{told:?}");
    }

    #[test]
    fn a_slow_disk_loses_entries_and_says_how_many() {
        let hub = Hub::new(false);
        let (recorder, waiting) = Recorder::new();
        for _ in 0..MOST_WAITING + 10 {
            recorder.record(entry(&hub));
        }
        waiting.entries.try_iter().take(5).for_each(drop);
        recorder.record(entry(&hub));
        let contents: Vec<Content> = waiting.entries.try_iter().map(|entry| entry.content).collect();
        let lost = contents.iter().find_map(|content| match content {
            Content::Lost(lost) => Some(lost.entries),
            _ => None,
        });
        assert_eq!((lost, contents.len()), (Some(10), MOST_WAITING - 5 + 2));
    }
}
