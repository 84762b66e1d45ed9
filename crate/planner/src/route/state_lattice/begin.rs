//! The first steps of paths: from the robot's pose, which lies off the lattice, to lattice states.

use core::f64::consts::TAU;

use glam::{DVec2, IVec2};

use super::gaps::Station;
use super::{BEGIN, FIRST_DIRECTIONS, FIRST_STEP_M, First, JOIN_M, MILLIMETRES, StateLattice};
use crate::terrain::headings::{HEADINGS, nearest};
use crate::terrain::slopes::Slopes;

/// Ground seen no farther than this from the robot may be that under its wheels alone.
const WHEELS_M: f64 = 1.25;

impl StateLattice {
    /// Connects the robot's pose to the first known places in each direction that it may turn to.
    pub(super) fn begin(&mut self) {
        let count = FIRST_DIRECTIONS as i32;
        let ground = self.traversability.places.gradient_at(self.here_m);
        let here = Slopes::facing(self.attitude.gradient, self.first_direction(self.facing));
        for (side, sign) in [1, -1].into_iter().enumerate() {
            self.turns[side] = count / 2;
            for turn in 0..=count / 2 {
                let facing = self.first_direction(self.facing + sign * turn);
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
                let index = self.facing + sign * turn;
                self.begin_here(index, facing, turn_m);
                for reverse in [false, true] {
                    self.begin_along(index, &First { facing, reverse }, turn_m);
                }
            }
        }
    }

    /// Directions to turn to the left (right if negative) to face direction `index`; the shorter side, as the
    /// controller turns.
    fn turn_to(&self, index: i32) -> i32 {
        let count = FIRST_DIRECTIONS as i32;
        let left = (index - self.facing).rem_euclid(count);
        if left <= count / 2 { left } else { left - count }
    }

    pub(super) fn first_direction(&self, index: i32) -> DVec2 {
        self.first_directions[index.rem_euclid(FIRST_DIRECTIONS as i32) as usize]
    }

    /// Starts at the place nearest to the robot, if that is too near to drive to.
    fn begin_here(&mut self, index: i32, facing: DVec2, cost_m: f64) {
        let Some(offset) = self.traversability.places.nearest(self.here_m) else { return };
        let away_m = (self.traversability.places.position_m(offset) - self.here_m).length();
        let heading = nearest(facing);
        if away_m < FIRST_STEP_M && self.traversability.risk(offset, heading).is_finite() {
            self.begin_with(offset, heading, index, cost_m + away_m);
        }
    }

    /// Reaches a state as the first of a path, in the robot's own place after turning to direction `index`.
    fn begin_with(&mut self, offset: IVec2, heading: usize, index: i32, cost_m: f64) {
        let state = self.traversability.places.index(offset) * HEADINGS + heading;
        let from = BEGIN + index.rem_euclid(FIRST_DIRECTIONS as i32) as u32;
        self.reach(state, from, (cost_m * MILLIMETRES) as u32);
    }

    /// Starts straight ahead or in reverse to the next known place and, where no beam reaches the ground at
    /// the wheels, to the first known place beyond the blind zone. `index` is that of the facing.
    fn begin_along(&mut self, index: i32, first: &First, cost_m: f64) {
        let travel = if first.reverse { -first.facing } else { first.facing };
        let heading = nearest(first.facing);
        let mut seen_m = 0.0;
        let mut passed_risk = 0.0_f64;
        let steps = (self.config.blind_radius_m / self.config.step_m) as usize;
        for step in 1..=steps {
            let along_m = self.config.step_m * step as f64;
            let Some(offset) = self.traversability.places.nearest(self.here_m + travel * along_m) else {
                return;
            };
            if self.traversability.is_at_cliff(offset) {
                return;
            }
            if self.traversability.is_hidden(offset, heading) {
                if seen_m > WHEELS_M {
                    return;
                }
                continue;
            }
            // Further places on the ground at the wheels are reached by the search itself.
            let beyond_blind = along_m - seen_m > 1.5 * self.config.step_m;
            seen_m = along_m;
            if !beyond_blind && along_m > JOIN_M {
                return;
            }
            let safe = self.begin_at(offset, index, first, cost_m, passed_risk);
            // By rounding, the nearest place may be one that the robot already covers.
            if beyond_blind && along_m > JOIN_M || !safe && step > 1 {
                return;
            }
            let risk = self.traversability.risk(offset, heading);
            if risk.is_finite() {
                passed_risk = passed_risk.max(risk);
            }
        }
    }

    /// Starts straight to a place, at no less than `passed_risk`; false if that is not safe.
    fn begin_at(&mut self, offset: IVec2, index: i32, first: &First, cost_m: f64, passed_risk: f64) -> bool {
        let Some(plane) = self.traversability.plane(offset) else { return false };
        let path = self.traversability.places.position_m(offset) - self.here_m;
        let distance_m = path.length();
        if distance_m < FIRST_STEP_M {
            return true;
        }
        let heading = nearest(first.facing);
        let start =
            Station { distance_m: 0.0, height_m: self.attitude.height_m, gradient: self.attitude.gradient };
        let end = Station { distance_m, height_m: plane.height_m, gradient: plane.gradient };
        let risk = self.risk_between(&start, &end, path / distance_m, 0.0);
        let risk = risk.max(self.traversability.risk(offset, heading)).max(passed_risk);
        if !risk.is_finite() {
            return false;
        }
        let price = if first.reverse { self.prices.reverse } else { 1.0 };
        let cost_m = cost_m
            + price * distance_m * (1.0 + self.prices.tilt * risk)
            + self.prices.climb * (end.height_m - start.height_m).abs();
        self.begin_with(offset, heading, index, cost_m);
        true
    }

    /// Whether the robot may turn on the spot to a facing.
    pub(super) fn may_turn_to(&self, facing: DVec2) -> bool {
        let [most_left, most_right] = self.turns;
        (-most_right..=most_left).contains(&self.turn_to(index_of(facing)))
    }

    /// Whether the robot may turn all around on the spot.
    pub(crate) fn may_turn_around(&self) -> bool {
        self.turns.iter().all(|&turns| turns == FIRST_DIRECTIONS as i32 / 2)
    }
}

/// Index of the direction nearest to a facing.
fn index_of(facing: DVec2) -> i32 {
    let bearing_rad = libm::atan2(facing.y, facing.x);
    (bearing_rad / TAU * FIRST_DIRECTIONS as f64).round() as i32
}
