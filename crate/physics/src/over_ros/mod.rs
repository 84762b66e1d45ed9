//! A task driven by the node itself: over DDS, with the odometry and the IMU of a robot, and no true pose.

mod cloud;
mod drift;
mod errand;
mod imu;
mod node;
mod odometry;
mod platform;
mod robot;

use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Context as _, ensure};
use clap::Args;
use glam::{DVec2, Vec3};
use mapless::{Command, Goal, Pose};
use mapless_trials::{Activity, Decision, LoadedScenario, Navigator, Trial};

use crate::engine::Engine;
use crate::simulator;
use cloud::cloud;
use errand::{Ended, Errand};
use node::NodeProcess;
use platform::Platform;
use robot::Robot;

/// What a drive over ROS needs.
#[derive(Debug, Args)]
pub(crate) struct OverRosArgs {
    /// Scenario file: terrain, objects that stand, start and goal. Its [reality] and its seed do not count.
    task: PathBuf,
    /// The program of the node.
    #[arg(long)]
    node: PathBuf,
    /// A DDS domain that nobody else uses.
    #[arg(long)]
    domain: u16,
    /// Seed of every error and noise.
    #[arg(long)]
    seed: u64,
    /// Another goal, x and y in metres.
    #[arg(long, num_args = 2, value_names = ["X", "Y"])]
    goal: Option<Vec<f64>>,
    /// The program of the physics engine, with its arguments.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    command: Vec<String>,
}

/// What is printed.
#[derive(Debug, serde::Serialize)]
pub(crate) struct DrivenOverRos {
    /// `reached` as the node says, `aborted` by the node, or how the drive ended otherwise.
    outcome: &'static str,
    reason: Option<String>,
    /// Since the goal was accepted, on the simulation's clock.
    time_s: f64,
    /// The same on the system's.
    took_s: f64,
    path_m: f64,
    max_abs_roll_rad: f64,
    max_abs_pitch_rad: f64,
    /// From where the robot truly is, seen from above.
    distance_to_goal_m: f64,
    /// How far off odometry and the node's estimate are at the end, seen from above.
    odometry_off_m: f64,
    odometry_off_rad: f64,
    estimate_off_m: f64,
    estimate_off_rad: f64,
    /// The most by which the node's own word on the distance to the goal differed from the estimate.
    feedback_off_m: f64,
    /// Times that the node began to backtrack or to search.
    recoveries: i16,
    /// Scans that the planner did not answer.
    unanswered: u64,
}

/// Stands in the trial where a planner would: what drives is elsewhere.
#[derive(Clone, Copy, Debug)]
struct Elsewhere {
    max_speed_m_s: f64,
}

impl Navigator for Elsewhere {
    fn navigate(&mut self, _: &[Vec3], _: &Pose, _: &Goal, _: Duration) -> Decision {
        Decision { activity: Activity::Driving, command: Command::STOP }
    }

    fn max_speed_m_s(&self) -> f64 {
        self.max_speed_m_s
    }

    fn reset(&mut self) {}
}

/// Drives the task.
///
/// # Errors
/// A file that cannot be read, an engine or a node that does not start or ends.
pub(crate) fn drive(args: &OverRosArgs) -> anyhow::Result<DrivenOverRos> {
    let node = NodeProcess::start(&args.node, args.domain)?;
    drive_with(args, &node).with_context(|| format!("the node's log ends with\n{}", node.log()))
}

fn drive_with(args: &OverRosArgs, node: &NodeProcess) -> anyhow::Result<DrivenOverRos> {
    let file = || args.task.display().to_string();
    let LoadedScenario { mut scenario, terrain } = LoadedScenario::read(&args.task)?;
    scenario.reality = simulator::reality_of_the_node();
    if let Some(&[x, y]) = args.goal.as_deref() {
        scenario.goal_m = DVec2::new(x, y);
    }
    ensure!(scenario.waypoints_m.is_empty(), "{}: waypoints: expected none", file());
    let elsewhere = Elsewhere { max_speed_m_s: node.config.drive.supervisor.max_speed_m_s };
    let mut trial =
        Trial::with_navigator(terrain.field, &scenario, elsewhere, args.seed).with_context(file)?;
    let told = node.config.drive.planner.sensor.offset_m();
    let mounted = trial.sensor().config().place_on_robot_m();
    ensure!(
        told == mounted,
        "{}: the sensor is at {mounted} m: expected {told} m, as the node has it",
        file()
    );

    let (engine, rest) =
        Engine::start(&args.command, &trial, &scenario.robot, simulator::friction()).with_context(file)?;
    let mut robot = Robot::new(mapless_peer::join(args.domain, "robot")?)?;
    let client = mapless_peer::join(args.domain, "client")?;
    robot.meet()?;
    let latency_s = scenario.reality.motion.latency_s;
    let mut platform = Platform::new(engine, rest, robot, &node.config.drive, latency_s, args.seed)?;
    let mut errand = Errand::new(client, platform.drift.in_odometry(scenario.goal_m))?;

    let mut unanswered = 0;
    let ended = loop {
        trial.look();
        if let Some(question) = trial.question() {
            trial.decide(&question);
            let cloud = cloud(&trial.scan().points, trial.sensor().config(), platform.now());
            unanswered += u64::from(!platform.robot.tell_scan(cloud, errand.is_pursued())?);
        }
        let is_held = !errand.is_pursued();
        let moved = trial.act_by(|_, seconds| platform.step(seconds, is_held)).with_context(file)?;
        if let Some(outcome) = moved {
            break Ended { outcome: outcome.name(), reason: trial.end_reason() };
        }
        if let Some(ended) = errand.go_on(trial.ticks(), trial.time_s(), &platform.drift)? {
            break ended;
        }
    };
    let metrics = trial.metrics();
    let [time_s, took_s] = errand.took_s(trial.time_s());
    let [odometry, estimate] = platform.drift.off(&platform.odometry);
    Ok(DrivenOverRos {
        outcome: ended.outcome,
        reason: ended.reason,
        time_s,
        took_s,
        path_m: metrics.distance_m,
        max_abs_roll_rad: metrics.max_abs_roll_rad,
        max_abs_pitch_rad: metrics.max_abs_pitch_rad,
        distance_to_goal_m: trial.true_distance_to_goal_m(),
        odometry_off_m: odometry.plan_m,
        odometry_off_rad: odometry.yaw_rad,
        estimate_off_m: estimate.plan_m,
        estimate_off_rad: estimate.yaw_rad,
        feedback_off_m: errand.feedback_off_m,
        recoveries: errand.recoveries,
        unanswered,
    })
}
