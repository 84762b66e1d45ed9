//! The action server of `NavigateToPose`: what the wire wants of it. What goals mean is `navigation`.
//!
//! Source: <https://design.ros2.org/articles/actions.html>. The server of `ros2-client` for async programs
//! answers one request for a result and reports a goal as executing until then, so its parts are used.

use std::time::{Duration, Instant};

use ros2_client::action::{
    ActionServer as Parts, ActionServerQosPolicies, CancelGoalRequest, CancelGoalResponse, GetResultResponse,
    GoalId, GoalInfo, GoalStatusEnum, SendGoalResponse,
};
use ros2_client::action_msgs::{CancelGoalResponseEnum, GoalStatus, GoalStatusArray};
use ros2_client::builtin_interfaces::Time;
use ros2_client::dds::ServiceMapping;
use ros2_client::qos::{Durability, History, Reliability, WhenFull};
use ros2_client::{ActionTypeName, Name, QosProfile, RmwRequestId};

use super::{Entities, RosError, making};
use crate::messages::{Feedback, NavigateGoal, NavigateResult};
use crate::navigation::End;
use mapless_robot::navigation::Outcome;

/// How long the result of a goal that ended is kept for whoever asks for it, as in rcl.
const KEPT: Duration = Duration::from_secs(15 * 60);
/// Goals that are remembered, and requests for results that wait: beyond, the oldest is forgotten.
const MOST: usize = 64;

/// A goal that was accepted.
struct Known {
    id: GoalId,
    stamp: Time,
    status: GoalStatusEnum,
    /// Set when it ended.
    result: Option<(NavigateResult, Instant)>,
}

/// The server.
pub(crate) struct ActionServer {
    parts: Parts<NavigateGoal, NavigateResult, Feedback>,
    known: Vec<Known>,
    waiting: Vec<(RmwRequestId, GoalId)>,
}

impl ActionServer {
    /// Serves `topic`.
    pub(crate) fn new(topic: &str, entities: &mut Entities) -> Result<Self, RosError> {
        let what = || format!("action {topic}");
        let service = QosProfile::publisher_default()
            .reliability(Reliability::Reliable { when_full: WhenFull::Fail })
            .history(History::KeepLast { depth: 10 });
        let status =
            service.clone().durability(Durability::TransientLocal).history(History::KeepLast { depth: 1 });
        let qos = ActionServerQosPolicies {
            goal_service: service.clone(),
            result_service: service.clone(),
            cancel_service: service.clone(),
            feedback_publisher: service,
            status_publisher: status,
        };
        let name = Name::parse(topic).map_err(making(what()))?;
        let kind = ActionTypeName::new("nav2_msgs", "NavigateToPose");
        let server = entities.node.create_action_server(ServiceMapping::Enhanced, &name, &kind, qos);
        let mut parts = server.map_err(making(what()))?;
        entities.wake_by(parts.goal_server())?;
        entities.wake_by(parts.cancel_server())?;
        entities.wake_by(parts.result_server())?;
        Ok(Self { parts, known: Vec::new(), waiting: Vec::new() })
    }

    /// The next goal that somebody asks for; it must be answered.
    pub(crate) fn asked(&self) -> Option<(RmwRequestId, GoalId, NavigateGoal)> {
        loop {
            match self.parts.receive_goal() {
                Ok(Some((request, goal))) if self.known.iter().any(|known| known.id == goal.goal_id) => {
                    self.answer(request, false);
                }
                Ok(goal) => return goal.map(|(request, goal)| (request, goal.goal_id, goal.goal)),
                Err(error) => log::warn!("a goal could not be read: {error}"),
            }
        }
    }

    fn answer(&self, request: RmwRequestId, accepted: bool) -> Time {
        let stamp = Time::now();
        if let Err(error) = self.parts.send_goal_response(request, SendGoalResponse { accepted, stamp }) {
            log::warn!("a goal could not be answered: {error:?}");
        }
        stamp
    }

    /// Refuses a goal.
    pub(crate) fn refuse(&self, request: RmwRequestId) {
        self.answer(request, false);
    }

    /// Accepts a goal, which is executed from now on.
    pub(crate) fn accept(&mut self, request: RmwRequestId, id: GoalId) {
        let stamp = self.answer(request, true);
        if self.known.len() == MOST {
            self.known.remove(0);
        }
        self.known.push(Known { id, stamp, status: GoalStatusEnum::Executing, result: None });
        self.publish_statuses();
    }

