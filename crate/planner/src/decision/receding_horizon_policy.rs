//! The policy `receding_horizon`, in the making: one price, one cost-to-go, one optimised trajectory.
//!
//! - **Ends.** The goal if it is near, and the frontier with its learned cost-to-go.
//! - **Cost-to-go.** One search backward from the ends over the state lattice, with arcs
//!   ([`crate::route::value_function`]). The same numbers are learned (LSS-LRTA*), so search, learning and
//!   choice share one price, and what is learned only grows.
//! - **Trajectory.** The best of short trajectories by its price along the way and the cost-to-go at its end
//!   ([`crate::control::trajectory_optimiser`]). Smoothness is part of the price. Driving back and turning on
//!   the spot are trajectories like any other; no state of the policy tells them apart.

use core::f64::consts::PI;
use core::time::Duration;

use glam::{DVec2, IVec2};

use crate::config::PlannerConfig;
use crate::control::controller::Controller;
use crate::control::trajectory_optimiser::{Course, Limits, Met, PlanPose, Start, TrajectoryOptimiser};
use crate::decision::observation::take_up;
use crate::decision::policy::{Motion, Plan, Situation, SubgoalPolicy};
use crate::decision::subgoals::{Cost, Subgoal, bearing_rad};
use crate::pose::{FrameChange, Pose};
use crate::route::heuristic_table::HeuristicTable;
use crate::route::state_lattice::{PathPoint, length_m};
use crate::route::value_function::{MOST_WAYPOINTS, ValueFunction, Waypoint};
use crate::skyline::scan_filter::ScanFilter;
use crate::terrain::attitude::AttitudeEstimate;
use crate::terrain::elevation_window::{ElevationWindow, TerrainQuery};
use crate::terrain::place_map::PlaceMap;
use crate::terrain::plane::Plane;

/// The cost-to-go is learned again after this distance.
const LEARN_SPACING_M: f64 = 0.5;
/// The frontier begins this far from the robot: unseen ground nearer by stays unseen from any nearer place.
const NEAR_M: f64 = 1.2;
/// A target is left only for one that is cheaper by this much, and a place this near to it counts as the
/// same.
const COMMITMENT_M: f64 = 1.0;
const SAME_TARGET_M: f64 = 1.5;
/// Standard deviation of the slope under the robot, by its attitude.
const OWN_DEVIATION: f64 = 0.05;
/// The place next to a goal is never farther from it than this.
const LEAST_GOAL_M: f64 = 0.5;
/// Largest speed in reverse, as a share of that forward; largest accelerations.
const REVERSE_SHARE: f64 = 0.5;
const ACCELERATION_M_S2: f64 = 0.8;
const TURN_ACCELERATION_RAD_S2: f64 = 1.5;
/// Costs of a second at (1 rad/s²)² and at (1 m/s²)², in metres, and the weight of the cost-to-go at a
/// trajectory's end, which pays for progress.
const SMOOTHNESS: f64 = 0.45;
const SPEED_SMOOTHNESS: f64 = 0.15;
const PROGRESS: f64 = 3.0;
/// Ground under the lowest beams reaches a little farther than on level ground.
const BLIND_SHARE: f64 = 1.3;

/// The policy's memory.
#[derive(Clone, Debug)]
pub(crate) struct RecedingHorizonPolicy {
    window: ElevationWindow,
    map: PlaceMap,
    value: ValueFunction,
    heuristic: HeuristicTable,
    optimiser: TrajectoryOptimiser,
    attitude: AttitudeEstimate,
    ends: Vec<(IVec2, f64)>,
    trajectory: Vec<PlanPose>,
    way: Vec<Waypoint>,
    target_m: Option<DVec2>,
    learned_at_m: Option<DVec2>,
    /// Ground nearer than this may lie below the lowest beams.
    blind_m: f64,
}

/// Seen ground, on which trajectories are judged.
struct SeenCourse<'a> {
    map: &'a PlaceMap,
    value: &'a ValueFunction,
    ground: &'a dyn TerrainQuery,
    way: &'a [Waypoint],
    /// Largest share of unsafe places around an admissible pose: a robot beside them may leave them.
    unsafe_share: f64,
}

impl Course for SeenCourse<'_> {
    fn met(&self, pose: &PlanPose) -> Option<Met> {
        let risk = self.map.risk_at(self.ground, pose.position_m, pose.yaw_rad);
        (risk.unsafe_share <= self.unsafe_share)
            .then_some(Met { risk: risk.price, utilisation: risk.utilisation })
    }

    fn cost_to_go_m(&self, pose: &PlanPose) -> Option<f64> {
        self.value.at(self.map, pose.position_m, pose.yaw_rad)
    }

    fn path(&self) -> impl Iterator<Item = (DVec2, bool)> {
        self.way.iter().map(|point| (point.position_m, point.reverse))
    }
}

