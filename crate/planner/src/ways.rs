//! Ways over the ground that the last scans saw: from where the robot stands to every place around it that it can reach
//! within its tilt limits.
//!
//! Safety is the paper's: |roll| and |pitch| inside the robot's limits. The paper judges a subgoal by its height at
//! r_oc alone; this looks at the way there. Places half a metre apart and sixteen headings make a graph; a step is a drive
//! along a heading or a turn to the next, each within a share of the limits with a margin for what is uncertain. Its cost is
//! its length and the tilt along it.

mod footing;
mod headings;
mod queue;
#[cfg(test)]
mod tests;

use core::f64::consts::TAU;

use glam::{DVec2, IVec2};

use crate::config::{ForecastConfig, TiltLimits};
use crate::forecast::{Forecast, ReachEnd};
use crate::plane::Plane;
use crate::pose::Pose;
use footing::{Caution, Footing, Slopes};
use headings::{DIRECTIONS, HEADINGS, STEPS, nearest};
use queue::BucketQueue;

/// Directions in which the way begins.
const FIRST_DIRECTIONS: usize = 64;
/// A way begins at a place at least this far from the robot.
const FIRST_STEP_M: f64 = 0.3;
/// Ground known no farther than this from the robot may be that under its wheels alone.
const WHEELS_M: f64 = 1.25;
/// A way joins the lattice at the places within this distance.
const JOIN_M: f64 = 1.6;
/// A retreat ends at this share of the slope that a way may use; what lies this far ahead of where it begins is barred.
const CALM_SHARE: f64 = 0.8;
/// Turning back on ground at least this steep says that what lies ahead is steeper than it had looked.
const STEEP_SHARE: f64 = 0.6;
const BARRED_AHEAD_M: f64 = 0.5;
/// The longest step of the lattice, √5 places, and some.
const LONGEST_STEP: f64 = 2.3;
/// Unseen ground that is driven over between two places, and what a metre of it costs.
const GAP_M: f64 = 2.5;
const GAP_PRICE: f64 = 1.5;
/// The robot minds what lies this far ahead; ground that was not seen counts as this share of the tilt limits, unless the robot
/// stands on less than that.
const AHEAD_M: f64 = 1.0;
const BLIND_SHARE: f64 = 0.75;
const LEVEL_SHARE: f64 = 0.2;
/// Beginnings within an eighth of a circle of each other are the same.
const SAME_COSINE: f64 = core::f64::consts::FRAC_1_SQRT_2;
/// Costs are whole millimetres of level ground.
const MILLIMETRES: f64 = 1000.0;
/// Longest way that is looked for, in metres of level ground.
const FARTHEST_M: usize = 60;
/// No step of the search costs less.
const LEAST_COST_MM: u32 = 100;
const UNREACHED: u32 = u32::MAX;
/// Marks a state that was reached straight from where the robot stands.
const BEGIN: u32 = u32::MAX;

/// Every place within reach, and how to get there.
#[derive(Clone, Debug)]
pub(crate) struct Ways {
    config: ForecastConfig,
    footing: Footing,
    first_directions: Vec<DVec2>,
    costs_mm: Vec<u32>,
    came_from: Vec<u32>,
    queue: BucketQueue,
    here_m: DVec2,
    standing_height_m: f64,
    standing_gradient: DVec2,
    caution: Caution,
    /// How the way that was last driven began.
    last: Option<First>,
    /// Whether the robot goes back the way it came, and then whether in reverse.
    retreat: Option<bool>,
    /// The first direction that the robot faces, and how many it may turn to the left and to the right.
    facing: i32,
    turns: [i32; 2],
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
pub struct WayPoint {
    /// Seen from above, in the world.
    pub position_m: DVec2,
    /// What getting there costs, in metres of level ground.
    pub cost_m: f64,
    /// Whether the robot gets there in reverse.
    pub reverse: bool,
}

/// A place that the robot can reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reached {
    /// Its state in the search.
    state: u32,
    /// What getting there costs, metres of level ground.
    pub(crate) cost_m: f64,
}

