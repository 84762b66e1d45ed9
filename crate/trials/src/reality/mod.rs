//! What the real world does to sensing, knowing and doing: the section `[reality]` of a scenario, and its
//! state in a trial. The models are in [`mapless_world`] where they belong to sensor or robot.

mod commands;
mod config;
mod delivery;
mod localisation;
mod pose_config;
mod presets;
mod trail;

pub use config::{RealityConfig, RealityPreset};
pub use pose_config::PoseConfig;

use commands::Commands;
use delivery::Delivery;
use glam::DVec2;
use localisation::Localisation;
use mapless::Pose;
use mapless_world::{Attitude, DriveCommand, Lidar, MotionCompensation, Robot, Scan, Scene, compensate};
use trail::Trail;

/// The state of everything that goes wrong in a trial.
#[derive(Clone, Debug)]
pub(crate) struct Reality {
    config: RealityConfig,
    localisation: Localisation,
    commands: Commands,
    delivery: Delivery,
    /// Motion steps in a period, and the time of one.
    steps: u32,
    step_s: f64,
    /// True poses of the last period.
    true_trail: Trail,
    /// What the odometry said, as far back as it is asked for.
    odometry_trail: Trail,
    /// Tick and odometry of a scan that has arrived and awaits a decision, where scans are late or lost.
    arrived: Option<(u64, Pose)>,
    /// Periods since the last decision.
    periods: u32,
}

impl Reality {
    /// Of a robot that sets out; there are `steps` motion steps in a period of `period_s`.
    pub(crate) fn new(config: RealityConfig, seed: u64, robot: &Robot, steps: u32, period_s: f64) -> Self {
        let truth = pose_of(robot);
        let step_s = period_s / f64::from(steps);
        let localisation = Localisation::new(config.pose.clone(), seed, truth);
        let memory = (config.pose.latency_s / step_s).ceil() as usize;
        Self {
            commands: Commands::new(&config.motion, step_s),
            delivery: Delivery::new(&config.sensing, seed),
            steps,
            step_s,
            true_trail: Trail::new(steps as usize, truth),
            odometry_trail: Trail::new(memory.max(steps as usize), localisation.odometry()),
            localisation,
            arrived: None,
            periods: 0,
            config,
        }
    }

    /// As at the start, with `robot` there.
    pub(crate) fn restart(&mut self, seed: u64, robot: &Robot) {
        let period_s = self.step_s * f64::from(self.steps);
        *self = Self::new(self.config.clone(), seed, robot, self.steps, period_s);
    }

