//! The goal at the node.

use std::time::Instant;

use anyhow::{anyhow, ensure};
use glam::DVec2;
use mapless_peer::{NavigateClient, goal, navigate_client, send};
use mapless_trials::Outcome;
use ros2_client::Node;
use ros2_client::action::{GoalId, GoalStatusEnum};
use ros2_client::service::request_id::RmwRequestId;

use super::drift::Drift;

/// The robot stands for so many periods before it gets its goal, and some more whenever that is refused: long
/// enough for the gyro's bias.
const STAND_PERIODS: u64 = 50;
const ASK_AGAIN_PERIODS: u64 = 5;
/// Goals that are refused before a drive is given up.
const MOST_REFUSALS: u64 = 60;

/// A goal that the node is given once the robot has stood for a while.
pub(crate) struct Errand {
    client: NavigateClient,
    _node: Node,
    /// In the odometry's frame.
    goal_m: DVec2,
    refusals: u64,
    pursued: Option<Pursued>,
    /// The most by which the node's own word on the distance to the goal differed from the estimate.
    pub(crate) feedback_off_m: f64,
    /// Times that the node began to backtrack or to search.
    pub(crate) recoveries: i16,
}

/// A goal that was accepted.
struct Pursued {
    id: GoalId,
    request: RmwRequestId,
    since_s: f64,
    began: Instant,
}

/// How a drive ended.
pub(crate) struct Ended {
    pub(crate) outcome: &'static str,
    pub(crate) reason: Option<String>,
}

impl Errand {
    /// To a place in the odometry's frame, told from `node`.
    pub(crate) fn new(mut node: Node, goal_m: DVec2) -> anyhow::Result<Self> {
        let client = navigate_client(&mut node)?;
        Ok(Self {
            client,
            _node: node,
            goal_m,
            refusals: 0,
            pursued: None,
            feedback_off_m: 0.0,
            recoveries: 0,
        })
    }

    /// Whether the node drives there.
    pub(crate) fn is_pursued(&self) -> bool {
        self.pursued.is_some()
    }

    /// Since the goal was accepted: simulated seconds and the system's.
    pub(crate) fn took_s(&self, time_s: f64) -> [f64; 2] {
        self.pursued.as_ref().map_or([time_s, 0.0], |Pursued { since_s, began, .. }| {
            [time_s - since_s, began.elapsed().as_secs_f64()]
        })
    }

    /// A period has passed, `periods` in all: gives the goal when it is due, and hears what the node says of
    /// it.
    pub(crate) fn go_on(
        &mut self,
        periods: u64,
        time_s: f64,
        drift: &Drift,
    ) -> anyhow::Result<Option<Ended>> {
        let Some(Pursued { id, request, .. }) = &self.pursued else {
            if periods == STAND_PERIODS + self.refusals * ASK_AGAIN_PERIODS {
                self.ask(time_s)?;
            }
            return Ok(None);
        };
        while let Ok(Some(feedback)) = self.client.receive_feedback(*id) {
            self.recoveries = self.recoveries.max(feedback.number_of_recoveries);
            let stamp = feedback.current_pose.header.stamp;
            if let Some(distance_m) = drift.distance_m(self.goal_m, stamp) {
                let off_m = distance_m - f64::from(feedback.distance_remaining);
                self.feedback_off_m = self.feedback_off_m.max(off_m.abs());
            }
        }
        let result = self.client.receive_result(*request);
        let result = result.map_err(|error| anyhow!("the result of the goal: {error}"))?;
        Ok(result.map(|(status, result)| match status {
            GoalStatusEnum::Succeeded => Ended { outcome: Outcome::Reached.name(), reason: None },
            _ => {
                let reason = format!("{}: {}", result.error_code, result.error_msg);
                Ended { outcome: "aborted", reason: Some(reason) }
            }
        }))
    }

    fn ask(&mut self, time_s: f64) -> anyhow::Result<()> {
        match send(&self.client, goal("odom", self.goal_m.x, self.goal_m.y))? {
            Some((id, true)) => {
                let request = self.client.request_result(id);
                let request = request.map_err(|error| anyhow!("asking for the result: {error}"))?;
                self.pursued = Some(Pursued { id, request, since_s: time_s, began: Instant::now() });
            }
            Some((_, false)) | None => self.refusals += 1,
        }
        ensure!(self.refusals < MOST_REFUSALS, "the node takes no goal");
        Ok(())
    }
}