impl Ways {
    /// Ways within `radius_m`.
    pub(crate) fn new(config: ForecastConfig, limits: &TiltLimits, radius_m: f64) -> Self {
        let footing = Footing::new(config, limits, radius_m);
        let states = footing.count() * HEADINGS;
        // Each state is entered by two drives, some gaps, two turns and the first directions.
        let entries = 6 * states + 16 * FIRST_DIRECTIONS;
        let direction = |k: usize| {
            let (sin, cos) = libm::sincos(TAU * k as f64 / FIRST_DIRECTIONS as f64);
            DVec2::new(cos, sin)
        };
        Self {
            config,
            footing,
            first_directions: (0..FIRST_DIRECTIONS).map(direction).collect(),
            costs_mm: vec![UNREACHED; states],
            came_from: vec![BEGIN; states],
            queue: BucketQueue::new(
                LEAST_COST_MM,
                FARTHEST_M * MILLIMETRES as usize / LEAST_COST_MM as usize,
                entries,
            ),
            here_m: DVec2::ZERO,
            standing_height_m: 0.0,
            standing_gradient: DVec2::ZERO,
            caution: Caution::Usual,
            last: None,
            retreat: None,
            facing: 0,
            turns: [0; 2],
        }
    }

    /// Finds the ways from `pose` over the ground that `plane_at` knows.
    pub(crate) fn search(&mut self, plane_at: &dyn Fn(DVec2) -> Option<Plane>, pose: &Pose) {
        self.here_m = pose.plan_m();
        self.standing_height_m = pose.position_m.z;
        self.facing = (pose.yaw_rad / TAU * FIRST_DIRECTIONS as f64).round() as i32;
        let up = pose.world_from_robot().z_axis;
        self.standing_gradient = -up.truncate() / up.z;
        self.footing.look(plane_at, self.here_m);
        self.mind_standing();
        self.search_with(Caution::Usual);
    }

    /// Where the robot stands steeper than a way may be, what it was told of the ground ahead is not true: it goes back the way it
    /// came, and what lay ahead is not tried again.
    fn mind_standing(&mut self) {
        let share = self.standing_share();
        if share < CALM_SHARE {
            self.retreat = None;
        } else if share > 1.0 && self.retreat.is_none() {
            self.turn_back();
        }
    }

    /// How much of the slope that a way may have the robot stands on.
    fn standing_share(&self) -> f64 {
        self.standing_slopes().share_of(self.footing.allowed(Caution::Usual, 0.0))
    }

    fn standing_slopes(&self) -> Slopes {
        Slopes::facing(self.standing_gradient, self.first_direction(self.facing))
    }

    fn turn_back(&mut self) {
        let Some(last) = self.last else { return };
        self.retreat = Some(!last.reverse);
        let facing = self.first_direction(self.facing);
        let travel = if last.reverse { -facing } else { facing };
        self.footing.bar(self.here_m + travel * BARRED_AHEAD_M);
    }

    /// Searches the same ground anew, with less caution near the robot.
    pub(crate) fn search_escape(&mut self) {
        self.search_with(Caution::Escape);
    }

    fn search_with(&mut self, caution: Caution) {
        self.caution = caution;
        self.footing.judge(self.here_m, caution);
        self.costs_mm.fill(UNREACHED);
        self.queue.clear();
        self.begin();
        self.expand();
    }

    /// From where the robot stands straight to the first known places in each direction that it may turn to.
    fn begin(&mut self) {
        let count = FIRST_DIRECTIONS as i32;
        let steepest = self.footing.allowed(self.caution, 0.0).across;
        for (side, sign) in [1, -1].into_iter().enumerate() {
            self.turns[side] = count / 2;
            for turn in 0..=count / 2 {
                let facing = self.first_direction(self.facing + sign * turn);
                if turn > 0 && self.standing_gradient.dot(facing.perp()).abs() > steepest {
                    self.turns[side] = turn - 1;
                    break;
                }
                let turn_m = self.config.turn_cost_m * f64::from(turn) * HEADINGS as f64 / f64::from(count);
                for reverse in [false, true] {
                    if self.retreat.is_some_and(|back| back != reverse) {
                        continue;
                    }
                    let first = First { facing, reverse };
                    let change_m = if self.continues(&first) { 0.0 } else { self.config.change_cost_m };
                    self.begin_along(&first, turn_m + change_m);
                }
            }
        }
    }

