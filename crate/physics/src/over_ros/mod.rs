//! A task driven by the node itself: over DDS, with the odometry and the IMU of a robot, and no true pose.

mod cloud;
mod drift;
mod imu;
mod node;
mod odometry;
mod robot;

use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context as _, ensure};
use clap::Args;
use glam::DVec2;
use mapless::{Command, Goal, Pose};
use mapless_node::messages::{Time, Twist};
use mapless_peer::{NavigateClient, goal, navigate_client, send};
use mapless_trials::{Activity, Decision, LoadedScenario, Moved, Navigator, Outcome, Trial};
use mapless_world::DriveCommand;
use ros2_client::action::{GoalId, GoalStatusEnum};
use ros2_client::service::request_id::RmwRequestId;

use crate::engine::{Engine, State};
use crate::motion::Motion;
use crate::simulator;
use drift::Drift;
use imu::ImuModel;
use node::NodeProcess;
use odometry::WheelOdometry;
use robot::Robot;

/// When a drive begins on the simulation's clock: some drivers take 0 for no time.
const BEGIN_NS: i64 = 100_000_000_000;
const STEP_NS: i64 = 10_000_000;
/// The IMU is told at every step, 100 Hz; odometry at 50 Hz and the emergency stop at 10 Hz.
const STEPS_PER_ODOMETRY: u64 = 2;
const STEPS_PER_STOP: u64 = 10;
/// The robot stands for so many periods before it gets its goal, and as many again if that is refused: long
/// enough for the gyro's bias.
const STAND_PERIODS: u64 = 50;
const ASK_AGAIN_PERIODS: u64 = 5;
/// Goals that are refused before a drive is given up.
const MOST_REFUSALS: u64 = 60;

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
    outcome: String,
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
    /// Scans that the planner did not answer.
    unanswered: u64,
}

/// Stands in the trial where a planner would: what drives is elsewhere.
#[derive(Clone, Copy, Debug)]
struct Elsewhere {
    max_speed_m_s: f64,
}

impl Navigator for Elsewhere {
    fn navigate(&mut self, _: &[glam::Vec3], _: &Pose, _: &Goal, _: std::time::Duration) -> Decision {
        Decision { activity: Activity::Driving, command: Command::STOP }
    }

    fn max_speed_m_s(&self) -> f64 {
        self.max_speed_m_s
    }

    fn reset(&mut self) {}
}

/// The robot between physics engine and network.
struct Platform {
    engine: Engine,
    state: State,
    motion: Motion,
    robot: Robot,
    imu: ImuModel,
    odometry: WheelOdometry,
    drift: Drift,
    steps: u64,
    /// Commands on their way to the wheels, the oldest first.
    waiting: VecDeque<DriveCommand>,
}

/// The goal at the node.
enum Errand {
    None { refusals: u64 },
    Pursued { id: GoalId, request: RmwRequestId, since_s: f64, began: Instant },
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
    let mut client_node = mapless_peer::join(args.domain, "client")?;
    let client = navigate_client(&mut client_node)?;
    robot.meet()?;
    let latency_steps = (scenario.reality.motion.latency_s * 1e9 / STEP_NS as f64).round() as usize;
    let mut platform = Platform {
        imu: ImuModel::new(args.seed, rest.pose()),
        drift: Drift::new(&node.config.drive, rest.pose())?,
        state: rest,
        motion: Motion::new(rest),
        odometry: WheelOdometry::default(),
        steps: 0,
        waiting: vec![DriveCommand::default(); latency_steps].into(),
        engine,
        robot,
    };
    let goal_m = platform.drift.in_odometry(scenario.goal_m);