    /// Whether the same goes wrong in both.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.config == other.config
    }

    /// Takes a scan into `scan`; returns whether the sensor saw anything. Late and lost scans leave `scan` as
    /// it was.
    pub(crate) fn look(&mut self, sensor: &Lidar, view: View<'_>, scan: &mut Scan) -> bool {
        if self.delivery.is_ideal() {
            self.scan(sensor, view, scan);
            return !scan.points.is_empty();
        }
        let mut taken = Scan::default();
        self.scan(sensor, view, &mut taken);
        let saw_something = !taken.points.is_empty();
        let arrived = self.delivery.send(view.tick, taken, self.odometry());
        self.arrived = arrived.map(|(tick, arrived, odometry)| {
            *scan = arrived;
            (tick, odometry)
        });
        saw_something
    }

    fn scan(&self, sensor: &Lidar, view: View<'_>, scan: &mut Scan) {
        let View { scene, sight_m, outline_m, seed, tick } = view;
        let sensing = &self.config.sensing;
        // A point at the origin must not stand for a return that was merely left out.
        let sight_m = if sensing.zeros { f64::INFINITY } else { sight_m };
        let seen_from = |steps_ago: f64| {
            let pose = self.true_trail.ago(steps_ago);
            sensor.true_pose_on(pose.plan_m(), pose.yaw_rad, &attitude(&pose))
        };
        if sensing.sweep {
            let ago = |share: f64| (1.0 - share) * f64::from(self.steps);
            sensor.scan_along(sight_m, &scene, |share| seen_from(ago(share)), seed, tick, scan);
            if sensing.motion_compensation == MotionCompensation::Odometry {
                let believed_from = |share: f64| {
                    let pose = self.odometry_trail.ago(ago(share));
                    sensor.config().pose_on(pose.plan_m(), pose.yaw_rad, &attitude(&pose))
                };
                compensate(scan, sensor.config().rings, &believed_from(1.0), believed_from);
            }
        } else {
            sensor.scan_within(sight_m, &scene, &seen_from(0.0), seed, tick, scan);
        }
        sensor.add_zeros(scan);
        sensor.add_self_returns(outline_m, seed, tick, &mut scan.points);
    }

    /// The odometry that the robot has now, which may be old.
    fn odometry(&self) -> Pose {
        self.odometry_trail.ago(self.config.pose.latency_s / self.step_s)
    }

    /// What the robot believes of its pose at `tick`.
    pub(crate) fn believed_pose(&self, tick: u64) -> Pose {
        self.localisation.believed(self.odometry(), tick)
    }

    /// The pose to decide on and the periods that have passed since the last decision; none if no scan has
    /// arrived. `sees` tells whether the decision needs one.
    pub(crate) fn begin_decision(&mut self, tick: u64, sees: bool) -> Option<(Pose, u32)> {
        self.periods += 1;
        let pose = if sees && !self.delivery.is_ideal() {
            let (tick, odometry) = self.arrived.take()?;
            self.localisation.believed(odometry, tick)
        } else {
            self.believed_pose(tick)
        };
        Some((pose, std::mem::take(&mut self.periods)))
    }

    /// What the drive tries to do in the motion step for which `command` is given.
    pub(crate) fn obeyed(&mut self, command: DriveCommand) -> DriveCommand {
        self.commands.obeyed(command)
    }

    /// The robot has made a motion step.
    pub(crate) fn moved(&mut self, robot: &Robot) {
        let (before, after) = (self.true_trail.ago(0.0), pose_of(robot));
        self.localisation.moved(&before, &after, robot.wheels().speed_m_s * self.step_s);
        self.true_trail.push(after);
        self.odometry_trail.push(self.localisation.odometry());
    }

    /// The ground has changed under the robot.
    pub(crate) fn settled(&mut self, robot: &Robot) {
        let (before, after) = (self.true_trail.ago(0.0), pose_of(robot));
        self.localisation.settled(&before, &after);
        self.true_trail.settle(after);
        self.odometry_trail.settle(self.localisation.odometry());
    }

    /// Corrects the drift if that is due at `tick`; returns the believed poses before and after if the
    /// planner is told.
    pub(crate) fn correct(&mut self, tick: u64) -> Option<(Pose, Pose)> {
        let period_s = self.step_s * f64::from(self.steps);
        let poses = self.localisation.correct(&self.true_trail.ago(0.0), tick, period_s);
        poses.filter(|_| self.config.pose.relocalises)
    }
}

/// What a scan is taken of.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) scene: Scene<'a>,
    pub(crate) sight_m: f64,
    /// Length and width of the robot.
    pub(crate) outline_m: DVec2,
    pub(crate) seed: u64,
    pub(crate) tick: u64,
}

/// The true pose of a robot.
pub(crate) fn pose_of(robot: &Robot) -> Pose {
    let state = robot.state();
    Pose::from_roll_pitch_yaw(
        robot.position(),
        state.attitude.roll_rad,
        state.attitude.pitch_rad,
        state.yaw_rad,
    )
}

fn attitude(pose: &Pose) -> Attitude {
    Attitude { height_m: pose.position_m.z, roll_rad: pose.roll_rad, pitch_rad: pose.pitch_rad }
}
