//! The state lattice: paths over the elevation window from the robot to every place that it can reach within
//! its tilt limits.
//!
//! Safety is the paper's: |roll| and |pitch| inside the robot's limits. The paper judges a subgoal by its
//! height at r_oc alone; this judges the whole path to it. The states are places half a metre apart with
//! sixteen headings. A step is a drive along a heading, forward or in reverse, or a turn to the next heading.
//! Each step keeps a margin inside the limits for the uncertainty of the slope. Its cost is its length, plus
//! terms for the tilt and the climb along it.

mod backward_search;
mod begin;
mod gaps;
mod kept_path;
mod path;
#[cfg(test)]
mod tests;

use core::f64::consts::TAU;
use core::time::Duration;

use glam::DVec2;

use crate::config::StateLatticeConfig;
use crate::pose::{FrameChange, Pose};
use crate::robot_model::RobotModel;
use crate::route::queue::BucketQueue;
use crate::terrain::attitude::AttitudeEstimate;
use crate::terrain::body_clearance::BodyClearance;
use crate::terrain::elevation_window::TerrainQuery;
use crate::terrain::headings::{HEADINGS, STEPS};
use crate::terrain::traversability::{Caution, TraversabilityMap};
use kept_path::KeptPath;
pub(crate) use kept_path::ON_PATH_M;
pub(crate) use path::{first_leg, length_m};

/// Directions in which a path may begin.
const FIRST_DIRECTIONS: usize = 64;
/// A path joins the lattice at places within this distance.
const JOIN_M: f64 = 1.6;
/// Attitudes are calm below the first tilt utilisation and steep above the second, as shares of the largest
/// admissible slope.
const CALM_SHARE: f64 = 0.8;
const STEEP_SHARE: f64 = 0.6;
/// The robot stops within this time at the reduced speed of steep ground. It backtracks when the attitude
/// extrapolated over that time exceeds this tilt utilisation.
const BRAKING_TIME: Duration = Duration::from_millis(300);
const BRAKING_UTILISATION: f64 = 0.98;
/// Turning back on steep ground inflates the slope variance this far ahead.
const INFLATED_AHEAD_M: f64 = 0.5;
/// The driven path is left only for one that is cheaper by this much, in metres of level ground.
const WORTH_LEAVING_M: f64 = 0.5;
/// A path begins at a place at least this far from the robot; a nearer one is reached by staying.
const FIRST_STEP_M: f64 = 0.3;
/// Costs are whole millimetres of level ground.
const MILLIMETRES: f64 = 1000.0;
/// Largest cost that is searched, in metres of level ground.
const FARTHEST_M: usize = 60;
/// Lower bound on the cost of a step.
const LEAST_COST_MM: u32 = 100;
const UNREACHED: u32 = u32::MAX;
/// The predecessor of a state that was reached directly from the robot's pose.
const BEGIN: u32 = u32::MAX;

/// The cheapest paths to all reachable states.
#[derive(Clone, Debug)]
pub(crate) struct StateLattice {
    config: StateLatticeConfig,
    prices: Prices,
    traversability: TraversabilityMap,
    first_directions: Vec<DVec2>,
    costs_mm: Vec<u32>,
    came_from: Vec<u32>,
    cost_to_go_mm: Vec<u32>,
    queue: BucketQueue,
    here_m: DVec2,
    attitude: AttitudeEstimate,
    caution: Caution,
    kept: KeptPath,
    /// The kept path's next state in this search, and whether it is entered in reverse.
    kept_state: Option<(usize, bool)>,
    /// Whether the last drive was in reverse.
    was_reverse: Option<bool>,
    /// Whether the last drive was in recovery, with the smaller margin.
    recovers: bool,
    /// Unit vector that the robot faces, and by how many directions it may turn to the left and to the right.
    facing: DVec2,
    turns: [i32; 2],
    body: BodyClearance,
}

/// Cost of a metre beyond its length: at the tilt limit, and for each metre up or down; and the factor for
/// reverse.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prices {
    pub(crate) tilt: f64,
    pub(crate) climb: f64,
    pub(crate) reverse: f64,
}

impl Prices {
    /// As configured, with the slope costs scaled by `steepness_share`.
    fn of(config: &StateLatticeConfig, steepness_share: f64) -> Self {
        Self {
            tilt: steepness_share * config.tilt_price,
            climb: steepness_share * config.climb_price,
            reverse: config.reverse_price,
        }
    }
}

/// A point on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Position in the world frame, seen from above.
    pub position_m: DVec2,
    /// Cost of the path up to here, in metres of level ground.
    pub cost_m: f64,
    /// Whether the robot drives here in reverse.
    pub reverse: bool,
}

