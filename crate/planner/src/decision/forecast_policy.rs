//! The policy `forecast`: subgoals at the ends of paths over the elevation window, judged by their predicted
//! tilt.
//!
//! It searches the window with a state lattice, learns corrections of the cost-to-go, commits to a target,
//! and backtracks along the robot's own trajectory where the ground is steeper than predicted or no path
//! leads on.

use core::f64::consts::PI;
use core::time::Duration;

use glam::DVec2;

use crate::config::{DecisionConfig, FollowingLaw, PlannerConfig, StateLatticeConfig};
use crate::control::backtrack::{Backtrack, BacktrackCommand};
use crate::control::controller::{Command, Controller};
use crate::control::trajectory_optimiser::{Limits, PlanPose, Start, TrajectoryOptimiser};
use crate::decision::candidates::Candidates;
use crate::decision::committed_target::CommittedTarget;
use crate::decision::cost::choose_cheapest;
use crate::decision::detour_budget::DetourBudget;
use crate::decision::observation::take_up;
use crate::decision::path_following::PathCourse;
use crate::decision::policy::{Motion, Plan, Situation, SubgoalPolicy};
use crate::decision::subgoals::{Cost, Subgoal, bearing_rad, on_segments};
use crate::math::angle::{difference_rad, wrap_rad};
use crate::pose::{FrameChange, Pose};
use crate::route::heuristic_table::HeuristicTable;
use crate::route::state_lattice::{PathPoint, ReachedState, StateLattice, length_m};
use crate::skyline::scan_filter::ScanFilter;
use crate::terrain::elevation_window::ElevationWindow;
use crate::terrain::remembered_ground::RememberedGround;

/// The cost-to-go is learned again after this distance.
const LEARN_SPACING_M: f64 = 0.5;
/// While backtracking, the robot drives as fast as with this much of the path left.
const LEAST_BACKTRACK_M: f64 = 0.3;
/// The way in which a path leaves is that to its first point farther away than this.
const LEAVES_M: f64 = 0.3;
/// Share of the slope costs that counts beyond the detour budget.
const OVER_BUDGET_SHARE: f64 = 0.25;
/// A target that the robot cannot reach, and the places around it, get this much added to their cost-to-go.
const UNREACHABLE_PENALTY_M: f64 = 7.0;
const UNREACHABLE_HALF_SIDE_M: f64 = 1.0;

/// The elevation window, the lattice over it, and what they taught.
#[derive(Clone, Debug)]
pub(crate) struct ForecastPolicy {
    window: ElevationWindow,
    lattice: StateLattice,
    lattice_config: StateLatticeConfig,
    /// The weights as configured, and the present ones: slopes cost less beyond the detour budget.
    configured: DecisionConfig,
    weights: DecisionConfig,
    heuristic: HeuristicTable,
    detour_budget: Option<DetourBudget>,
    committed: CommittedTarget,
    backtrack: Backtrack,
    optimiser: TrajectoryOptimiser,
    learned_at_m: Option<DVec2>,
    ends: Vec<(ReachedState, f64)>,
    /// World bearing of the last choice.
    last_bearing_rad: Option<f64>,
}

impl ForecastPolicy {
    /// A policy with an empty window. The configuration must have been validated.
    pub(crate) fn new(config: &PlannerConfig) -> Self {
        let lattice =
            StateLattice::new(config.state_lattice, &config.robot, config.perception.surface_radius_m);
        Self {
            window: ElevationWindow::new(config),
            lattice_config: config.state_lattice,
            configured: config.decision,
            weights: config.decision,
            heuristic: HeuristicTable::new(config.state_lattice.step_m),
            detour_budget: None,
            committed: CommittedTarget::default(),
            backtrack: Backtrack::new(),
            optimiser: TrajectoryOptimiser::new(Limits::of(config)),
            learned_at_m: None,
            ends: Vec::with_capacity(lattice.count() + 1),
            lattice,
            last_bearing_rad: None,
        }
    }

    /// Sets the cost of slopes, on paths and in the choice: as configured, or less beyond the detour budget.
    fn scale_slope_cost(&mut self, within_budget: bool) {
        let StateLatticeConfig { recovery_margin_rad, over_budget_margin_rad, .. } = self.lattice_config;
        let (share, least_margin_rad) = if within_budget {
            (1.0, recovery_margin_rad)
        } else {
            (OVER_BUDGET_SHARE, over_budget_margin_rad)
        };
        self.lattice.scale_slope_cost(share);
        self.lattice.keep_margin(least_margin_rad);
        self.weights.steepness_weight = share * self.configured.steepness_weight;
        self.weights.climb_weight = share * self.configured.climb_weight;
    }

