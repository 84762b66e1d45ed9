//! The planner: one type with one step.

use core::time::Duration;

use glam::{DVec2, Vec3};
use mapless_parameters::ConfigError;

use crate::config::{CostModel, PlannerConfig};
use crate::control::controller::{Command, Controller};
use crate::decision::forecast_policy::ForecastPolicy;
use crate::decision::goal_progress::{GoalProgress, MOST_ELAPSED};
use crate::decision::paper_policy::PaperPolicy;
use crate::decision::policy::{Motion, Plan, Situation, SubgoalPolicy};
use crate::decision::step::{PerceptionOverride, Status, Step, StopReason};
use crate::goal::Goal;
use crate::gp::GpError;
use crate::math::angle::difference_rad;
use crate::pose::{FrameChange, Pose};
use crate::skyline::beam_grid::BeamGrid;
use crate::skyline::columns::{COLUMNS, column_azimuth_rad};
use crate::skyline::occupancy::OccupancySurface;
use crate::skyline::perception::Perception;
use crate::skyline::profile::ElevationProfile;
use crate::skyline::scan_filter::ScanFilter;
use crate::skyline::segments::{Segment, cut_segments};
use crate::skyline::surface::PredictedSurface;
use crate::terrain::remembered_ground::RememberedGround;

/// Poses and goals farther from the origin are invalid; cells and places are counted in 32 bits.
const FARTHEST_M: f64 = 1e6;
/// Room for the longest path.
const MAX_PATH_POINTS: usize = 256;
/// The final heading is reached within this angle.
const HEADING_TOLERANCE_RAD: f64 = 0.05;

/// Scan and pose in; subgoal and command out.
///
/// There is no global map: the planner keeps a local elevation window, its own trajectory, learned
/// corrections of the cost-to-go around it, and its last choice.
#[derive(Clone, Debug)]
pub struct Planner {
    config: PlannerConfig,
    filter: ScanFilter,
    observed: OccupancySurface,
    perception: Perception,
    profile: ElevationProfile,
    segments: Vec<Segment>,
    policy: Policy,
    controller: Controller,
    plan: Plan,
    goal: Option<Goal>,
    /// The goal for which the present corrections were learned.
    goal_anchor_m: DVec2,
    progress: GoalProgress,
    /// Time since the ground was observed; some steps stop before.
    since_observed: Duration,
    /// Time without a candidate.
    searched: Duration,
    status: Status,
    command: Command,
}

/// The policy that chooses the subgoal.
#[derive(Clone, Debug)]
enum Policy {
    Paper(PaperPolicy),
    Forecast(Box<ForecastPolicy>),
}

impl Policy {
    fn new(config: &PlannerConfig) -> Self {
        match config.decision.cost_model {
            CostModel::Paper => Self::Paper(PaperPolicy),
            CostModel::Forecast => Self::Forecast(Box::new(ForecastPolicy::new(config))),
        }
    }

    fn get(&self) -> &dyn SubgoalPolicy {
        match self {
            Self::Paper(paper) => paper,
            Self::Forecast(forecast) => &**forecast,
        }
    }

    fn get_mut(&mut self) -> &mut dyn SubgoalPolicy {
        match self {
            Self::Paper(paper) => paper,
            Self::Forecast(forecast) => &mut **forecast,
        }
    }
}

impl Planner {
    /// A planner that has seen nothing and has no goal yet.
    ///
    /// # Errors
    /// [`ConfigError`] for a value that makes no sense.
    pub fn new(config: PlannerConfig) -> Result<Self, ConfigError> {
        config.validate("planner")?;
        let grid = BeamGrid::new(&config.sensor);
        let filter = ScanFilter::new(&config.sensor, &config.robot, sight_m(&config));
        Ok(Self {
            filter,
            perception: Perception::new(config.perception, &grid),
            observed: OccupancySurface::new(config.perception.surface_radius_m, grid),
            profile: Vec::new(),
            segments: Vec::new(),
            policy: Policy::new(&config),
            controller: Controller::new(config.controller),
            plan: Plan { path: Vec::with_capacity(MAX_PATH_POINTS), ..Plan::default() },
            goal: None,
            goal_anchor_m: DVec2::ZERO,
            progress: GoalProgress::NONE,
            since_observed: Duration::ZERO,
            searched: Duration::ZERO,
            status: Status::Stopped(StopReason::NoGoal),
            command: Command::STOP,
            config,
        })
    }

    /// The configuration.
    pub fn config(&self) -> &PlannerConfig {
        &self.config
    }

