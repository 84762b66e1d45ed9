//! What the supervisor is told at each tick, and what it answers.

use core::time::Duration;

use mapless::{Command, Status, Step};

use crate::messages::Time;

use super::reason::Reason;
use super::states::State;

/// A message of scan, odometry or IMU, as far as the supervisor looks at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Message {
    /// When it arrived, on the clock of the ticks.
    pub arrived: Duration,
    /// What the robot's clock (in ROS: the node's, simulated or not) said then, nanoseconds.
    pub clock_ns: i64,
    /// Its stamp, nanoseconds. Sensors' clocks lie, so it only orders messages and tells changes of their
    /// delay.
    pub stamp_ns: i64,
    /// A digest of its content without stamp and counters: equal for equal content.
    pub fingerprint: u64,
    /// Whether it could be read, and its numbers are finite and its frame is right.
    pub is_well_formed: bool,
}

/// What happened since the last tick, and what is so now. Of several messages the newest counts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inputs {
    /// The scan that came.
    pub scan: Option<Message>,
    /// The odometry that came.
    pub odometry: Option<Message>,
    /// The message of the IMU that came.
    pub imu: Option<Message>,
    /// Whether the emergency stop is pressed, if it told.
    pub emergency_stop: Option<bool>,
    /// The simulation's clock, if it told.
    pub clock: Option<Duration>,
    /// Roll and pitch now, radians; `None` until the estimator has them.
    pub attitude_rad: Option<[f64; 2]>,
    /// The estimator saw the position or heading jump since the last tick.
    pub has_jumped: bool,
    /// The estimator finds that wheels and IMU disagree.
    pub wheels_disagree: bool,
    /// Whether a peer takes the commands.
    pub has_peer: bool,
    /// A command could not be published since the last tick.
    pub publish_failed: bool,
    /// Others that publish on the topic of the commands.
    pub other_publishers: usize,
    /// The goal that was accepted last, numbered upwards; `None` when there is none.
    pub goal: Option<u64>,
    /// Somebody asked for a reset since the last tick.
    pub reset: bool,
}

impl Inputs {
    /// The emergency stop tells whether it is pressed. Pressed once is pressed, even if it is released before
    /// the next tick.
    pub fn hear_emergency_stop(&mut self, is_pressed: bool) {
        self.emergency_stop = Some(self.emergency_stop == Some(true) || is_pressed);
    }

    /// A scan was spoilt on its way. A good one that the supervisor does not know yet stays.
    pub fn hear_spoilt_scan(&mut self, arrived: Duration, clock_ns: i64) {
        self.scan.get_or_insert(Message {
            arrived,
            clock_ns,
            stamp_ns: 0,
            fingerprint: 0,
            is_well_formed: false,
        });
    }

    /// The simulation's clock tells the time.
    pub fn hear_clock(&mut self, time: Time) {
        self.clock = u64::try_from(time.nanoseconds()).ok().map(Duration::from_nanos);
    }

    /// What was told since this was last asked. Messages and events are told once; what is so stays.
    pub fn take(&mut self) -> Self {
        let taken = *self;
        *self = Self {
            attitude_rad: taken.attitude_rad,
            wheels_disagree: taken.wheels_disagree,
            has_peer: taken.has_peer,
            other_publishers: taken.other_publishers,
            goal: taken.goal,
            ..Self::default()
        };
        taken
    }
}

/// What the planner made of a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal {
    /// The goal that it pursues, as in [`Inputs::goal`].
    pub goal: u64,
    /// When its scan arrived: [`Message::arrived`].
    pub scan_arrived: Duration,
    /// What came out.
    pub outcome: Outcome,
}

/// How a step of the planner ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// With a command.
    Command(Command),
    /// With a stop of its own.
    Stopped,
    /// In a panic.
    Panicked,
}

impl From<&Step<'_>> for Outcome {
    fn from(step: &Step<'_>) -> Self {
        match step.status {
            Status::Stopped(_) => Self::Stopped,
            Status::Driving | Status::Arrived | Status::Backtracking | Status::Searching => {
                Self::Command(step.command)
            }
        }
    }
}

/// The answer to a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// The command to publish: zero in every state but [`State::Driving`].
    pub command: Command,
    /// The state.
    pub state: State,
    /// Why the robot was stopped; `None` in standby and while driving.
    pub reason: Option<Reason>,
    /// What is wrong at this moment; a stop outlasts it.
    pub cause: Option<Reason>,
    /// Whether a goal that is accepted now will be pursued. In another state, or with a cause, refuse it with
    /// the reason.
    pub takes_goals: bool,
}
