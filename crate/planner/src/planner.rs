//! The planner: one type with one step.

use core::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3};

use crate::config::{CostModel, DecisionConfig, PlannerConfig, StateLatticeConfig};
use crate::control::backtrack::{Backtrack, BacktrackCommand};
use crate::control::controller::{Command, Controller};
use crate::decision::candidates::Candidates;
use crate::decision::committed_target::CommittedTarget;
use crate::decision::cost::{self, Situation};
use crate::decision::detour_budget::DetourBudget;
use crate::decision::step::{PerceptionOverride, Status, Step, StopReason};
use crate::decision::subgoals::{Subgoal, bearing_rad};
use crate::error::ConfigError;
use crate::gp::jitter::GpError;
use crate::math::angle::wrap_rad;
use crate::pose::Pose;
use crate::route::heuristic_table::HeuristicTable;
use crate::route::state_lattice::{PathPoint, ReachedState, StateLattice, length_m};
use crate::skyline::beam_grid::BeamGrid;
use crate::skyline::occupancy::{COLUMNS, OccupancySurface, column_azimuth_rad};
use crate::skyline::perception::Perception;
use crate::skyline::profile::ElevationProfile;
use crate::skyline::segments::{Segment, cut_segments};
use crate::skyline::surface::PredictedSurface;
use crate::terrain::elevation_window::ElevationWindow;

/// Poses and goals farther from the origin make no sense; cells and places are counted in 32 bits.
const FARTHEST_M: f64 = 1e6;
/// Room for the longest way.
const MAX_PATH_POINTS: usize = 256;
/// What is known of dead ends is brought up to date when the robot has driven this far.
const LEARN_SPACING_M: f64 = 0.5;
/// On the way back it drives as fast as with this much left of it.
const LEAST_BACK_M: f64 = 0.3;
/// A robot that has lost its patience minds steep ground by this share.
const IMPATIENT_SHARE: f64 = 0.25;
/// Under the robot the ground is taken for known at places no farther apart than this.
const WHEEL_GROUND_M: f64 = 0.35;
/// What the robot cannot get to lies this much farther from the goal than it seemed, with the places around it.
const IN_VAIN_M: f64 = 7.0;
const IN_VAIN_HALF_SIDE_M: f64 = 1.0;

/// Scan, pose and goal in; subgoal and command out. No map: it keeps the ground that the last scans saw, where it has
/// been, and its last choice.
#[derive(Clone, Debug)]
pub struct Planner {
    config: PlannerConfig,
    observed: OccupancySurface,
    perception: Perception,
    profile: ElevationProfile,
    segments: Vec<Segment>,
    subgoals: Vec<Subgoal>,
    ground: ElevationWindow,
    controller: Controller,
    lattice: StateLattice,
    path: Vec<PathPoint>,
    /// As configured, less what patience lost takes off.
    decision: DecisionConfig,
    heuristic: HeuristicTable,
    patience: Option<DetourBudget>,
    committed: CommittedTarget,
    backtrack: Backtrack,
    learned_at_m: Option<DVec2>,
    ends: Vec<(ReachedState, f64)>,
    goal_m: Option<DVec2>,
    last_bearing_rad: Option<f64>,
    searched_ticks: u32,
    status: Status,
    command: Command,
    chosen: Option<usize>,
}

