//! The middleware's thread: takes messages, serves goals, and tells how it goes.

use std::time::Duration;

use mapless::Goal;
use mapless_recording::Content;
use mapless_robot::navigation::{End, Outcome, code, goal_of};
use ros2_client::{Publisher, Subscription};
use serde::de::DeserializeOwned;

use crate::config::NodeConfig;
use crate::diagnostics::diagnose;
use crate::hub::Hub;
use crate::messages::{DiagnosticArray, Feedback, Header, PoseStamped, Quaternion};
use crate::navigation::{Ended, Navigation};
use crate::parameters::Parameters;
use crate::ros::{ActionServer, Entities, Heartbeat, Incoming, ParameterServices, Presence};
use crate::senses::Senses;

/// The longest wait for a message: goals end and peers come without one.
const WAIT: Duration = Duration::from_millis(20);
/// Diagnostics go out once in this time, as `diagnostic_updater` does.
const DIAGNOSE_EVERY: Duration = Duration::from_secs(1);

/// What the thread holds.
pub(crate) struct Receiving<'a> {
    pub(crate) hub: &'a Hub,
    pub(crate) config: &'a NodeConfig,
    pub(crate) entities: &'a mut Entities,
    pub(crate) incoming: Incoming,
    pub(crate) actions: ActionServer,
    pub(crate) parameters: Parameters,
    pub(crate) parameter_services: ParameterServices,
    pub(crate) diagnostics: Publisher<DiagnosticArray>,
    pub(crate) presence: Presence,
    pub(crate) heartbeat: Heartbeat,
    pub(crate) senses: Senses,
    pub(crate) navigation: Navigation,
    pub(crate) diagnosed: Duration,
    pub(crate) fed_back: Duration,
}

