//! The first steps of paths: from the robot's pose, which lies off the lattice, to lattice states.
//!
//! The robot turns on the spot and then drives on an arc to a place nearby, or straight across its blind
//! zone. Each of these steps is judged at the headings at which it is driven.

use core::f64::consts::{FRAC_PI_8, TAU};

use glam::{DVec2, IVec2};

use super::gaps::Station;
use super::{BEGIN, FIRST_DIRECTIONS, FIRST_STEP_M, JOIN_M, MILLIMETRES, StateLattice, WORTH_LEAVING_M};
use crate::terrain::headings::{HEADINGS, nearest};
use crate::terrain::slopes::Slopes;

/// Ground seen no farther than this from the robot may be that under its wheels alone.
const WHEELS_M: f64 = 1.25;

/// An arc is judged at headings no farther apart than this.
const ALIKE_RAD: f64 = 0.2;

/// An arc from the robot.
#[derive(Clone, Copy, Debug)]
struct Arc {
    /// Unit vector in which the robot sets out.
    travel: DVec2,
    chord_m: f64,
    /// Angle from the direction in which it sets out to the chord; the arc turns by twice as much.
    half_turn_rad: f64,
    length_m: f64,
}

/// The facing of a robot that travels along a unit vector, and the other way round.
fn faced(direction: DVec2, reverse: bool) -> DVec2 {
    if reverse { -direction } else { direction }
}

impl Arc {
    /// The arc to what is `way_m` away; `None` if it turns by more than an eighth of a circle.
    fn new(travel: DVec2, way_m: DVec2) -> Option<Self> {
        let along_m = travel.dot(way_m);
        if along_m <= 0.0 {
            return None;
        }
        let half_turn_rad = libm::atan2(travel.perp_dot(way_m), along_m);
        let chord_m = way_m.length();
        let longer = if half_turn_rad == 0.0 { 1.0 } else { half_turn_rad / libm::sin(half_turn_rad) };
        let turns_little = half_turn_rad.abs() <= FRAC_PI_8;
        turns_little.then_some(Self { travel, chord_m, half_turn_rad, length_m: longer * chord_m })
    }

    /// At so many places its headings differ by little.
    fn samples(&self) -> usize {
        (2.0 * self.half_turn_rad.abs() / ALIKE_RAD).ceil().max(1.0) as usize
    }

    /// Unit vector of travel after a share of the arc.
    fn travel_at(&self, share: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(2.0 * share * self.half_turn_rad);
        DVec2::new(cos, sin).rotate(self.travel)
    }

    /// Where the robot is after a share of the arc, from where it sets out.
    fn way_m(&self, share: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(share * self.half_turn_rad);
        let part = if self.half_turn_rad == 0.0 { share } else { sin / libm::sin(self.half_turn_rad) };
        DVec2::new(cos, sin).rotate(self.travel) * (part * self.chord_m)
    }
}

impl StateLattice {
    /// Connects the robot's pose to the first known places in each direction that it may turn to, and to the
    /// next one of the kept path.
    pub(super) fn begin(&mut self) {
        let count = FIRST_DIRECTIONS as i32;
        let ground = self.traversability.places.gradient_at(self.here_m);
        let here = Slopes::facing(self.attitude.gradient, self.facing);
        self.stay();
        self.keep_on();
        for (side, sign) in [1, -1].into_iter().enumerate() {
            self.turns[side] = count / 2;
            for turn in 0..=count / 2 {
                let facing = self.first_direction(sign * turn);
                let allowed = self.traversability.most();
                // If the attitude already exceeds the limits, a turn may not increase the pitch further.
                let slopes = Slopes::facing(self.attitude.gradient, facing);
                let steeper = slopes.across > allowed.across || slopes.along > allowed.along.max(here.along);
                let touches = self.body.is_too_near(self.here_m, facing, ground);
                if turn > 0 && (steeper || touches) {
                    self.turns[side] = turn - 1;
                    break;
                }
                let turn_m = self.config.turn_cost_m * f64::from(turn) * HEADINGS as f64 / f64::from(count);
                for reverse in [false, true] {
                    let travel = faced(facing, reverse);
                    self.begin_near(travel, reverse, turn_m);
                    self.begin_beyond_blind_zone(travel, reverse, turn_m);
                }
            }
        }
    }

    /// The direction that the robot faces after turning to the left (right if negative) by this many of
    /// [`FIRST_DIRECTIONS`].
    fn first_direction(&self, turn: i32) -> DVec2 {
        let turned = self.first_directions[turn.rem_euclid(FIRST_DIRECTIONS as i32) as usize];
        turned.rotate(self.facing)
    }