impl Planner {
    /// A planner that has seen nothing yet.
    ///
    /// # Errors
    /// [`ConfigError`] for a value that makes no sense.
    pub fn new(config: PlannerConfig) -> Result<Self, ConfigError> {
        config.validate()?;
        let grid = BeamGrid::new(&config.sensor);
        let lattice =
            StateLattice::new(config.state_lattice, &config.robot, config.perception.surface_radius_m);
        Ok(Self {
            perception: Perception::new(config.perception, &grid),
            observed: OccupancySurface::new(config.perception.surface_radius_m, grid),
            profile: Vec::new(),
            segments: Vec::new(),
            subgoals: Vec::new(),
            ground: ElevationWindow::new(&config),
            controller: Controller::new(config.controller),
            path: Vec::with_capacity(MAX_PATH_POINTS),
            decision: config.decision,
            heuristic: HeuristicTable::new(config.state_lattice.step_m),
            patience: None,
            committed: CommittedTarget::default(),
            backtrack: Backtrack::new(),
            learned_at_m: None,
            ends: Vec::with_capacity(lattice.count() + 1),
            lattice,
            goal_m: None,
            last_bearing_rad: None,
            searched_ticks: 0,
            status: Status::Searching,
            command: Command::STOP,
            chosen: None,
            config,
        })
    }

    /// The configuration.
    pub fn config(&self) -> &PlannerConfig {
        &self.config
    }

    /// Forgets everything seen, learned and driven, as after a change of the world.
    pub fn reset(&mut self) {
        self.perception.reset(self.config.perception, self.observed.grid());
        self.ground.clear();
        self.lattice.clear();
        self.backtrack.clear();
        self.goal_m = None;
    }

