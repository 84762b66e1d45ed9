//! Topics that somebody must choose among before a recording opens.

use std::collections::BTreeMap;

use mapless_recording::{Candidate, Choice, Role, TopicNames, choices};
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::crossing::give;
use crate::file::{File, RecordingFile, refused};

/// A topic that a role may have.
#[derive(Debug, Serialize, Tsify)]
pub struct TopicCandidate {
    topic: String,
    /// How many messages it has, if the file tells.
    messages: Option<u64>,
}

/// A role that several topics of a recording may have.
#[derive(Debug, Serialize, Tsify)]
pub struct TopicChoice {
    /// `scan`, `odometry`, `imu`, `emergency_stop`, `reset`, `goal_pose` or `clock`.
    role: &'static str,
    /// The type of their messages.
    schema: &'static str,
    /// Those with the most messages first.
    candidates: Vec<TopicCandidate>,
}

/// Choices, in the order of their roles.
#[derive(Debug, Serialize, Tsify)]
#[serde(transparent)]
pub struct TopicChoices(Vec<TopicChoice>);

/// Names of topics by their roles.
#[derive(Debug, Deserialize, Tsify)]
pub struct NamedTopics(#[tsify(type = "Readonly<Record<string, string>>")] BTreeMap<String, String>);

impl NamedTopics {
    /// By roles; a role that is none is passed over.
    pub(crate) fn by_role(self) -> TopicNames {
        self.0.into_iter().filter_map(|(name, topic)| Some((Role::named(&name)?, topic))).collect()
    }
}

/// The roles for which a topic must be named before the recording can be opened; mostly none.
///
/// # Errors
/// A file that is no recording, with its name and what was expected.
#[wasm_bindgen]
pub fn topic_choices(file: RecordingFile) -> Result<Ts<TopicChoices>, JsError> {
    let (name, file) = File::new(file);
    let choices = choices(file, &TopicNames::new()).map_err(|error| refused(&name, &error))?;
    give(&TopicChoices(choices.into_iter().map(TopicChoice::from).collect()))
}

impl From<Choice> for TopicChoice {
    fn from(Choice { role, candidates }: Choice) -> Self {
        let candidates =
            candidates.into_iter().map(|Candidate { topic, messages }| TopicCandidate { topic, messages });
        Self { role: role.name(), schema: role.schema(), candidates: candidates.collect() }
    }
}