/// A place that the search reached, as its state with the cheapest heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ReachedState {
    state: u32,
}

impl StateLattice {
    /// A lattice over the places within `radius_m` of the robot.
    pub(crate) fn new(config: StateLatticeConfig, limits: &RobotModel, radius_m: f64) -> Self {
        let traversability = TraversabilityMap::new(config, limits, radius_m);
        let states = traversability.places.count() * HEADINGS;
        // Each state is entered by two drives, some gaps, two turns and the first directions.
        let entries = 6 * states + 16 * FIRST_DIRECTIONS;
        let direction = |k: usize| {
            let (sin, cos) = libm::sincos(TAU * k as f64 / FIRST_DIRECTIONS as f64);
            DVec2::new(cos, sin)
        };
        Self {
            prices: Prices::of(&config, 1.0),
            config,
            traversability,
            first_directions: (0..FIRST_DIRECTIONS).map(direction).collect(),
            costs_mm: vec![UNREACHED; states],
            came_from: vec![BEGIN; states],
            cost_to_go_mm: vec![UNREACHED; states],
            queue: BucketQueue::new(
                LEAST_COST_MM,
                FARTHEST_M * MILLIMETRES as usize / LEAST_COST_MM as usize,
                entries,
            ),
            here_m: DVec2::ZERO,
            attitude: AttitudeEstimate::default(),
            caution: Caution::Usual,
            kept: KeptPath::default(),
            kept_state: None,
            was_reverse: None,
            recovers: false,
            facing: DVec2::X,
            turns: [0; 2],
            body: BodyClearance::new(limits, radius_m),
        }
    }

    /// Number of places.
    pub(crate) fn count(&self) -> usize {
        self.traversability.places.count()
    }

    /// Searches paths from `pose` over `ground`, `elapsed` after the last search.
    pub(crate) fn search(&mut self, ground: &dyn TerrainQuery, pose: &Pose, elapsed: Duration) {
        let moved_m = pose.plan_m() - self.here_m;
        self.traversability.drive_on(moved_m.length());
        self.traversability.places.look(ground, pose.plan_m());
        self.stand(ground, pose, elapsed);
        self.search_with(Caution::Usual);
    }

    /// Takes up the attitude at `pose` and what is upright around it, `elapsed` after the last time.
    pub(crate) fn stand(&mut self, ground: &dyn TerrainQuery, pose: &Pose, elapsed: Duration) {
        self.here_m = pose.plan_m();
        self.attitude.be_at(pose, elapsed);
        let (sin, cos) = libm::sincos(pose.yaw_rad);
        self.facing = DVec2::new(cos, sin);
        let expected = self.traversability.places.gradient_at(self.here_m);
        self.body.look(ground, self.here_m, self.facing, self.attitude.gradient, expected);
    }

    /// Whether the attitude exceeds even the recovery margin, or, extrapolated over the braking time, a tilt
    /// limit: the elevation window was wrong about the ground.
    pub(crate) fn is_too_steep(&self) -> bool {
        let stopped = self.attitude.slopes_within(BRAKING_TIME);
        !self.attitude.slopes().within(self.traversability.most(), 0.0)
            || stopped.share_of(self.traversability.limits()) > BRAKING_UTILISATION
    }

    /// Whether the attitude is a large part of the largest admissible slope.
    pub(crate) fn is_on_steep_ground(&self) -> bool {
        self.slope_share() > STEEP_SHARE
    }

    /// Whether the attitude is calm and the last search found its paths without recovery.
    pub(crate) fn is_calm(&self) -> bool {
        self.slope_share() < CALM_SHARE && self.caution == Caution::Usual
    }

    /// Inflates the slope variance ahead: the ground turned out steeper than predicted while the robot drove
    /// along the unit vector `travel`.
    pub(crate) fn inflate_variance_ahead(&mut self, travel: DVec2) {
        self.traversability.inflate_variance(self.here_m + travel * INFLATED_AHEAD_M);
    }

    /// The attitude's share of the largest admissible slope.
    fn slope_share(&self) -> f64 {
        self.attitude.slopes().share_of(self.traversability.most())
    }

    /// Repeats the search in recovery: with the smallest margin near the robot.
    pub(crate) fn search_recovery(&mut self) {
        self.search_with(Caution::Recovery);
    }

    fn search_with(&mut self, caution: Caution) {
        self.caution = caution;
        self.traversability.judge(self.here_m, caution);
        self.costs_mm.fill(UNREACHED);
        self.queue.clear();
        self.begin();
        self.expand();
    }

