//! What `/diagnostics` says.

use mapless_robot::supervisor::State;

use crate::config::NodeConfig;
use crate::hub::Hub;
use crate::messages::{DiagnosticArray, DiagnosticStatus, Header, KeyValue, Level};

/// One status: the supervisor's state, with what was complained of last.
pub(crate) fn diagnose(hub: &Hub, config: &NodeConfig) -> DiagnosticArray {
    let decision = hub.decision();
    let level = match decision.map(|decision| decision.state) {
        Some(State::Standby | State::Driving) => Level::Ok,
        Some(State::Paused) | None => Level::Warn,
        Some(State::Aborted | State::Latched) => Level::Error,
    };
    let message = match decision {
        None => "starting".to_owned(),
        Some(decision) => match decision.reason {
            Some(reason) => format!("{:?}: {reason}", decision.state),
            None => format!("{:?}", decision.state),
        },
    };
    let mut values = Vec::new();
    let mut add = |key: &str, value: String| values.push(KeyValue { key: key.to_owned(), value });
    if let Some(cause) = decision.and_then(|decision| decision.cause) {
        add("cause", cause.to_string());
    }
    if let Some(task) = hub.task() {
        add("goal", task.goal.position_m.to_string());
    }
    if let Some(planned) = hub.planned() {
        add("planner", format!("{:?}", planned.status));
        add("planner step, ms", format!("{:.1}", 1e3 * planned.took.as_secs_f64()));
    }
    if let Some(slowest) = hub.take_slowest_answer() {
        add("slowest scan to command, ms", format!("{:.1}", 1e3 * slowest.as_secs_f64()));
    }
    for (what, complaint) in hub.complaints() {
        add(what, complaint);
    }
    let name = format!("{}: supervisor", config.node_name);
    let status =
        DiagnosticStatus { level: level as u8, name, message, hardware_id: config.namespace.clone(), values };
    DiagnosticArray { header: Header { stamp: hub.stamp(), ..Header::default() }, status: vec![status] }
}
