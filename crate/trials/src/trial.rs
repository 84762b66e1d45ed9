//! One trial: a loop of world, scan, planner and command.

mod equipment;
mod stance;

pub use stance::Stance;

use core::convert::Infallible;
use core::time::Duration;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use mapless::gp::GpError;
use mapless::skyline::surface::PredictedSurface;
use mapless::{Command, Goal, Planner, PlannerConfig, Pose, Step};
use mapless_world::{
    Attitude, Body, Brush, Caster, Contact, ContactKind, DriveCommand, DriveError, Footing, HeightField,
    Lidar, Object, Objects, Robot, RobotConfig, RobotState, SampleRect, Scan, Scene, SensorConfig, Solid,
};

use crate::digest::TrajectoryDigest;
use crate::metrics::{Metrics, MetricsRecorder, Ride, Sample};
use crate::navigator::{Activity, Decision, Navigator, NavigatorStop};
use crate::outcome::Outcome;
use crate::places::StartPose;
use crate::progress_checker::ProgressChecker;
use crate::reality::{Reality, View, pose_of};
use crate::scenario::{Preset, Scenario};

/// Motion steps in one planning period.
const MOTION_STEPS: u32 = 10;

/// Why a trial cannot begin or change.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrialError {
    /// A place that is not on the terrain.
    #[error("{what} = ({:.3}, {:.3}) m: expected a place on the terrain, which spans (0, 0) to ({:.3}, {:.3}) m", place_m.x, place_m.y, extent_m.x, extent_m.y)]
    OffTerrain {
        /// `start`, `waypoint` or `goal`.
        what: &'static str,
        /// The place.
        place_m: DVec2,
        /// North-east corner of the terrain.
        extent_m: DVec2,
    },
    /// A configuration value outside its range.
    #[error("{0}")]
    Config(String),
}

/// Where something other than the trial's kinematic motion has moved the robot in a motion step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// Pose and motion.
    pub state: RobotState,
    /// What its wheels do, as the motion of a body that does not slip.
    pub wheels: DriveCommand,
    /// The tilt by which limits and metrics judge, without the shaking of an instant.
    pub judged: Attitude,
}

/// What a navigator is asked on a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Question {
    /// The robot's pose in the world, as it believes.
    pub pose: Pose,
    /// Its present target.
    pub goal: Goal,
    /// Since the last decision.
    pub elapsed: Duration,
}

/// A running trial, driven by this planner or by another navigator.
#[derive(Clone, Debug)]
pub struct Trial<N = Planner> {
    /// Shared by copies of the trial until one of them changes its ground.
    caster: Arc<Caster>,
    objects: Objects,
    sensor: Lidar,
    scan: Scan,
    husky: Robot,
    body: Body,
    /// What goes wrong.
    reality: Reality,
    navigator: N,
    decision: Decision,
    start: StartPose,
    waypoints_m: Vec<DVec2>,
    /// Waypoints behind the robot.
    passed: usize,
    goal_m: DVec2,
    goal_heading_rad: Option<f64>,
    seed: u64,
    tick: u64,
    metrics: MetricsRecorder,
    digest: TrajectoryDigest,
    progress: ProgressChecker,
    outcome: Option<Outcome>,
    contact: Option<Contact>,
}

impl Trial {
    /// Puts the scenario's robot on `field`; `seed` replaces the scenario's own.
    ///
    /// # Errors
    /// [`TrialError`] for a start or goal off the terrain or a configuration outside its range.
    pub fn new(
        field: HeightField,
        scenario: &Scenario,
        preset: Preset,
        seed: u64,
    ) -> Result<Self, TrialError> {
        let config = scenario.planner_config(preset).map_err(|e| TrialError::Config(e.to_string()))?;
        Self::with_planner(field, scenario, config, seed)
    }

    /// As [`Trial::new`], with another planner configuration.
    ///
    /// # Errors
    /// As [`Trial::new`].
    pub fn with_planner(
        field: HeightField,
        scenario: &Scenario,
        planner: PlannerConfig,
        seed: u64,
    ) -> Result<Self, TrialError> {
        let planner = Planner::new(planner).map_err(|e| TrialError::Config(e.to_string()))?;
        Self::with_navigator(field, scenario, planner, seed)
    }