/// Places this near to the goal are ends: those within its tolerance, and at least those beside it.
fn at_goal_m(goal_tolerance_m: f64) -> f64 {
    goal_tolerance_m.max(LEAST_GOAL_M)
}

impl RecedingHorizonPolicy {
    /// A policy with an empty window. The configuration must have been validated.
    pub(crate) fn new(config: &PlannerConfig) -> Self {
        let map = PlaceMap::new(config.state_lattice, &config.robot, config.perception.surface_radius_m);
        let controller = &config.controller;
        let lowest = -config.sensor.lowest_elevation_rad;
        let blind_m = if lowest > 0.05 {
            BLIND_SHARE * config.sensor.height_m / libm::tan(lowest)
        } else {
            config.state_lattice.blind_radius_m
        };
        Self {
            window: ElevationWindow::new(config),
            value: ValueFunction::new(config.state_lattice, map.places.count()),
            heuristic: HeuristicTable::new(config.state_lattice.step_m),
            optimiser: TrajectoryOptimiser::new(Limits {
                speed_m_s: controller.max_speed_m_s,
                reverse_m_s: REVERSE_SHARE * controller.max_speed_m_s,
                turn_rate_rad_s: controller.max_turn_rate_rad_s,
                acceleration_m_s2: ACCELERATION_M_S2,
                turn_acceleration_rad_s2: TURN_ACCELERATION_RAD_S2,
                smoothness: SMOOTHNESS,
                speed_smoothness: SPEED_SMOOTHNESS,
                turn_m_rad: config.state_lattice.turn_m_rad(),
                progress: PROGRESS,
                tilt_price: config.state_lattice.tilt_price,
                reverse_price: config.state_lattice.reverse_price,
                regulate_from: controller.regulate_from_utilisation,
                least_share: controller.min_speed_share,
            }),
            attitude: AttitudeEstimate::default(),
            ends: Vec::with_capacity(map.places.count() + 4),
            trajectory: Vec::with_capacity(64),
            way: Vec::with_capacity(MOST_WAYPOINTS + 1),
            target_m: None,
            learned_at_m: None,
            blind_m: blind_m.min(config.state_lattice.blind_radius_m),
            map,
        }
    }

    /// The ends of the search: the goal if it is near, or else the frontier, with their cost-to-go.
    fn find_ends(&mut self, situation: &Situation<'_>) {
        let Situation { pose, goal_m, goal_tolerance_m, .. } = *situation;
        let here_m = pose.plan_m();
        self.ends.clear();
        for index in 0..self.map.places.count() {
            let offset = self.map.places.offset(index);
            let Some(_) = self.map.plane(offset) else { continue };
            let place_m = self.map.places.position_m(offset);
            let to_goal_m = (goal_m - place_m).length();
            if to_goal_m <= at_goal_m(goal_tolerance_m) {
                self.ends.push((offset, to_goal_m));
            } else if (place_m - here_m).length() > NEAR_M && self.map.is_frontier(offset) {
                let kept =
                    self.target_m.is_some_and(|target_m| (target_m - place_m).length() < SAME_TARGET_M);
                let bonus_m = if kept { COMMITMENT_M } else { 0.0 };
                self.ends.push((offset, self.heuristic.cost_to_go_m(place_m, goal_m) - bonus_m));
            }
        }
    }

    fn learn(&mut self, situation: &Situation<'_>) {
        let here_m = situation.pose.plan_m();
        if self.learned_at_m.is_some_and(|last_m| (last_m - here_m).length() < LEARN_SPACING_M) {
            return;
        }
        self.learned_at_m = Some(here_m);
        for index in 0..self.map.places.count() {
            if let Some(value_m) = self.value.of_place(index) {
                let place_m = self.map.places.position_m(self.map.places.offset(index));
                self.heuristic.learn(place_m, situation.goal_m, value_m);
            }
        }
    }