    let mut errand = Errand::None { refusals: 0 };
    let (mut unanswered, mut feedback_off_m) = (0, 0.0_f64);
    let ended = loop {
        trial.look();
        if let Some(question) = trial.question() {
            trial.decide(&question);
            let cloud = cloud::cloud(&trial.scan().points, trial.sensor().config(), platform.now());
            let is_pursuing = matches!(errand, Errand::Pursued { .. });
            unanswered += u64::from(!platform.robot.tell_scan(cloud, is_pursuing)?);
        }
        let is_held = matches!(errand, Errand::None { .. });
        let moved = trial.act_by(|_, seconds| platform.step(seconds, is_held)).with_context(file)?;
        if let Some(outcome) = moved {
            break Ended::by_the_world(outcome, trial.end_reason());
        }
        match &mut errand {
            Errand::None { refusals } => {
                if trial.ticks() == STAND_PERIODS + *refusals * ASK_AGAIN_PERIODS {
                    match ask(&client, goal_m)? {
                        Some(id) => {
                            let request = client
                                .request_result(id)
                                .map_err(|error| anyhow::anyhow!("asking for the result: {error}"))?;
                            let (since_s, began) = (trial.time_s(), Instant::now());
                            errand = Errand::Pursued { id, request, since_s, began };
                        }
                        None => *refusals += 1,
                    }
                    if let Errand::None { refusals } = errand {
                        ensure!(refusals < MOST_REFUSALS, "the node takes no goal");
                    }
                }
            }
            Errand::Pursued { id, request, .. } => {
                while let Ok(Some(feedback)) = client.receive_feedback(*id) {
                    let stamp = feedback.current_pose.header.stamp;
                    if let Some(distance_m) = platform.drift.distance_m(goal_m, stamp) {
                        let off_m = distance_m - f64::from(feedback.distance_remaining);
                        feedback_off_m = feedback_off_m.max(off_m.abs());
                    }
                }
                if let Ok(Some((status, result))) = client.receive_result(*request) {
                    break Ended::by_the_node(status, result.error_code, result.error_msg);
                }
            }
        }
    };
    let metrics = trial.metrics();
    let (time_s, took_s) = match errand {
        Errand::None { .. } => (trial.time_s(), 0.0),
        Errand::Pursued { since_s, began, .. } => (trial.time_s() - since_s, began.elapsed().as_secs_f64()),
    };
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
        feedback_off_m,
        unanswered,
    })
}

/// Asks the node to drive there; the goal's id, if it accepts.
fn ask(client: &NavigateClient, goal_m: DVec2) -> anyhow::Result<Option<GoalId>> {
    let answer = send(client, goal("odom", goal_m.x, goal_m.y))?;
    Ok(answer.filter(|(_, is_accepted)| *is_accepted).map(|(id, _)| id))
}

/// How a drive ended.
struct Ended {
    outcome: String,
    reason: Option<String>,
}

impl Ended {
    fn by_the_world(outcome: Outcome, reason: Option<String>) -> Self {
        Self { outcome: outcome.name().to_owned(), reason }
    }

    fn by_the_node(status: GoalStatusEnum, code: u16, text: String) -> Self {
        if status == GoalStatusEnum::Succeeded {
            return Self { outcome: Outcome::Reached.name().to_owned(), reason: None };
        }
        Self { outcome: "aborted".to_owned(), reason: Some(format!("{code}: {text}")) }
    }
}

impl Platform {
    /// The time on the simulation's clock.
    fn now(&self) -> Time {
        self.time(0)
    }

    /// That of some steps ago.
    fn time(&self, steps_ago: i64) -> Time {
        Time::from_nanoseconds(BEGIN_NS + (self.steps as i64 - steps_ago) * STEP_NS)
    }

    /// Drives on for a step, tells what was measured, and waits for the node's command. It commands at least
    /// every other step.
    ///
    /// A robot that is held does not move: MuJoCo's tyres creep on a slope, and a turn at rest looks to the node
    /// like the gyro's bias.
    fn step(&mut self, seconds: f64, is_held: bool) -> anyhow::Result<Moved> {
        let command = self.waiting.pop_front().unwrap_or_default();
        if !is_held {
            self.state = self.engine.drive(command, seconds)?;
        }
        let state = self.state;
        self.steps += 1;
        let now = self.now();
        self.robot.tell_clock(now)?;
        let imu = self.imu.measure(state.pose(), seconds, now);
        self.drift.take_imu(&imu);
        self.robot.tell_imu(imu)?;
        self.odometry.turn(state.wheels, seconds);
        if self.steps.is_multiple_of(STEPS_PER_ODOMETRY) {
            let odometry = self.odometry.message(now);
            self.drift.take_odometry(&odometry);
            self.robot.tell_odometry(odometry)?;
        }
        if self.steps.is_multiple_of(STEPS_PER_STOP) {
            self.robot.tell_released()?;
        }
        self.drift.move_to(state.pose());
        let Twist { linear, angular } = self.robot.command(self.time(1), now)?;
        self.waiting.push_back(DriveCommand { speed_m_s: linear.x, turn_rate_rad_s: angular.z });
        Ok(self.motion.moved(state, seconds))
    }
}
