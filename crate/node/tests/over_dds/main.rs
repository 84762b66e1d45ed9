//! The node as a process, and a robot and a client of `NavigateToPose` that speak DDS with it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![cfg(all(unix, not(feature = "humble")))]

mod flood;
mod packets;
mod parameters;
mod robot;
mod rtps;
mod simulated;
mod sockets;
mod surfaces;
mod tf;
mod velodyne;

use std::path::Path;
use std::process::{Child, Command};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use mapless_node::config::NodeConfig;
use mapless_node::messages::{NavigateGoal, NavigateResult};
use mapless_node::navigation::code;
use mapless_peer::{NavigateClient, goal, navigate_client, until};
use mapless_recording::{Options, replay};
use robot::Robot;
use ros2_client::Node;
use ros2_client::action::{GoalId, GoalStatusEnum};

/// Peers find each other within this, even on a loaded machine.
const DISCOVERY: Duration = Duration::from_secs(60);
/// A command every 20 ms, on a loaded machine.
const SLACK: Duration = Duration::from_millis(300);
const FAR_M: f64 = 200.0;
/// Where the node records, beside its file.
const DRIVES: &str = "drives";
/// The sample file's section about the mount.
const MOUNT: [&str; 5] = ["sensor:", "height_m:", "forward_m:", "left_m:", "pitch_rad:"];

/// One test at a time: each has a robot that must keep its rates.
static ALONE: Mutex<()> = Mutex::new(());

/// The process under test; it is killed when a test fails.
struct Process {
    child: Child,
    command: Command,
    folder: tempfile::TempDir,
    _alone: MutexGuard<'static, ()>,
}

impl Process {
    /// The node in a domain of its own, by the sample file with `more` at its end.
    fn start(domain_id: u16, more: &str) -> Self {
        Self::start_as(domain_id, more, &[])
    }

    /// The same with variables of its environment.
    fn start_as(domain_id: u16, more: &str, variables: &[(&str, &Path)]) -> Self {
        let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/config/husky-jazzy.yaml");
        let text = std::fs::read_to_string(sample).unwrap();
        let text = text.replace("domain_id: 0", &format!("domain_id: {domain_id}"));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("robot.yaml");
        // A mount by tf takes the place of that in the file.
        let is_kept = |line: &&str| {
            !more.contains("sensor_mount") || !MOUNT.iter().any(|key| line.trim_start().starts_with(key))
        };
        let text: String = text.lines().filter(is_kept).map(|line| format!("{line}\n")).collect();
        let drives = folder.path().join(DRIVES);
        let recording = format!("    recording:\n      folder: {}\n", drives.display());
        std::fs::write(&file, text + &recording + more).unwrap();
        NodeConfig::open(&file).unwrap();
        let log = std::fs::File::create(folder.path().join("log")).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_mapless-node"));
        command.arg(&file).envs(variables.iter().copied()).stderr(log);
        let child = command.spawn().unwrap();
        Self { child, command, folder, _alone: alone }
    }

    /// Starts it again once it has ended, as systemd does.
    fn restart(&mut self) {
        self.child = self.command.spawn().unwrap();
    }
}

impl Process {
    /// What it wrote to its log.
    fn log(&self) -> String {
        std::fs::read_to_string(self.folder.path().join("log")).unwrap()
    }

