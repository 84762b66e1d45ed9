//! A client of `NavigateToPose`.

use std::time::Duration;

use mapless_node::messages::{Feedback, Header, NavigateGoal, NavigateResult, Point, Pose, PoseStamped};
use ros2_client::action::{ActionClient, ActionClientQosPolicies, GoalId};
use ros2_client::dds::ServiceMapping;
use ros2_client::qos::{Durability, History};
use ros2_client::{ActionTypeName, Name, Node, QosProfile};

use crate::error::making;
use crate::waiting::until;

/// How long a server may take to say whether it accepts.
const ANSWERED_WITHIN: Duration = Duration::from_secs(2);

/// A client of the action `navigate_to_pose`.
pub type NavigateClient = ActionClient<NavigateGoal, NavigateResult, Feedback>;

/// Makes the client.
///
/// # Errors
/// Those of the middleware.
pub fn navigate_client(node: &mut Node) -> anyhow::Result<NavigateClient> {
    let what = "navigate_to_pose";
    let service = QosProfile::publisher_default().history(History::KeepLast { depth: 10 });
    let qos = ActionClientQosPolicies {
        goal_service: service.clone(),
        result_service: service.clone(),
        cancel_service: service.clone(),
        feedback_subscription: service.clone(),
        status_subscription: service.durability(Durability::TransientLocal),
    };
    let kind = ActionTypeName::new("nav2_msgs", "NavigateToPose");
    let name = Name::new("", what).map_err(making(what))?;
    node.create_action_client(ServiceMapping::Enhanced, &name, &kind, qos).map_err(making(what))
}

/// A goal at a place in a frame, whatever the heading.
#[must_use]
pub fn goal(frame_id: &str, x: f64, y: f64) -> NavigateGoal {
    let pose = Pose { position: Point { x, y, z: 0.0 }, ..Pose::default() };
    let header = Header { frame_id: frame_id.to_owned(), ..Header::default() };
    NavigateGoal { pose: PoseStamped { header, pose }, behavior_tree: String::new() }
}

/// Sends a goal; its id and whether it was accepted, or `None` if nobody answered.
///
/// # Errors
/// Those of the middleware.
pub fn send(client: &NavigateClient, goal: NavigateGoal) -> anyhow::Result<Option<(GoalId, bool)>> {
    let (request, id) = client.send_goal(goal).map_err(making("sending a goal"))?;
    let ask = || client.receive_goal_response(request).transpose();
    let response = until(ANSWERED_WITHIN, ask).transpose().map_err(making("the answer to a goal"))?;
    Ok(response.map(|response| (id, response.accepted)))
}
