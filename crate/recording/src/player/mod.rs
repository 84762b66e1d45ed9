//! Going to any moment of a recording.
//!
//! The whole file is decided again once, a piece at a time, as [`Player::decide_on`] is called; copies of the
//! replay are kept on the way. [`Player::go_to`] goes on from the last copy before a moment. The file is read
//! a chunk at a time, and copies are given up once they take too much, so the memory does not grow with the
//! length of the recording but for a few bytes a tenth of a second.

mod choices;
mod index;
mod run;
mod source;

use core::time::Duration;
use std::rc::Rc;

use mapless::glam::DVec3;

use crate::error::{Fault, RecordingError};
use crate::head::Head;
use crate::reader::Known;
use crate::replay::{Difference, Moment, News, Options, Replay, Report};
use crate::topics::Role;

pub use choices::{Candidate, Choice, choices};
use index::Index;
use run::{Checkpoint, Opened, Run};
pub use source::Source;

/// A copy of the replay is kept this often at first.
const FIRST_SPACING: Duration = Duration::from_secs(1);
/// Copies are given up once they take more than this, bytes, about.
const MOST_BYTES: usize = 96 << 20;
/// What a copy takes besides its scans, bytes, about.
const COPY_BYTES: usize = 1 << 20;
/// A place of the trajectory is kept this often.
const TRAIL_SPACING: Duration = Duration::from_millis(100);
/// Differences that are kept; more are counted.
const MOST_DIFFERENCES: usize = 1000;
/// Changes of state that are kept.
const MOST_CHANGES: usize = 10_000;

/// What was found by deciding again, as far as that went.
#[derive(Debug, Default)]
pub struct Found {
    /// Until when everything was decided again.
    pub until: Duration,
    /// Whether that is the end.
    pub has_ended: bool,
    /// Why the file cannot be read any further.
    pub fault: Option<RecordingError>,
    /// When the planner answered, or, while it had nothing to do, when scans came.
    pub scans: Vec<Duration>,
    /// Where the robot was, metres, in the estimator's frame, and when.
    pub trail: Vec<(Duration, DVec3)>,
    /// Changes of the supervisor's state and of the goal: when and what.
    pub changes: Vec<(Duration, String)>,
    /// The first decisions that differ from the recorded ones.
    pub differences: Vec<Difference>,
}

/// A recording that is open.
#[derive(Debug)]
pub struct Player<S> {
    opened: Opened<S>,
    /// Decides everything again, once.
    frontier: Run<S>,
    /// Stands where somebody looks.
    shown: Run<S>,
    until: Duration,
    copies: Vec<Checkpoint>,
    spacing: Duration,
    found: Found,
}

impl<S: Source> Player<S> {
    /// Opens a recording of the node, or a robot's own.
    ///
    /// # Errors
    /// [`RecordingError`] for a file that is neither, with what was expected.
    pub fn open(source: S, options: Options) -> Result<Self, RecordingError> {
        let index = Index::of(&source, &options.topics).map_err(at_begin)?;
        let first = Checkpoint {
            section: 0,
            at: Duration::ZERO,
            known: Known::new(options.topics.clone()),
            replay: None,
        };
        let opened = Opened { source: Rc::new(source), index, options };
        let (mut frontier, shown) = (Run::from(&first, &opened)?, Run::from(&first, &opened)?);
        if frontier.next_at(&opened)?.is_none() {
            let role = Role::Scan;
            return Err(frontier.reader().error(Fault::Needed { role: role.name(), schema: role.schema() }));
        }
        let began_ns = frontier.reader().began_ns();
        let until = Duration::from_nanos(opened.index.until_ns.saturating_sub(began_ns));
        let mut player = Self {
            opened,
            frontier,
            shown,
            until,
            copies: vec![first],
            spacing: FIRST_SPACING,
            found: Found::default(),
        };
        // The first entry brings the configuration, which may be out of order.
        player.frontier.take(&player.opened, &mut |_| {})?;
        player.shown.next_at(&player.opened)?;
        player.shown.take(&player.opened, &mut |_| {})?;
        Ok(player)
    }

    /// What stands at the begin of a recording of the node; `None` for other files.
    pub fn head(&self) -> Option<&Head> {
        self.frontier.reader().head()
    }

