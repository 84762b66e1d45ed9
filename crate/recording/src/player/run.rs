//! A replay that can begin at any checkpoint.

use core::time::Duration;
use std::io::BufReader;
use std::rc::Rc;

use super::index::Index;
use super::source::{Section, Source};
use crate::entry::Entry;
use crate::error::RecordingError;
use crate::reader::{Known, Reader};
use crate::replay::{News, Options, Replay};

/// Read at once, bytes: each read of the page's files takes a while.
const BUFFER: usize = 256 << 10;

/// A replay at the begin of a section.
#[derive(Clone, Debug)]
pub(super) struct Checkpoint {
    pub(super) section: usize,
    /// When the last entry before it took effect.
    pub(super) at: Duration,
    pub(super) known: Known,
    pub(super) replay: Option<Replay>,
}

/// Where the file is read from.
#[derive(Debug)]
pub(super) struct Opened<S> {
    pub(super) source: Rc<S>,
    pub(super) index: Index,
    pub(super) options: Options,
}

/// A replay, and where it is in the file.
#[derive(Debug)]
pub(super) struct Run<S> {
    reader: Reader<BufReader<Section<S>>>,
    section: usize,
    at: Duration,
    next: Option<Entry>,
    replay: Option<Replay>,
    /// What was known where the section began, until somebody takes it.
    boundary: Option<Known>,
}

impl<S: Source> Run<S> {
    /// Goes on from a checkpoint.
    pub(super) fn from(checkpoint: &Checkpoint, opened: &Opened<S>) -> Result<Self, RecordingError> {
        let Checkpoint { section, at, known, replay } = checkpoint.clone();
        let reader = read_section(opened, section, known)?;
        Ok(Self { reader, section, at, next: None, replay, boundary: None })
    }

    pub(super) fn replay(&self) -> Option<&Replay> {
        self.replay.as_ref()
    }

    pub(super) fn replay_mut(&mut self) -> Option<&mut Replay> {
        self.replay.as_mut()
    }

    pub(super) fn reader(&self) -> &Reader<BufReader<Section<S>>> {
        &self.reader
    }

    /// When the last entry took effect that was taken.
    pub(super) fn at(&self) -> Duration {
        self.at
    }

    /// When the next entry takes effect; `None` at the end of the file.
    pub(super) fn next_at(&mut self, opened: &Opened<S>) -> Result<Option<Duration>, RecordingError> {
        while self.next.is_none() {
            self.next = self.reader.next_in_section()?;
            if self.next.is_some() {
                break;
            }
            if self.reader.is_cut() || self.section + 1 >= opened.index.sections.len() {
                return Ok(None);
            }
            let known = self.reader.known().clone();
            self.section += 1;
            self.reader = read_section(opened, self.section, known.clone())?;
            self.boundary = Some(known);
        }
        Ok(self.next.as_ref().map(|entry| entry.arrival.at))
    }

    /// A checkpoint, if the next entry is the first one of a section and nobody took it yet.
    pub(super) fn checkpoint(&mut self, is_due: impl FnOnce(Duration) -> bool) -> Option<Checkpoint> {
        let known = self.boundary.take()?;
        is_due(self.at).then(|| Checkpoint {
            section: self.section,
            at: self.at,
            known,
            replay: self.replay.clone(),
        })
    }

    /// Takes the entry that [`Self::next_at`] told of.
    pub(super) fn take(
        &mut self,
        opened: &Opened<S>,
        tell: &mut dyn FnMut(&News),
    ) -> Result<(), RecordingError> {
        let Some(entry) = self.next.take() else { return Ok(()) };
        self.boundary = None;
        if self.replay.is_none() {
            let new = Replay::new(self.reader.head(), &opened.options);
            self.replay = Some(new.map_err(|fault| self.reader.error(fault))?);
        }
        if let Some(replay) = &mut self.replay {
            replay.take(&entry, tell).map_err(|fault| self.reader.error(fault))?;
        }
        self.at = self.at.max(entry.arrival.at);
        Ok(())
    }
}

fn read_section<S: Source>(
    opened: &Opened<S>,
    number: usize,
    known: Known,
) -> Result<Reader<BufReader<Section<S>>>, RecordingError> {
    let [begin, end] = opened.index.section(number).unwrap_or([opened.index.end; 2]);
    let section = Section::new(Rc::clone(&opened.source), begin, end);
    let section = BufReader::with_capacity(BUFFER, section);
    Reader::of_section(section, begin, end == opened.index.end, known)
}
