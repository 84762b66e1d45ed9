//! What a replay tells.

use core::time::Duration;
use std::collections::BTreeMap;

use mapless_robot::supervisor::{Decision, Reason, State};

use super::comparison::Difference;

/// Something that happens in a replay.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum News {
    /// A decision differs from the recorded one.
    Difference(Difference),
    /// The supervisor's state or a goal changed.
    Change {
        /// When.
        at: Duration,
        /// What, for people.
        text: String,
    },
}

/// What a replay found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Whether the file has decisions to compare with.
    pub has_decisions: bool,
    /// The time of the last entry.
    pub until: Duration,
    /// Ticks of the supervisor.
    pub ticks: u64,
    /// Answers of the planner.
    pub answers: u64,
    /// Ticks whose decisions differ from the recorded ones.
    pub different_ticks: u64,
    /// Answers that differ from the recorded ones.
    pub different_answers: u64,
    /// Entries that could not be recorded: decisions after them may differ.
    pub lost: u64,
    /// Goals on the topic of goals.
    pub goals: u64,
    /// Whether the file ended before its end was marked.
    pub is_cut: bool,
    /// What was wrong with messages: how often, and the last word on it.
    pub complaints: BTreeMap<&'static str, (u64, String)>,
    /// Of all decisions of the replay.
    pub digest: String,
    /// Of all recorded decisions, if there are any.
    pub recorded_digest: Option<String>,
    pub(super) last: Option<(State, Option<Reason>)>,
}

impl Report {
    pub(super) fn complain(&mut self, what: &'static str, text: &str) {
        let (count, last) = self.complaints.entry(what).or_default();
        *count += 1;
        text.clone_into(last);
    }

    pub(super) fn last_complaint(&self, what: &str) -> Option<&str> {
        self.complaints.get(what).map(|(_, last)| &**last)
    }

    pub(super) fn tell_change(&mut self, at: Duration, decision: &Decision, tell: &mut dyn FnMut(&News)) {
        let now = (decision.state, decision.reason);
        if self.last.replace(now) != Some(now) {
            let state = format!("{:?}", decision.state);
            let text = decision.reason.map_or_else(|| state.clone(), |reason| format!("{state}: {reason}"));
            tell(&News::Change { at, text });
        }
    }
}
