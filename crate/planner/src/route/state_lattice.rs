//! StateLattice over the ground that the last scans saw: from where the robot stands to every place around it that it can reach
//! within its tilt limits.
//!
//! Safety is the paper's: |roll| and |pitch| inside the robot's limits. The paper judges a subgoal by its height at
//! r_oc alone; this looks at the way there. Places half a metre apart and sixteen headings make a graph; a step is a drive
//! along a heading, forward or in reverse, or a turn to the next, each a margin inside the limits with what is uncertain. Its cost is
//! its length and the tilt along it.

mod backward_search;
mod begin;
mod gaps;
mod path;
#[cfg(test)]
mod tests;

use core::f64::consts::TAU;

use glam::DVec2;

use crate::config::StateLatticeConfig;
use crate::math::angle::wrap_rad;
use crate::pose::Pose;
use crate::robot_model::RobotModel;
use crate::route::queue::BucketQueue;
use crate::terrain::attitude::AttitudeEstimate;
use crate::terrain::elevation_window::TerrainQuery;
use crate::terrain::headings::{HEADINGS, STEPS};
use crate::terrain::traversability::{Caution, TraversabilityMap};
pub(crate) use path::length_m;

/// Directions in which the way begins.
const FIRST_DIRECTIONS: usize = 64;
/// A way joins the lattice at the places within this distance.
const JOIN_M: f64 = 1.6;
/// ElevationWindow is calm up to this share of the slope that a way may use at most, and steep from this one.
const CALM_SHARE: f64 = 0.8;
const STEEP_SHARE: f64 = 0.6;
/// A robot stands still after so many steps at the slow speed of steep ground; with no more than this share of the limits it is within them.
const BRAKING_TICKS: f64 = 3.0;
const MOST_SHARE: f64 = 0.98;
/// Turning back on steep ground says that what lies this far ahead is steeper than it had looked.
const MISTRUSTED_AHEAD_M: f64 = 0.5;
/// Each change within this distance makes the next one dearer, up to so many: where a way is refused and allowed by turns, the robot
/// would drive to and fro.
const SAME_PLACE_M: f64 = 1.0;
const MOST_CHANGES: i32 = 5;
/// The robot means to drive this far at most before it changes its mind; with this much left it has.
const LEG_M: f64 = 1.0;
const LEG_DONE_M: f64 = 0.15;
/// A way begins at a place at least this far from the robot; nearer ones are where it stands.
const FIRST_STEP_M: f64 = 0.3;
/// Costs are whole millimetres of level ground.
const MILLIMETRES: f64 = 1000.0;
/// Longest way that is looked for, in metres of level ground.
const FARTHEST_M: usize = 60;
/// No step of the search costs less.
const LEAST_COST_MM: u32 = 100;
const UNREACHED: u32 = u32::MAX;
/// From here on stand the first directions in which a state was reached straight from where the robot stands.
const BEGIN: u32 = u32::MAX - FIRST_DIRECTIONS as u32;

/// Every place within reach, and how to get there.
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
    /// How the way that was last driven began, and what the robot headed for on it.
    last: Option<First>,
    leg: Option<PathPoint>,
    /// Where it last began to change its mind, and how often it did so there.
    changed_at_m: DVec2,
    changes: i32,
    /// Whether it last drove with less caution, to get away.
    escapes: bool,
    /// The first direction that the robot faces, and how many it may turn to the left and to the right.
    facing: i32,
    turns: [i32; 2],
}

/// What a metre of a way costs beyond itself: at the tilt limit, and for each metre up or down; and what one in reverse costs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prices {
    pub(crate) tilt: f64,
    pub(crate) climb: f64,
    pub(crate) reverse: f64,
}

impl Prices {
    /// As configured, with `steepness_share` of what steep ground costs.
    fn of(config: &StateLatticeConfig, steepness_share: f64) -> Self {
        Self {
            tilt: steepness_share * config.tilt_price,
            climb: steepness_share * config.climb_price,
            reverse: config.reverse_price,
        }
    }
}

/// How a way begins.
#[derive(Clone, Copy, Debug)]
struct First {
    /// Unit vector along which the robot faces.
    facing: DVec2,
    reverse: bool,
}

/// A place on a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Seen from above, in the world.
    pub position_m: DVec2,
    /// What getting there costs, in metres of level ground.
    pub cost_m: f64,
    /// Whether the robot gets there in reverse.
    pub reverse: bool,
}

/// A place that the robot can reach, by its state in the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ReachedState {
    state: u32,
}

