//! Long drives with faults: memory does not grow, and no command breaks a rule.

#![allow(unsafe_code, reason = "an allocator that counts is one by nature")]

use core::time::Duration;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::env;

use mapless::Command;
use mapless::glam::DVec2;
use mapless_recording::{Content, Entry, FaultKind, Faults, InjectedFault};
use mapless_robot::supervisor::{Decision, State, SupervisorConfig};
use mapless_world::random::key;

use crate::SHORT;
use crate::drive::{Drive, Plan};

/// So many simulated minutes are driven, unless `cargo xtask soak` asks for more.
const MINUTES: u64 = 5;
/// After three fifths of the time, but after so many minutes at the latest, nothing may grow.
const MOST_WARM_UP_MINUTES: usize = 10;
const GROWTH: f64 = 1.05;
/// A fault begins every so many ticks of 10 ms.
const FAULT_EVERY: u64 = 2_000;
/// Somebody resets what is latched after so many ticks.
const RESET_AFTER: u64 = 300;
/// The supervisor looks at ages every 20 ms.
const TICK_S: f64 = 0.02;

thread_local! {
    /// What this thread holds, bytes: each test has a thread of its own.
    static HELD: Cell<isize> = const { Cell::new(0) };
}

struct Counting;

fn count(bytes: isize) {
    HELD.set(HELD.get() + bytes);
}

// SAFETY: everything is passed on to the system's allocator; the counter itself allocates nothing.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: the caller keeps the promises that this function asks for.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size as isize - layout.size() as isize);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Holds the supervisor to its rules, tick by tick.
struct Judge {
    config: SupervisorConfig,
    /// When the last good scan, odometry and message of the IMU came.
    came: [Duration; 3],
    last: Option<(Duration, Decision)>,
    driven: Duration,
    /// How often the robot was stopped, by reason.
    stops: BTreeMap<String, u64>,
}

impl Judge {
    fn take(&mut self, entry: &Entry, decision: Option<Decision>) {
        let at = entry.arrival.at;
        match &entry.content {
            Content::Scan(_) => self.came[0] = at,
            Content::Odometry(_) => self.came[1] = at,
            Content::Imu(imu) if imu.orientation.w.is_finite() => self.came[2] = at,
            Content::Tick(_) => self.judge(at, decision.unwrap()),
            _ => {}
        }
    }

    fn judge(&mut self, at: Duration, decision: Decision) {
        let Decision { command, state, reason, .. } = decision;
        let SupervisorConfig { scan_s, odometry_s, imu_s, .. } = self.config;
        let is_driving = state == State::Driving;
        assert!(is_driving || command == Command::STOP, "{at:?}: {decision:?}");
        assert!(command.linear_m_s.abs() <= self.config.max_speed_m_s + 1e-9, "{at:?}: {decision:?}");
        assert!(
            command.angular_rad_s.abs() <= self.config.max_turn_rate_rad_s + 1e-9,
            "{at:?}: {decision:?}"
        );
        if command != Command::STOP {
            for (came, limit_s) in self.came.into_iter().zip([scan_s, odometry_s, imu_s]) {
                let age_s = (at - came).as_secs_f64();
                assert!(age_s <= limit_s + TICK_S, "{at:?}: driven by what is {age_s} s old");
            }
        }
        if let Some((before, last)) = self.last
            && is_driving
            && last.state == State::Driving
        {
            let passed_s = (at - before).as_secs_f64();
            let [dv_m_s, domega_rad_s] = [
                command.linear_m_s - last.command.linear_m_s,
                command.angular_rad_s - last.command.angular_rad_s,
            ];
            let most = [self.config.max_acceleration_m_s2, self.config.max_turn_acceleration_rad_s2];
            assert!(dv_m_s.abs() <= most[0] * passed_s + 1e-9, "{at:?}: {last:?}, {decision:?}");
            assert!(domega_rad_s.abs() <= most[1] * passed_s + 1e-9, "{at:?}: {last:?}, {decision:?}");
            self.driven += at - before;
        }
        if let Some(reason) = reason
            && self.last.is_none_or(|(_, last)| last.reason != Some(reason))
        {
            *self.stops.entry(reason.to_string()).or_default() += 1;
        }
        self.last = Some((at, decision));
    }
}

fn share(seed: u64, number: u64) -> f64 {
    key(seed, number) as f64 / u64::MAX as f64
}

/// The faults come in turn, each for 0.1 to 2 s; a process is suspended for half a second at the most.
fn fault(number: u64, from: Duration) -> InjectedFault {
    let (kind, _) = FaultKind::ALL[number as usize % FaultKind::ALL.len()];
    let most_s = if kind == FaultKind::Suspended { 0.5 } else { 2.0 };
    let length_s = 0.1 + (most_s - 0.1) * share(1, number);
    InjectedFault { kind, from, until: from + Duration::from_secs_f64(length_s) }
}

#[test]
fn hours_with_faults_hold_no_more_memory_and_break_no_rule() {
    let minutes = env::var("MAPLESS_SOAK_MINUTES").map_or(MINUTES, |text| text.parse().unwrap());
    let mut drive = Drive::new(Plan { pressed_s: f64::INFINITY, changed_s: f64::INFINITY, ..SHORT });
    let config = drive.config.supervisor;
    let came = [Duration::ZERO; 3];
    let mut judge = Judge { config, came, last: None, driven: Duration::ZERO, stops: BTreeMap::new() };
    let (mut goals, mut faults, mut latched) = (0, 0, 0);
    let mut most_held = Vec::new();
    for tick in 0..6_000 * minutes {
        if tick.is_multiple_of(6_000) {
            most_held.push(0);
        }
        if tick % FAULT_EVERY == FAULT_EVERY - 1 {
            drive.faults = Faults(vec![fault(faults, Duration::from_millis(10 * tick))]);
            faults += 1;
        }
        if drive.navigation.task().is_none() {
            drive.goal_m = DVec2::new(15.0 + 30.0 * share(2, goals), 15.0 + 30.0 * share(3, goals));
        }
        let had_goal = drive.navigation.task().is_some();
        drive.step(tick);
        goals += u64::from(!had_goal && drive.navigation.task().is_some());
        let decision = drive.decision;
        drive.entries.drain(..).for_each(|entry| judge.take(&entry, decision));
        let is_latched = decision.is_some_and(|decision| decision.state == State::Latched);
        latched = if is_latched { latched + 1 } else { 0 };
        if latched == RESET_AFTER {
            drive.inputs.reset = true;
        }
        if let Some(most) = most_held.last_mut() {
            *most = HELD.get().max(*most);
        }
    }
    let (driven_s, stops) = (judge.driven.as_secs_f64(), &judge.stops);
    let warm_up = (most_held.len() * 3 / 5).min(MOST_WARM_UP_MINUTES);
    let (first, rest) = most_held.split_at(warm_up);
    let (first, rest) = (*first.iter().max().unwrap(), *rest.iter().max().unwrap());
    println!(
        "{minutes} simulated minutes: {goals} goals, {driven_s:.0} s of driving, {faults} faults; at most {} kB held in \
         the first {warm_up} minutes, {} kB after. Stops: {stops:#?}",
        first / 1000,
        rest / 1000,
    );
    assert!(first > 100_000, "{first} bytes are too few to be all");
    assert!(rest as f64 <= GROWTH * first as f64, "{most_held:?}");
    assert!(driven_s > 20.0 * minutes as f64, "it drove for {driven_s} s");
    assert!(stops.len() >= 6, "{stops:#?}");
}