    /// The place nearest to the robot is reached by staying, if it is too near to drive to. No path goes on
    /// from there: the robot stands beside it.
    fn stay(&mut self) {
        let places = &self.traversability.places;
        let Some(offset) = places.nearest(self.here_m) else { return };
        let away_m = places.position_m(offset).distance(self.here_m);
        let heading = nearest(self.facing);
        if away_m < FIRST_STEP_M && self.traversability.risk(offset, heading).is_finite() {
            let state = places.index(offset) * HEADINGS + heading;
            self.costs_mm[state] = (away_m * MILLIMETRES) as u32;
            self.came_from[state] = BEGIN;
        }
    }

    /// Goes on to the next place of the kept path, if that and what lies before it are safe, and the robot
    /// may go on turning to it. Where it sets out is not judged again: centimetres decide there.
    fn keep_on(&mut self) {
        self.kept_state = None;
        let Some(next) = self.kept.next(self.here_m) else { return };
        let Some(offset) = self.traversability.places.nearest(next.position_m) else { return };
        let reverse = next.reverse;
        let state = self.traversability.places.index(offset) * HEADINGS + next.heading;
        self.kept_state = Some((state, reverse));
        let way_m = next.position_m - self.here_m;
        let travel = way_m.normalize_or_zero();
        let Some(turn_rad) = self.kept.turn_rad(self.here_m, self.facing) else { return };
        let Some(arc) = Arc::new(travel, way_m) else { return };
        let safe_rad = self.attitude.safe_turn_rad(turn_rad, self.traversability.most_when_begun());
        if safe_rad.abs() < turn_rad.abs() - 1e-9 || self.touches_in_turn(turn_rad) {
            return;
        }
        let share = self.attitude.slopes().share_of(self.traversability.limits());
        let ahead = self.risk_passed(&arc, reverse).max(self.traversability.risk(offset, next.heading));
        let risk = 0.5 * (share * share + ahead);
        if risk.is_finite() {
            let turn_m = self.config.turn_m_rad() * turn_rad.abs();
            self.begin_with(
                offset,
                next.heading,
                reverse,
                turn_m + self.drive_cost_m(&arc, offset, reverse, risk),
            );
        }
    }

    /// Whether a turn on the spot that was begun, anticlockwise, brings the body too near to something
    /// upright.
    fn touches_in_turn(&self, turn_rad: f64) -> bool {
        self.clear_share(turn_rad, |facing, ground| {
            self.body.is_too_near_when_begun(self.here_m, facing, ground)
        }) < 1.0
    }

    /// The largest part of a turn on the spot, anticlockwise, that keeps the body off what is upright.
    pub(crate) fn clear_turn_rad(&self, turn_rad: f64) -> f64 {
        turn_rad
            * self.clear_share(turn_rad, |facing, ground| self.body.is_too_near(self.here_m, facing, ground))
    }

    /// The share of a turn on the spot, anticlockwise, before the first facing that is too near to something
    /// upright, on ground with the gradient here.
    fn clear_share(&self, turn_rad: f64, is_too_near: impl Fn(DVec2, DVec2) -> bool) -> f64 {
        let ground = self.traversability.places.gradient_at(self.here_m);
        let steps = (turn_rad.abs() / TAU * FIRST_DIRECTIONS as f64).ceil();
        let touching = (1..=steps as i32).find(|&step| {
            let (sin, cos) = libm::sincos(turn_rad * f64::from(step) / steps);
            is_too_near(DVec2::new(cos, sin).rotate(self.facing), ground)
        });
        touching.map_or(1.0, |step| f64::from(step - 1) / steps)
    }

    /// Starts on arcs to the places nearby.
    fn begin_near(&mut self, travel: DVec2, reverse: bool, turn_m: f64) {
        let Some(own) = self.traversability.places.nearest(self.here_m) else { return };
        let steps = (JOIN_M / self.config.step_m).ceil() as i32;
        for y in -steps..=steps {
            for x in -steps..=steps {
                let offset = own + IVec2::new(x, y);
                if !self.traversability.places.holds(offset) {
                    continue;
                }
                let way_m = self.traversability.places.position_m(offset) - self.here_m;
                if (FIRST_STEP_M..=JOIN_M).contains(&way_m.length())
                    && let Some(arc) = Arc::new(travel, way_m)
                {
                    self.begin_on(&arc, offset, reverse, turn_m);
                }
            }
        }
    }

