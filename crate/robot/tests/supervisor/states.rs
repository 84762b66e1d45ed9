//! The states, their transitions, and the page that draws them.

use mapless_robot::supervisor::{Event, State, TRANSITIONS, diagram};

/// The state after every pair of state and event, said again as rules.
fn expected(state: State, event: Event) -> State {
    match (state, event) {
        // A stronger stop replaces a weaker one, never the other way.
        (State::Latched, Event::Reset) => State::Aborted,
        (State::Latched, _) | (_, Event::Latch) => State::Latched,
        (State::Aborted, Event::Clear) => State::Standby,
        (State::Aborted, _) | (_, Event::Abort) => State::Aborted,
        (State::Paused, Event::Clear) => State::Standby,
        (State::Paused, _) | (_, Event::Pause) => State::Paused,
        // Without a stop the goal alone counts.
        (State::Standby | State::Driving, Event::Goal) => State::Driving,
        (State::Standby | State::Driving, Event::NoGoal) => State::Standby,
        (State::Standby | State::Driving, Event::Clear | Event::Reset) => state,
    }
}

#[test]
fn every_pair_of_state_and_event_leads_where_the_rules_say() {
    for (index, state) in State::ALL.into_iter().enumerate() {
        assert_eq!(TRANSITIONS[index].0, state, "the rows are in order");
        for event in Event::ALL {
            assert_eq!(state.after(event), expected(state, event), "{state:?} after {event:?}");
        }
    }
}

#[test]
fn only_a_goal_in_standby_leads_to_driving() {
    for state in State::ALL {
        for event in Event::ALL {
            if state != State::Driving && state.after(event) == State::Driving {
                assert_eq!((state, event), (State::Standby, Event::Goal));
            }
        }
    }
}

#[test]
fn the_design_page_draws_the_table() {
    let page = include_str!("../../../../docs/design/robot.md");
    assert!(page.contains(&diagram()), "docs/design/robot.md must hold this diagram:\n{}", diagram());
}