    /// The goals that somebody wants to take back, which are so from now on.
    pub(crate) fn take_cancels(&mut self) -> Vec<GoalId> {
        let mut cancelled = Vec::new();
        loop {
            match self.parts.receive_cancel_request() {
                Ok(Some((request, cancel))) => cancelled.extend(self.cancel(request, &cancel)),
                Ok(None) => return cancelled,
                Err(error) => log::warn!("a request to cancel could not be read: {error}"),
            }
        }
    }

    fn cancel(&mut self, request: RmwRequestId, cancel: &CancelGoalRequest) -> Vec<GoalId> {
        let Some(GoalInfo { goal_id, stamp }) = goal_info(cancel) else { return Vec::new() };
        let (by_id, by_time) = (goal_id != GoalId::ZERO, stamp != Time::ZERO);
        let mut found = Vec::new();
        for known in self.known.iter_mut().filter(|known| known.result.is_none()) {
            let is_meant =
                by_id && known.id == goal_id || by_time && known.stamp <= stamp || !by_id && !by_time;
            if is_meant {
                known.status = GoalStatusEnum::Canceling;
                found.push(GoalInfo { goal_id: known.id, stamp: known.stamp });
            }
        }
        let asked_for = self.known.iter().find(|known| by_id && known.id == goal_id);
        let return_code = match asked_for {
            _ if !found.is_empty() => CancelGoalResponseEnum::None,
            Some(_) => CancelGoalResponseEnum::GoalTerminated,
            None if by_id => CancelGoalResponseEnum::UnknownGoal,
            None => CancelGoalResponseEnum::Rejected,
        };
        let ids = found.iter().map(|info| info.goal_id).collect();
        let response = CancelGoalResponse { return_code, goals_canceling: found };
        if let Err(error) = self.parts.send_cancel_response(request, response) {
            log::warn!("a request to cancel could not be answered: {error:?}");
        }
        self.publish_statuses();
        ids
    }

    /// Ends a goal.
    pub(crate) fn end(&mut self, id: GoalId, how: End) {
        let Some(known) = self.known.iter_mut().find(|known| known.id == id) else { return };
        let (status, outcome) = match how {
            End::Succeeded => (GoalStatusEnum::Succeeded, Outcome::default()),
            End::Canceled => (GoalStatusEnum::Canceled, Outcome::default()),
            End::Aborted(outcome) => (GoalStatusEnum::Aborted, outcome),
        };
        known.status = status;
        known.result = Some((outcome.into(), Instant::now()));
        self.publish_statuses();
        self.answer_results();
    }

    /// Answers those who ask for results of goals that ended, and forgets old ones.
    pub(crate) fn answer_results(&mut self) {
        loop {
            match self.parts.receive_result_request() {
                Ok(Some((request, asked))) => {
                    if self.waiting.len() == MOST {
                        self.waiting.remove(0);
                    }
                    self.waiting.push((request, asked.goal_id));
                }
                Ok(None) => break,
                Err(error) => log::warn!("a request for a result could not be read: {error}"),
            }
        }
        self.known.retain(|known| known.result.as_ref().is_none_or(|(_, ended)| ended.elapsed() < KEPT));
        let (known, parts) = (&self.known, &self.parts);
        self.waiting.retain(|(request, id)| {
            let (status, result) = match known.iter().find(|known| known.id == *id) {
                Some(Known { result: None, .. }) => return true,
                Some(Known { result: Some((result, _)), status, .. }) => (*status, result.clone()),
                None => (GoalStatusEnum::Unknown, NavigateResult::default()),
            };
            if let Err(error) = parts.send_result(*request, GetResultResponse { status, result }) {
                log::warn!("a result could not be sent: {error:?}");
            }
            false
        });
    }

    /// Tells whoever gave the goal how it goes.
    pub(crate) fn publish_feedback(&self, id: GoalId, feedback: Feedback) {
        if let Err(error) = self.parts.send_feedback(id, feedback) {
            log::warn!("feedback could not be sent: {error}");
        }
    }

    fn publish_statuses(&self) {
        let status_list = self.known.iter().map(|known| GoalStatus {
            goal_info: GoalInfo { goal_id: known.id, stamp: known.stamp },
            status: known.status,
        });
        let statuses = GoalStatusArray { status_list: status_list.collect() };
        if let Err(error) = self.parts.send_goal_statuses(statuses) {
            log::warn!("the goals' statuses could not be sent: {error}");
        }
    }
}

/// What a request to cancel asks for. `ros2-client` keeps it to itself, but encodes it.
fn goal_info(cancel: &CancelGoalRequest) -> Option<GoalInfo> {
    let bytes = cdr_encoding::to_vec::<_, byteorder::LittleEndian>(cancel).ok()?;
    cdr_encoding::from_bytes::<GoalInfo, byteorder::LittleEndian>(&bytes).ok().map(|(info, _)| info)
}
