//! The supervisor: decides at each tick whether the robot may move.
//!
//! [`Supervisor::tick`] takes what happened since the last tick, looks for causes to stop, changes its
//! [`State`] by [`TRANSITIONS`] and lets the planner's command pass in [`State::Driving`] alone, within the
//! limits of [`SupervisorConfig`]. In every other state the command is zero, at once: the limits on
//! acceleration and jerk bind the commands while driving, and no stop. Call it at 50 Hz and publish each
//! command; nobody else may.
//!
//! A cause that clears by itself pauses: the goal is pursued further after `clear_after_s` in order. One
//! that needs a new goal aborts, and one that needs a reset latches: both make the goal void, and every goal
//! that is given before all has cleared, so nothing but a later goal moves the robot again.

mod config;
mod input;
mod limiter;
mod reason;
mod states;
mod stream;

use core::time::Duration;

use mapless::Command;
use mapless_parameters::ConfigError;

pub use config::SupervisorConfig;
pub use input::{Decision, Inputs, Message, Outcome, Proposal};
pub use reason::{Defect, Reason};
pub use states::{Event, State, TRANSITIONS, diagram};

use limiter::Limiter;
use stream::{Stream, seconds_since};

/// Commands above these are to move the robot: what it senses should change.
const MOVING_M_S: f64 = 0.1;
const MOVING_RAD_S: f64 = 0.1;

/// Decides whether the robot may move.
#[derive(Clone, Debug)]
pub struct Supervisor {
    config: SupervisorConfig,
    state: State,
    reason: Option<Reason>,
    scan: Stream,
    odometry: Stream,
    imu: Stream,
    linear: Limiter,
    angular: Limiter,
    command: Command,
    /// The last tick.
    ticked: Option<Duration>,
    /// Since when everything is in order.
    in_order_since: Option<Duration>,
    is_pressed: bool,
    told_of_emergency_stop: Option<Duration>,
    clock: Option<Duration>,
    clock_moved: Option<Duration>,
    had_peer: Option<Duration>,
    goal: Option<u64>,
    /// Goals up to this number are void.
    void_goal: Option<u64>,
    /// What the planner last answered for the goal.
    outcome: Option<Outcome>,
    /// The newest good scan, and the oldest that the planner did not answer.
    newest_scan: Duration,
    unanswered_scan: Option<Duration>,
}

impl Supervisor {
    /// A supervisor that has heard nothing: it starts in [`State::Paused`].
    ///
    /// # Errors
    /// [`ConfigError`] for a limit that makes no sense.
    pub fn new(config: SupervisorConfig) -> Result<Self, ConfigError> {
        config.validate("supervisor")?;
        let stream = |limit_s, frozen_s| Stream::new([limit_s, frozen_s, config.future_s]);
        Ok(Self {
            state: State::Paused,
            reason: Some(Reason::Starting),
            scan: stream(config.scan_s, config.scan_s),
            odometry: stream(config.odometry_s, config.frozen_s),
            imu: stream(config.imu_s, config.frozen_s),
            linear: Limiter::new(config.linear()),
            angular: Limiter::new(config.angular()),
            command: Command::STOP,
            ticked: None,
            in_order_since: None,
            is_pressed: false,
            told_of_emergency_stop: None,
            clock: None,
            clock_moved: None,
            had_peer: None,
            goal: None,
            void_goal: None,
            outcome: None,
            newest_scan: Duration::ZERO,
            unanswered_scan: None,
            config,
        })
    }

