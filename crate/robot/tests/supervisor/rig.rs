//! A robot whose sensors, planner and platform send what they should, but for one fault.

use core::time::Duration;

use mapless::Command;
use mapless_robot::supervisor::{
    Decision, Defect, Inputs, Message, Outcome, Proposal, Reason, Supervisor, SupervisorConfig,
};
use mapless_world::random::Sequence;

/// Sensors' clocks lie: in one capture by as much.
const SENSOR_CLOCK_AHEAD_NS: i64 = 1_674_000_000_000;
/// A system clock that began long ago.
const EPOCH_NS: i64 = 1_700_000_000_000_000_000;

/// Which sensor a fault is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sensor {
    Scan,
    Odometry,
    Imu,
}

/// What is wrong with a message, or with the robot, while it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fault {
    /// Nothing comes.
    Missing(Sensor),
    /// Everything comes late, with the stamps of when it was taken, seconds.
    Late(Sensor, f64),
    /// The same message again and again.
    Repeated(Sensor),
    /// New stamps, old content.
    Frozen(Sensor),
    /// NaN, a wrong frame, a truncated message, half a scan: what cannot be used.
    Malformed(Sensor),
    /// Stamps ahead of time, seconds.
    Future(Sensor, f64),
    /// The system's clock is set, by seconds, and with it the stamps of all but the scan.
    ClockStep(f64),
    /// The simulation's clock stands still.
    ClockStops,
    /// The simulation's clock goes back by 5 s.
    ClockBack,
    /// The monotonic clock goes back by seconds.
    TimeBack(f64),
    /// The process is stopped for seconds, and what came meanwhile is delivered at its end.
    Suspended(f64),
    EmergencyStop,
    EmergencyStopSilent,
    Tilt([f64; 2]),
    Jump,
    WheelsDisagree,
    PlannerSilent,
    PlannerStops,
    PlannerPanics,
    PlannerCommand(Command),
    NoPeer,
    PublishFails,
    OtherPublisher,
}

impl Fault {
    /// The stated limit of time, seconds, and the reason that the supervisor must give.
    pub(crate) fn expected(self, config: &SupervisorConfig) -> (f64, Reason) {
        let stream = |sensor: Sensor, defect: Defect| match sensor {
            Sensor::Scan => (config.scan_s, Reason::Scan(defect)),
            Sensor::Odometry => (config.odometry_s, Reason::Odometry(defect)),
            Sensor::Imu => (config.imu_s, Reason::Imu(defect)),
        };
        match self {
            Self::Missing(sensor) | Self::Late(sensor, _) => stream(sensor, Defect::Stale),
            Self::Repeated(sensor) => stream(sensor, Defect::Frozen),
            Self::Frozen(Sensor::Scan) => (config.scan_s, Reason::Scan(Defect::Frozen)),
            Self::Frozen(sensor) => (config.frozen_s, stream(sensor, Defect::Frozen).1),
            Self::Malformed(sensor) => stream(sensor, Defect::Malformed),
            Self::Future(sensor, _) => stream(sensor, Defect::Future),
            // The IMU has the shortest limit of those whose stamps are set with the system's clock.
            Self::ClockStep(step_s) if step_s > 0.0 => stream(Sensor::Imu, Defect::Future),
            Self::ClockStep(_) => stream(Sensor::Imu, Defect::Stale),
            Self::ClockStops => (config.clock_s, Reason::ClockLost),
            Self::ClockBack | Self::TimeBack(_) => (0.0, Reason::TimeBackwards),
            Self::Suspended(lasts_s) => (lasts_s, Reason::Suspended),
            Self::EmergencyStop => (0.0, Reason::EmergencyStop),
            Self::EmergencyStopSilent => (config.emergency_stop_s, Reason::EmergencyStopSilent),
            Self::Tilt(_) => (0.0, Reason::Tilt),
            Self::Jump => (0.0, Reason::Jump),
            Self::WheelsDisagree => (0.0, Reason::WheelsDisagree),
            Self::PlannerSilent => (0.1 + config.planner_s, Reason::PlannerOverrun),
            // The planner answers scans, each 0.1 s.
            Self::PlannerStops => (0.1, Reason::NoSubgoal),
            Self::PlannerPanics => (0.1, Reason::PlannerPanic),
            Self::PlannerCommand(_) => (0.1, Reason::PlannerNan),
            Self::NoPeer => (config.peer_s, Reason::PeerLost),
            Self::PublishFails => (0.0, Reason::PublishFailed),
            Self::OtherPublisher => (0.0, Reason::OtherPublisher),
        }
    }
}