    /// Releases every commitment.
    fn release(&mut self) {
        self.last_bearing_rad = None;
        self.lattice.release();
        self.committed.release();
        self.optimiser.reset();
    }

    /// Searches paths over the terrain and chooses a subgoal; `None` if there is no candidate.
    fn search(&mut self, situation: &Situation<'_>, plan: &mut Plan) -> Option<usize> {
        let Situation { pose, goal_m, since_observed, .. } = *situation;
        let here_m = pose.plan_m();
        let budget = self.detour_budget.get_or_insert_with(|| DetourBudget::new(here_m, goal_m));
        if budget.is_spent_now(here_m) {
            self.scale_slope_cost(false);
            self.heuristic.scale(OVER_BUDGET_SHARE);
        }
        match situation.terrain {
            Some(terrain) => self.lattice.search(&terrain, pose, since_observed),
            None => self.lattice.search(&self.window, pose, since_observed),
        }
        self.choose(situation, plan).or_else(|| {
            self.lattice.search_recovery();
            self.choose(situation, plan)
        })
    }

    /// Places the subgoals and chooses one.
    fn choose(&mut self, situation: &Situation<'_>, plan: &mut Plan) -> Option<usize> {
        let Situation { config, pose, goal_m, profile, .. } = *situation;
        let Plan { subgoals, path, .. } = plan;
        subgoals.clear();
        let mut candidates = Candidates { config, pose, lattice: &self.lattice, path };
        subgoals.extend(on_segments(config, pose, situation.segments));
        for subgoal in subgoals.iter_mut() {
            candidates.move_within_reach(subgoal);
        }
        if let Some(goal) = candidates.goal(goal_m, situation.goal_tolerance_m) {
            subgoals.push(goal);
            return Some(subgoals.len() - 1);
        }
        match self.committed.reconsider(&mut candidates) {
            Ok(target) => subgoals.extend(target),
            Err(place_m) => {
                self.heuristic.raise(place_m, UNREACHABLE_HALF_SIDE_M, UNREACHABLE_PENALTY_M);
            }
        }
        if subgoals.iter().all(|subgoal| subgoal.refusal.is_some()) {
            let cost_to_go_m = |place_m| self.heuristic.cost_to_go_m(place_m, goal_m);
            subgoals.extend(candidates.frontier(profile, cost_to_go_m));
        }
        for subgoal in subgoals.iter_mut().filter(|subgoal| subgoal.refusal.is_none()) {
            subgoal.cost = Some(self.terms(subgoal, situation));
        }
        choose_cheapest(subgoals, &self.weights)
    }

    /// The terms of the cost, each on a fixed scale: half a turn, the surface's radius, the tilt limits.
    fn terms(&self, subgoal: &Subgoal, situation: &Situation<'_>) -> Cost {
        let Situation { config, pose, goal_m, .. } = *situation;
        let surface_radius_m = config.perception.surface_radius_m;
        let here_m = pose.plan_m();
        let there_m = subgoal.position_m.truncate();
        let forecast = subgoal.forecast.unwrap_or_default();
        let around_m = forecast.path_m - forecast.reach_m + self.weights.climb_weight * forecast.climb_m;
        let lost_m = (goal_m - there_m).length() - (goal_m - here_m).length() + around_m;
        let turn = self
            .last_bearing_rad
            .map_or(0.0, |last| difference_rad(pose.yaw_rad + subgoal.bearing_rad, last));
        let correction_m = self.heuristic.correction_m(there_m);
        Cost {
            direction: subgoal.bearing_rad.abs() / PI,
            distance: 0.5 + 0.5 * lost_m / surface_radius_m,
            steepness: forecast.mean_risk,
            commitment: turn.abs() / PI,
            correction: 0.5 * correction_m / surface_radius_m,
        }
    }