    /// One tick at `now`, on a monotonic clock that begins anywhere. `proposal` is what the planner finished
    /// since the last tick.
    pub fn tick(&mut self, now: Duration, inputs: &Inputs, proposal: Option<&Proposal>) -> Decision {
        let elapsed_s = self.ticked.map_or(0.0, |last| seconds_since(now, last));
        let mut causes = Causes::default();
        causes.add(self.ticked.is_some_and(|last| now < last), Reason::TimeBackwards);
        causes.add(elapsed_s > self.config.tick_s, Reason::Suspended);
        if causes.strongest == Some(Reason::TimeBackwards) {
            self.forget_times();
        }
        self.ticked = Some(now);
        self.take_goal(inputs);
        self.take(now, inputs, &mut causes);
        self.take_proposal(proposal);
        self.look_for_causes(now, inputs, &mut causes);

        if inputs.reset {
            self.change(Event::Reset, None);
        }
        if let Some(reason) = causes.strongest {
            self.in_order_since = None;
            self.change(reason.event(), Some(reason));
        } else if seconds_since(now, *self.in_order_since.get_or_insert(now)) >= self.config.clear_after_s {
            self.change(Event::Clear, None);
        }
        if matches!(self.state, State::Aborted | State::Latched) {
            self.void_goal = self.void_goal.max(inputs.goal);
            self.take_goal(inputs);
        }
        self.change(if self.goal.is_some() { Event::Goal } else { Event::NoGoal }, None);
        self.command = self.limited_command(elapsed_s);
        let takes_goals = causes.strongest.is_none() && self.state < State::Aborted;
        Decision {
            command: self.command,
            state: self.state,
            reason: self.reason,
            cause: causes.strongest,
            takes_goals,
        }
    }

    /// Takes the limits on motion and tilt of `limits`; how old an input may get stays as it was. A speed
    /// above a lowered limit is brought down within those on acceleration and jerk.
    ///
    /// # Errors
    /// [`ConfigError`] for a limit that makes no sense; nothing has changed then.
    pub fn limit(&mut self, limits: &SupervisorConfig) -> Result<(), ConfigError> {
        limits.validate("supervisor")?;
        self.linear.limit(limits.linear());
        self.angular.limit(limits.angular());
        self.config = self.config.limited_as(limits);
        Ok(())
    }

    /// The configuration.
    pub fn config(&self) -> &SupervisorConfig {
        &self.config
    }

    fn forget_times(&mut self) {
        [&mut self.scan, &mut self.odometry, &mut self.imu].into_iter().for_each(Stream::forget);
        (self.told_of_emergency_stop, self.clock_moved, self.had_peer) = (None, None, None);
        (self.unanswered_scan, self.newest_scan) = (None, Duration::ZERO);
    }

    /// The goal in service, if the one that was accepted last is not void.
    fn take_goal(&mut self, inputs: &Inputs) {
        let goal = inputs.goal.filter(|_| inputs.goal > self.void_goal);
        if goal != self.goal {
            (self.goal, self.outcome, self.unanswered_scan) = (goal, None, None);
        }
    }

    fn take(&mut self, now: Duration, inputs: &Inputs, causes: &mut Causes) {
        let Command { linear_m_s, angular_rad_s } = self.command;
        let is_moving = linear_m_s.abs() > MOVING_M_S || angular_rad_s.abs() > MOVING_RAD_S;
        let settles = self.goal.is_none() || self.reason == Some(Reason::Starting);
        if let Some(scan) = inputs.scan.and_then(|scan| self.scan.take(now, scan, is_moving, settles)) {
            self.newest_scan = scan;
            self.unanswered_scan = self.goal.and(self.unanswered_scan.or(Some(scan)));
        }
        inputs.odometry.and_then(|odometry| self.odometry.take(now, odometry, is_moving, settles));
        inputs.imu.and_then(|imu| self.imu.take(now, imu, is_moving, settles));
        if let Some(is_pressed) = inputs.emergency_stop {
            (self.is_pressed, self.told_of_emergency_stop) = (is_pressed, Some(now));
        }
        if let Some(clock) = inputs.clock {
            causes.add(self.clock.is_some_and(|last| clock < last), Reason::TimeBackwards);
            if self.clock != Some(clock) {
                (self.clock, self.clock_moved) = (Some(clock), Some(now));
            }
        }
        if inputs.has_peer {
            self.had_peer = Some(now);
        }
    }