/// A sensor that sends at its rate.
struct Source {
    sensor: Sensor,
    period_s: f64,
    next_s: f64,
    last: Option<Message>,
}

pub(crate) struct Rig {
    pub(crate) supervisor: Supervisor,
    pub(crate) goal: Option<u64>,
    pub(crate) fault: Option<Fault>,
    pub(crate) reset: bool,
    /// Time on the true clock, seconds.
    pub(crate) time_s: f64,
    random: Sequence,
    sources: [Source; 3],
    emergency_stop_s: f64,
    /// What the monotonic and the simulation's clock are off by since a fault.
    monotonic_off_s: f64,
    clock_off_s: f64,
    /// When the last good scan came, true and by the monotonic clock, until the planner answers it.
    scan: Option<(f64, Duration)>,
    answer_s: f64,
}

impl Rig {
    pub(crate) fn new(seed: u64) -> Self {
        let source = |sensor, period_s| Source { sensor, period_s, next_s: 0.0, last: None };
        let config = SupervisorConfig { has_clock: true, ..SupervisorConfig::default() };
        Self {
            supervisor: Supervisor::new(config).unwrap(),
            goal: None,
            fault: None,
            reset: false,
            time_s: 0.0,
            random: Sequence::new(seed),
            sources: [source(Sensor::Scan, 0.1), source(Sensor::Odometry, 0.02), source(Sensor::Imu, 0.01)],
            emergency_stop_s: 0.0,
            monotonic_off_s: 0.0,
            clock_off_s: 0.0,
            scan: None,
            answer_s: 0.0,
        }
    }

    pub(crate) fn between(&mut self, range: [f64; 2]) -> f64 {
        self.random.between(range)
    }

    /// The monotonic clock, which began 100 s ago.
    fn monotonic(&self, time_s: f64) -> Duration {
        Duration::from_secs_f64(100.0 + self.monotonic_off_s + time_s)
    }

    /// The next tick, some 20 ms later.
    pub(crate) fn tick(&mut self) -> Decision {
        match self.fault {
            Some(Fault::Suspended(lasts_s)) => {
                self.time_s += lasts_s;
                self.fault = None;
            }
            Some(Fault::TimeBack(back_s)) => {
                self.time_s += 0.02;
                self.monotonic_off_s -= back_s;
                self.fault = None;
            }
            Some(Fault::ClockBack) => {
                self.time_s += 0.02;
                self.clock_off_s -= 5.0;
                self.fault = None;
            }
            _ => self.time_s += self.random.between([0.018, 0.022]),
        }
        let now = self.monotonic(self.time_s);
        let mut inputs = Inputs {
            attitude_rad: Some(if let Some(Fault::Tilt(attitude_rad)) = self.fault {
                attitude_rad
            } else {
                [0.1, 0.2]
            }),
            has_jumped: self.fault == Some(Fault::Jump),
            wheels_disagree: self.fault == Some(Fault::WheelsDisagree),
            has_peer: self.fault != Some(Fault::NoPeer),
            publish_failed: self.fault == Some(Fault::PublishFails),
            other_publishers: usize::from(self.fault == Some(Fault::OtherPublisher)),
            goal: self.goal,
            reset: core::mem::take(&mut self.reset),
            ..Inputs::default()
        };
        if self.fault != Some(Fault::ClockStops) {
            inputs.clock = Some(Duration::from_secs_f64(1000.0 + self.clock_off_s + self.time_s));
        }
        if self.time_s >= self.emergency_stop_s && self.fault != Some(Fault::EmergencyStopSilent) {
            inputs.emergency_stop = Some(self.fault == Some(Fault::EmergencyStop));
            self.emergency_stop_s = self.time_s + 0.1;
        }
        // Some faults show at once, whatever the rate of the topic.
        if self.fault == Some(Fault::EmergencyStop) {
            inputs.emergency_stop = Some(true);
        }
        inputs.scan = self.newest(0);
        inputs.odometry = self.newest(1);
        inputs.imu = self.newest(2);
        if let Some(scan) = inputs.scan.filter(|scan| scan.is_well_formed) {
            self.scan = Some((self.time_s, scan.arrived));
            self.answer_s = self.time_s + self.random.between([0.005, 0.04]);
        }
        let proposal = self.answer();
        self.supervisor.tick(now, &inputs, proposal.as_ref())
    }

