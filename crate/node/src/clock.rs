//! The node's time: the system's, or the simulation's.
//!
//! A simulation may run slower or faster than the system. Ages of messages, limits on acceleration and
//! timeouts are then of its time, as the motion is that they are about.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::messages::{self, Time};
use crate::slot::lock;

/// A simulation that has not gone on for so long on the system's clock stands still: the node's time goes on
/// without it, and what is late is noticed.
const STANDS_AFTER: Duration = Duration::from_secs(5);
/// How often it is looked whether simulated time has come so far.
const LOOK_EVERY: Duration = Duration::from_millis(1);

/// The time since the node began, and the time of what is sent.
#[derive(Debug)]
pub(crate) struct NodeClock {
    began: Instant,
    simulated: Option<Mutex<Simulated>>,
}

impl NodeClock {
    /// A clock that begins now, the system's or the simulation's.
    pub(crate) fn new(is_simulated: bool) -> Self {
        let began = Instant::now();
        Self { began, simulated: is_simulated.then(|| Mutex::new(Simulated::new(began))) }
    }

    /// Time since the node began. It never goes back.
    pub(crate) fn now(&self) -> Duration {
        self.simulated.as_ref().map_or_else(|| self.began.elapsed(), |clock| lock(clock).now(Instant::now()))
    }

    /// The stamp of what is sent now.
    pub(crate) fn stamp(&self) -> Time {
        self.simulated.as_ref().map_or_else(messages::now, |clock| lock(clock).told)
    }

    /// When the node began, on the system's clock, nanoseconds.
    pub(crate) fn began_ns(&self) -> u64 {
        let now_ns = u64::try_from(messages::now().nanoseconds()).unwrap_or(0);
        now_ns.saturating_sub(u64::try_from(self.began.elapsed().as_nanos()).unwrap_or(0))
    }

    /// The simulation's clock says this.
    pub(crate) fn set(&self, time: Time) {
        if let Some(clock) = &self.simulated {
            lock(clock).hear(time, Instant::now());
        }
    }

    /// How long to wait, on the system's clock, before it is looked again whether it is `due`.
    pub(crate) fn wait_for(&self, due: Duration) -> Duration {
        let left = due.saturating_sub(self.now());
        if self.simulated.is_some() { left.min(LOOK_EVERY) } else { left }
    }
}

/// Time that goes on as the simulation's clock does.
#[derive(Debug)]
struct Simulated {
    told: Time,
    /// The node's time when the clock last went on, and when that was on the system's clock.
    passed: Duration,
    went_on: Instant,
    is_known: bool,
}

impl Simulated {
    fn new(now: Instant) -> Self {
        Self { told: Time::default(), passed: Duration::ZERO, went_on: now, is_known: false }
    }

    fn now(&self, at: Instant) -> Duration {
        self.passed + at.saturating_duration_since(self.went_on).saturating_sub(STANDS_AFTER)
    }

    fn hear(&mut self, time: Time, at: Instant) {
        if self.is_known && time == self.told {
            return;
        }
        // A clock that goes back is told to the supervisor; no time passes by it.
        let step_ns = time.nanoseconds().saturating_sub(self.told.nanoseconds());
        let step = if self.is_known { u64::try_from(step_ns).unwrap_or(0) } else { 0 };
        *self = Self {
            told: time,
            passed: self.now(at) + Duration::from_nanos(step),
            went_on: at,
            is_known: true,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(ms: i64) -> Time {
        Time::from_nanoseconds(ms * 1_000_000)
    }

    #[test]
    fn simulated_time_passes_as_its_clock_says() {
        let began = Instant::now();
        let after = |ms| began + Duration::from_millis(ms);
        let mut clock = Simulated::new(began);
        clock.hear(time(5_000), after(300));
        assert_eq!((clock.told, clock.now(after(300))), (time(5_000), Duration::ZERO));
        // At half the system's rate, and at twice.
        clock.hear(time(5_100), after(500));
        assert_eq!(clock.now(after(650)), Duration::from_millis(100));
        clock.hear(time(5_300), after(600));
        assert_eq!(clock.now(after(600)), Duration::from_millis(300));
        // Back: no time passes, and it goes on from there.
        clock.hear(time(1_000), after(700));
        assert_eq!(clock.now(after(700)), Duration::from_millis(300));
        clock.hear(time(1_020), after(720));
        assert_eq!(clock.now(after(720)), Duration::from_millis(320));
    }

    #[test]
    fn time_goes_on_without_a_clock_that_stands() {
        let began = Instant::now();
        let after = |ms| began + Duration::from_millis(ms);
        let mut clock = Simulated::new(began);
        clock.hear(time(100), after(0));
        clock.hear(time(200), after(100));
        // The same again is no going on.
        clock.hear(time(200), after(1_000));
        assert_eq!(clock.now(after(5_000)), Duration::from_millis(100));
        assert_eq!(clock.now(after(5_600)), Duration::from_millis(600));
        // What passed meanwhile stays passed.
        clock.hear(time(210), after(5_600));
        assert_eq!(clock.now(after(5_650)), Duration::from_millis(610));
    }

    #[test]
    fn without_a_simulation_it_is_the_system_s() {
        let clock = NodeClock::new(false);
        clock.set(time(77));
        assert!((clock.stamp().nanoseconds() - messages::now().nanoseconds()).abs() < 1_000_000_000);
        let due = clock.now() + Duration::from_secs(9);
        assert!(clock.wait_for(due) > Duration::from_secs(8));
        assert!(NodeClock::new(true).wait_for(due) <= LOOK_EVERY);
    }
}