    /// Keeps the path to a reached place. A reversal on steep ground inflates the slope variance ahead.
    pub(crate) fn keep(&mut self, reached: ReachedState) {
        let kept = self.kept_path_to(reached);
        let reverse = kept.is_reverse();
        let turned_back = self.was_reverse.is_some_and(|was_reverse| was_reverse != reverse);
        let recovers = self.caution == Caution::Recovery;
        if recovers && !self.recovers {
            self.traversability.penalise(self.here_m);
        } else if !recovers && turned_back && self.is_on_steep_ground() {
            self.inflate_variance_ahead(if reverse { self.facing } else { -self.facing });
        }
        self.recovers = recovers;
        self.was_reverse = Some(reverse);
        self.kept = kept;
    }

    /// Releases the kept path.
    pub(crate) fn release(&mut self) {
        self.was_reverse = None;
        self.kept = KeptPath::default();
    }

    /// Dijkstra's algorithm from the states that [`begin`](Self::begin) reached.
    fn expand(&mut self) {
        let prices = self.prices;
        while let Some((state, cost_mm)) = self.queue.pop() {
            if self.costs_mm[state as usize] != cost_mm {
                continue;
            }
            for (next, price_mm) in self.steps(state, &prices).into_iter().flatten() {
                self.reach(next, state, cost_mm.saturating_add(price_mm));
            }
        }
    }

    /// The successors of a state and the cost of each: two turns, a drive forward, one in reverse, and one
    /// over a virtual surface ahead.
    fn steps(&self, state: u32, prices: &Prices) -> [Option<(usize, u32)>; 5] {
        let (place, heading) = (state as usize / HEADINGS, state as usize % HEADINGS);
        let offset = self.traversability.places.offset(place);
        let turn = |turned: usize| {
            let price_mm = (self.config.turn_cost_m * MILLIMETRES) as u32;
            self.traversability
                .risk(offset, turned)
                .is_finite()
                .then_some((place * HEADINGS + turned, price_mm))
        };
        let step_mm = STEPS[heading].as_dvec2().length() * self.config.step_m * MILLIMETRES;
        let drive = |forward: bool, price: f64| {
            let (to, risk) = self.traversability.drive(offset, heading, forward)?;
            let price_mm = price * step_mm * (1.0 + prices.tilt * risk)
                + prices.climb * self.traversability.climb_m(offset, to) * MILLIMETRES;
            Some((self.traversability.places.index(to) * HEADINGS + heading, price_mm as u32))
        };
        let gap = || {
            let (to, price_m) = self.cross_gap(offset, heading, prices)?;
            Some((self.traversability.places.index(to) * HEADINGS + heading, (price_m * MILLIMETRES) as u32))
        };
        [
            turn((heading + 1) % HEADINGS),
            turn((heading + HEADINGS - 1) % HEADINGS),
            drive(true, 1.0),
            drive(false, prices.reverse),
            gap(),
        ]
    }

    fn reach(&mut self, state: usize, from: u32, cost_mm: u32) {
        if cost_mm < self.costs_mm[state] && self.queue.takes(cost_mm) {
            self.costs_mm[state] = cost_mm;
            self.came_from[state] = from;
            self.queue.push(state as u32, cost_mm);
        }
    }

    /// Scales the costs of slopes to this share of the configured ones; the limits stay.
    pub(crate) fn scale_slope_cost(&mut self, share: f64) {
        self.prices = Prices::of(&self.config, share);
    }

    /// Sets the smallest margin inside the tilt limits, for tight ground and recovery.
    pub(crate) fn keep_margin(&mut self, least_margin_rad: f64) {
        self.traversability.keep_margin(least_margin_rad);
    }

    /// The largest part of a turn on the spot, anticlockwise, that keeps the attitude admissible.
    pub(crate) fn safe_turn_rad(&self, turn_rad: f64) -> f64 {
        self.attitude.safe_turn_rad(turn_rad, self.traversability.most())
    }

    /// Whether the body has room within `distance_m` of a point, whatever the slope; `None` if unknown.
    pub(crate) fn has_room_within(&self, point_m: DVec2, distance_m: f64) -> Option<bool> {
        self.traversability.places.has_room_within(point_m, distance_m)
    }

    /// Has the ground within `radius_m` of a place queried again at the next scan.
    pub(crate) fn query_again_near(&mut self, place_m: DVec2, radius_m: f64) {
        self.traversability.places.query_again_near(place_m, radius_m);
    }

    /// Moves the remembered state from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        self.here_m = change.place_m(self.here_m);
        self.traversability.relocalise(change);
        self.release();
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.attitude = AttitudeEstimate::default();
        self.traversability.clear();
        self.release();
        self.recovers = false;
    }
}