    fn take_proposal(&mut self, proposal: Option<&Proposal>) {
        let Some(proposal) = proposal.filter(|proposal| Some(proposal.goal) == self.goal) else { return };
        self.outcome = Some(proposal.outcome);
        if self.unanswered_scan.is_some_and(|scan| scan <= proposal.scan_arrived) {
            self.unanswered_scan = Some(self.newest_scan).filter(|newest| *newest > proposal.scan_arrived);
        }
    }

    /// Causes that come first win among those of one strength.
    fn look_for_causes(&self, now: Duration, inputs: &Inputs, causes: &mut Causes) {
        let config = &self.config;
        let is_silent =
            |then: Option<Duration>, limit_s| then.is_none_or(|then| seconds_since(now, then) > limit_s);
        let is_stop_silent = is_silent(self.told_of_emergency_stop, config.emergency_stop_s);
        causes.add(self.is_pressed, Reason::EmergencyStop);
        causes.add(config.has_emergency_stop && is_stop_silent, Reason::EmergencyStopSilent);
        causes.add(inputs.publish_failed, Reason::PublishFailed);
        causes.add(inputs.other_publishers > 0, Reason::OtherPublisher);
        causes.add(is_silent(self.had_peer, config.peer_s), Reason::PeerLost);
        causes.add(config.has_clock && is_silent(self.clock_moved, config.clock_s), Reason::ClockLost);
        for (stream, reason) in [
            (&self.scan, Reason::Scan as fn(Defect) -> Reason),
            (&self.odometry, Reason::Odometry),
            (&self.imu, Reason::Imu),
        ] {
            if let Some(defect) = stream.defect(now) {
                causes.add(true, reason(defect));
            }
        }
        let leans = |[roll_rad, pitch_rad]: [f64; 2]| {
            // Also true for NaN.
            !(roll_rad.abs() <= config.max_roll_rad && pitch_rad.abs() <= config.max_pitch_rad)
        };
        causes.add(inputs.attitude_rad.is_some_and(leans), Reason::Tilt);
        causes.add(inputs.has_jumped, Reason::Jump);
        causes.add(inputs.wheels_disagree, Reason::WheelsDisagree);
        let is_finite =
            |command: Command| command.linear_m_s.is_finite() && command.angular_rad_s.is_finite();
        match self.outcome {
            Some(Outcome::Panicked) => causes.add(true, Reason::PlannerPanic),
            Some(Outcome::Command(command)) => causes.add(!is_finite(command), Reason::PlannerNan),
            Some(Outcome::Stopped) => causes.add(true, Reason::NoSubgoal),
            None => {}
        }
        let waits_s = self.unanswered_scan.map_or(0.0, |scan| seconds_since(now, scan));
        causes.add(waits_s > config.planner_s, Reason::PlannerOverrun);
    }

    fn change(&mut self, event: Event, reason: Option<Reason>) {
        let state = self.state.after(event);
        if state != self.state {
            // A reset leads to a weaker stop for the same reason.
            self.reason = if event == Event::Reset { self.reason } else { reason };
            self.state = state;
        }
    }

    fn limited_command(&mut self, elapsed_s: f64) -> Command {
        let wanted = match self.outcome {
            Some(Outcome::Command(command)) if self.state == State::Driving => command,
            _ if self.state == State::Driving => Command::STOP,
            _ => {
                self.linear.stop();
                self.angular.stop();
                return Command::STOP;
            }
        };
        Command {
            linear_m_s: self.linear.follow(wanted.linear_m_s, elapsed_s),
            angular_rad_s: self.angular.follow(wanted.angular_rad_s, elapsed_s),
        }
    }
}

/// The causes to stop that were found in a tick.
#[derive(Default)]
struct Causes {
    strongest: Option<Reason>,
}

impl Causes {
    fn add(&mut self, holds: bool, reason: Reason) {
        if holds && self.strongest.is_none_or(|strongest| (strongest.event() as u8) < reason.event() as u8) {
            self.strongest = Some(reason);
        }
    }
}
