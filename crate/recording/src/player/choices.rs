//! Topics that their types do not tell apart.

use core::cmp::Reverse;
use std::collections::BTreeMap;
use std::io::BufReader;
use std::rc::Rc;

use super::at_begin;
use super::index::Summary;
use super::source::{Section, Source};
use crate::error::{Fault, RecordingError};
use crate::reader::{Known, Reader};
use crate::topics::{Role, Roles, TopicNames};

/// So much of a file whose summary tells nothing is looked through, bytes: each topic has come by then.
const LOOKED_THROUGH: u64 = 16 << 20;

/// A topic that a role may have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// Its name.
    pub topic: String,
    /// How many messages it has, if the file's summary tells.
    pub messages: Option<u64>,
}

/// A role that several topics of a file may have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The role.
    pub role: Role,
    /// Its topics: those with the most messages first, then by name.
    pub candidates: Vec<Candidate>,
}

/// The roles for which a topic must be named in [`Options::topics`](crate::Options::topics) before the file
/// can be opened, beyond those that are `named`; none for a recording of the node.
///
/// # Errors
/// A file without a topic for scan, odometry or IMU, of which naming others makes nothing.
pub fn choices<S: Source>(source: S, named: &TopicNames) -> Result<Vec<Choice>, RecordingError> {
    let summary = Summary::of(&source).map_err(at_begin)?;
    match summary.filter(|summary| !summary.chunks.is_empty()) {
        Some(summary) => from_summary(&summary, named).map_err(at_begin),
        None => from_begin(source, named),
    }
}

fn from_summary(summary: &Summary, named: &TopicNames) -> Result<Vec<Choice>, Fault> {
    let roles = Roles::new(named.clone());
    let mut choices = Vec::new();
    for role in Role::INPUTS {
        let mut topics = BTreeMap::new();
        for (channel, schema) in &summary.channels {
            if roles.may_be(role, &channel.topic, schema) {
                // A topic with several publishers may have several channels.
                let messages: &mut Option<u64> = topics.entry(channel.topic.clone()).or_default();
                let more = summary.messages.get(&channel.id);
                *messages = more.map(|more| messages.unwrap_or(0) + more).or(*messages);
            }
        }
        if topics.is_empty() && Role::SENSORS.contains(&role) {
            return Err(Fault::Needed { role: role.name(), schema: role.schema() });
        }
        choices.extend(choice(role, topics));
    }
    Ok(choices)
}

/// From the messages at the begin of a file that was cut off.
fn from_begin<S: Source>(source: S, named: &TopicNames) -> Result<Vec<Choice>, RecordingError> {
    let end = source.length();
    let begin = BufReader::new(Section::new(Rc::new(source), 0, end.min(LOOKED_THROUGH)));
    let mut reader = Reader::of_section(begin, 0, true, Known::new(named.clone()))?;
    let mut topics: BTreeMap<Role, BTreeMap<String, Option<u64>>> = BTreeMap::new();
    while reader.head().is_none() {
        match reader.next_in_section() {
            Ok(Some(_)) => {}
            Err(RecordingError { fault: Fault::Ambiguous { role, first, second, .. }, .. }) => {
                if let Some(role) = Role::named(role) {
                    topics.entry(role).or_default().extend([(first, None), (second, None)]);
                }
            }
            // What else is wrong is told where that is read.
            Ok(None) | Err(_) => break,
        }
    }
    Ok(topics.into_iter().filter_map(|(role, topics)| choice(role, topics)).collect())
}

fn choice(role: Role, topics: BTreeMap<String, Option<u64>>) -> Option<Choice> {
    let candidates = topics.into_iter().map(|(topic, messages)| Candidate { topic, messages });
    let mut candidates: Vec<Candidate> = candidates.collect();
    candidates.sort_by_key(|candidate| Reverse(candidate.messages));
    (candidates.len() > 1).then_some(Choice { role, candidates })
}