    /// Changes the ground during the trial: the robot settles on it and forgets the terrain. Returns the
    /// samples that changed.
    ///
    /// # Errors
    /// [`TrialError::Config`] for a brush that is not valid.
    pub fn sculpt(&mut self, brush: &Brush) -> Result<Option<SampleRect>, TrialError> {
        let changed = Arc::make_mut(&mut self.caster)
            .sculpt(brush)
            .map_err(|e| TrialError::Config(format!("brush.{e}")))?;
        self.settle(changed.is_some());
        Ok(changed)
    }

    /// Replaces the heights in a rectangle, with the same consequences as [`Trial::sculpt`].
    ///
    /// # Errors
    /// [`TrialError::Config`] for heights that do not fit; nothing then changes.
    pub fn replace_ground(&mut self, rect: SampleRect, heights_m: &[f32]) -> Result<(), TrialError> {
        Arc::make_mut(&mut self.caster)
            .replace(rect, heights_m)
            .map_err(|e| TrialError::Config(e.to_string()))?;
        self.settle(true);
        Ok(())
    }

    /// Puts other objects on the ground, with the same consequences as [`Trial::sculpt`].
    ///
    /// # Errors
    /// [`TrialError::Config`] for an object that is not valid; nothing then changes.
    pub fn set_objects(&mut self, objects: Vec<Object>) -> Result<(), TrialError> {
        for (index, object) in objects.iter().enumerate() {
            let place = format!("objects[{}]", index + 1);
            object.validate(&place).map_err(|e| TrialError::Config(e.to_string()))?;
        }
        self.objects = Objects::new(objects, self.caster.field());
        self.settle(true);
        Ok(())
    }

    /// Settles the robot on the ground; the navigator forgets the terrain if it `changed`.
    fn settle(&mut self, changed: bool) {
        if changed {
            self.navigator.reset();
            self.objects.settle(self.caster.field());
        }
        let footing = Footing { field: self.caster.field(), solids: self.objects.solids() };
        let settled = self.husky.settle(&footing);
        self.reality.settled(&self.husky);
        if settled.is_err() {
            self.outcome = Some(Outcome::LeftTerrain);
        } else if self.outcome.is_some_and(|outcome| outcome != Outcome::Reached) {
            self.resume();
        }
    }

    /// The planner's last step.
    pub fn step(&self) -> Step<'_> {
        self.navigator.last_step()
    }

    /// The reconstructed occupancy and the variance surface of the last planner step's scan.
    ///
    /// # Errors
    /// [`GpError`] when there is no posterior.
    pub fn predicted_surface(&mut self) -> Result<&PredictedSurface, GpError> {
        self.navigator.predicted_surface()
    }

    /// The planner's configuration.
    pub fn planner_config(&self) -> &PlannerConfig {
        self.navigator.config()
    }
}

impl<N: Navigator> Trial<N> {
    /// Puts the scenario's robot on `field`, driven by `navigator`; the scenario's `[planner]` section is
    /// ignored.
    ///
    /// # Errors
    /// [`TrialError`] for a start or goal off the terrain or a sensor or robot outside its range.
    pub fn with_navigator(
        field: HeightField,
        scenario: &Scenario,
        navigator: N,
        seed: u64,
    ) -> Result<Self, TrialError> {
        let sensor: SensorConfig = scenario.sensor.clone();
        let reality = scenario.reality.clone();
        let sensor = Lidar::new(sensor)
            .and_then(|sensor| sensor.in_the_field(reality.sensing.clone()))
            .map_err(|e| TrialError::Config(e.to_string()))?;
        let objects = Objects::new(scenario.objects.clone().unwrap_or_default(), &field);
        let husky = place(&field, objects.solids(), scenario.robot.clone(), scenario.start)?
            .with_motion(reality.motion.clone());
        let body = Body::new(husky.config(), sensor.config().place_on_robot_m());
        check_route(&field, &scenario.waypoints_m, scenario.goal_m)?;
        let mut trial = Self {
            metrics: MetricsRecorder::new(sample_of(&husky)),
            caster: Arc::new(Caster::new(field)),
            objects,
            reality: Reality::new(reality, seed, &husky, MOTION_STEPS, sensor.config().period_s),
            sensor,
            scan: Scan::default(),
            husky,
            body,
            navigator,
            decision: Decision { activity: Activity::Searching, command: Command::STOP },
            start: scenario.start,
            waypoints_m: scenario.waypoints_m.clone(),
            passed: 0,
            goal_m: scenario.goal_m,
            goal_heading_rad: scenario.goal_heading_rad,
            seed,
            tick: 0,
            digest: TrajectoryDigest::default(),
            progress: ProgressChecker::default(),
            outcome: None,
            contact: None,
        };
        trial.restart_time_limit();
        Ok(trial)
    }