impl Receiving<'_> {
    /// Goes on until the node ends.
    pub(crate) fn run(mut self) {
        while !self.hub.is_ending() {
            self.entities.wait(WAIT);
            self.receive();
            self.serve();
            self.tell();
        }
        let ended = self
            .navigation
            .end(End::Aborted(Outcome { code: code::SHUTDOWN, text: "the node is ending".to_owned() }));
        self.end(ended);
    }

    fn receive(&mut self) {
        let (hub, incoming, senses) = (self.hub, &self.incoming, &mut self.senses);
        if let Some(clock) = &incoming.clock {
            each(hub, clock, "clock", |message| hub.set_clock(message.clock));
        }
        each(hub, &incoming.emergency_stop, "emergency stop", |message| {
            let told = || Content::EmergencyStop(message);
            hub.tell_of(hub.arrival(), told, |inputs| inputs.hear_emergency_stop(message.data));
        });
        each(hub, &incoming.reset, "reset", |message| {
            hub.tell_of(hub.arrival(), || Content::Reset(message), |inputs| inputs.reset |= message.data);
        });
        each(hub, &incoming.imu, "IMU", |message| senses.take_imu(hub, &message));
        each(hub, &incoming.odometry, "odometry", |message| senses.take_odometry(hub, &message));
        if let Some(scan) = &incoming.scan {
            each(hub, scan, "scan", |message| senses.take_scan(hub, &message));
        }
        if let Some(revolution) = hub.revolution.take(Duration::ZERO) {
            senses.take_revolution(hub, revolution);
        }
        if self.heartbeat.beat() {
            hub.beat();
        }
        if self.heartbeat.is_silent() {
            hub.complain("heartbeat", "the node does not hear itself: what it publishes may not leave");
        }
        self.presence.look(&self.entities.participant);
        let (readers, writers) = (self.presence.readers, self.presence.writers);
        hub.tell(|inputs| (inputs.has_peer, inputs.other_publishers) = (readers > 0, writers));
    }

    /// Goals by action and by topic, what takes them back, and what ends them.
    fn serve(&mut self) {
        while let Some((request, id, goal)) = self.actions.asked() {
            match self.goal(&goal.pose) {
                Ok(goal) => {
                    self.actions.accept(request, id);
                    let before = self.navigation.accept(goal, Some(id), self.hub.now());
                    self.end(before);
                }
                Err(reason) => {
                    self.hub.complain("goal", &reason);
                    self.actions.refuse(request);
                }
            }
        }
        let mut poses = Vec::new();
        each(self.hub, &self.incoming.goal_pose, "goal", |pose| poses.push(pose));
        for pose in poses {
            self.hub.record(|| Content::GoalPose(pose.clone()));
            match self.goal(&pose) {
                Ok(goal) => {
                    let before = self.navigation.accept(goal, None, self.hub.now());
                    self.end(before);
                }
                Err(reason) => self.hub.complain("goal", &reason),
            }
        }
        for id in self.actions.take_cancels() {
            if self.navigation.pursues(id) {
                let ended = self.navigation.end(End::Canceled);
                self.end(ended);
            }
        }
        if let (Some(decision), Some(task)) = (self.hub.decision(), self.navigation.task()) {
            let status = self.hub.planned_for(task).map(|planned| planned.status);
            let ended = self.navigation.check(&decision, status, self.hub.now());
            self.end(ended);
        }
        self.actions.answer_results();
        self.configure();
    }

    /// Parameters that are asked for and set; who needs to know of a change is told.
    fn configure(&mut self) {
        let before = self.parameters.clone();
        let is_pursuing = self.navigation.task().is_some();
        self.parameter_services.serve(&mut self.parameters, is_pursuing, self.hub.stamp());
        let Parameters { planner, supervisor, navigation, .. } = &self.parameters;
        if *planner != before.planner {
            self.hub.planner.put(planner.clone());
        }
        if *supervisor != before.supervisor {
            self.hub.limits.put(*supervisor);
        }
        self.navigation.set_timeout(Duration::from_secs_f64(navigation.timeout_s));
    }

    /// Ends a goal for the one who gave it, and lets the others know what is pursued now.
    fn end(&mut self, ended: Option<Ended>) {
        self.hub.set_task(self.navigation.task());
        let Some((id, how)) = ended else { return };
        log::info!("a goal ended: {how:?}");
        if let Some(id) = id {
            self.actions.end(id, how);
        }
    }

    /// The goal of a message, or why it is refused.
    fn goal(&self, pose: &PoseStamped) -> Result<Goal, String> {
        let (decision, poses) = (self.hub.decision(), self.hub.poses());
        let has_final_heading = self.parameters.navigation.final_heading;
        goal_of(pose, &self.config.drive.frames.odom, decision.as_ref(), poses, has_final_heading)
    }

    fn tell(&mut self) {
        let now = self.hub.now();
        if now >= self.diagnosed + DIAGNOSE_EVERY {
            self.diagnosed = now;
            if let Err(error) = self.diagnostics.publish(diagnose(self.hub, self.config)) {
                log::warn!("diagnostics could not be published: {error}");
            }
        }
        let feedback_every = Duration::from_secs_f64(1.0 / self.parameters.navigation.feedback_hz);
        if now >= self.fed_back + feedback_every {
            self.fed_back = now;
            self.feed_back(now);
        }
    }

    fn feed_back(&self, now: Duration) {
        let (Some((task, id)), Some([believed, told])) = (self.navigation.action(), self.hub.poses()) else {
            return;
        };
        let distance_m = (task.goal.position_m - believed.plan_m()).length();
        let speed_m_s = self.parameters.supervisor.max_speed_m_s;
        let mut current_pose = PoseStamped {
            header: Header { stamp: self.hub.stamp(), frame_id: self.config.drive.frames.odom.clone() },
            ..PoseStamped::default()
        };
        current_pose.pose.position = told.position_m.into();
        current_pose.pose.orientation = Quaternion::from_yaw(told.yaw_rad);
        self.actions.publish_feedback(
            id,
            Feedback {
                current_pose,
                navigation_time: self.navigation.pursued_for(now).into(),
                estimated_time_remaining: Duration::from_secs_f64((distance_m / speed_m_s).min(1e6)).into(),
                number_of_recoveries: self.hub.planned_for(task).map_or(0, |planned| planned.recoveries),
                distance_remaining: distance_m as f32,
            },
        );
    }
}

/// Takes every message that waits.
fn each<M: DeserializeOwned + 'static>(
    hub: &Hub,
    subscription: &Subscription<M>,
    what: &'static str,
    mut take: impl FnMut(M),
) {
    loop {
        match subscription.take() {
            Ok(Some((message, _))) => take(message),
            Ok(None) => return,
            Err(error) => hub.complain(what, &error),
        }
    }
}
