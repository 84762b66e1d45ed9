//! Every fault at random moments of a drive: a stop in time, for the right reason, and no way back but by the
//! rule of the reason.

use mapless::Command;
use mapless_robot::supervisor::{Decision, Event, State};

use crate::rig::{Fault, Rig, Sensor};

/// Random moments for each fault.
const MOMENTS: u64 = 200;
/// A stop comes within this time after its stated limit.
const TOLERANCE_S: f64 = 0.1;

const FAULTS: [Fault; 36] = [
    Fault::Missing(Sensor::Scan),
    Fault::Missing(Sensor::Odometry),
    Fault::Missing(Sensor::Imu),
    Fault::Late(Sensor::Scan, 0.6),
    Fault::Late(Sensor::Odometry, 0.4),
    Fault::Late(Sensor::Imu, 0.3),
    Fault::Repeated(Sensor::Scan),
    Fault::Repeated(Sensor::Odometry),
    Fault::Repeated(Sensor::Imu),
    Fault::Frozen(Sensor::Scan),
    Fault::Frozen(Sensor::Odometry),
    Fault::Frozen(Sensor::Imu),
    Fault::Malformed(Sensor::Scan),
    Fault::Malformed(Sensor::Odometry),
    Fault::Malformed(Sensor::Imu),
    Fault::Future(Sensor::Scan, 2.0),
    Fault::Future(Sensor::Odometry, 1e6),
    Fault::Future(Sensor::Imu, 0.8),
    Fault::ClockStep(30.0),
    Fault::ClockStep(-30.0),
    Fault::ClockStops,
    Fault::ClockBack,
    Fault::TimeBack(0.5),
    Fault::Suspended(1.5),
    Fault::EmergencyStop,
    Fault::EmergencyStopSilent,
    Fault::Tilt([0.5, 0.0]),
    Fault::Tilt([0.0, -0.75]),
    Fault::Tilt([f64::NAN, 0.0]),
    Fault::Jump,
    Fault::WheelsDisagree,
    Fault::PlannerSilent,
    Fault::PlannerStops,
    Fault::PlannerPanics,
    Fault::PlannerCommand(Command { linear_m_s: f64::NAN, angular_rad_s: 0.0 }),
    Fault::PlannerCommand(Command { linear_m_s: 0.5, angular_rad_s: f64::INFINITY }),
];
const PLATFORM_FAULTS: [Fault; 3] = [Fault::NoPeer, Fault::PublishFails, Fault::OtherPublisher];

/// A rig that drives, at a random moment.
fn driving(seed: u64) -> Rig {
    let mut rig = Rig::new(seed);
    let begins_s = rig.between([1.5, 3.0]);
    run(&mut rig, begins_s, |_, _| {});
    rig.goal = Some(1);
    let lasts_s = rig.between([1.0, 3.0]);
    let last = run(&mut rig, lasts_s, |_, _| {});
    assert_eq!((last.state, last.cause), (State::Driving, None));
    assert!(last.command.linear_m_s > 0.3);
    rig
}

/// Ticks for seconds; the last decision.
fn run(rig: &mut Rig, lasts_s: f64, mut sees: impl FnMut(f64, &Decision)) -> Decision {
    let begin_s = rig.time_s;
    loop {
        let decision = rig.tick();
        sees(rig.time_s - begin_s, &decision);
        if rig.time_s - begin_s >= lasts_s {
            return decision;
        }
    }
}

fn stands(decision: &Decision) -> bool {
    decision.command == Command::STOP
}

fn moves_within(rig: &mut Rig, lasts_s: f64) -> bool {
    let mut moved = false;
    run(rig, lasts_s, |_, decision| moved |= !stands(decision));
    moved
}

#[test]
fn every_fault_stops_the_robot_in_time_for_its_reason_and_clears_by_its_rule() {
    for fault in FAULTS.into_iter().chain(PLATFORM_FAULTS) {
        for moment in 0..MOMENTS {
            let what = format!("{fault:?}, moment {moment}");
            let mut rig = driving(moment);
            let (limit_s, reason) = fault.expected(rig.supervisor.config());
            rig.fault = Some(fault);
            let (mut stopped, mut late) = (None, 0);
            run(&mut rig, 3.0, |passed_s, decision| {
                if stopped.is_none() && stands(decision) {
                    stopped = Some((passed_s, decision.reason));
                }
                // A momentary fault clears by its rule; one that lasts holds the robot.
                late += usize::from(
                    !stands(decision) && passed_s > limit_s + TOLERANCE_S && passed_s < limit_s + 1.0,
                );
            });
            let (after_s, given) = stopped.unwrap_or_else(|| panic!("{what}: no stop"));
            assert!(after_s <= limit_s + TOLERANCE_S, "{what}: a stop after {after_s} s");
            assert_eq!(given, Some(reason), "{what}");
            assert_eq!(late, 0, "{what}: moved again within a second");
            rig.fault = None;
            recovers(&mut rig, reason.event(), &what);
        }
    }
}

