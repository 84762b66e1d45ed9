//! The value function: cost-to-go of every state of the lattice, by one search backward from the ends.

use core::f64::consts::PI;

use glam::{DVec2, IVec2};

use crate::config::StateLatticeConfig;
use crate::math::angle::difference_rad;
use crate::route::queue::BucketQueue;
use crate::terrain::headings::{HEADINGS, STEPS, heading_below};
use crate::terrain::place_map::PlaceMap;

/// Costs are whole millimetres of level ground.
const MILLIMETRES: f64 = 1000.0;
/// Largest cost that is searched, beyond that of the best end.
const FARTHEST_M: usize = 150;
/// Lower bound on the cost of a step.
const LEAST_COST_MM: u32 = 100;
const UNREACHED: u32 = u32::MAX;
/// The most places of a path.
pub(crate) const MOST_WAYPOINTS: usize = 64;
/// States that differ by less are interpolated.
const SMOOTH_M: f64 = 2.5;

/// A motion that ends at a place with a heading.
#[derive(Clone, Copy, Debug)]
struct Motion {
    /// From its begin to its end, and to the place passed, in places.
    step: IVec2,
    passed: IVec2,
    /// Heading at its begin.
    heading: usize,
    /// Length in steps, times its price.
    length: f64,
}

/// A place on the way to an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Waypoint {
    pub(crate) position_m: DVec2,
    /// Whether it is driven to in reverse.
    pub(crate) reverse: bool,
}

/// The cost-to-go.
#[derive(Clone, Debug)]
pub(crate) struct ValueFunction {
    config: StateLatticeConfig,
    cost_mm: Vec<u32>,
    /// The next state on the way to an end; the state itself at an end.
    next: Vec<u32>,
    least_m: f64,
    queue: BucketQueue,
    /// For each heading, the motions that end with it.
    motions: Vec<Vec<Motion>>,
}

impl ValueFunction {
    /// For a map of so many places; nothing is searched yet.
    pub(crate) fn new(config: StateLatticeConfig, places: usize) -> Self {
        let states = places * HEADINGS;
        Self {
            cost_mm: vec![UNREACHED; states],
            next: vec![0; states],
            least_m: 0.0,
            queue: BucketQueue::new(
                LEAST_COST_MM,
                FARTHEST_M * MILLIMETRES as usize / LEAST_COST_MM as usize,
                8 * states,
            ),
            motions: (0..HEADINGS).map(|heading| motions_to(heading, config.reverse_price)).collect(),
            config,
        }
    }

    /// Searches backward from `ends`: places with their cost-to-go, at every heading. A robot that stands
    /// unsafe at the place `escapes_from` may leave it.
    pub(crate) fn search(&mut self, map: &PlaceMap, ends: &[(IVec2, f64)], escapes_from: Option<IVec2>) {
        let risk_at = |offset: IVec2, heading: usize| match escapes_from {
            Some(from) => map.escape_risk(offset, heading, from),
            None => map.risk(offset, heading),
        };
        self.cost_mm.fill(UNREACHED);
        self.queue.clear();
        self.least_m = ends.iter().map(|end| end.1).fold(f64::INFINITY, f64::min);
        for &(offset, left_m) in ends {
            let cost_mm = ((left_m - self.least_m) * MILLIMETRES) as u32;
            for heading in 0..HEADINGS {
                if map.risk(offset, heading).is_finite() {
                    let state = map.places.index(offset) * HEADINGS + heading;
                    self.relax(state, state as u32, cost_mm);
                }
            }
        }
        let turn_mm = (self.config.turn_cost_m * MILLIMETRES) as u32;
        let step_m = self.config.step_m;
        while let Some((state, cost_mm)) = self.queue.pop() {
            if self.cost_mm[state as usize] != cost_mm {
                continue;
            }
            let (place, heading) = (state as usize / HEADINGS, state as usize % HEADINGS);
            let offset = map.places.offset(place);
            for turned in [(heading + 1) % HEADINGS, (heading + HEADINGS - 1) % HEADINGS] {
                if risk_at(offset, turned).is_finite() {
                    self.relax(place * HEADINGS + turned, state, cost_mm.saturating_add(turn_mm));
                }
            }
            let risk = risk_at(offset, heading);
            let height_m = map.plane(offset).map_or(0.0, |plane| plane.height_m);
            for index in 0..self.motions[heading].len() {
                let Motion { step, passed, heading: from_heading, length } = self.motions[heading][index];
                let from = offset - step;
                if !map.places.holds(from) {
                    continue;
                }
                let from_risk = risk_at(from, from_heading);
                let between = risk_at(from + passed, from_heading).max(risk_at(from + passed, heading));
                let mean = (risk + from_risk + between) / 3.0;
                if !mean.is_finite() {
                    continue;
                }
                let climb_m = map.plane(from).map_or(0.0, |plane| (plane.height_m - height_m).abs());
                let price_m = length * step_m * (1.0 + self.config.tilt_price * mean)
                    + self.config.climb_price * climb_m;
                self.relax(
                    map.places.index(from) * HEADINGS + from_heading,
                    state,
                    cost_mm.saturating_add((price_m * MILLIMETRES) as u32),
                );
            }
        }
    }

