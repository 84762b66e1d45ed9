//! Decisions as they were recorded and as they are now.

use core::time::Duration;

use sha2::{Digest as _, Sha256};

use crate::message::{AnswerMessage, TickMessage};

/// A decision that differs from the recorded one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// When it was recorded.
    pub at: Duration,
    /// Whose decision it is.
    pub whose: &'static str,
    /// What differs: name, recorded value and value now.
    pub fields: Vec<(&'static str, String, String)>,
}

type Fields = Vec<(&'static str, String)>;

/// Compares decisions, and makes a digest of all of either kind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Comparison {
    recorded: Sha256,
    replayed: Sha256,
}

impl Comparison {
    pub(crate) fn tick(
        &mut self,
        at: Duration,
        recorded: Option<&TickMessage>,
        replayed: &TickMessage,
    ) -> Option<Difference> {
        self.compare(at, "supervisor", recorded.map(tick_fields), Some(tick_fields(replayed)))
    }

    /// `replayed` is `None` if the scan or the goal of the answer is not known.
    pub(crate) fn answer(
        &mut self,
        at: Duration,
        recorded: Option<&AnswerMessage>,
        replayed: Option<&AnswerMessage>,
    ) -> Option<Difference> {
        self.compare(at, "planner", recorded.map(answer_fields), replayed.map(answer_fields))
    }

    fn compare(
        &mut self,
        at: Duration,
        whose: &'static str,
        recorded: Option<Fields>,
        replayed: Option<Fields>,
    ) -> Option<Difference> {
        add(&mut self.recorded, at, recorded.as_ref());
        add(&mut self.replayed, at, replayed.as_ref());
        let recorded = recorded?;
        let now = |index: usize| match &replayed {
            Some(fields) => fields[index].1.clone(),
            None => "no answer: its scan or goal is not in the recording".to_owned(),
        };
        let fields = recorded.into_iter().enumerate().map(|(index, (name, then))| (name, then, now(index)));
        let fields: Vec<_> = fields.filter(|(_, then, now)| then != now).collect();
        (!fields.is_empty()).then_some(Difference { at, whose, fields })
    }

    /// Of what was recorded.
    pub(crate) fn recorded_digest(&self) -> String {
        hexadecimal(&self.recorded)
    }

    /// Of what was decided now.
    pub(crate) fn replayed_digest(&self) -> String {
        hexadecimal(&self.replayed)
    }
}

fn hexadecimal(hash: &Sha256) -> String {
    hash.clone().finalize()[..16].iter().map(|byte| format!("{byte:02x}")).collect()
}

fn add(hash: &mut Sha256, at: Duration, fields: Option<&Fields>) {
    hash.update(at.as_nanos().to_le_bytes());
    for (name, value) in fields.into_iter().flatten() {
        hash.update(name);
        hash.update(b"=");
        hash.update(value);
        hash.update(b"\n");
    }
}

/// Numbers are written so that other bits are other digits.
fn command([linear_m_s, angular_rad_s]: [f64; 2]) -> String {
    format!("{linear_m_s:?} m/s, {angular_rad_s:?} rad/s")
}

fn tick_fields(tick: &TickMessage) -> Fields {
    vec![
        ("command", command([tick.linear_m_s, tick.angular_rad_s])),
        ("state", tick.state.clone()),
        ("reason", tick.reason.clone()),
        ("cause", tick.cause.clone()),
        ("takes goals", tick.takes_goals.to_string()),
    ]
}

fn answer_fields(answer: &AnswerMessage) -> Fields {
    vec![
        ("status", answer.status.clone()),
        ("command", command([answer.linear_m_s, answer.angular_rad_s])),
        ("digest", answer.digest.clone()),
    ]
}
