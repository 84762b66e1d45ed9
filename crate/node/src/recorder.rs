//! Where the threads leave entries for the recording.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};

use mapless_recording::{Content, Entry, LostMessage};

/// Entries that may wait for the disk: about two seconds of them, and bytes of their clouds. What comes
/// while that many wait is lost to the recording.
pub(crate) const MOST_WAITING: usize = 512;
const MOST_BYTES: usize = 64 << 20;

/// Where entries are left for the recording.
#[derive(Debug)]
pub(crate) struct Recorder {
    entries: SyncSender<Entry>,
    bytes: Arc<AtomicUsize>,
    lost: AtomicU32,
}

/// The other end.
pub(crate) struct Waiting {
    pub(crate) entries: Receiver<Entry>,
    /// Of the entries that wait.
    pub(crate) bytes: Arc<AtomicUsize>,
}

impl Recorder {
    /// Both ends.
    pub(crate) fn new() -> (Self, Waiting) {
        let (sender, receiver) = sync_channel(MOST_WAITING);
        let bytes = Arc::new(AtomicUsize::new(0));
        let waiting = Waiting { entries: receiver, bytes: Arc::clone(&bytes) };
        (Self { entries: sender, bytes, lost: AtomicU32::new(0) }, waiting)
    }

    /// Leaves an entry, without ever waiting.
    pub(crate) fn record(&self, entry: Entry) {
        let lost = self.lost.swap(0, Ordering::Relaxed);
        if lost > 0 {
            let content = Content::Lost(LostMessage { entries: lost });
            self.leave(Entry { arrival: entry.arrival, content }, lost);
        }
        self.leave(entry, 1);
    }

    /// `worth` entries are lost if it cannot be left.
    fn leave(&self, entry: Entry, worth: u32) {
        let bytes = entry.content.bytes();
        if self.bytes.fetch_add(bytes, Ordering::Relaxed) + bytes <= MOST_BYTES {
            match self.entries.try_send(entry) {
                // If the recording has ended, it said so.
                Ok(()) | Err(TrySendError::Disconnected(_)) => return,
                Err(TrySendError::Full(_)) => {}
            }
        }
        self.bytes.fetch_sub(bytes, Ordering::Relaxed);
        self.lost.fetch_add(worth, Ordering::Relaxed);
    }
}