    /// Runs one planning period: [`Trial::look`], [`Trial::plan`], [`Trial::act`]. Does nothing once the
    /// trial has ended.
    pub fn tick(&mut self) -> Option<Outcome> {
        if self.outcome.is_none() {
            self.look();
            self.plan();
            self.act();
        }
        self.outcome
    }

    /// Takes a scan at the robot's pose, out to the navigator's range.
    pub fn look(&mut self) {
        // A scan without any return would mean a blind sensor, not a drop all around.
        if !self.look_as_far_as(self.navigator.sight_m()) {
            self.look_far();
        }
    }

    /// As [`Trial::look`], out to the sensor's range. It takes longer and changes no decision; for observers.
    pub fn look_far(&mut self) {
        if self.navigator.sight_m() > 0.0 {
            self.look_as_far_as(f64::INFINITY);
        }
    }

    /// Returns whether the sensor saw anything.
    fn look_as_far_as(&mut self, sight_m: f64) -> bool {
        if sight_m <= 0.0 {
            return false;
        }
        let RobotConfig { length_m, width_m, .. } = *self.husky.config();
        let outline_m = DVec2::new(length_m, width_m);
        let scene = Scene { caster: &self.caster, solids: self.objects.solids() };
        let view = View { scene, sight_m, outline_m, seed: self.seed, tick: self.tick };
        self.reality.look(&self.sensor, view, &mut self.scan)
    }

    /// Lets the navigator decide on the last scan. If none has arrived, the last decision holds.
    pub fn plan(&mut self) -> Decision {
        if let Some(question) = self.question() {
            self.decide(&question);
        }
        self.decision
    }

    /// What the navigator is asked on the last scan; `None` if none has arrived, and the last decision holds.
    /// [`Trial::plan`] asks and has the navigator answer at once. A navigator that first asks somebody else
    /// is given time between this and [`Trial::decide`].
    pub fn question(&mut self) -> Option<Question> {
        let sees = self.navigator.sight_m() > 0.0;
        let Some((pose, periods)) = self.reality.begin_decision(self.tick, sees) else {
            if self.decision.activity == Activity::Arrived {
                self.decision.activity = Activity::Searching;
            }
            return None;
        };
        let elapsed = Duration::from_secs_f64(self.period_s() * f64::from(periods));
        Some(Question { pose, goal: self.target(), elapsed })
    }

    /// Lets the navigator answer.
    pub fn decide(&mut self, Question { pose, goal, elapsed }: &Question) -> Decision {
        self.decision = self.navigator.navigate(&self.scan.points, pose, goal, *elapsed);
        self.decision
    }

    /// Moves the robot by the last decision until the next scan is due.
    pub fn act(&mut self) -> Option<Outcome> {
        let Ok(outcome) = self.act_with::<Infallible>(|robot, command, dt_s, footing| {
            Ok(robot.step(command, dt_s, footing).map(|()| robot.state().attitude))
        });
        outcome
    }

    /// As [`Trial::act`], where `motion` moves the robot in place of its own kinematic motion. In every
    /// motion step it is given what the drive tries to do and the seconds to do it in. Objects that walk do
    /// so all the same.
    ///
    /// # Errors
    /// Those of `motion`; the trial then stands within a period and cannot go on.
    pub fn act_by<E>(
        &mut self,
        mut motion: impl FnMut(DriveCommand, f64) -> Result<Moved, E>,
    ) -> Result<Option<Outcome>, E> {
        self.act_with(|robot, command, dt_s, footing| {
            let Moved { state, wheels, judged } = motion(command, dt_s)?;
            Ok(robot.move_to(state, wheels, footing).map(|()| judged))
        })
    }