    /// Whether a way that begins like this begins as the last one meant to.
    fn continues(&self, first: &First) -> bool {
        self.last
            .is_none_or(|last| last.reverse == first.reverse && last.facing.dot(first.facing) > SAME_COSINE)
    }

    /// The place beyond unseen ground that a drive along a heading leads to, and what that costs.
    fn cross_gap(&self, from: IVec2, heading: usize) -> Option<(IVec2, f64)> {
        let to = self.footing.beyond_gap(from, heading, GAP_M)?;
        let (begin, end) = (self.footing.plane(from)?, self.footing.plane(to)?);
        let way = self.footing.position_m(to) - self.footing.position_m(from);
        let distance_m = way.length();
        let start = Station { distance_m: 0.0, height_m: begin.height_m, gradient: begin.gradient };
        let end = Station { distance_m, height_m: end.height_m, gradient: end.gradient };
        let risk = self.risk_between(&start, &end, way / distance_m);
        risk.is_finite().then_some((to, GAP_PRICE * distance_m * (1.0 + self.config.tilt_price * risk)))
    }

    /// Remembers how the way that is driven begins; nothing when none is driven. Where the robot turns back on steep ground, what
    /// lay ahead is not tried again.
    pub(crate) fn drive(&mut self, point: Option<&WayPoint>) {
        let next = point.map(|point| {
            let way = point.position_m - self.here_m;
            let facing = if point.reverse { -way } else { way };
            First { facing: facing.normalize_or_zero(), reverse: point.reverse }
        });
        let turns_back = self.last.zip(next).is_some_and(|(last, next)| last.reverse != next.reverse);
        if self.caution == Caution::Escape {
            self.footing.bar(self.here_m);
        } else if turns_back && self.standing_share() > STEEP_SHARE {
            self.turn_back();
        }
        self.last = next;
    }

    fn first_direction(&self, index: i32) -> DVec2 {
        self.first_directions[index.rem_euclid(FIRST_DIRECTIONS as i32) as usize]
    }

    /// Straight ahead or in reverse to the next known place and, where no beam reaches the ground at the wheels, to the first
    /// one beyond.
    fn begin_along(&mut self, first: &First, cost_m: f64) {
        let travel = if first.reverse { -first.facing } else { first.facing };
        let mut seen_m = 0.0;
        let steps = (self.config.blind_radius_m / self.config.step_m) as usize;
        for step in 1..=steps {
            let along_m = self.config.step_m * step as f64;
            let Some(offset) = self.footing.nearest(self.here_m + travel * along_m) else { return };
            if self.footing.plane(offset).is_none() {
                if seen_m > WHEELS_M {
                    return;
                }
                continue;
            }
            // From the ground at the wheels the search itself goes on.
            let beyond_blind = along_m - seen_m > 1.5 * self.config.step_m;
            seen_m = along_m;
            if !beyond_blind && along_m > JOIN_M {
                return;
            }
            let safe = self.begin_at(offset, first, cost_m);
            // The place nearest to the robot may miss by rounding what it already stands on.
            if beyond_blind && along_m > JOIN_M || !safe && step > 1 {
                return;
            }
        }
    }