    /// One step: `points_m` are the scan's returns in the sensor frame, `pose` the robot's in the world, `goal_m` the goal
    /// seen from above, in the world.
    ///
    /// The answer to anything that makes no sense is a stop with its reason.
    pub fn step(&mut self, points_m: &[Vec3], pose: &Pose, goal_m: DVec2) -> Step<'_> {
        self.step_with(points_m, pose, goal_m, PerceptionOverride::default())
    }

    /// As [`Planner::step`], with what `insight` tells in place of what the scans say.
    pub fn step_with(
        &mut self,
        points_m: &[Vec3],
        pose: &Pose,
        goal_m: DVec2,
        overrides: PerceptionOverride<'_>,
    ) -> Step<'_> {
        self.chosen = None;
        self.path.clear();
        self.subgoals.clear();
        self.segments.clear();
        if self.goal_m != Some(goal_m) {
            self.goal_m = Some(goal_m);
            self.heuristic.clear();
            self.patience = None;
            self.scale_slope_cost(true);
            self.lattice.stand();
            self.committed.stand();
            self.backtrack.end();
            self.learned_at_m = None;
            self.last_bearing_rad = None;
            self.searched_ticks = 0;
            self.controller.reset();
        }
        self.status = self.decide(points_m, pose, goal_m, overrides);
        self.command = match self.status {
            Status::Driving | Status::Backtracking => self.command,
            Status::Searching if self.may_spin() => self.controller.spin(),
            Status::Searching => Command::STOP,
            Status::Arrived | Status::Stopped(_) => {
                self.controller.reset();
                Command::STOP
            }
        };
        self.last_step()
    }

    /// What the last step saw and decided.
    pub fn last_step(&self) -> Step<'_> {
        Step {
            status: self.status,
            command: self.command,
            observed: &self.observed,
            diagnostics: self.perception.diagnostics(),
            profile: &self.profile,
            segments: &self.segments,
            subgoals: &self.subgoals,
            chosen: self.chosen,
            path: &self.path,
        }
    }

    /// The reconstructed occupancy and the variance surface of the last step's scan. A step itself needs only their edge, so
    /// they are predicted here.
    ///
    /// # Errors
    /// [`GpError`] when there is no posterior.
    pub fn predicted_surface(&mut self) -> Result<&PredictedSurface, GpError> {
        self.perception.surface(&self.observed)
    }

    fn decide(
        &mut self,
        points_m: &[Vec3],
        pose: &Pose,
        goal_m: DVec2,
        overrides: PerceptionOverride<'_>,
    ) -> Status {
        let near = |place_m: DVec2| place_m.abs().max_element() < FARTHEST_M;
        if !(pose.is_finite() && near(pose.plan_m()) && near(goal_m)) {
            return Status::Stopped(StopReason::InvalidInput);
        }
        if points_m.is_empty() && overrides.profile.is_none() {
            return Status::Stopped(StopReason::EmptyScan);
        }
        if let Err(error) = self.perceive(points_m, overrides) {
            return Status::Stopped(StopReason::NoPerception(error));
        }
        self.remember(points_m, pose);
        if (goal_m - pose.plan_m()).length() <= self.config.goal_tolerance_m {
            return Status::Arrived;
        }

        let chosen = match self.config.decision.cost_model {
            CostModel::Paper => self.choose(pose, goal_m),
            CostModel::Forecast => {
                let here_m = pose.plan_m();
                if self.patience.get_or_insert_with(|| DetourBudget::new(here_m, goal_m)).lost(here_m) {
                    self.scale_slope_cost(false);
                    self.heuristic.scale(IMPATIENT_SHARE);
                }
                match overrides.ground {
                    Some(told) => self.lattice.search(&told, pose),
                    None => self.lattice.search(&self.ground, pose),
                }
                self.choose(pose, goal_m).or_else(|| {
                    self.lattice.search_escape();
                    self.choose(pose, goal_m)
                })
            }
        };
        if self.config.decision.cost_model == CostModel::Forecast && self.backtracks(chosen, pose) {
            return Status::Backtracking;
        }
        let Some(chosen) = chosen else {
            self.searched_ticks += 1;
            self.last_bearing_rad = None;
            self.lattice.stand();
            self.committed.stand();
            let given_up = self.searched_ticks > self.config.decision.look_ticks;
            return if given_up { Status::Stopped(StopReason::NoSubgoal) } else { Status::Searching };
        };
        self.searched_ticks = 0;
        self.chosen = Some(chosen);
        let subgoal = self.subgoals[chosen];
        self.last_bearing_rad = Some(pose.yaw_rad + subgoal.bearing_rad);
        self.command = match self.config.decision.cost_model {
            CostModel::Paper => {
                let distance_m = (subgoal.position_m.truncate() - pose.plan_m()).length();
                self.controller.drive(distance_m, subgoal.bearing_rad, self.config.period_s)
            }
            CostModel::Forecast => {
                if let Some(place_m) = self.committed.head_for(&subgoal, pose) {
                    self.heuristic.raise(place_m, IN_VAIN_HALF_SIDE_M, IN_VAIN_M);
                    if self.lattice.is_on_steep_ground() {
                        self.meet_steeper_ground(pose.plan_m());
                    }
                }
                self.learn(pose, goal_m);
                self.follow(&subgoal, pose)
            }
        };
        Status::Driving
    }

    /// Minds steep ground as configured or, without patience, less: on ways and in the choice.
    fn scale_slope_cost(&mut self, patient: bool) {
        let StateLatticeConfig { escape_margin_rad, impatient_margin_rad, .. } = self.config.state_lattice;
        let (share, least_margin_rad) =
            if patient { (1.0, escape_margin_rad) } else { (IMPATIENT_SHARE, impatient_margin_rad) };
        self.lattice.scale_slope_cost(share);
        self.lattice.keep_margin(least_margin_rad);
        let DecisionConfig { steepness_weight, climb_weight, .. } = self.config.decision;
        self.decision.steepness_weight = share * steepness_weight;
        self.decision.climb_weight = share * climb_weight;
    }

    /// Whether turning on the spot stays within the tilt limits, as far as this planner minds.
    fn may_spin(&self) -> bool {
        self.config.decision.cost_model == CostModel::Paper || self.lattice.may_turn_around()
    }

    /// Goes back the way it came, from where nothing leads on or the robot stands too steep, until it stands on calm ground some way back
    /// and something leads on again. Whether it does.
    fn backtracks(&mut self, chosen: Option<usize>, pose: &Pose) -> bool {
        let here_m = pose.plan_m();
        self.backtrack.be_at(pose);
        if !self.backtrack.is_on() {
            if chosen.is_none() || self.lattice.is_too_steep() {
                self.meet_steeper_ground(here_m);
            }
        } else if chosen.is_some() && self.lattice.is_calm() && self.backtrack.has_gone_far(here_m) {
            self.backtrack.end();
        }
        if !self.backtrack.is_on() {
            return false;
        }
        let Some(back) = self.backtrack.next(pose, |turn_rad| self.lattice.safe_turn_rad(turn_rad)) else {
            return false;
        };
        self.searched_ticks = 0;
        self.last_bearing_rad = None;
        self.lattice.stand();
        self.committed.stand();
        let reverse = matches!(back, BacktrackCommand::Drive { reverse: true, .. });
        let point = |position_m| PathPoint { position_m, cost_m: 0.0, reverse };
        self.path.clear();
        self.path.push(point(here_m));
        self.path.extend(self.backtrack.way_back_m().map(point));
        let share = self.lattice.share_here();
        let period_s = self.config.period_s;
        self.command = match back {
            BacktrackCommand::Brake => Command::STOP,
            BacktrackCommand::Turn { by_rad } => {
                let turning = self.controller.drive(0.0, by_rad, period_s);
                self.controller.regulated(Command { linear_m_s: 0.0, ..turning }, share)
            }
            BacktrackCommand::Drive { turn_rad_m, reverse } => {
                let distance_m = length_m(&self.path).max(LEAST_BACK_M);
                let driving = self.controller.drive_arc(distance_m, turn_rad_m, reverse, period_s);
                self.controller.regulated(driving, share)
            }
        };
        true
    }

    /// Turns back from ground that turned out steeper than it had looked.
    fn meet_steeper_ground(&mut self, here_m: DVec2) {
        if let Some(travel) = self.backtrack.begin(here_m) {
            self.lattice.meet_steeper_ground(travel);
        }
    }

    /// Drives a distance at a bearing, as slow as ground asks for that takes up `share` of the tilt limits.
    fn drive_along(&mut self, distance_m: f64, bearing: f64, reverse: bool, share: f64) -> Command {
        let facing = if reverse { wrap_rad(bearing + PI) } else { bearing };
        let mut command = self.controller.drive(distance_m, facing, self.config.period_s);
        if reverse {
            command.linear_m_s = -command.linear_m_s;
        }
        self.controller.regulated(command, share)
    }

    /// Drives along the way to a subgoal.
    fn follow(&mut self, subgoal: &Subgoal, pose: &Pose) -> Command {
        let end_m = subgoal.position_m.truncate();
        let reached = self.lattice.to(end_m);
        if let Some(reached) = reached {
            self.lattice.follow(reached, &mut self.path);
        }
        if let Some(last) = self.path.last_mut() {
            // The subgoal lies up to half a step from the last place.
            last.position_m = end_m;
        }
        let next = self.lattice.lookahead(&self.path);
        let ahead = self.lattice.drive(&next);
        let bearing = bearing_rad(pose, ahead.position_m);
        let path_m = subgoal.forecast.map_or(0.0, |f| f.path_m);
        let share = self.lattice.share_ahead(&self.path, &ahead);
        self.drive_along(path_m, bearing, ahead.reverse, share)
    }

    /// Learns how far the goal is from the places around by the best of the ways on: to the goal itself or to where what was seen ends,
    /// and from there as far as is known.
    fn learn(&mut self, pose: &Pose, goal_m: DVec2) {
        let here = pose.plan_m();
        if self.learned_at_m.is_some_and(|last| (last - here).length() < LEARN_SPACING_M) {
            return;
        }
        self.learned_at_m = Some(here);
        let left_m = |place_m| self.heuristic.left_m(place_m, goal_m);
        let frontier = self.lattice.frontier().map(|(reached, place_m)| (reached, left_m(place_m)));
        let goal = self.lattice.to_within(goal_m, self.config.goal_tolerance_m);
        self.ends.clear();
        self.ends.extend(frontier.chain(goal.map(|(reached, _)| (reached, 0.0))));
        let DecisionConfig { distance_weight, steepness_weight, climb_weight, .. } = self.decision;
        // The prices of the subgoals' cost: a risk counts for the way to r_oc there, and 2 r_oc of distance for one.
        let tilt_price = if distance_weight > 0.0 { 2.0 * steepness_weight / distance_weight } else { 0.0 };
        for (place_m, to_goal_m) in self.lattice.remaining(&self.ends, tilt_price, climb_weight) {
            self.heuristic.learn(place_m, goal_m, to_goal_m);
        }
    }

    /// Places the subgoals and chooses one; `None` when there is no candidate.
    fn choose(&mut self, pose: &Pose, goal_m: DVec2) -> Option<usize> {
        self.subgoals.clear();
        let mut candidates =
            Candidates { config: &self.config, pose, lattice: &self.lattice, path: &mut self.path };
        candidates.on_segments(&self.segments, &mut self.subgoals);
        if let Some(goal) = candidates.goal(goal_m, &self.profile) {
            self.subgoals.push(goal);
            return Some(self.subgoals.len() - 1);
        }
        if self.config.decision.cost_model == CostModel::Forecast {
            match self.committed.again(&mut candidates) {
                Ok(again) => self.subgoals.extend(again),
                Err(place_m) => self.heuristic.raise(place_m, IN_VAIN_HALF_SIDE_M, IN_VAIN_M),
            }
            if self.subgoals.iter().all(|subgoal| subgoal.refusal.is_some()) {
                let left_m = |place_m| self.heuristic.left_m(place_m, goal_m);
                self.subgoals.extend(candidates.edge_of_sight(&self.profile, left_m));
            }
        }
        let situation = Situation {
            pose,
            goal_m,
            surface_radius_m: self.config.perception.surface_radius_m,
            last_bearing_rad: self.last_bearing_rad,
            heuristic: &self.heuristic,
        };
        cost::choose(&mut self.subgoals, &self.decision, &situation)
    }

    fn perceive(&mut self, points_m: &[Vec3], overrides: PerceptionOverride<'_>) -> Result<(), GpError> {
        self.observed.project(points_m);
        match overrides.profile {
            None => self.perception.profile(&self.observed, &mut self.profile)?,
            Some(told) => {
                self.profile.clear();
                self.profile.extend((0..COLUMNS).map(|column| told(column_azimuth_rad(column))));
            }
        }
        cut_segments(
            &self.profile,
            &self.config.segments,
            self.config.perception.surface_radius_m,
            self.config.robot.width_m,
            &self.config.sensor,
            &mut self.segments,
        );
        Ok(())
    }

    /// Adds the near part of the scan, and the ground the wheels stand on, to what is remembered.
    fn remember(&mut self, points_m: &[Vec3], pose: &Pose) {
        self.ground.advance();
        let world_from_robot = pose.world_from_robot();
        let sensor = pose.position_m + world_from_robot * self.config.sensor.offset_m();
        let mount = self.config.sensor.robot_from_sensor();
        let world_from_sensor = mount.map_or(world_from_robot, |mount| world_from_robot * mount);
        self.ground.looked_from(sensor, world_from_sensor);
        let radius_squared = self.config.elevation_window.radius_m * self.config.elevation_window.radius_m;
        for point in points_m {
            let point = point.as_dvec3();
            // Also passes over NaN.
            if point.length_squared() <= radius_squared {
                self.ground.add(sensor + world_from_sensor * point);
            }
        }
        let half_width = 0.5 * self.config.robot.width_m;
        let parts = (half_width / WHEEL_GROUND_M).ceil() as i32;
        let place = |part: i32| half_width * (f64::from(part) / f64::from(parts));
        for x in -parts..=parts {
            for y in -parts..=parts {
                self.ground.add(pose.position_m + world_from_robot * DVec3::new(place(x), place(y), 0.0));
            }
        }
    }
}