    fn relax(&mut self, state: usize, next: u32, cost_mm: u32) {
        if cost_mm < self.cost_mm[state] && self.queue.takes(cost_mm) {
            self.cost_mm[state] = cost_mm;
            self.next[state] = next;
            self.queue.push(state as u32, cost_mm);
        }
    }

    fn of_state(&self, place: usize, heading: usize) -> Option<f64> {
        let cost_mm = self.cost_mm[place * HEADINGS + heading];
        (cost_mm != UNREACHED).then(|| self.least_m + f64::from(cost_mm) / MILLIMETRES)
    }

    /// Cost-to-go of a place with its best heading.
    pub(crate) fn of_place(&self, place: usize) -> Option<f64> {
        (0..HEADINGS).filter_map(|heading| self.of_state(place, heading)).min_by(f64::total_cmp)
    }

    /// Writes the path from a pose to an end to `path`: the places that it passes.
    pub(crate) fn path_from(
        &self,
        map: &PlaceMap,
        position_m: DVec2,
        yaw_rad: f64,
        path: &mut Vec<Waypoint>,
    ) {
        path.clear();
        let Some((_, mut state)) = self.connect(map, position_m, yaw_rad) else { return };
        let mut last = position_m;
        while path.len() < MOST_WAYPOINTS {
            let (place, heading) = (state as usize / HEADINGS, state as usize % HEADINGS);
            let at_m = map.places.position_m(map.places.offset(place));
            let reverse = (at_m - last).dot(STEPS[heading].as_dvec2()) < 0.0;
            if path.last().is_none_or(|last: &Waypoint| last.position_m != at_m) {
                path.push(Waypoint { position_m: at_m, reverse: reverse && !path.is_empty() });
                last = at_m;
            }
            let next = self.next[state as usize];
            if next == state {
                break;
            }
            state = next;
        }
    }

    /// The state around a pose with the least cost-to-go and way to it: a turn on the spot and a straight
    /// drive, forward or in reverse.
    fn connect(&self, map: &PlaceMap, position_m: DVec2, yaw_rad: f64) -> Option<(f64, u32)> {
        let low = map.places.steps_from_centre(position_m).floor().as_ivec2();
        let turn_m_rad = self.config.turn_m_rad();
        let mut best: Option<(f64, u32)> = None;
        for offset in (-1..=2).flat_map(|dy| (-1..=2).map(move |dx| low + IVec2::new(dx, dy))) {
            if !map.places.holds(offset) {
                continue;
            }
            let place = map.places.index(offset);
            let way = map.places.position_m(offset) - position_m;
            let way_m = way.length();
            let bearing_rad = if way_m > 0.0 { libm::atan2(way.y, way.x) } else { yaw_rad };
            for (facing_rad, price) in [(bearing_rad, 1.0), (bearing_rad + PI, self.config.reverse_price)] {
                let (below, share) = heading_below(facing_rad);
                let heading = if share < 0.5 { below } else { (below + 1) % HEADINGS };
                let Some(value_m) = self.of_state(place, heading) else { continue };
                let risk = map.risk(offset, heading).min(1.0);
                // The nearer the place, the less does its direction say.
                let turn_rad =
                    difference_rad(facing_rad, yaw_rad).abs() * (way_m / self.config.step_m).min(1.0);
                let total_m =
                    value_m + turn_m_rad * turn_rad + price * way_m * (1.0 + self.config.tilt_price * risk);
                if best.is_none_or(|(least_m, _)| total_m < least_m) {
                    best = Some((total_m, (place * HEADINGS + heading) as u32));
                }
            }
        }
        best
    }

    /// Cost-to-go of a pose: the mean of the states around it, weighted by nearness, where they are all
    /// reached and differ little; elsewhere that of the best of them and of the way to it. In a narrow pass
    /// the states on either side are worse than both its ends.
    pub(crate) fn at(&self, map: &PlaceMap, position_m: DVec2, yaw_rad: f64) -> Option<f64> {
        let steps = map.places.steps_from_centre(position_m);
        let low = steps.floor().as_ivec2();
        let share = steps - low.as_dvec2();
        let (heading, turn) = heading_below(yaw_rad);
        let (mut mean, mut lowest_m, mut highest_m) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
        for (step, weight) in [
            (IVec2::ZERO, (1.0 - share.x) * (1.0 - share.y)),
            (IVec2::X, share.x * (1.0 - share.y)),
            (IVec2::Y, (1.0 - share.x) * share.y),
            (IVec2::ONE, share.x * share.y),
        ] {
            for (heading, part) in [(heading, 1.0 - turn), ((heading + 1) % HEADINGS, turn)] {
                let offset = low + step;
                let value_m = map
                    .places
                    .holds(offset)
                    .then(|| self.of_state(map.places.index(offset), heading))
                    .flatten();
                let value_m = value_m.unwrap_or(f64::INFINITY);
                lowest_m = lowest_m.min(value_m);
                highest_m = highest_m.max(value_m);
                mean += weight * part * value_m;
            }
        }
        // Also false for infinite ones.
        if highest_m - lowest_m < SMOOTH_M {
            return Some(mean);
        }
        self.connect(map, position_m, yaw_rad).map(|(total_m, _)| total_m)
    }
}