    /// Straight to a place, unless that is not safe.
    fn begin_at(&mut self, offset: IVec2, first: &First, cost_m: f64) -> bool {
        let Some(plane) = self.footing.plane(offset) else { return false };
        let way = self.footing.position_m(offset) - self.here_m;
        let distance_m = way.length();
        if distance_m < FIRST_STEP_M {
            return true;
        }
        let heading = nearest(first.facing);
        let start =
            Station { distance_m: 0.0, height_m: self.standing_height_m, gradient: self.standing_gradient };
        let end = Station { distance_m, height_m: plane.height_m, gradient: plane.gradient };
        let risk = self.risk_between(&start, &end, way / distance_m).max(self.footing.risk(offset, heading));
        if !risk.is_finite() {
            return false;
        }
        let price = if first.reverse { self.config.reverse_price } else { 1.0 };
        let cost_m = cost_m + price * distance_m * (1.0 + self.config.tilt_price * risk);
        let state = self.footing.index(offset) * HEADINGS + heading;
        self.reach(state, BEGIN, (cost_m * MILLIMETRES) as u32);
        true
    }

    /// Mean risk along a straight line over ground that was not seen, a cubic through both heights and slopes; infinite where
    /// it is not safe.
    fn risk_between(&self, from: &Station, to: &Station, direction: DVec2) -> f64 {
        let allowed = *self.footing.allowed(self.caution, to.distance_m);
        let count = (to.distance_m / self.config.step_m).ceil().max(1.0) as usize;
        let mut sum = 0.0;
        for k in 1..=count {
            let slopes = from.slopes_towards(to, direction, k as f64 / count as f64);
            if !slopes.within(&allowed, 0.0) {
                return f64::INFINITY;
            }
            let share = slopes.share_of(self.footing.limits());
            sum += share * share;
        }
        sum / count as f64
    }

    /// Dijkstra's search from the states that [`begin`](Self::begin) reached.
    fn expand(&mut self) {
        let step_mm = STEPS.map(|step| step.as_dvec2().length() * self.config.step_m * MILLIMETRES);
        let turn_mm = (self.config.turn_cost_m * MILLIMETRES) as u32;
        while let Some((state, cost_mm)) = self.queue.pop() {
            if self.costs_mm[state as usize] != cost_mm {
                continue;
            }
            let (place, heading) = (state as usize / HEADINGS, state as usize % HEADINGS);
            let offset = self.footing.offset(place);
            for turned in [(heading + 1) % HEADINGS, (heading + HEADINGS - 1) % HEADINGS] {
                if self.footing.risk(offset, turned).is_finite() {
                    self.reach(place * HEADINGS + turned, state, cost_mm + turn_mm);
                }
            }
            for (forward, price) in [(true, 1.0), (false, self.config.reverse_price)] {
                if let Some((to, risk)) = self.footing.drive(offset, heading, forward) {
                    let price_mm = price * step_mm[heading] * (1.0 + self.config.tilt_price * risk);
                    let next = self.footing.index(to) * HEADINGS + heading;
                    self.reach(next, state, cost_mm + price_mm as u32);
                }
            }
            if let Some((to, price_m)) = self.cross_gap(offset, heading) {
                let next = self.footing.index(to) * HEADINGS + heading;
                self.reach(next, state, cost_mm + (price_m * MILLIMETRES) as u32);
            }
        }
    }

    fn reach(&mut self, state: usize, from: u32, cost_mm: u32) {
        if cost_mm < self.costs_mm[state] && self.queue.takes(cost_mm) {
            self.costs_mm[state] = cost_mm;
            self.came_from[state] = from;
            self.queue.push(state as u32, cost_mm);
        }
    }

    /// The cheapest way to the place nearest to a point; `None` when there is none.
    pub(crate) fn to(&self, point_m: DVec2) -> Option<Reached> {
        let place = self.footing.index(self.footing.nearest(point_m)?);
        let states = place * HEADINGS..(place + 1) * HEADINGS;
        let state = states.min_by_key(|&state| self.costs_mm[state])?;
        let cost_mm = self.costs_mm[state];
        let cost_m = f64::from(cost_mm) / MILLIMETRES;
        (cost_mm != UNREACHED).then_some(Reached { state: state as u32, cost_m })
    }