    /// `motion` moves the robot and gives the tilt to judge it by.
    fn act_with<E>(
        &mut self,
        motion: impl FnMut(&mut Robot, DriveCommand, f64, &Footing<'_>) -> Result<Result<Attitude, DriveError>, E>,
    ) -> Result<Option<Outcome>, E> {
        let Decision { activity, command } = self.decision;
        self.outcome = match activity {
            Activity::Arrived if self.passed < self.waypoints_m.len() => {
                self.passed += 1;
                self.restart_time_limit();
                self.drive(command, motion)?
            }
            Activity::Arrived => Some(Outcome::Reached),
            Activity::Stopped(_) => Some(Outcome::NoSubgoal),
            Activity::Driving | Activity::Backtracking | Activity::Searching => {
                self.drive(command, motion)?
            }
        };
        self.tick += 1;
        if let Some((before, after)) = self.reality.correct(self.tick) {
            self.navigator.relocalise(&before, &after);
        }
        let here_m = self.husky.state().position;
        self.outcome = self.outcome.or_else(|| self.progress.check(here_m, self.tick));
        Ok(self.outcome)
    }

    fn drive<E>(
        &mut self,
        command: Command,
        mut motion: impl FnMut(
            &mut Robot,
            DriveCommand,
            f64,
            &Footing<'_>,
        ) -> Result<Result<Attitude, DriveError>, E>,
    ) -> Result<Option<Outcome>, E> {
        let command = DriveCommand { speed_m_s: command.linear_m_s, turn_rate_rad_s: command.angular_rad_s };
        let dt_s = self.period_s() / f64::from(MOTION_STEPS);
        for _ in 0..MOTION_STEPS {
            let obeyed = self.reality.obeyed(command);
            let field = self.caster.field();
            let here_m = self.husky.state().position;
            self.objects.walk(dt_s, field, here_m, |solid| self.body.is_clear_of(self.husky.state(), solid));
            let solids = self.objects.solids();
            let footing = Footing { field, solids };
            let judged = match motion(&mut self.husky, obeyed, dt_s, &footing)? {
                Ok(judged) => judged,
                Err(DriveError::LeftTerrain { .. }) => return Ok(Some(Outcome::LeftTerrain)),
                Err(DriveError::NotFinite { .. }) => return Ok(Some(Outcome::NoSubgoal)),
            };
            self.reality.moved(&self.husky);
            let Attitude { roll_rad, pitch_rad, .. } = judged;
            let sample = Sample { roll_rad, pitch_rad, ..sample_of(&self.husky) };
            self.metrics.record(sample, dt_s);
            self.digest.add(&sample, self.husky.state().yaw_rad);
            let state = self.body.on_wheels(self.husky.state(), &footing);
            self.contact = self.body.contact_with(solids, &state).or_else(|| {
                let touches = self.husky.motion().touches_ground;
                touches.then(|| self.body.contact_with_ground(field, &footing, &state)).flatten()
            });
            if let Some(contact) = self.contact {
                return Ok(Some(contact.kind.into()));
            }
            let limits = self.husky.config();
            if sample.roll_rad.abs() > limits.roll_limit_rad
                || sample.pitch_rad.abs() > limits.pitch_limit_rad
            {
                return Ok(Some(Outcome::TiltLimit));
            }
        }
        Ok(None)
    }

    /// Restarts the time limit, for the distance to the present target.
    fn restart_time_limit(&mut self) {
        let here_m = self.husky.state().position;
        let speed_m_s = self.navigator.max_speed_m_s().min(self.husky.config().max_speed_m_s);
        let straight_s = (self.target_m() - here_m).length() / speed_m_s;
        self.progress = ProgressChecker::new(here_m, self.tick, self.period_s(), straight_s);
    }

    /// Sets a new goal and continues; the metrics continue too.
    ///
    /// # Errors
    /// [`TrialError::OffTerrain`]; the goal then stays as it was.
    pub fn set_goal(&mut self, goal_m: DVec2) -> Result<(), TrialError> {
        self.set_route(Vec::new(), goal_m, None)
    }

    /// As [`Trial::set_goal`], with waypoints before the goal, in order, and a final heading, if any.
    ///
    /// # Errors
    /// [`TrialError::OffTerrain`]; the route then stays as it was.
    pub fn set_route(
        &mut self,
        waypoints_m: Vec<DVec2>,
        goal_m: DVec2,
        goal_heading_rad: Option<f64>,
    ) -> Result<(), TrialError> {
        check_route(self.caster.field(), &waypoints_m, goal_m)?;
        (self.waypoints_m, self.passed) = (waypoints_m, 0);
        (self.goal_m, self.goal_heading_rad) = (goal_m, goal_heading_rad);
        self.resume();
        Ok(())
    }

    /// Moves the robot to another start and begins again there, on the ground as it is now.
    ///
    /// # Errors
    /// [`TrialError::OffTerrain`]; nothing then changes.
    pub fn set_start(&mut self, start: StartPose) -> Result<(), TrialError> {
        let motion = self.husky.motion().clone();
        let objects = Objects::new(self.objects.list().to_vec(), self.caster.field());
        let husky = place(self.caster.field(), objects.solids(), self.husky.config().clone(), start)?;
        self.husky = husky.with_motion(motion);
        self.objects = objects;
        self.reality.restart(self.seed, &self.husky);
        self.decision = Decision { activity: Activity::Searching, command: Command::STOP };
        self.start = start;
        self.passed = 0;
        self.tick = 0;
        self.metrics = MetricsRecorder::new(sample_of(&self.husky));
        self.digest = TrajectoryDigest::default();
        self.navigator.reset();
        self.resume();
        Ok(())
    }

    /// Continues an ended trial after a change.
    fn resume(&mut self) {
        self.outcome = None;
        self.contact = None;
        self.restart_time_limit();
    }

    /// How the trial ended; `None` while it runs.
    pub fn outcome(&self) -> Option<Outcome> {
        self.outcome
    }

    /// What the body touched to end the trial, if it did.
    pub fn contact(&self) -> Option<Contact> {
        self.contact
    }

    /// What stands and walks on the ground.
    pub fn objects(&self) -> &Objects {
        &self.objects
    }

    /// Why the trial ended, in a sentence: what the body touched, or why the navigator stopped.
    pub fn end_reason(&self) -> Option<String> {
        let of_contact = self.contact.map(|Contact { kind, place_m, object }| {
            let object = object.and_then(|index| Some((index, self.objects.list().get(index)?)));
            let thing = object.map_or("the ground".to_owned(), |(index, object)| {
                format!("{} {}", object.name(), index + 1)
            });
            let what = match kind {
                ContactKind::Collision => "the body ran into",
                ContactKind::HighCentred => "the belly or a bumper is on",
                ContactKind::Step => "a wheel is against a step of",
            };
            format!("{what} {thing} at ({:.2}, {:.2}) m", place_m.x, place_m.y)
        });
        of_contact.or_else(|| self.stop_reason().map(|reason| reason.to_string()))
    }

    /// Why the navigator stopped, if it did.
    pub fn stop_reason(&self) -> Option<NavigatorStop> {
        match self.decision.activity {
            Activity::Stopped(reason) => Some(reason),
            Activity::Driving | Activity::Arrived | Activity::Backtracking | Activity::Searching => None,
        }
    }

    /// The navigator that drives the robot.
    pub fn navigator(&self) -> &N {
        &self.navigator
    }

    /// The navigator, to tell it something between question and answer.
    pub fn navigator_mut(&mut self) -> &mut N {
        &mut self.navigator
    }

    /// The last scan that arrived, in the sensor frame of the pose before the last motion, unless scans are
    /// late.
    pub fn scan(&self) -> &Scan {
        &self.scan
    }

    /// The ground.
    pub fn field(&self) -> &HeightField {
        self.caster.field()
    }

    /// The ground with its ray-casting hierarchy.
    pub fn caster(&self) -> &Caster {
        &self.caster
    }

    /// The sensor.
    pub fn sensor(&self) -> &Lidar {
        &self.sensor
    }

    /// The robot's motion.
    pub fn robot(&self) -> &RobotState {
        self.husky.state()
    }

    /// The robot's true pose.
    pub fn pose(&self) -> Pose {
        pose_of(&self.husky)
    }

    /// The pose that the robot believes, in whose frame the goal is reached. A scan that arrives late comes
    /// with the one that was believed when it was taken.
    pub fn believed_pose(&self) -> Pose {
        self.reality.believed_pose(self.tick)
    }

    /// Distance from where the robot truly is to the goal, seen from above, metres.
    pub fn true_distance_to_goal_m(&self) -> f64 {
        (self.goal_m - self.husky.state().position).length()
    }

    /// x, y, z in metres; roll, pitch, yaw in radians; speed in m/s and turn rate in rad/s.
    pub fn motion(&self) -> [f64; 8] {
        let (pose, robot) = (self.pose(), self.robot());
        let [x, y, z] = pose.position_m.to_array();
        [x, y, z, pose.roll_rad, pose.pitch_rad, pose.yaw_rad, robot.speed_m_s, robot.turn_rate_rad_s]
    }

    /// The start.
    pub fn start(&self) -> StartPose {
        self.start
    }

    /// The goal.
    pub fn goal_m(&self) -> DVec2 {
        self.goal_m
    }

    /// The waypoints before the goal, in order.
    pub fn waypoints_m(&self) -> &[DVec2] {
        &self.waypoints_m
    }

    /// The number of waypoints passed.
    pub fn waypoints_passed(&self) -> usize {
        self.passed
    }

    /// The present target: the next waypoint, or the goal.
    pub fn target_m(&self) -> DVec2 {
        self.waypoints_m.get(self.passed).copied().unwrap_or(self.goal_m)
    }

    /// The present target; with the final heading if it is the goal and has one.
    pub fn target(&self) -> Goal {
        let target = Goal::at(self.target_m());
        let is_last = self.passed >= self.waypoints_m.len();
        self.goal_heading_rad.filter(|_| is_last).map_or(target, |heading_rad| target.facing(heading_rad))
    }

    /// The final heading; any if `None`.
    pub fn goal_heading_rad(&self) -> Option<f64> {
        self.goal_heading_rad
    }

    /// Time between two scans, in seconds.
    pub fn period_s(&self) -> f64 {
        self.sensor.config().period_s
    }

    /// Planning periods run.
    pub fn ticks(&self) -> u64 {
        self.tick
    }

    /// Simulated time.
    pub fn time_s(&self) -> f64 {
        self.tick as f64 * self.period_s()
    }

    /// The paper's metrics so far.
    pub fn metrics(&self) -> Metrics {
        self.metrics.metrics()
    }

    /// What others measure of the drive so far.
    pub fn ride(&self) -> Ride {
        self.metrics.ride()
    }

    /// Digest of the trajectory so far, 32 hexadecimal digits.
    pub fn digest(&self) -> String {
        self.digest.hex(self.outcome)
    }
}

fn place(
    field: &HeightField,
    solids: &[Solid],
    robot: RobotConfig,
    start: StartPose,
) -> Result<Robot, TrialError> {
    Robot::new(robot, &Footing { field, solids }, start.position_m, start.heading_rad).map_err(|_| {
        TrialError::OffTerrain { what: "start", place_m: start.position_m, extent_m: field.extent_m() }
    })
}

fn check_route(field: &HeightField, waypoints_m: &[DVec2], goal_m: DVec2) -> Result<(), TrialError> {
    waypoints_m.iter().try_for_each(|&place_m| on_terrain(field, "waypoint", place_m))?;
    on_terrain(field, "goal", goal_m)
}

fn on_terrain(field: &HeightField, what: &'static str, place_m: DVec2) -> Result<(), TrialError> {
    if field.contains(place_m) {
        Ok(())
    } else {
        Err(TrialError::OffTerrain { what, place_m, extent_m: field.extent_m() })
    }
}

fn sample_of(husky: &Robot) -> Sample {
    let state = husky.state();
    let position_m: DVec3 = husky.position();
    Sample {
        position_m,
        roll_rad: state.attitude.roll_rad,
        pitch_rad: state.attitude.pitch_rad,
        speed_m_s: state.speed_m_s,
        turn_rate_rad_s: state.turn_rate_rad_s,
    }
}
