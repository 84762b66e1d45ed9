//! Driving estimator, motion compensation, supervisor and planner with a recording.

mod comparison;
mod faults;
mod foreign;
mod moment;
mod report;
mod settings;

use core::time::Duration;
use std::collections::VecDeque;
use std::io::Read;
use std::rc::Rc;

use mapless::glam::DVec2;
use mapless::{Pose, Status};
use mapless_robot::drive_config::DriveConfig;
use mapless_robot::messages::{Point, PoseStamped};
use mapless_robot::navigation::{Navigation, Task};
use mapless_robot::pilot::{Answer, Pilot};
use mapless_robot::senses::{Heard, Scan, Senses};
use mapless_robot::supervisor::{Decision, Inputs, Proposal, Supervisor};

use crate::entry::{Content, Entry};
use crate::error::{Fault, RecordingError};
use crate::head::Head;
use crate::message::{AnswerMessage, TickMessage, nanoseconds};
use crate::reader::Reader;
use crate::topics::{Role, TopicNames};

use comparison::Comparison;
pub use comparison::Difference;
pub use faults::{FaultKind, Faults, InjectedFault};
pub use moment::{Moment, Seen};
pub use report::{News, Report};

/// Of a file without recorded ticks, the supervisor ticks this often: 50 Hz, as in the node.
const PERIOD: Duration = Duration::from_millis(20);
/// After a longer gap the recording's clock was set, or nothing was recorded.
const LONGEST_GAP: Duration = Duration::from_secs(1);
/// Scans and answers that may still be asked for: the planner takes the newest within a second.
const KEPT: usize = 32;

/// What a replay is told besides the file.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Topics whose roles do not follow from their types.
    pub topics: TopicNames,
    /// Values in place of those of the configuration, as `planner.goal_tolerance_m=2`.
    pub settings: Vec<String>,
    /// A goal from the begin on, in the odometry's frame, metres; for files without any.
    pub goal_m: Option<DVec2>,
    /// What goes wrong beyond what went wrong on the robot.
    pub faults: Vec<InjectedFault>,
}

/// Replays a recording; `tell` hears what happens as it happens.
///
/// # Errors
/// [`RecordingError`] with the place in the file and what was expected there.
pub fn replay(
    file: impl Read,
    options: &Options,
    mut tell: impl FnMut(&News),
) -> Result<Report, RecordingError> {
    let mut reader = Reader::new(file, options.topics.clone())?;
    let mut replay = None;
    while let Some(entry) = reader.next_entry()? {
        if replay.is_none() {
            let new = Replay::new(reader.head(), options);
            replay = Some(new.map_err(|fault| reader.error(fault))?);
        }
        if let Some(replay) = &mut replay {
            replay.take(&entry, &mut tell).map_err(|fault| reader.error(fault))?;
        }
    }
    for role in Role::SENSORS {
        if !reader.topics().contains_key(&role) && !reader.is_cut() {
            return Err(reader.error(Fault::Needed { role: role.name(), schema: role.schema() }));
        }
    }
    let mut report = replay.as_ref().map_or_else(Report::default, Replay::report);
    if reader.head().is_none() && report.goals == 0 && options.goal_m.is_none() {
        return Err(reader.error(Fault::NoGoal));
    }
    report.is_cut = reader.is_cut();
    Ok(report)
}

/// The node's parts without its threads, and what they decided.
///
/// A recording of the node tells when its threads took what: the supervisor's ticks and the planner's scans
/// are those of the recording. For other files the supervisor ticks at 50 Hz, and the planner answers every
/// scan at once.
#[derive(Clone, Debug)]
pub(crate) struct Replay {
    config: DriveConfig,
    settings: Vec<String>,
    faults: Faults,
    has_schedule: bool,
    senses: Senses,
    pilot: Pilot,
    supervisor: Supervisor,
    inputs: Inputs,
    scans: VecDeque<Rc<Scan>>,
    /// The scan that came last, and the one that the planner answered last with the number of its goal.
    newest: Option<Rc<Scan>>,
    answered: Option<(Rc<Scan>, u64)>,
    /// When the planner last answered, or a scan came that it had no goal for.
    looked: Option<Duration>,
    proposals: VecDeque<Proposal>,
    task: Option<Task>,
    /// Those before, too: a goal may change while the planner works for the last one.
    tasks: VecDeque<Task>,
    /// Of a file without a schedule:
    navigation: Navigation<()>,
    asked: Option<PoseStamped>,
    has_jumped: bool,
    poses: Option<[Pose; 2]>,
    decision: Option<Decision>,
    status: Option<Status>,
    due: Duration,
    odom: Option<String>,
    comparison: Comparison,
    report: Report,
}