    /// How far one can get along the straight line from the robot in a direction, up to `length_m`, whatever the way there.
    pub(crate) fn reach_along(&self, direction: DVec2, length_m: f64) -> (f64, ReachEnd) {
        let steps = (length_m / self.config.step_m).ceil() as usize;
        let distance_m = |step: usize| (self.config.step_m * step as f64).min(length_m);
        let at = |step: usize| self.here_m + direction * distance_m(step);
        let last = (1..=steps).rev().find(|&step| self.to(at(step)).is_some()).unwrap_or(0);
        if last == steps {
            return (length_m, ReachEnd::Whole);
        }
        let known =
            self.footing.nearest(at(last + 1)).is_some_and(|place| self.footing.plane(place).is_some());
        let end = if known { ReachEnd::Tilt } else { ReachEnd::Unseen };
        // Stop short of what is steep or unseen: the body reaches further than its centre.
        let most_m = distance_m(last) - self.config.clearance_m;
        let reach = (1..last).rev().find(|&step| distance_m(step) <= most_m && self.to(at(step)).is_some());
        (reach.map_or(0.0, distance_m), end)
    }

    /// Writes the places on the way to a place, the robot's own first, to `way`, and gives what the way promises.
    pub(crate) fn follow(&self, reached: Reached, way: &mut Vec<WayPoint>) -> Forecast {
        way.clear();
        let (mut across, mut along) = (0.0_f64, 0.0_f64);
        let (mut risk_sum, mut count) = (0.0, 0.0);
        let mut state = reached.state;
        while state != BEGIN {
            let (place, heading) = (state as usize / HEADINGS, state as usize % HEADINGS);
            let from = self.came_from[state as usize];
            let turned = from != BEGIN && from as usize / HEADINGS == place;
            if !turned {
                let offset = self.footing.offset(place);
                risk_sum += self.footing.risk(offset, heading);
                count += 1.0;
                if let Some(plane) = self.footing.plane(offset) {
                    let slopes = Slopes::facing(plane.gradient, DIRECTIONS[heading % DIRECTIONS.len()]);
                    across = across.max(slopes.across);
                    along = along.max(slopes.along);
                }
                let position_m = self.footing.position_m(offset);
                let last_m = match from {
                    BEGIN => self.here_m,
                    _ => self.footing.position_m(self.footing.offset(from as usize / HEADINGS)),
                };
                let cost_m = f64::from(self.costs_mm[state as usize]) / MILLIMETRES;
                let reverse = (position_m - last_m).dot(STEPS[heading].as_dvec2()) < 0.0;
                way.push(WayPoint { position_m, cost_m, reverse });
            }
            state = from;
        }
        way.push(WayPoint { position_m: self.here_m, cost_m: 0.0, reverse: false });
        way.reverse();
        Forecast {
            way_m: way.windows(2).map(|pair| (pair[1].position_m - pair[0].position_m).length()).sum(),
            mean_risk: if count > 0.0 { risk_sum / count } else { 0.0 },
            max_roll_rad: libm::atan(across),
            max_pitch_rad: libm::atan(along),
            ..Forecast::default()
        }
    }

    /// Height of the ground at a place that was reached.
    pub(crate) fn height_m(&self, reached: Reached) -> f64 {
        let offset = self.footing.offset(reached.state as usize / HEADINGS);
        self.footing.plane(offset).map_or(self.standing_height_m, |plane| plane.height_m)
    }

    /// Where to head for on a way: the farthest place before it changes between forward and reverse that costs no more to drive
    /// to straight.
    pub(crate) fn shortcut(&self, way: &[WayPoint]) -> WayPoint {
        let stay = WayPoint { position_m: self.here_m, cost_m: 0.0, reverse: false };
        let Some(&first) = way.get(1) else { return stay };
        let blind_m = (first.position_m - self.here_m).length();
        let leg = way[1..].iter().take_while(|point| point.reverse == first.reverse);
        let straight = |point: &&WayPoint| self.straight_cost_m(point, blind_m) <= point.cost_m;
        *leg.filter(straight).last().unwrap_or(&first)
    }