    /// Range of the returns that the planner uses, metres: farther ones change nothing. A scan may be cropped
    /// to it to save time, as long as one return is left: a scan without any means a blind sensor.
    pub fn sight_m(&self) -> f64 {
        sight_m(&self.config)
    }

    /// The goal.
    pub fn goal(&self) -> Option<Goal> {
        self.goal
    }

    /// Sets the goal. Corrections learned for the last goal are forgotten, unless the new goal lies within
    /// its tolerance of that: a goal that is refined, or given in a drifting frame, costs nothing. The
    /// elevation window is kept.
    pub fn set_goal(&mut self, goal: Goal) {
        let tolerance_m = goal.tolerance_m.unwrap_or(self.config.goal_tolerance_m);
        let moved_m = (goal.position_m - self.goal_anchor_m).length();
        // Also restarts for a goal that is not finite.
        let is_near = self.goal.is_some() && moved_m < tolerance_m;
        self.goal = Some(goal);
        if !is_near {
            self.goal_anchor_m = goal.position_m;
            self.progress = GoalProgress::NONE;
            self.policy.get_mut().start();
            self.searched = Duration::ZERO;
            self.controller.reset();
        }
    }

    /// Cancels the goal: the planner stops until it gets another.
    pub fn cancel_goal(&mut self) {
        self.goal = None;
    }

    /// Forgets the goal and everything sensed, learned and driven, as after a change of the world.
    pub fn reset(&mut self) {
        self.perception.reset(self.config.perception, self.observed.grid());
        self.policy.get_mut().forget_terrain();
        self.goal = None;
        self.command = Command::STOP;
    }

    /// Corrects for a jump of the localisation: the pose that it gave as `before` it now gives as `after`.
    /// The elevation window, the trajectory and the corrections move along; the goal keeps its place in the
    /// world.
    ///
    /// Without this a jump of the pose tears the window apart. Only the turn about z and the shift between
    /// both poses count.
    pub fn relocalise(&mut self, before: &Pose, after: &Pose) {
        if before.is_finite() && after.is_finite() {
            let away_m = |pose: &Pose| self.goal.map_or(0.0, |goal| goal.position_m.distance(pose.plan_m()));
            self.progress.relocalise(away_m(after) - away_m(before));
            let change = FrameChange::between(before, after);
            match &mut self.policy {
                // The paper's choice remembers nothing.
                Policy::Paper(_) => {}
                Policy::Forecast(policy) => policy.relocalise(&change),
            }
        }
    }