    /// Backtracks if the attitude is too steep or there is no candidate, until the attitude is calm, the
    /// robot has driven some distance back and there is a candidate. Returns the command meanwhile.
    fn backtrack(
        &mut self,
        situation: &Situation<'_>,
        controller: &mut Controller,
        plan: &mut Plan,
        has_candidate: bool,
    ) -> Option<Command> {
        let Situation { pose, elapsed, .. } = *situation;
        let here_m = pose.plan_m();
        self.backtrack.record(pose, elapsed);
        if !self.backtrack.is_active() {
            if !has_candidate || self.lattice.is_too_steep() {
                self.start_backtrack(here_m);
            }
        } else if has_candidate && self.lattice.is_calm() && self.backtrack.has_driven_far(here_m) {
            self.backtrack.end();
        }
        if !self.backtrack.is_active() {
            return None;
        }
        let back = self.backtrack.next(pose, |turn_rad| self.lattice.safe_turn_rad(turn_rad))?;
        self.release();
        let reverse = matches!(back, BacktrackCommand::Drive { reverse: true, .. });
        let point = |position_m| PathPoint { position_m, cost_m: 0.0, reverse };
        plan.path.clear();
        plan.path.push(point(here_m));
        plan.path.extend(self.backtrack.positions_m().map(point));
        let utilisation = self.lattice.utilisation_here();
        Some(match back {
            BacktrackCommand::Brake => Command::STOP,
            BacktrackCommand::Turn { by_rad } => {
                let turning = controller.drive(0.0, by_rad, elapsed);
                controller.regulated(Command { linear_m_s: 0.0, ..turning }, utilisation)
            }
            BacktrackCommand::Drive { turn_rad_m, reverse } => {
                let distance_m = length_m(&plan.path).max(LEAST_BACKTRACK_M);
                let driving = controller.drive_arc(distance_m, turn_rad_m, reverse, elapsed);
                controller.regulated(driving, utilisation)
            }
        })
    }

    /// Begins to backtrack, and inflates the slope variance of the ground ahead.
    fn start_backtrack(&mut self, here_m: DVec2) {
        if let Some(travel) = self.backtrack.begin(here_m) {
            self.lattice.inflate_variance_ahead(travel);
        }
    }

    /// Drives along the path to a subgoal; `None` if the robot stands and nothing admissible leads on.
    fn follow(
        &mut self,
        subgoal: &Subgoal,
        situation: &Situation<'_>,
        controller: &mut Controller,
        path: &mut Vec<PathPoint>,
    ) -> Option<Command> {
        let end_m = subgoal.position_m.truncate();
        if let Some(reached) = self.lattice.to(end_m) {
            self.lattice.follow(reached, path);
            self.lattice.keep(reached);
        }
        if let Some(last) = path.last_mut() {
            // The subgoal lies up to half a step from the last place.
            last.position_m = end_m;
        }
        match situation.config.controller.following {
            FollowingLaw::Pid => Some(self.follow_by_pid(subgoal, situation, controller, path)),
            FollowingLaw::RecedingHorizon => self.follow_by_trajectory(situation, path),
        }
    }

    /// Drives to the lookahead point of the path.
    fn follow_by_pid(
        &mut self,
        subgoal: &Subgoal,
        situation: &Situation<'_>,
        controller: &mut Controller,
        path: &[PathPoint],
    ) -> Command {
        let ahead = self.lattice.lookahead(path);
        let bearing = bearing_rad(situation.pose, ahead.position_m);
        let path_m = subgoal.forecast.map_or(0.0, |forecast| forecast.path_m);
        let utilisation = self.lattice.utilisation_ahead(path, &ahead);
        let facing = if ahead.reverse { wrap_rad(bearing + PI) } else { bearing };
        let mut command = controller.drive(path_m, facing, situation.elapsed);
        if ahead.reverse {
            command.linear_m_s = -command.linear_m_s;
        }
        controller.regulated(command, utilisation)
    }

    /// Drives the best short trajectory along the path; `None` if the robot stands and would be left
    /// standing.
    fn follow_by_trajectory(&mut self, situation: &Situation<'_>, path: &[PathPoint]) -> Option<Command> {
        let Situation { config, pose, last_command, .. } = *situation;
        let here_m = pose.plan_m();
        let from = Start {
            pose: PlanPose { position_m: here_m, yaw_rad: pose.yaw_rad },
            command: last_command,
            elapsed_s: situation.elapsed.as_secs_f64(),
            utilisation: self.lattice.utilisation_here(),
        };
        self.optimiser.drive(&PathCourse::new(&self.lattice, path, config), from)
    }

    /// Learns the cost-to-go of the places around by a backward search from the frontier, with the
    /// corrections there, and from the goal if it is reached.
    fn learn(&mut self, situation: &Situation<'_>) {
        let Situation { pose, goal_m, goal_tolerance_m, .. } = *situation;
        let here_m = pose.plan_m();
        if self.learned_at_m.is_some_and(|last_m| (last_m - here_m).length() < LEARN_SPACING_M) {
            return;
        }
        self.learned_at_m = Some(here_m);
        let cost_to_go_m = |place_m| self.heuristic.cost_to_go_m(place_m, goal_m);
        let frontier = self.lattice.frontier().map(|(reached, place_m)| (reached, cost_to_go_m(place_m)));
        let goal = self.lattice.to_within(goal_m, goal_tolerance_m);
        self.ends.clear();
        self.ends.extend(frontier.chain(goal.map(|(reached, _)| (reached, 0.0))));
        let DecisionConfig { distance_weight, steepness_weight, climb_weight, .. } = self.weights;
        // The weights of the subgoals' cost as prices of a path: a mean risk of 1 costs as much as 2 r_oc of
        // distance.
        let tilt_price = if distance_weight > 0.0 { 2.0 * steepness_weight / distance_weight } else { 0.0 };
        for (place_m, to_goal_m) in self.lattice.backward_search(&self.ends, tilt_price, climb_weight) {
            self.heuristic.learn(place_m, goal_m, to_goal_m);
        }
    }
}