    fn answer(&mut self) -> Option<Proposal> {
        let (goal, (_, scan_arrived)) = (self.goal?, self.scan?);
        if self.time_s < self.answer_s || self.fault == Some(Fault::PlannerSilent) {
            return None;
        }
        self.scan = None;
        let outcome = match self.fault {
            Some(Fault::PlannerStops) => Outcome::Stopped,
            Some(Fault::PlannerPanics) => Outcome::Panicked,
            Some(Fault::PlannerCommand(command)) => Outcome::Command(command),
            _ => {
                Outcome::Command(Command { linear_m_s: 0.8, angular_rad_s: self.random.between([-0.9, 0.9]) })
            }
        };
        Some(Proposal { goal, scan_arrived, outcome })
    }

    /// The newest message of a source that came since the last tick.
    fn newest(&mut self, index: usize) -> Option<Message> {
        let sensor = self.sources[index].sensor;
        let mut newest = None;
        while self.sources[index].next_s <= self.time_s {
            let taken_s = self.sources[index].next_s;
            let period_s = self.sources[index].period_s;
            // Odometry of a Clearpath robot has gaps of 58 ms.
            let is_gap = sensor == Sensor::Odometry && self.random.happens(0.01);
            let jitter_s = if is_gap { 0.058 } else { period_s * self.random.between([0.9, 1.1]) };
            self.sources[index].next_s = taken_s + jitter_s;
            newest = self.message(index, taken_s).or(newest);
        }
        newest
    }

    fn message(&mut self, index: usize, taken_s: f64) -> Option<Message> {
        let (sensor, last) = (self.sources[index].sensor, self.sources[index].last);
        let step_s = if let Some(Fault::ClockStep(step_s)) = self.fault { step_s } else { 0.0 };
        let nanoseconds = |seconds: f64| (seconds * 1e9) as i64;
        let lie_ns = if sensor == Sensor::Scan { SENSOR_CLOCK_AHEAD_NS } else { nanoseconds(step_s) };
        // A message that waited for the process arrives when it is read.
        let arrived = self.monotonic(self.time_s);
        let mut message = Message {
            arrived,
            clock_ns: EPOCH_NS + nanoseconds(self.time_s),
            stamp_ns: EPOCH_NS + lie_ns + nanoseconds(taken_s),
            fingerprint: (self.random.share() * 1e15) as u64,
            is_well_formed: true,
        };
        match self.fault {
            Some(Fault::Missing(of)) if of == sensor => return None,
            Some(Fault::Late(of, late_s)) if of == sensor => message.stamp_ns -= nanoseconds(late_s),
            Some(Fault::Repeated(of)) if of == sensor => {
                return last.map(|last| Message { arrived, clock_ns: message.clock_ns, ..last });
            }
            Some(Fault::Frozen(of)) if of == sensor => {
                message.fingerprint = last.map_or(0, |last| last.fingerprint);
            }
            Some(Fault::Malformed(of)) if of == sensor => message.is_well_formed = false,
            Some(Fault::Future(of, ahead_s)) if of == sensor => message.stamp_ns += nanoseconds(ahead_s),
            _ => {}
        }
        self.sources[index].last = Some(message);
        Some(message)
    }
}
