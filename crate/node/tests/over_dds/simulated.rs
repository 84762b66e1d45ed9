//! A simulation that is slower than the system.

use std::time::Duration;

use ros2_client::action::GoalStatusEnum;

use crate::robot::Robot;
use crate::{DISCOVERY, Process, client, goal, peer, send, until};

const RATE: f64 = 0.5;

#[test]
fn a_robot_in_slow_time_gets_to_its_goal_and_no_less_far() {
    let domain_id = 101 + (std::process::id() % 25) as u16;
    let mut process = Process::start(domain_id, "    use_sim_time: true\n");
    let robot = Robot::start_simulated(peer(domain_id, "robot"), RATE);
    let mut node = peer(domain_id, "client");
    let client = client(&mut node);
    let accepted =
        until(DISCOVERY, || send(&client, goal("odom", 2.5, 0.0)).filter(|(_, accepted)| *accepted));
    let (id, _) = accepted.expect("no goal was accepted");
    let request = client.request_result(id).unwrap();
    let reached = until(Duration::from_secs(60), || client.receive_result(request).unwrap());
    assert_eq!(reached.expect("the goal was not reached").0, GoalStatusEnum::Succeeded);
    // Counted by the system's clock, half of the way would seem to be all of it.
    let [x, y] = robot.position_m();
    let missed_m = libm::hypot(x - 2.5, y);
    assert!(missed_m < 0.8, "{missed_m} m from the goal");
    process.end();
}