    /// One step.
    ///
    /// - `points_m`: the scan's returns in the sensor frame, metres, in any order. Returns that are not
    ///   finite are passed over.
    /// - `pose`: the robot's in the world, at the time of the scan; points of a sweep should be corrected for
    ///   the motion since their firing.
    /// - `elapsed`: the time since the step before, with that of scans that were lost; of the first step it
    ///   only limits how far the command changes.
    ///
    /// The answer to anything that makes no sense is a stop with its reason.
    pub fn step(&mut self, points_m: &[Vec3], pose: &Pose, elapsed: Duration) -> Step<'_> {
        self.step_with(points_m, pose, elapsed, PerceptionOverride::default())
    }

    /// As [`Planner::step`], with what `overrides` holds in place of what the scans say.
    pub fn step_with(
        &mut self,
        points_m: &[Vec3],
        pose: &Pose,
        elapsed: Duration,
        overrides: PerceptionOverride<'_>,
    ) -> Step<'_> {
        self.plan.clear();
        self.segments.clear();
        self.status = self.decide(points_m, pose, elapsed, overrides);
        self.command = match self.status {
            Status::Driving | Status::Backtracking => self.command,
            Status::Searching if self.policy.get().may_spin() => self.controller.spin(),
            Status::Searching => Command::STOP,
            Status::Arrived | Status::Stopped(_) => {
                self.controller.reset();
                Command::STOP
            }
        };
        self.last_step()
    }

    /// The result of the last step.
    pub fn last_step(&self) -> Step<'_> {
        Step {
            status: self.status,
            command: self.command,
            return_kinds: self.filter.kinds(),
            observed: &self.observed,
            diagnostics: self.perception.diagnostics(),
            profile: &self.profile,
            segments: &self.segments,
            subgoals: &self.plan.subgoals,
            chosen: self.plan.chosen,
            path: &self.plan.path,
        }
    }

    /// The reconstructed occupancy and the variance surface of the last step's scan. A step itself needs only
    /// their edge, so they are predicted here.
    ///
    /// # Errors
    /// [`GpError`] when there is no posterior.
    pub fn predicted_surface(&mut self) -> Result<&PredictedSurface, GpError> {
        self.perception.surface(&self.observed)
    }

    /// The ground on which paths are judged, as the last step left it: the cells of the elevation window, in
    /// the frame of the poses and in no particular order. The policy `paper` remembers none.
    pub fn remembered_ground(&self) -> impl Iterator<Item = RememberedGround> {
        let policy = match &self.policy {
            Policy::Paper(_) => None,
            Policy::Forecast(policy) => Some(policy),
        };
        policy.into_iter().flat_map(|policy| policy.remembered_ground())
    }

    fn decide(
        &mut self,
        points_m: &[Vec3],
        pose: &Pose,
        elapsed: Duration,
        overrides: PerceptionOverride<'_>,
    ) -> Status {
        self.since_observed = self.since_observed.saturating_add(elapsed);
        let Some(goal) = self.goal else { return Status::Stopped(StopReason::NoGoal) };
        let near = |place_m: DVec2| place_m.abs().max_element() < FARTHEST_M;
        if !(pose.is_finite() && near(pose.plan_m()) && goal.is_valid() && near(goal.position_m)) {
            return Status::Stopped(StopReason::InvalidInput);
        }
        self.filter.sort(points_m);
        if !self.filter.has_returns() && overrides.profile.is_none() {
            return Status::Stopped(StopReason::EmptyScan);
        }
        if let Err(error) = self.perceive(overrides) {
            return Status::Stopped(StopReason::NoPerception(error));
        }
        self.policy.get_mut().observe(&self.config, &self.filter, pose, self.since_observed);
        let since_observed = core::mem::take(&mut self.since_observed);
        let goal_tolerance_m = goal.tolerance_m.unwrap_or(self.config.goal_tolerance_m);
        if (goal.position_m - pose.plan_m()).length() <= goal_tolerance_m {
            return self.arrive(&goal, pose, elapsed, since_observed);
        }
        let has_room = self.policy.get().has_room_within(goal.position_m, goal_tolerance_m);
        self.progress.notice_room(has_room);
        let sight_m = self.config.perception.surface_radius_m;
        let commanded = if self.command == Command::STOP { Duration::ZERO } else { elapsed };
        if let Err(reason) = self.progress.check(pose.plan_m(), goal.position_m, sight_m, commanded) {
            return Status::Stopped(reason);
        }
        let situation = Situation {
            config: &self.config,
            pose,
            goal_m: goal.position_m,
            goal_tolerance_m,
            profile: &self.profile,
            segments: &self.segments,
            elapsed,
            since_observed,
            last_command: self.command,
            terrain: overrides.terrain,
        };
        match self.policy.get_mut().decide(&situation, &mut self.controller, &mut self.plan) {
            Motion::Drive(command) => {
                self.searched = Duration::ZERO;
                self.command = command;
                Status::Driving
            }
            Motion::Backtrack(command) => {
                self.searched = Duration::ZERO;
                self.command = command;
                Status::Backtracking
            }
            Motion::NoCandidate => {
                self.searched = self.searched.saturating_add(elapsed.min(MOST_ELAPSED));
                if self.searched > self.config.decision.spin_recovery() {
                    Status::Stopped(StopReason::NoSubgoal)
                } else {
                    Status::Searching
                }
            }
        }
    }

    /// At the goal: turns to the final heading.
    fn arrive(&mut self, goal: &Goal, pose: &Pose, elapsed: Duration, since_observed: Duration) -> Status {
        let turn_rad = goal.heading_rad.map_or(0.0, |heading_rad| difference_rad(heading_rad, pose.yaw_rad));
        if turn_rad.abs() <= HEADING_TOLERANCE_RAD {
            return Status::Arrived;
        }
        self.policy.get_mut().stand(pose, since_observed);
        let unsafe_rad = turn_rad.abs() - self.policy.get().safe_turn_rad(turn_rad).abs();
        if unsafe_rad > HEADING_TOLERANCE_RAD {
            return Status::Stopped(StopReason::HeadingUnsafe);
        }
        self.command = Command { linear_m_s: 0.0, ..self.controller.drive(0.0, turn_rad, elapsed) };
        Status::Driving
    }

    fn perceive(&mut self, overrides: PerceptionOverride<'_>) -> Result<(), GpError> {
        self.observed.project_cells(self.filter.cells());
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
}

/// Range of the returns that are of use.
fn sight_m(config: &PlannerConfig) -> f64 {
    config.perception.surface_radius_m.max(config.elevation_window.radius_m)
}
