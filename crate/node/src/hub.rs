//! What the threads share: single-slot mailboxes, and a few values that are locked for moments.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use mapless::{PlannerConfig, Pose, Status};
use mapless_recording::{Content, Entry, GoalMessage, TickMessage};
use mapless_robot::senses::{Arrival, Scan};
use mapless_robot::supervisor::{Decision, Inputs, Proposal, Supervisor, SupervisorConfig};

use crate::clock::NodeClock;
use crate::messages::{Clock, PointCloud2, Time};
use crate::navigation::Task;
use crate::recorder::Recorder;
use crate::slot::{Slot, lock};

/// A revolution of a sensor that sends packets.
#[derive(Debug)]
pub(crate) struct Revolution {
    /// When its last packet arrived.
    pub(crate) arrival: Arrival,
    /// Its returns, stamped by the sensor's clock.
    pub(crate) cloud: PointCloud2,
}

/// What the planner last made of a scan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planned {
    /// The goal that it was for.
    pub(crate) goal: u64,
    /// What came out.
    pub(crate) status: Status,
    /// Times it began to backtrack or to search since the goal was given.
    pub(crate) recoveries: i16,
    /// Time that the step took.
    pub(crate) took: Duration,
}

/// What was last wrong with a kind of message.
#[derive(Debug)]
struct Complaint {
    text: String,
    at: Duration,
    logged: Duration,
}

/// A complaint is logged once in this time, and forgotten after it.
const COMPLAIN_EVERY: Duration = Duration::from_secs(5);

/// What the threads share.
#[derive(Debug)]
pub(crate) struct Hub {
    clock: NodeClock,
    is_ending: AtomicBool,
    has_jumped: AtomicBool,
    has_beaten: AtomicBool,
    /// From the LiDAR, if it sends packets, to the middleware.
    pub(crate) revolution: Slot<Revolution>,
    /// From the middleware to the planner.
    pub(crate) scan: Slot<Scan>,
    /// From the planner to the supervisor.
    pub(crate) proposal: Slot<Proposal>,
    /// New limits for the supervisor, and another configuration for the planner.
    pub(crate) limits: Slot<SupervisorConfig>,
    pub(crate) planner: Slot<PlannerConfig>,
    inputs: Mutex<Inputs>,
    decision: Mutex<Option<Decision>>,
    planned: Mutex<Option<Planned>>,
    slowest: Mutex<Option<Duration>>,
    task: Mutex<Option<Task>>,
    /// The pose that the estimator believes, and that of the last odometry.
    poses: Mutex<Option<[Pose; 2]>>,
    complaints: Mutex<BTreeMap<&'static str, Complaint>>,
    /// Where everything is left that a replay needs, in the order in which it takes effect.
    pub(crate) recorder: Option<Recorder>,
}

impl Hub {
    /// Without any message; with `use_sim_time`, time is that of the simulation's clock.
    pub(crate) fn new(use_sim_time: bool) -> Self {
        Self {
            clock: NodeClock::new(use_sim_time),
            is_ending: AtomicBool::new(false),
            has_jumped: AtomicBool::new(false),
            has_beaten: AtomicBool::new(false),
            revolution: Slot::default(),
            scan: Slot::default(),
            proposal: Slot::default(),
            limits: Slot::default(),
            planner: Slot::default(),
            inputs: Mutex::default(),
            decision: Mutex::default(),
            planned: Mutex::default(),
            slowest: Mutex::default(),
            task: Mutex::default(),
            poses: Mutex::default(),
            complaints: Mutex::default(),
            recorder: None,
        }
    }

    /// Monotonic time since the node began; nothing else measures ages.
    pub(crate) fn now(&self) -> Duration {
        self.clock.now()
    }

    /// How long to wait, on the system's clock, before it is looked again whether it is `due`.
    pub(crate) fn wait_for(&self, due: Duration) -> Duration {
        self.clock.wait_for(due)
    }

    /// When the node began, on the system's clock, nanoseconds.
    pub(crate) fn began_ns(&self) -> u64 {
        self.clock.began_ns()
    }

