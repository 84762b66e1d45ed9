//! The states of the supervisor and the transitions between them.

/// Whether the robot may move, and what has to happen before it may again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum State {
    /// In order, without a goal. The robot stands.
    Standby,
    /// In order and with a goal: the planner's commands pass, within limits. The only state that moves.
    Driving,
    /// Stopped. Once everything has been in order for a while, the goal is pursued further.
    Paused,
    /// Stopped, and the goal is void. Once everything has been in order for a while, a new goal is taken.
    Aborted,
    /// Stopped, and the goal is void. Somebody must reset it.
    Latched,
}

/// What makes the state change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Event {
    /// There is a goal that no stop has made void.
    Goal,
    /// There is none.
    NoGoal,
    /// A cause to stop that clears by itself.
    Pause,
    /// A cause to stop that needs a new goal.
    Abort,
    /// A cause to stop that needs a reset.
    Latch,
    /// Everything has been in order for `clear_after_s`.
    Clear,
    /// Somebody reset the supervisor.
    Reset,
}

impl State {
    /// Every state.
    pub const ALL: [Self; 5] = [Self::Standby, Self::Driving, Self::Paused, Self::Aborted, Self::Latched];

    /// The state after an event: [`TRANSITIONS`] as a function.
    pub fn after(self, event: Event) -> Self {
        TRANSITIONS[self as usize].1[event as usize]
    }
}

impl Event {
    /// Every event, in the order of the columns of [`TRANSITIONS`].
    pub const ALL: [Self; 7] =
        [Self::Goal, Self::NoGoal, Self::Pause, Self::Abort, Self::Latch, Self::Clear, Self::Reset];
}

use State::{Aborted, Driving, Latched, Paused, Standby};

/// The state after each event, in the order of [`Event::ALL`].
#[rustfmt::skip]
pub const TRANSITIONS: [(State, [State; 7]); 5] = [
    //         Goal     NoGoal   Pause    Abort    Latch    Clear    Reset
    (Standby, [Driving, Standby, Paused,  Aborted, Latched, Standby, Standby]),
    (Driving, [Driving, Standby, Paused,  Aborted, Latched, Driving, Driving]),
    (Paused,  [Paused,  Paused,  Paused,  Aborted, Latched, Standby, Paused]),
    (Aborted, [Aborted, Aborted, Aborted, Aborted, Latched, Standby, Aborted]),
    (Latched, [Latched, Latched, Latched, Latched, Latched, Latched, Aborted]),
];

/// The transitions as a Mermaid state diagram, as docs/design/robot.md shows it.
pub fn diagram() -> String {
    let mut lines = vec!["stateDiagram-v2".to_owned(), "    [*] --> Paused".to_owned()];
    for (from, row) in TRANSITIONS {
        for to in State::ALL {
            let leads = |event: &&Event| from != to && row[**event as usize] == to;
            let events: Vec<String> =
                Event::ALL.iter().filter(leads).map(|event| format!("{event:?}")).collect();
            if !events.is_empty() {
                lines.push(format!("    {from:?} --> {to:?}: {}", events.join(", ")));
            }
        }
    }
    lines.join("\n")
}