    /// Moves all that is remembered from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        self.window.relocalise(change);
        self.map.clear();
        self.heuristic.relocalise(change);
        self.target_m = self.target_m.map(|place_m| change.place_m(place_m));
        self.learned_at_m = self.learned_at_m.map(|place_m| change.place_m(place_m));
    }

    /// The target as a subgoal; its cost is the cost-to-go from here.
    fn subgoal(&self, situation: &Situation<'_>, target_m: DVec2) -> Subgoal {
        let Situation { config, pose, .. } = *situation;
        let here_m = pose.plan_m();
        let offset = self.map.places.nearest(target_m);
        let height_m =
            offset.and_then(|offset| self.map.plane(offset)).map_or(pose.position_m.z, |p| p.height_m);
        let over_sensor_m = height_m - pose.position_m.z - config.sensor.height_m;
        let cost_to_go_m = self.value.at(&self.map, here_m, pose.yaw_rad).unwrap_or_default();
        let bearing_rad = bearing_rad(pose, target_m);
        Subgoal {
            segment: None,
            azimuth_rad: bearing_rad,
            elevation_rad: libm::atan2(over_sensor_m, (target_m - here_m).length()),
            position_m: target_m.extend(height_m),
            bearing_rad,
            forecast: None,
            refusal: None,
            cost: Some(Cost { distance: cost_to_go_m, ..Cost::default() }),
        }
    }
}

impl SubgoalPolicy for RecedingHorizonPolicy {
    fn start(&mut self) {
        self.heuristic.clear();
        self.target_m = None;
        self.learned_at_m = None;
        self.optimiser.reset();
    }

    fn forget_terrain(&mut self) {
        self.window.clear();
        self.map.clear();
    }

    fn observe(&mut self, config: &PlannerConfig, scan: &ScanFilter, pose: &Pose, elapsed: Duration) {
        take_up(&mut self.window, config, scan, pose, elapsed);
        let reach_m = self.window.reach_m();
        for &place_m in self.window.refuted_m() {
            self.map.places.forget_near(place_m, reach_m);
        }
    }

    fn decide(&mut self, situation: &Situation<'_>, _: &mut Controller, plan: &mut Plan) -> Motion {
        let Situation { pose, goal_m, goal_tolerance_m, elapsed, last_command, terrain, .. } = *situation;
        let here_m = pose.plan_m();
        self.attitude.be_at(pose, elapsed);
        let own = Plane {
            height_m: self.attitude.height_m,
            gradient: self.attitude.gradient,
            gradient_deviation: OWN_DEVIATION,
        };
        match &terrain {
            Some(told) => self.map.look(told, here_m, own, self.blind_m),
            None => self.map.look(&self.window, here_m, own, self.blind_m),
        }
        self.find_ends(situation);
        self.value.search(&self.map, &self.ends, None);
        // What a way out of unsafe ground costs is not learned: it holds only from where the robot stands.
        self.learn(situation);
        if self.value.at(&self.map, here_m, pose.yaw_rad).is_none() {
            self.value.search(&self.map, &self.ends, Some(IVec2::ZERO));
        }
        self.value.path_from(&self.map, here_m, pose.yaw_rad, &mut self.way);
        if let Some(end) = self
            .way
            .last()
            .copied()
            .filter(|end| end.position_m.distance(goal_m) <= at_goal_m(goal_tolerance_m))
        {
            self.way.push(Waypoint { position_m: goal_m, ..end });
        }
        let ground: &dyn TerrainQuery = match &terrain {
            Some(told) => told,
            None => &self.window,
        };
        let here = PlanPose { position_m: here_m, yaw_rad: pose.yaw_rad };
        let from = Start { pose: here, command: last_command };
        let unsafe_share = (self.map.risk_at(ground, here_m, pose.yaw_rad).unsafe_share + 0.02).max(0.5);
        let course = SeenCourse { map: &self.map, value: &self.value, ground, way: &self.way, unsafe_share };
        let Some(command) = self.optimiser.drive(&course, from, &mut self.trajectory) else {
            self.target_m = None;
            return Motion::NoCandidate;
        };
        let reverse = command.linear_m_s < 0.0;
        let point = |position_m| PathPoint { position_m, cost_m: 0.0, reverse };
        plan.path.push(point(here_m));
        plan.path.extend(self.trajectory.iter().map(|pose| point(pose.position_m)));
        let target_m = self.way.last().map_or(here_m, |end| end.position_m);
        let beyond_m = length_m(&plan.path);
        plan.path.extend(
            (self.way.iter().filter(|way| way.position_m.distance(here_m) > beyond_m))
                .map(|way| point(way.position_m)),
        );
        self.target_m = Some(target_m);
        plan.chosen = Some(0);
        plan.subgoals.push(self.subgoal(situation, target_m));
        Motion::Drive(command)
    }

    fn safe_turn_rad(&self, turn_rad: f64) -> f64 {
        self.attitude.safe_turn_rad(turn_rad, self.map.most())
    }

    fn may_spin(&self) -> bool {
        self.safe_turn_rad(PI).abs() >= PI && self.safe_turn_rad(-PI).abs() >= PI
    }
}