impl StateLattice {
    /// StateLattice within `radius_m`.
    pub(crate) fn new(config: StateLatticeConfig, limits: &RobotModel, radius_m: f64) -> Self {
        let traversability = TraversabilityMap::new(config, limits, radius_m);
        let states = traversability.count() * HEADINGS;
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
            last: None,
            leg: None,
            changed_at_m: DVec2::ZERO,
            changes: 0,
            escapes: false,
            facing: 0,
            turns: [0; 2],
        }
    }

    /// How many places there are.
    pub(crate) fn count(&self) -> usize {
        self.traversability.count()
    }

    /// Finds the ways from `pose` over the ground that was seen.
    pub(crate) fn search(&mut self, ground: &dyn TerrainQuery, pose: &Pose) {
        let moved_m = pose.plan_m() - self.here_m;
        self.here_m = pose.plan_m();
        self.attitude.be_at(pose);
        self.facing = (wrap_rad(pose.yaw_rad) / TAU * FIRST_DIRECTIONS as f64).round() as i32;
        if (self.changed_at_m - self.here_m).length() > SAME_PLACE_M {
            self.changes = 0;
        }
        self.traversability.drive_on(moved_m.length());
        self.traversability.look(ground, self.here_m);
        self.search_with(Caution::Usual);
    }

    /// Whether the robot stands steeper than even an escape may lead it, or would exceed a limit before it stands still: what it was told
    /// of the ground is not true.
    pub(crate) fn is_too_steep(&self) -> bool {
        let stopped = self.attitude.slopes_within(BRAKING_TICKS);
        !self.attitude.slopes().within(self.traversability.most(), 0.0)
            || stopped.share_of(self.traversability.limits()) > MOST_SHARE
    }

    /// Whether it stands on ground that is a good part of that steep.
    pub(crate) fn is_on_steep_ground(&self) -> bool {
        self.standing_share() > STEEP_SHARE
    }

    /// Whether it stands where a way may begin, and the last search found its ways with the usual caution.
    pub(crate) fn is_calm(&self) -> bool {
        self.standing_share() < CALM_SHARE && self.caution == Caution::Usual
    }

    /// ElevationWindow ahead turned out steeper than it had looked, with the robot driving along the unit vector `travel`.
    pub(crate) fn meet_steeper_ground(&mut self, travel: DVec2) {
        self.traversability.surprise(self.here_m + travel * MISTRUSTED_AHEAD_M);
    }

    /// How much of the slope that a way may have at most the robot stands on.
    fn standing_share(&self) -> f64 {
        self.attitude.slopes().share_of(self.traversability.most())
    }

    /// Searches the same ground anew, with less caution near the robot.
    pub(crate) fn search_escape(&mut self) {
        self.search_with(Caution::Escape);
    }

    fn search_with(&mut self, caution: Caution) {
        self.caution = caution;
        self.traversability.judge(self.here_m, caution);
        self.costs_mm.fill(UNREACHED);
        self.queue.clear();
        self.begin();
        self.expand();
    }

    /// Heads for the next point of a way or, where that leads elsewhere than the robot is about to drive, for what it headed for before as
    /// long as that is ahead and safe: with each metre it changes its mind once at most. Gives what it heads for. Where it turns back on
    /// steep ground, what lay ahead costs more from now on.
    pub(crate) fn drive(&mut self, point: &PathPoint) -> PathPoint {
        let path = point.position_m - self.here_m;
        let facing = if point.reverse { -path } else { path };
        let next = First { facing: facing.normalize_or_zero(), reverse: point.reverse };
        if !self.continues(&next) {
            if let Some(leg) = self.unfinished_leg() {
                return leg;
            }
            if self.changes == 0 {
                self.changed_at_m = self.here_m;
            }
            self.changes = MOST_CHANGES.min(self.changes + 1);
        }
        let turned_back = self.last.filter(|last| last.reverse != next.reverse);
        let escapes = self.caution == Caution::Escape;
        if escapes && !self.escapes {
            self.traversability.mistrust(self.here_m);
        } else if !escapes && let Some(last) = turned_back.filter(|_| self.is_on_steep_ground()) {
            let facing = self.first_direction(self.facing);
            self.meet_steeper_ground(if last.reverse { -facing } else { facing });
        }
        self.escapes = escapes;
        self.last = Some(next);
        self.leg = Some(PathPoint { position_m: self.here_m + path.clamp_length_max(LEG_M), ..*point });
        *point
    }

    /// What the robot headed for, if that is still ahead and the straight way there safe.
    fn unfinished_leg(&self) -> Option<PathPoint> {
        let (leg, last) = self.leg.zip(self.last)?;
        let travel = if last.reverse { -last.facing } else { last.facing };
        let path = leg.position_m - self.here_m;
        let ahead = path.dot(travel) > LEG_DONE_M && path.length() < LEG_M + LEG_DONE_M;
        (ahead && self.straight_cost_m(&leg, FIRST_STEP_M).is_finite()).then_some(leg)
    }

    /// Forgets what was driven last.
    pub(crate) fn stand(&mut self) {
        self.last = None;
        self.leg = None;
    }

    /// Dijkstra's search from the states that [`begin`](Self::begin) reached.
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

    /// The states that one step leads to, and what each costs: both turns, a drive forward and one in reverse, and one across unseen
    /// ground ahead.
    fn steps(&self, state: u32, prices: &Prices) -> [Option<(usize, u32)>; 5] {
        let (place, heading) = (state as usize / HEADINGS, state as usize % HEADINGS);
        let offset = self.traversability.offset(place);
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
            Some((self.traversability.index(to) * HEADINGS + heading, price_mm as u32))
        };
        let gap = || {
            let (to, price_m) = self.cross_gap(offset, heading, prices)?;
            Some((self.traversability.index(to) * HEADINGS + heading, (price_m * MILLIMETRES) as u32))
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

    /// Minds steep ground by this share of what is configured; what is not safe stays so.
    pub(crate) fn scale_slope_cost(&mut self, share: f64) {
        self.prices = Prices::of(&self.config, share);
    }

    /// Keeps this margin inside the tilt limits where there is nothing better.
    pub(crate) fn keep_margin(&mut self, least_margin_rad: f64) {
        self.traversability.keep_margin(least_margin_rad);
    }

    /// As much of a turn on the spot, anticlockwise, as makes the robot no steeper than a way may lead it.
    pub(crate) fn safe_turn_rad(&self, turn_rad: f64) -> f64 {
        self.attitude.safe_turn_rad(turn_rad, self.traversability.most())
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.attitude = AttitudeEstimate::default();
        self.traversability.clear();
        self.stand();
        self.escapes = false;
    }
}
