//! The robot between physics engine and network.

use std::collections::VecDeque;

use mapless_node::messages::{Time, Twist};
use mapless_robot::drive_config::DriveConfig;
use mapless_trials::Moved;
use mapless_world::DriveCommand;

use super::drift::Drift;
use super::imu::ImuModel;
use super::odometry::WheelOdometry;
use super::robot::Robot;
use crate::engine::{Engine, State};
use crate::motion::Motion;

/// When a drive begins on the simulation's clock: some drivers take 0 for no time.
const BEGIN_NS: i64 = 100_000_000_000;
const STEP_NS: i64 = 10_000_000;
/// The IMU is told at every step, 100 Hz; odometry at 50 Hz and the emergency stop at 10 Hz.
const STEPS_PER_ODOMETRY: u64 = 2;
const STEPS_PER_STOP: u64 = 10;
/// The robot between physics engine and network.
pub(crate) struct Platform {
    engine: Engine,
    state: State,
    motion: Motion,
    pub(crate) robot: Robot,
    imu: ImuModel,
    pub(crate) odometry: WheelOdometry,
    pub(crate) drift: Drift,
    steps: u64,
    /// Commands on their way to the wheels, the oldest first.
    waiting: VecDeque<DriveCommand>,
}

impl Platform {
    /// A robot at rest whose commands reach the wheels `latency_s` late, with errors by `seed`. `config` is
    /// the node's.
    pub(crate) fn new(
        engine: Engine,
        rest: State,
        robot: Robot,
        config: &DriveConfig,
        latency_s: f64,
        seed: u64,
    ) -> anyhow::Result<Self> {
        let latency_steps = (latency_s * 1e9 / STEP_NS as f64).round() as usize;
        Ok(Self {
            imu: ImuModel::new(seed, rest.pose()),
            drift: Drift::new(config, rest.pose())?,
            state: rest,
            motion: Motion::new(rest),
            odometry: WheelOdometry::default(),
            steps: 0,
            waiting: vec![DriveCommand::default(); latency_steps].into(),
            engine,
            robot,
        })
    }

    /// The time on the simulation's clock.
    pub(crate) fn now(&self) -> Time {
        self.time(0)
    }

    /// That of some steps ago.
    fn time(&self, steps_ago: i64) -> Time {
        Time::from_nanoseconds(BEGIN_NS + (self.steps as i64 - steps_ago) * STEP_NS)
    }

    /// Drives on for a step, tells what was measured, and waits for the node's command. It commands at least
    /// every other step.
    ///
    /// A robot that is held does not move: MuJoCo's tyres creep on a slope, and a turn at rest looks to the
    /// node like the gyro's bias.
    pub(crate) fn step(&mut self, seconds: f64, is_held: bool) -> anyhow::Result<Moved> {
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