/// The motions that end with a heading: straight, bends out of the next two headings to either side, and
/// straight in reverse.
fn motions_to(heading: usize, reverse_price: f64) -> Vec<Motion> {
    let end = STEPS[heading];
    let half = |step: IVec2| if step.x.abs() + step.y.abs() == 3 { step / 2 } else { IVec2::ZERO };
    let straight = Motion { step: end, passed: half(end), heading, length: end.as_dvec2().length() };
    let reverse =
        Motion { step: -end, passed: half(-end), length: reverse_price * straight.length, ..straight };
    let bends = [1, HEADINGS - 1, 2, HEADINGS - 2].map(|turn| {
        let from = (heading + turn) % HEADINGS;
        let (begin, end) = (STEPS[from].as_dvec2(), end.as_dvec2());
        let at = |t: f64| begin * (2.0 * t - t * t) + end * (t * t);
        let length = (0..16).map(|k| at(f64::from(k) / 16.0).distance(at(f64::from(k + 1) / 16.0))).sum();
        Motion {
            step: STEPS[from] + STEPS[heading],
            passed: at(0.5).round().as_ivec2(),
            heading: from,
            length,
        }
    });
    [straight, reverse].into_iter().chain(bends).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::terrain::plane::Plane;
    use proptest::prelude::*;

    const LEVEL: Plane = Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.0 };
    const GOAL: IVec2 = IVec2::new(10, 0);

    fn value_on(ground: impl Fn(DVec2) -> Option<Plane>) -> (PlaceMap, ValueFunction) {
        let config = PlannerConfig::default();
        let mut map = PlaceMap::new(config.state_lattice, &config.robot, 7.0);
        map.look(&ground, DVec2::ZERO, LEVEL, 3.0);
        let mut value = ValueFunction::new(config.state_lattice, map.places.count());
        value.search(&map, &[(GOAL, 0.0)], None);
        (map, value)
    }

    #[test]
    fn on_level_ground_it_is_the_way_and_the_turns() {
        let (map, value) = value_on(|_| Some(LEVEL));
        let at = |x: f64, y: f64, yaw_rad: f64| value.at(&map, DVec2::new(x, y), yaw_rad).unwrap();
        assert!((at(0.0, 0.0, 0.0) - 5.0).abs() < 0.01, "{}", at(0.0, 0.0, 0.0));
        assert!((at(0.8, 0.0, 0.0) - 4.2).abs() < 0.01, "between places too");
        // Eight turns of a sixteenth, or the same way in reverse at twice the price.
        let turned_m = at(0.0, 0.0, core::f64::consts::PI) - 5.0;
        assert!((turned_m - 8.0 * 0.15).abs() < 0.2, "{turned_m}");
        assert!(at(0.0, 3.0, 0.0) > 5.8 && at(0.0, 3.0, 0.0) < 6.8, "{}", at(0.0, 3.0, 0.0));
    }

    #[test]
    fn behind_a_wall_it_is_the_way_around_or_nothing() {
        let wall = |whole: bool| {
            move |place_m: DVec2| {
                let is_wall = (2.3..3.2).contains(&place_m.x) && (whole || place_m.y < 2.3);
                let gradient = if is_wall { DVec2::new(3.0, 3.0) } else { DVec2::ZERO };
                Some(Plane { gradient, ..LEVEL })
            }
        };
        let (map, value) = value_on(wall(false));
        assert!(value.at(&map, DVec2::ZERO, 0.0).unwrap() > 6.0);
        let (map, value) = value_on(wall(true));
        assert!(value.at(&map, DVec2::ZERO, 0.0).is_none());
    }

    proptest! {
        /// One motion never gains more than it costs: the estimate is consistent.
        #[test]
        fn no_motion_gains_more_than_its_price(slope in 0.0..0.4_f64, x in -8..8_i32, y in -8..8_i32, heading in 0..HEADINGS) {
            let (map, value) = value_on(move |place_m| {
                let gradient = DVec2::new(slope * libm::sin(place_m.y), 0.5 * slope);
                Some(Plane { gradient, ..LEVEL })
            });
            let to = IVec2::new(x, y);
            for motion in &value.motions[heading] {
                let from = to - motion.step;
                if !map.places.holds(from) {
                    continue;
                }
                let before = value.of_state(map.places.index(from), motion.heading);
                let after = value.of_state(map.places.index(to), heading);
                if let (Some(before), Some(after)) = (before, after) {
                    let dearest_m = motion.length * value.config.step_m * (1.0 + value.config.tilt_price * 3.0);
                    prop_assert!(before <= after + dearest_m + 1e-9);
                }
            }
        }
    }
}