/// The unit vector in which a path leaves a pose; the heading if it stays.
fn direction_of(path: &[PathPoint], pose: &Pose) -> DVec2 {
    let here_m = pose.plan_m();
    let mut ways_m = path.iter().map(|point| point.position_m - here_m);
    let off_m = ways_m.find(|way_m| way_m.length() > LEAVES_M);
    off_m.map_or_else(|| DVec2::from_angle(pose.yaw_rad), DVec2::normalize)
}

impl ForecastPolicy {
    /// The ground that is remembered.
    pub(crate) fn remembered_ground(&self) -> impl Iterator<Item = RememberedGround> {
        self.window.remembered()
    }

    /// Moves all that is remembered from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        self.window.relocalise(change);
        self.lattice.relocalise(change);
        self.heuristic.relocalise(change);
        self.committed.relocalise(change);
        self.backtrack.relocalise(change);
        if let Some(budget) = &mut self.detour_budget {
            budget.relocalise(change);
        }
        self.learned_at_m = self.learned_at_m.map(|place_m| change.place_m(place_m));
        self.last_bearing_rad = self.last_bearing_rad.map(|bearing_rad| bearing_rad + change.turn_rad());
    }
}

impl SubgoalPolicy for ForecastPolicy {
    fn start(&mut self) {
        self.heuristic.clear();
        self.detour_budget = None;
        self.scale_slope_cost(true);
        self.release();
        self.backtrack.end();
        self.learned_at_m = None;
    }

    fn forget_terrain(&mut self) {
        self.window.clear();
        self.lattice.clear();
        self.backtrack.clear();
    }

    fn observe(&mut self, config: &PlannerConfig, scan: &ScanFilter, pose: &Pose, elapsed: Duration) {
        take_up(&mut self.window, config, scan, pose, elapsed);
        let reach_m = self.window.reach_m();
        for &place_m in self.window.refuted_m() {
            self.lattice.query_again_near(place_m, reach_m);
        }
    }

    fn decide(&mut self, situation: &Situation<'_>, controller: &mut Controller, plan: &mut Plan) -> Motion {
        let chosen = self.search(situation, plan);
        if let Some(command) = self.backtrack(situation, controller, plan, chosen.is_some()) {
            return Motion::Backtrack(command);
        }
        let Some(chosen) = chosen else {
            self.release();
            return Motion::NoCandidate;
        };
        plan.chosen = Some(chosen);
        let subgoal = plan.subgoals[chosen];
        let pose = situation.pose;
        self.last_bearing_rad = Some(pose.yaw_rad + subgoal.bearing_rad);
        if let Some(place_m) = self.committed.commit(&subgoal, pose, situation.elapsed) {
            self.heuristic.raise(place_m, UNREACHABLE_HALF_SIDE_M, UNREACHABLE_PENALTY_M);
            if self.lattice.is_on_steep_ground() {
                self.start_backtrack(pose.plan_m());
            }
        }
        self.learn(situation);
        let command = self.follow(&subgoal, situation, controller, &mut plan.path);
        if command.is_none() {
            // The way that the path takes first is no way on, whether or not the robot can back off.
            self.lattice.inflate_variance_ahead(direction_of(&plan.path, pose));
            if self.backtrack.begin(pose.plan_m()).is_none() {
                plan.chosen = None;
                return Motion::NoCandidate;
            }
        }
        Motion::Drive(command.unwrap_or(Command::STOP))
    }

    fn stand(&mut self, pose: &Pose, elapsed: Duration) {
        self.lattice.stand(&self.window, pose, elapsed);
    }

    fn safe_turn_rad(&self, turn_rad: f64) -> f64 {
        self.lattice.clear_turn_rad(self.lattice.safe_turn_rad(turn_rad))
    }

    fn has_room_within(&self, point_m: DVec2, distance_m: f64) -> Option<bool> {
        self.lattice.has_room_within(point_m, distance_m)
    }

    fn may_spin(&self) -> bool {
        self.lattice.may_turn_around()
    }
}