    /// What the straight line to a place on a way costs, given that its first part is fine; infinite where the robot may not turn
    /// to it.
    fn straight_cost_m(&self, point: &WayPoint, blind_m: f64) -> f64 {
        let way = point.position_m - self.here_m;
        let facing = if point.reverse { -way } else { way };
        if !self.may_turn_to(facing) {
            return f64::INFINITY;
        }
        let length_m = way.length();
        let heading = nearest(facing);
        let count = (2.0 * length_m / self.config.step_m).ceil();
        let mut risk = 0.0;
        for k in 1..=count as usize {
            let share = k as f64 / count;
            if share * length_m <= blind_m {
                continue;
            }
            let at = self.footing.nearest(self.here_m + way * share);
            risk += at.map_or(f64::INFINITY, |at| self.footing.risk(at, heading));
        }
        let price = if point.reverse { self.config.reverse_price } else { 1.0 };
        price * length_m * (1.0 + self.config.tilt_price * risk / count)
    }

    /// The share of the tilt limits that the robot takes up or soon will on a way, in slope.
    pub(crate) fn share_ahead(&self, way: &[WayPoint]) -> f64 {
        let standing = self.standing_slopes().share_of(self.footing.limits());
        let mut share = standing;
        for leg in way.windows(2) {
            let (from_m, to_m) = (leg[0].position_m, leg[1].position_m);
            if (from_m - self.here_m).length() > AHEAD_M {
                break;
            }
            // On level ground nothing is feared of what no beam reaches.
            let blind = (to_m - from_m).length() > (LONGEST_STEP * self.config.step_m).max(JOIN_M);
            if blind && standing > LEVEL_SHARE {
                share = share.max(BLIND_SHARE);
            }
            let risk =
                self.footing.nearest(to_m).map_or(0.0, |at| self.footing.risk(at, nearest(to_m - from_m)));
            if risk.is_finite() {
                share = share.max(risk.sqrt());
            }
        }
        share
    }

    /// Whether the robot may turn on the spot until it faces a direction.
    fn may_turn_to(&self, facing: DVec2) -> bool {
        let bearing_rad = libm::atan2(facing.y, facing.x);
        let count = FIRST_DIRECTIONS as i32;
        let index = (bearing_rad / TAU * f64::from(count)).round() as i32;
        let left = (index - self.facing).rem_euclid(count);
        let [most_left, most_right] = self.turns;
        // The controller turns the shorter way.
        if left <= count / 2 { left <= most_left } else { count - left <= most_right }
    }

    /// Whether the robot may turn all around where it stands.
    pub(crate) fn may_turn_around(&self) -> bool {
        self.turns.iter().all(|&turns| turns == FIRST_DIRECTIONS as i32 / 2)
    }

    /// Every place that was reached, and what getting there costs.
    pub(crate) fn reached(&self) -> impl Iterator<Item = (DVec2, f64)> {
        self.costs_mm.chunks_exact(HEADINGS).enumerate().filter_map(|(place, costs)| {
            let cost_mm = costs.iter().copied().min().filter(|&cost| cost != UNREACHED)?;
            let position_m = self.footing.position_m(self.footing.offset(place));
            Some((position_m, f64::from(cost_mm) / MILLIMETRES))
        })
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.footing.clear();
        self.last = None;
        self.retreat = None;
    }
}

/// Ground under a place on a straight line.
struct Station {
    distance_m: f64,
    height_m: f64,
    gradient: DVec2,
}

impl Station {
    /// Slopes at a share of the way to another station, on the cubic Hermite polynomial through both heights and slopes.
    fn slopes_towards(&self, to: &Self, direction: DVec2, share: f64) -> Slopes {
        let t = share;
        let length_m = to.distance_m - self.distance_m;
        let across = self.gradient.lerp(to.gradient, t).dot(direction.perp()).abs();
        let (from_slope, to_slope) = (self.gradient.dot(direction), to.gradient.dot(direction));
        let along = 6.0 * t * (1.0 - t) * (to.height_m - self.height_m) / length_m
            + (1.0 - t) * (1.0 - 3.0 * t) * from_slope
            + t * (3.0 * t - 2.0) * to_slope;
        Slopes { across, along: along.abs() }
    }
}