impl Replay {
    /// Parts that have heard nothing. A head says that the entries tell when the threads took what.
    ///
    /// # Errors
    /// A value of the configuration that makes no sense.
    pub(crate) fn new(head: Option<&Head>, options: &Options) -> Result<Self, Fault> {
        let config = settings::config(head.map(|head| &head.config), &options.settings)?;
        let has_schedule = head.is_some();
        let asked = options.goal_m.map(|goal_m| {
            let mut pose = PoseStamped::default();
            pose.header.frame_id.clone_from(&config.frames.odom);
            pose.pose.position = Point { x: goal_m.x, y: goal_m.y, z: 0.0 };
            pose
        });
        Ok(Self {
            settings: options.settings.clone(),
            faults: Faults(options.faults.clone()),
            has_schedule,
            senses: config.senses()?,
            pilot: Pilot::new(config.planner.clone())?,
            supervisor: Supervisor::new(config.supervisor)?,
            inputs: Inputs::default(),
            scans: VecDeque::new(),
            newest: None,
            answered: None,
            looked: None,
            proposals: VecDeque::new(),
            task: None,
            tasks: VecDeque::new(),
            navigation: Navigation::new(Duration::from_secs_f64(config.navigation.timeout_s)),
            asked,
            has_jumped: false,
            poses: None,
            decision: None,
            status: None,
            due: Duration::ZERO,
            odom: None,
            comparison: Comparison::default(),
            report: Report { has_decisions: has_schedule, ..Report::default() },
            config,
        })
    }

    /// The supervisor's ticks up to a time. As in the node, those that were missed are not made up.
    fn tick_until(&mut self, at: Duration, tell: &mut dyn FnMut(&News)) {
        if self.due + LONGEST_GAP < at {
            self.due = at;
        }
        while self.due <= at {
            self.tick_freely(self.due, tell);
            self.due += PERIOD;
        }
    }

    /// Takes the next entry.
    ///
    /// # Errors
    /// A configuration that makes no sense.
    pub(crate) fn take(&mut self, entry: &Entry, tell: &mut dyn FnMut(&News)) -> Result<(), Fault> {
        let at = entry.arrival.at;
        if !self.has_schedule {
            self.tick_until(at, tell);
        }
        if at + LONGEST_GAP < self.report.until {
            let (at_s, until_s) = (at.as_secs_f64(), self.report.until.as_secs_f64());
            let complaint = format!(
                "a message at {at_s:.3} s after one at {until_s:.3} s: expected a clock that is not set back"
            );
            self.report.complain("time", &complaint);
        }
        self.report.until = self.report.until.max(at);
        let Some(entry) = self.faults.message(entry) else { return Ok(()) };
        match &entry.content {
            Content::Scan(cloud) if self.has_schedule => {
                let heard = self.senses.take_scan(entry.arrival, cloud);
                self.hear(heard);
            }
            Content::Odometry(odometry) if self.has_schedule => {
                let heard = self.senses.take_odometry(entry.arrival, odometry);
                self.hear(heard);
            }
            Content::Imu(imu) if self.has_schedule => {
                let heard = self.senses.take_imu(entry.arrival, imu);
                self.hear(heard);
            }
            Content::Scan(_) | Content::Odometry(_) | Content::Imu(_) => self.take_foreign(&entry),
            Content::EmergencyStop(message) => self.inputs.hear_emergency_stop(message.data),
            Content::Reset(message) => self.inputs.reset |= message.data,
            Content::Clock(message) => self.inputs.hear_clock(message.clock),
            Content::GoalPose(pose) => {
                self.report.goals += 1;
                if !self.has_schedule {
                    self.ask(pose.clone());
                }
            }
            Content::Goal(goal) => {
                self.task = goal.task();
                keep(&mut self.tasks, self.task);
                self.inputs.goal = self.task.map(|task| task.number);
            }
            Content::Tick(recorded) => self.tick(at, recorded, tell),
            Content::Answer(recorded) => self.answer(at, recorded, tell),
            Content::Spoilt(spoilt) => {
                self.report.complain("packets", &spoilt.why);
                self.inputs.hear_spoilt_scan(at, entry.arrival.clock_ns);
            }
            Content::Limits(limits) => {
                self.configure(DriveConfig { supervisor: **limits, ..self.config.clone() })?;
                self.supervisor.limit(&self.config.supervisor)?;
            }
            Content::Planner(planner) => {
                self.configure(DriveConfig { planner: (**planner).clone(), ..self.config.clone() })?;
                self.pilot.configure(self.config.planner.clone())?;
                self.answered = None;
            }
            Content::Lost(lost) => self.report.lost += u64::from(lost.entries),
        }
        Ok(())
    }