    /// When the last entry took effect, as far as that is known without reading them all.
    pub fn until(&self) -> Duration {
        if self.found.has_ended { self.found.until } else { self.until.max(self.found.until) }
    }

    /// What was found so far.
    pub fn found(&self) -> &Found {
        &self.found
    }

    /// What the replay says so far.
    pub fn report(&self) -> Option<Report> {
        self.frontier.replay().map(Replay::report)
    }

    /// Whether the file ended before its end was marked.
    pub fn is_cut(&self) -> bool {
        self.frontier.reader().is_cut()
    }

    /// Decides so many more entries again.
    pub fn decide_on(&mut self, entries: usize) {
        for _ in 0..entries {
            if self.found.has_ended {
                return;
            }
            if let Err(fault) = self.decide_next() {
                self.found.fault = Some(fault);
                self.found.has_ended = true;
            }
        }
    }

    fn decide_next(&mut self) -> Result<(), RecordingError> {
        if self.frontier.next_at(&self.opened)?.is_none() {
            self.found.has_ended = true;
            return Ok(());
        }
        let due = self.copies.last().map_or(Duration::ZERO, |copy| copy.at + self.spacing);
        if let Some(copy) = self.frontier.checkpoint(|at| at >= due) {
            self.keep(copy);
        }
        let found = &mut self.found;
        let mut tell = |news: &News| match news {
            News::Difference(difference) if found.differences.len() < MOST_DIFFERENCES => {
                found.differences.push(difference.clone());
            }
            News::Change { at, text } if found.changes.len() < MOST_CHANGES => {
                found.changes.push((*at, text.clone()));
            }
            _ => {}
        };
        self.frontier.take(&self.opened, &mut tell)?;
        found.until = self.frontier.at();
        let Some(moment) = self.frontier.replay().map(Replay::moment) else { return Ok(()) };
        if let Some(looked) = moment.looked
            && found.scans.last().is_none_or(|last| *last < looked)
        {
            found.scans.push(looked);
        }
        let due = found.trail.last().map_or(Duration::ZERO, |(at, _)| *at + TRAIL_SPACING);
        if let Some(pose) = moment.pose
            && found.until >= due
        {
            found.trail.push((found.until, pose.position_m));
        }
        Ok(())
    }

    fn keep(&mut self, copy: Checkpoint) {
        self.copies.push(copy);
        let bytes_of = |copy: &Checkpoint| COPY_BYTES + copy.replay.as_ref().map_or(0, Replay::scan_bytes);
        while self.copies.len() > 2 && self.copies.iter().map(bytes_of).sum::<usize>() > MOST_BYTES {
            let mut index = 0;
            self.copies.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.spacing *= 2;
        }
    }

    /// Goes to a moment, or to where everything was decided again if that is earlier.
    ///
    /// # Errors
    /// [`RecordingError`] if the file cannot be read any more.
    pub fn go_to(&mut self, at: Duration) -> Result<(), RecordingError> {
        let at = at.min(self.found.until);
        let copy = self.copies.iter().rev().find(|copy| copy.at <= at);
        if let Some(copy) = copy
            && (at < self.shown.at() || copy.at > self.shown.at())
        {
            self.shown = Run::from(copy, &self.opened)?;
        }
        loop {
            match self.shown.next_at(&self.opened) {
                Ok(Some(next)) if next <= at => {}
                Err(error) if self.found.fault.is_none() => return Err(error),
                // Where the file is broken, it ends here, too.
                _ => return Ok(()),
            }
            self.shown.take(&self.opened, &mut |_| {})?;
        }
    }

    /// What is the case there.
    pub fn moment(&self) -> Option<Moment<'_>> {
        self.shown.replay().map(Replay::moment)
    }

    /// Asks the planner as it is there for what a step by itself does not predict.
    pub fn ask<T>(&mut self, ask: impl FnOnce(&mut mapless::Planner) -> T) -> Option<T> {
        self.shown.replay_mut().and_then(|replay| replay.ask_planner(ask))
    }
}

fn at_begin(fault: Fault) -> RecordingError {
    RecordingError { messages: 0, byte: 0, fault }
}