    /// Asks it to end. The whole drive was recorded, and is decided again to the bit: what became of it.
    fn end(&mut self) -> String {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").arg(&id).status().unwrap().success());
        let status =
            until(Duration::from_secs(10), || self.child.try_wait().unwrap()).expect("it does not end");
        assert!(status.success());
        let drives = std::fs::read_dir(self.folder.path().join(DRIVES)).unwrap();
        let recorded: Vec<_> = drives.map(|entry| entry.unwrap().path()).collect();
        assert_eq!(recorded.len(), 1);
        let mut news = Vec::new();
        let bytes = std::fs::File::open(&recorded[0]).unwrap();
        let report = replay(bytes, &Options::default(), |told| news.push(format!("{told:?}"))).unwrap();
        assert!(report.ticks > 50 && report.answers > 3 && !report.is_cut, "{report:?}");
        assert_eq!((report.different_ticks, report.different_answers, report.lost), (0, 0, 0), "{news:#?}");
        assert_eq!(report.recorded_digest.as_ref(), Some(&report.digest));
        format!("{news:#?}\n{report:#?}")
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A node of the test.
fn peer(domain_id: u16, name: &str) -> Node {
    mapless_peer::join(domain_id, name).unwrap()
}

fn client(node: &mut Node) -> NavigateClient {
    navigate_client(node).unwrap()
}

/// Sends a goal; its id, and whether it was accepted.
fn send(client: &NavigateClient, goal: NavigateGoal) -> Option<(GoalId, bool)> {
    mapless_peer::send(client, goal).unwrap()
}

/// Sends a far goal until the robot drives to it.
fn drive(client: &NavigateClient, robot: &Robot) -> GoalId {
    let accepted = until(DISCOVERY, || {
        let [x, y] = robot.position_m();
        send(client, goal("odom", x + FAR_M, y)).filter(|(_, accepted)| *accepted)
    });
    let (id, _) = accepted.expect("no goal was accepted");
    until(Duration::from_secs(10), || robot.is_driven().then_some(())).expect("it does not drive");
    id
}

fn result(client: &NavigateClient, id: GoalId) -> (GoalStatusEnum, NavigateResult) {
    let request = client.request_result(id).unwrap();
    until(Duration::from_secs(5), || client.receive_result(request).unwrap()).expect("no result came")
}

/// One test, as its parts share a process and its discovery.
#[test]
fn a_robot_is_driven_by_the_action_and_stopped() {
    let domain_id = 1 + (std::process::id() % 50) as u16;
    let mut process = Process::start(domain_id, "");
    let robot = Robot::start(peer(domain_id, "robot"));
    let mut node = peer(domain_id, "client");
    let client = client(&mut node);

    // Feedback, then a cancel: zero at once.
    let id = drive(&client, &robot);
    let feedback = until(Duration::from_secs(5), || client.receive_feedback(id).unwrap());
    let feedback = feedback.expect("no feedback came");
    assert!(feedback.distance_remaining > 100.0 && feedback.current_pose.header.frame_id == "odom");
    let begun = Instant::now();
    let request = client.cancel_goal(id).unwrap();
    let response = until(Duration::from_secs(2), || client.receive_cancel_response(request).unwrap());
    assert_eq!(response.expect("no answer to the cancel").goals_canceling.len(), 1);
    let stopped = until(Duration::from_secs(2), || (!robot.is_driven()).then(|| begun.elapsed())).unwrap();
    assert!(stopped < Duration::from_millis(100) + SLACK, "stopped {stopped:?} after the cancel");
    assert_eq!(result(&client, id).0, GoalStatusEnum::Canceled);

    // Another frame is refused, and what was not accepted has no result.
    let (refused, accepted) = send(&client, goal("map", 1.0, 0.0)).unwrap();
    assert!(!accepted && !robot.is_driven());
    assert_eq!(result(&client, refused).0, GoalStatusEnum::Unknown);

    // A near goal pre-empts a far one, and is reached.
    let far = drive(&client, &robot);
    let [x, y] = robot.position_m();
    let (near, accepted) = send(&client, goal("odom", x + 1.5, y)).unwrap();
    assert!(accepted);
    let (status, outcome) = result(&client, far);
    assert_eq!((status, outcome.error_code), (GoalStatusEnum::Aborted, code::PREEMPTED));
    let request = client.request_result(near).unwrap();
    let reached = until(Duration::from_secs(30), || client.receive_result(request).unwrap());
    assert_eq!(reached.expect("the goal was not reached").0, GoalStatusEnum::Succeeded);
    let [at_x, at_y] = robot.position_m();
    let missed_m = libm::hypot(at_x - x - 1.5, at_y - y);
    assert!(missed_m < 0.8, "{missed_m} m from the goal");

    // A tilt latches; the goal is aborted with its reason, and none is taken until a reset.
    let id = drive(&client, &robot);
    robot.tilt(0.7);
    let (status, outcome) = result(&client, id);
    assert_eq!((status, outcome.error_code), (GoalStatusEnum::Aborted, code::STOPPED));
    assert!(outcome.error_msg.contains("tilted"), "{}", outcome.error_msg);
    robot.tilt(0.0);
    std::thread::sleep(Duration::from_secs(2));
    assert!(!send(&client, goal("odom", x, y)).unwrap().1 && !robot.is_driven());
    robot.reset();
    drive(&client, &robot);

    // Scans cease: zero within the limit.
    let begun = Instant::now();
    robot.blind();
    let stopped = until(Duration::from_secs(3), || (!robot.is_driven()).then(|| begun.elapsed())).unwrap();
    assert!(stopped < Duration::from_millis(350) + SLACK, "stopped {stopped:?} after the last scan");

    // It ends by itself when asked to.
    let recorded = process.end();
    assert!(!robot.is_driven());
    assert!(recorded.contains("tilted"), "{recorded}");
}
