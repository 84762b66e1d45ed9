//! Faults that are put into a replay stop the robot in time, and for their reason.

use core::time::Duration;

use mapless_recording::{FaultKind, InjectedFault, News, Options, replay};

use crate::drive::{Plan, drive};
use crate::{SHORT, file};

/// The supervisor's limits let a stop come this much later, seconds.
const SLACK_S: f64 = 0.1;

/// Each kind with the change that it makes, and after how long at the most, seconds.
const EXPECTED: [(FaultKind, &str, f64); 15] = [
    (FaultKind::NoScan, "Paused: scan: Stale", 0.35),
    (FaultKind::NoOdometry, "Paused: odometry: Stale", 0.15),
    (FaultKind::NoImu, "Paused: IMU: Stale", 0.1),
    (FaultKind::ImuNotFinite, "Paused: IMU: Malformed", 0.1),
    (FaultKind::Tilt, "Latched: the robot is tilted beyond its limit", 0.0),
    (FaultKind::PoseJump, "Aborted: the localisation jumped", 0.0),
    (FaultKind::EmergencyStop, "Aborted: the emergency stop is pressed", 0.0),
    (FaultKind::EmergencyStopSilent, "Aborted: the emergency stop is silent", 1.0),
    (FaultKind::PlannerSilent, "Paused: the planner is late", 0.4),
    (FaultKind::PlannerPanic, "Latched: the planner panicked", 0.1),
    (FaultKind::PlannerNotFinite, "Latched: the planner's command is not a number", 0.1),
    (FaultKind::PeerLost, "Aborted: no peer takes the commands", 0.1),
    (FaultKind::PublishFailed, "Aborted: a command could not be published", 0.0),
    (FaultKind::OtherPublisher, "Latched: another publisher commands the robot", 0.0),
    (FaultKind::Suspended, "Paused: the process was suspended", 0.3),
];

/// What the supervisor does from a moment on.
fn changes(bytes: &[u8], faults: &[InjectedFault], from: Duration) -> Vec<(Duration, String)> {
    let options = Options { faults: faults.to_vec(), ..Options::default() };
    let mut changes = Vec::new();
    let tell = |news: &News| match news {
        News::Change { at, text } if *at >= from => changes.push((*at, text.clone())),
        _ => {}
    };
    replay(bytes, &options, tell).unwrap();
    changes
}

#[test]
fn each_stops_the_robot_in_time_with_its_reason() {
    let bytes = file(&drive(Plan { seconds: 4.0, pressed_s: 9.0, ..SHORT }));
    let from = Duration::from_secs(2);
    assert_eq!(changes(&bytes, &[], from), [], "it drives all the time");
    for (kind, expected, wait_s) in EXPECTED {
        let until = from + Duration::from_secs_f64(wait_s + 0.06);
        let changes = changes(&bytes, &[InjectedFault { kind, from, until }], from);
        let (at, text) = changes.first().unwrap_or_else(|| panic!("{kind:?} changes nothing"));
        assert_eq!(text, expected, "{kind:?}: {changes:?}");
        let late_s = at.as_secs_f64() - from.as_secs_f64() - wait_s;
        assert!(late_s <= SLACK_S, "{kind:?}: {changes:?}");
    }
}