    /// The stamp of what is sent now.
    pub(crate) fn stamp(&self) -> Time {
        self.clock.stamp()
    }

    /// A message arrives now.
    pub(crate) fn arrival(&self) -> Arrival {
        Arrival { at: self.now(), clock_ns: self.stamp().nanoseconds() }
    }

    /// The simulation's clock says this.
    pub(crate) fn set_clock(&self, time: Time) {
        self.clock.set(time);
        let told = || Content::Clock(Clock { clock: time });
        self.tell_of(self.arrival(), told, |inputs| inputs.hear_clock(time));
    }

    /// The localisation jumped: what the planner remembers of the ground lies elsewhere now. The supervisor
    /// is told by the message that showed it.
    pub(crate) fn jump(&self) {
        self.has_jumped.store(true, Ordering::Relaxed);
    }

    /// Whether the localisation jumped since this was last asked.
    pub(crate) fn take_jump(&self) -> bool {
        self.has_jumped.swap(false, Ordering::Relaxed)
    }

    /// The node heard itself: what it publishes leaves.
    pub(crate) fn beat(&self) {
        self.has_beaten.store(true, Ordering::Relaxed);
    }

    /// Whether the node heard itself since this was last asked.
    pub(crate) fn take_beat(&self) -> bool {
        self.has_beaten.swap(false, Ordering::Relaxed)
    }

    /// Asks every thread to end.
    pub(crate) fn end(&self) {
        self.is_ending.store(true, Ordering::Relaxed);
    }

    /// Whether the threads are to end.
    pub(crate) fn is_ending(&self) -> bool {
        self.is_ending.load(Ordering::Relaxed)
    }

    /// Tells the supervisor something.
    pub(crate) fn tell(&self, change: impl FnOnce(&mut Inputs)) {
        change(&mut lock(&self.inputs));
    }

    /// Tells the supervisor something that is recorded.
    pub(crate) fn tell_of(
        &self,
        arrival: Arrival,
        content: impl FnOnce() -> Content,
        change: impl FnOnce(&mut Inputs),
    ) {
        let entry = self.recorder.as_ref().map(|recorder| (recorder, Entry { arrival, content: content() }));
        let mut inputs = lock(&self.inputs);
        change(&mut inputs);
        if let Some((recorder, entry)) = entry {
            recorder.record(entry);
        }
    }

    /// Records something that the supervisor is not told.
    pub(crate) fn record(&self, content: impl FnOnce() -> Content) {
        if let Some(recorder) = &self.recorder {
            recorder.record(Entry { arrival: self.arrival(), content: content() });
        }
    }

    /// A tick of the supervisor with what it was told since the last one.
    pub(crate) fn tick(
        &self,
        now: Duration,
        supervisor: &mut Supervisor,
        proposal: Option<&Proposal>,
    ) -> Decision {
        let arrival = Arrival { at: now, clock_ns: self.stamp().nanoseconds() };
        // Nothing is told in between, so a replay knows what was told before.
        let mut inputs = lock(&self.inputs);
        let taken = inputs.take();
        let decision = supervisor.tick(now, &taken, proposal);
        if let Some(recorder) = &self.recorder {
            let content = Content::Tick(TickMessage::new(&taken, proposal, &decision));
            recorder.record(Entry { arrival, content });
        }
        decision
    }

    /// The supervisor's last decision; `None` before the first.
    pub(crate) fn decision(&self) -> Option<Decision> {
        *lock(&self.decision)
    }

    /// Publishes a decision to the other threads.
    pub(crate) fn decide(&self, decision: Decision) {
        *lock(&self.decision) = Some(decision);
    }

    /// The planner's last answer.
    pub(crate) fn planned(&self) -> Option<Planned> {
        *lock(&self.planned)
    }

    /// The planner's last answer, if it was for this goal.
    pub(crate) fn planned_for(&self, task: Task) -> Option<Planned> {
        self.planned().filter(|planned| planned.goal == task.number)
    }

    /// Publishes an answer of the planner to the other threads.
    pub(crate) fn plan(&self, planned: Planned) {
        *lock(&self.planned) = Some(planned);
    }