    /// Another configuration; what is set for the replay stays.
    fn configure(&mut self, config: DriveConfig) -> Result<(), Fault> {
        self.config = settings::config(Some(&config), &self.settings)?;
        Ok(())
    }

    fn hear(&mut self, heard: Heard) {
        for (what, complaint) in &heard.complaints {
            self.report.complain(what, complaint);
        }
        heard.tell(&mut self.inputs);
        self.has_jumped |= heard.jump.is_some();
        self.poses = heard.poses.or(self.poses);
        if let Some(scan) = heard.scan.map(Rc::new) {
            if self.task.is_none() {
                self.looked = Some(scan.arrived);
            }
            self.newest = Some(Rc::clone(&scan));
            keep(&mut self.scans, Some(scan));
        }
    }

    /// A tick of the recording.
    fn tick(&mut self, at: Duration, recorded: &TickMessage, tell: &mut dyn FnMut(&News)) {
        self.inputs.has_peer = recorded.has_peer;
        self.inputs.publish_failed = recorded.publish_failed;
        self.inputs.other_publishers = recorded.other_publishers as usize;
        let is_it = |proposal: &&Proposal| nanoseconds(proposal.scan_arrived) == recorded.answered_scan_ns;
        let mut proposal = self.proposals.iter().find(is_it).copied();
        if !self.faults.tick(at, &mut self.inputs, &mut proposal) {
            return;
        }
        let inputs = self.inputs.take();
        let decision = self.supervisor.tick(at, &inputs, proposal.as_ref());
        let mut replayed = TickMessage::new(&inputs, proposal.as_ref(), &decision);
        // What the planner did not answer here is told about the answer.
        replayed.answered_scan_ns = recorded.answered_scan_ns;
        self.report.ticks += 1;
        self.report.tell_change(at, &decision, tell);
        self.decision = Some(decision);
        if let Some(difference) = self.comparison.tick(at, Some(recorded), &replayed) {
            self.report.different_ticks += 1;
            tell(&News::Difference(difference));
        }
    }

    /// An answer of the recording.
    fn answer(&mut self, at: Duration, recorded: &AnswerMessage, tell: &mut dyn FnMut(&News)) {
        self.report.answers += 1;
        while self.scans.front().is_some_and(|scan| nanoseconds(scan.arrived) < recorded.scan_ns) {
            self.scans.pop_front();
        }
        let is_there = self.scans.front().is_some_and(|scan| nanoseconds(scan.arrived) == recorded.scan_ns);
        let scan = if is_there { self.scans.pop_front() } else { None };
        let task = self.tasks.iter().find(|task| task.number == recorded.goal).copied();
        let replayed = scan.zip(task).map(|(scan, task)| {
            let answer = self.pilot.answer(&scan, task, recorded.has_jumped);
            keep(&mut self.proposals, Some(answer.proposal));
            self.looked(&answer, scan, at);
            AnswerMessage::new(&answer, recorded.has_jumped)
        });
        if let Some(difference) = self.comparison.answer(at, Some(recorded), replayed.as_ref()) {
            self.report.different_answers += 1;
            tell(&News::Difference(difference));
        }
    }

    /// The planner answered a scan; after a panic it knows nothing of it any more.
    fn looked(&mut self, answer: &Answer, scan: Rc<Scan>, at: Duration) {
        self.answered = answer.status.is_some().then_some((scan, answer.proposal.goal));
        self.looked = Some(at);
    }

    /// What was decided so far.
    pub(crate) fn report(&self) -> Report {
        Report {
            digest: self.comparison.replayed_digest(),
            recorded_digest: self.has_schedule.then(|| self.comparison.recorded_digest()),
            ..self.report.clone()
        }
    }
}

/// Adds the newest; the oldest is forgotten once there are many.
fn keep<T>(kept: &mut VecDeque<T>, newest: Option<T>) {
    kept.extend(newest);
    if kept.len() > KEPT {
        kept.pop_front();
    }
}