/// The fault is gone: nothing but what its rule asks for moves the robot.
fn recovers(rig: &mut Rig, rule: Event, what: &str) {
    match rule {
        Event::Pause => assert!(moves_within(rig, 4.0), "{what}: the goal is pursued further"),
        Event::Abort | Event::Latch => {
            assert!(!moves_within(rig, 4.0), "{what}: a void goal moves nothing");
            if rule == Event::Latch {
                rig.goal = Some(2);
                assert!(!moves_within(rig, 3.0), "{what}: a goal does not reset");
                rig.reset = true;
                assert!(!moves_within(rig, 4.0), "{what}: a reset moves nothing");
            }
            rig.goal = Some(3);
            assert!(moves_within(rig, 3.0), "{what}: a new goal is pursued");
        }
        _ => unreachable!("{rule:?} is no stop"),
    }
}

#[test]
fn a_goal_that_is_given_while_the_emergency_stop_is_pressed_moves_nothing_when_it_is_released() {
    for moment in 0..MOMENTS {
        let mut rig = driving(moment);
        rig.fault = Some(Fault::EmergencyStop);
        run(&mut rig, 1.0, |_, _| {});
        rig.goal = Some(2);
        let refused = run(&mut rig, 1.0, |_, decision| assert!(!decision.takes_goals));
        assert_eq!(refused.state, State::Aborted);
        rig.fault = None;
        assert!(!moves_within(&mut rig, 5.0));
    }
}

#[test]
fn a_stop_lasts_until_all_was_in_order_for_a_second() {
    let mut rig = driving(7);
    rig.fault = Some(Fault::Missing(Sensor::Imu));
    run(&mut rig, 1.0, |_, _| {});
    rig.fault = None;
    let mut moved_s = None;
    run(&mut rig, 3.0, |passed_s, decision| {
        if !stands(decision) && moved_s.is_none() {
            moved_s = Some(passed_s);
        }
    });
    assert!((0.95..1.2).contains(&moved_s.unwrap()), "{moved_s:?}");
}

#[test]
fn a_frozen_scan_that_goes_on_does_not_let_the_robot_creep() {
    let mut rig = driving(3);
    rig.fault = Some(Fault::Frozen(Sensor::Scan));
    run(&mut rig, 0.6, |_, _| {});
    assert!(!moves_within(&mut rig, 20.0));
}

#[test]
fn messages_that_stay_late_keep_the_robot_standing() {
    for fault in
        [Fault::Late(Sensor::Scan, 0.6), Fault::Late(Sensor::Odometry, 0.4), Fault::Late(Sensor::Imu, 0.3)]
    {
        let mut rig = driving(11);
        rig.fault = Some(fault);
        run(&mut rig, 0.6, |_, _| {});
        assert!(!moves_within(&mut rig, 20.0), "{fault:?}");
    }
}

#[test]
fn a_clock_that_was_set_stops_the_robot_until_it_has_no_goal() {
    for step_s in [30.0, -30.0] {
        let mut rig = driving(13);
        rig.fault = Some(Fault::ClockStep(step_s));
        assert!(stands(&run(&mut rig, 0.6, |_, _| {})));
        // The clock stays as it was set. Set ahead, the goal is void; set back, it waits.
        assert!(!moves_within(&mut rig, 5.0), "{step_s}");
        rig.goal = None;
        assert_eq!(run(&mut rig, 2.0, |_, _| {}).state, State::Standby, "{step_s}");
        rig.goal = Some(2);
        assert!(moves_within(&mut rig, 1.0), "{step_s}");
    }
}

#[test]
fn a_simulated_hour_without_faults_shows_no_stop() {
    let mut rig = driving(1);
    run(&mut rig, 3600.0, |passed_s, decision| {
        assert_eq!((decision.state, decision.cause), (State::Driving, None), "after {passed_s} s");
    });
}

#[test]
fn a_goal_that_ends_stands_at_once() {
    let mut rig = driving(5);
    rig.goal = None;
    let decision = rig.tick();
    assert_eq!((decision.state, decision.command), (State::Standby, Command::STOP));
}