    /// A scan that arrived then was answered by a command that is published now.
    pub(crate) fn note_answer(&self, scan_arrived: Duration) {
        let took = self.now().saturating_sub(scan_arrived);
        let mut slowest = lock(&self.slowest);
        *slowest = (*slowest).max(Some(took));
    }

    /// From a scan's arrival to its command: the longest time since this was asked last.
    pub(crate) fn take_slowest_answer(&self) -> Option<Duration> {
        lock(&self.slowest).take()
    }

    /// Where the robot is, in the estimator's frame and in the odometry's; `None` until odometry and IMU
    /// came.
    pub(crate) fn poses(&self) -> Option<[Pose; 2]> {
        *lock(&self.poses)
    }

    /// Publishes the poses to the other threads: the estimator's, and the odometry's.
    pub(crate) fn set_poses(&self, believed: Pose, told: Pose) {
        *lock(&self.poses) = Some([believed, told]);
    }

    /// Something is wrong with a message about `what`. It is logged now and then, and told in diagnostics.
    pub(crate) fn complain(&self, what: &'static str, error: &(impl Display + ?Sized)) {
        let (text, at) = (error.to_string(), self.now());
        let mut complaints = lock(&self.complaints);
        let last = complaints.get(what).map(|complaint| complaint.logged);
        let logged = last.filter(|last| at.saturating_sub(*last) < COMPLAIN_EVERY).unwrap_or(at);
        if logged == at {
            log::warn!("{what}: {text}");
        }
        complaints.insert(what, Complaint { text, at, logged });
    }

    /// What was complained of lately.
    pub(crate) fn complaints(&self) -> Vec<(&'static str, String)> {
        let now = self.now();
        let mut complaints = lock(&self.complaints);
        complaints.retain(|_, complaint| now.saturating_sub(complaint.at) < COMPLAIN_EVERY);
        complaints.iter().map(|(what, complaint)| (*what, complaint.text.clone())).collect()
    }

    /// The goal in service.
    pub(crate) fn task(&self) -> Option<Task> {
        *lock(&self.task)
    }

    /// Sets or ends the goal in service, for planner and supervisor alike.
    pub(crate) fn set_task(&self, task: Option<Task>) {
        if self.task() == task {
            return;
        }
        let told = || Content::Goal(GoalMessage::new(task.as_ref()));
        self.tell_of(self.arrival(), told, |inputs| inputs.goal = task.map(|task| task.number));
        *lock(&self.task) = task;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless::Goal;
    use mapless::glam::DVec2;

    #[test]
    fn events_are_told_once_and_what_is_so_stays() {
        let hub = Hub::new(false);
        hub.tell(|inputs| {
            (inputs.has_jumped, inputs.reset, inputs.publish_failed) = (true, true, true);
            (inputs.has_peer, inputs.other_publishers, inputs.attitude_rad) = (true, 2, Some([0.1, 0.2]));
            inputs.emergency_stop = Some(true);
            inputs.wheels_disagree = true;
        });
        let told = lock(&hub.inputs).take();
        assert!(told.has_jumped && told.reset && told.publish_failed && told.emergency_stop == Some(true));
        let later = lock(&hub.inputs).take();
        assert!(!later.has_jumped && !later.reset && !later.publish_failed && later.emergency_stop.is_none());
        assert!(later.has_peer && later.other_publishers == 2 && later.attitude_rad == Some([0.1, 0.2]));
        assert!(later.wheels_disagree, "the estimator finds so until its next word");
    }

    #[test]
    fn an_answer_for_one_goal_is_none_for_the_next() {
        let hub = Hub::new(false);
        let task = |number| Task { number, goal: Goal::at(DVec2::X) };
        hub.plan(Planned { goal: 1, status: Status::Searching, recoveries: 3, took: Duration::ZERO });
        assert_eq!(hub.planned_for(task(1)).map(|planned| planned.recoveries), Some(3));
        assert!(hub.planned_for(task(2)).is_none());
    }
}
