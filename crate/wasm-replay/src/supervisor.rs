//! The supervisor as a state machine, and what can go wrong by hand.

use mapless_recording::FaultKind;
use mapless_robot::supervisor::{Event, State};
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::crossing::give;

/// From one state to another.
#[derive(Debug, Serialize, Tsify)]
pub struct SupervisorTransition {
    from: String,
    to: String,
    /// What leads there: `Goal`, `NoGoal`, `Pause`, `Abort`, `Latch`, `Clear` or `Reset`.
    events: Vec<String>,
}

/// Every transition from one state to another, in the order of the states.
#[derive(Debug, Serialize, Tsify)]
#[serde(transparent)]
pub struct SupervisorTransitions(Vec<SupervisorTransition>);

/// The supervisor's states and what leads from one to another.
///
/// # Errors
/// None that is known.
#[wasm_bindgen]
pub fn supervisor_transitions() -> Result<Ts<SupervisorTransitions>, JsError> {
    let transition = |from: State, to: State| {
        let leads = Event::ALL.into_iter().filter(|event| from != to && from.after(*event) == to);
        let events: Vec<String> = leads.map(|event| format!("{event:?}")).collect();
        let (from, to) = (format!("{from:?}"), format!("{to:?}"));
        (!events.is_empty()).then_some(SupervisorTransition { from, to, events })
    };
    let from = |from: State| State::ALL.into_iter().filter_map(move |to| transition(from, to));
    give(&SupervisorTransitions(State::ALL.into_iter().flat_map(from).collect()))
}

/// The kinds of faults that a recording can be opened with.
#[wasm_bindgen]
pub fn fault_kinds() -> Vec<String> {
    FaultKind::ALL.iter().map(|(_, name)| (*name).to_owned()).collect()
}