    /// Starts straight to the first known place beyond the blind zone, where no beam reaches the ground at
    /// the wheels. Further places on that ground are reached by the search itself.
    fn begin_beyond_blind_zone(&mut self, travel: DVec2, reverse: bool, turn_m: f64) {
        let heading = nearest(faced(travel, reverse));
        let mut seen_m = 0.0;
        let steps = (self.config.blind_radius_m / self.config.step_m) as usize;
        for step in 1..=steps {
            let along_m = self.config.step_m * step as f64;
            let Some(offset) = self.traversability.places.nearest(self.here_m + travel * along_m) else {
                return;
            };
            if self.traversability.is_hidden(offset, heading) {
                if seen_m > WHEELS_M {
                    return;
                }
                continue;
            }
            if along_m > JOIN_M {
                let way_m = self.traversability.places.position_m(offset) - self.here_m;
                if along_m - seen_m > 1.5 * self.config.step_m
                    && let Some(arc) = Arc::new(travel, way_m)
                {
                    self.begin_on(&arc, offset, reverse, turn_m);
                }
                return;
            }
            seen_m = along_m;
        }
    }

    /// Starts on an arc to a place, if that is safe.
    fn begin_on(&mut self, arc: &Arc, offset: IVec2, reverse: bool, turn_m: f64) {
        let Some(plane) = self.traversability.plane(offset) else { return };
        let heading = nearest(faced(arc.travel_at(1.0), reverse));
        let at_end = self.traversability.risk(offset, heading);
        let turn_m = turn_m + self.config.turn_m_rad() * 2.0 * arc.half_turn_rad.abs();
        let state = self.traversability.places.index(offset) * HEADINGS + heading;
        let least_mm = (turn_m + arc.length_m) * MILLIMETRES;
        if at_end.is_infinite() || f64::from(self.costs_mm[state]) <= least_mm {
            return;
        }
        let start =
            Station { distance_m: 0.0, height_m: self.attitude.height_m, gradient: self.attitude.gradient };
        let end = Station { distance_m: arc.length_m, height_m: plane.height_m, gradient: plane.gradient };
        let between = self.risk_between(&start, &end, |share| arc.travel_at(share), 0.0, arc.samples());
        // Not the larger one: a place would cost much more from nearby than from the place before it.
        let risk = 0.5 * (between + at_end.max(self.risk_passed(arc, reverse)));
        if risk.is_finite() {
            self.begin_with(offset, heading, reverse, turn_m + self.drive_cost_m(arc, offset, reverse, risk));
        }
    }

    /// The largest risk at the known places that an arc passes before its end; infinite if one is not safe.
    fn risk_passed(&self, arc: &Arc, reverse: bool) -> f64 {
        let step_m = self.config.step_m;
        let steps = (arc.length_m / step_m - 0.5).ceil() as usize;
        let at = |step: usize| {
            let share = step_m * step as f64 / arc.length_m;
            let Some(offset) = self.traversability.places.nearest(self.here_m + arc.way_m(share)) else {
                return f64::INFINITY;
            };
            let heading = nearest(faced(arc.travel_at(share), reverse));
            let risk = self.traversability.risk(offset, heading);
            // By rounding, the first place may be one that the robot already covers.
            let is_own = step == 1 && risk.is_infinite();
            let passes = is_own || self.traversability.is_hidden(offset, heading);
            if passes && !self.traversability.is_at_cliff(offset) { 0.0 } else { risk }
        };
        (1..steps).map(at).fold(0.0, f64::max)
    }

    /// Cost of driving along an arc to a place at this risk.
    fn drive_cost_m(&self, arc: &Arc, offset: IVec2, reverse: bool, risk: f64) -> f64 {
        let price = if reverse { self.prices.reverse } else { 1.0 };
        let climb_m = self
            .traversability
            .plane(offset)
            .map_or(0.0, |plane| (plane.height_m - self.attitude.height_m).abs());
        price * arc.length_m * (1.0 + self.prices.tilt * risk) + self.prices.climb * climb_m
    }

    /// Reaches a state as the first of a path. One that is not the next of the kept path costs more.
    fn begin_with(&mut self, offset: IVec2, heading: usize, reverse: bool, cost_m: f64) {
        let state = self.traversability.places.index(offset) * HEADINGS + heading;
        let leaves = self.kept_state.is_some_and(|kept| kept != (state, reverse));
        let cost_m = cost_m + if leaves { WORTH_LEAVING_M } else { 0.0 };
        self.reach(state, BEGIN, (cost_m * MILLIMETRES) as u32);
    }

    /// Whether the robot may turn on the spot to a facing.
    pub(super) fn may_turn_to(&self, facing: DVec2) -> bool {
        let turn_rad = libm::atan2(self.facing.perp_dot(facing), self.facing.dot(facing));
        let turn = (turn_rad / TAU * FIRST_DIRECTIONS as f64).round() as i32;
        let [most_left, most_right] = self.turns;
        (-most_right..=most_left).contains(&turn)
    }

    /// Whether the robot may turn all around on the spot.
    pub(crate) fn may_turn_around(&self) -> bool {
        self.turns.iter().all(|&turns| turns == FIRST_DIRECTIONS as i32 / 2)
    }
}
