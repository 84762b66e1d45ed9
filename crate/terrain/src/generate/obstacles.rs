//! What stands on generated ground, and ditches in it.
//!
//! Sizes and distances are of the Husky's order: it is 0.99 m long and 0.67 m wide, and its belly is 0.13 m
//! over the ground.

use super::Family;
use super::writer::Writer;
use glam::DVec2;
use mapless_world::random::Sequence;
use std::f64::consts::TAU;

/// Obstacles keep this far from the border, metres.
const BORDER_M: f64 = 2.0;
/// Trunks stand at least this far apart, axis to axis, metres.
const TRUNKS_APART_M: f64 = 1.5;
/// Radius and height of a person, metres.
const PERSON_M: [f64; 2] = [0.25, 1.7];

/// Draws the obstacles of a family; returns what they are.
pub(super) fn of(family: Family, side_m: f64, draw: &mut Sequence, tables: &mut Writer) -> Vec<&'static str> {
    let mut yard = Yard { side_m, draw, tables };
    match family {
        Family::Ground(_) => Vec::new(),
        Family::Rocks => yard.rocks([0.025, 0.05]),
        Family::Posts => yard.posts([0.05, 0.09]),
        Family::Walls => yard.walls([3, 5], [5, 9]),
        Family::Ditches => yard.ditches([2, 4], [2, 4]),
        Family::Mixed => {
            let mut kinds = yard.rocks([0.008, 0.015]);
            kinds.extend(yard.posts([0.008, 0.015]));
            kinds.extend(yard.walls([0, 1], [2, 4]));
            kinds
        }
        Family::Movers => {
            yard.posts([0.004, 0.01]);
            yard.movers([8, 14])
        }
    }
}

/// A square to be filled.
struct Yard<'a> {
    side_m: f64,
    draw: &'a mut Sequence,
    tables: &'a mut Writer,
}

impl Yard<'_> {
    fn place(&mut self) -> DVec2 {
        let inside_m = self.side_m - 2.0 * BORDER_M;
        DVec2::splat(BORDER_M) + DVec2::new(self.draw.share(), self.draw.share()) * inside_m
    }

    fn direction(&mut self) -> DVec2 {
        let (sin, cos) = libm::sincos(self.draw.share() * TAU);
        DVec2::new(cos, sin)
    }

    /// How many there are at a density per square metre.
    fn count(&mut self, per_m2: [f64; 2]) -> u32 {
        (self.draw.between(per_m2) * self.side_m * self.side_m).round() as u32
    }

    /// Between two sizes, each octave as often as another.
    fn size(&mut self, [low, high]: [f64; 2]) -> f64 {
        libm::exp(self.draw.between([libm::log(low), libm::log(high)]))
    }

    fn clamped(&self, place: DVec2) -> DVec2 {
        place.clamp(DVec2::splat(BORDER_M), DVec2::splat(self.side_m - BORDER_M))
    }

    fn rocks(&mut self, per_m2: [f64; 2]) -> Vec<&'static str> {
        for _ in 0..self.count(per_m2) {
            let height_m = self.size([0.08, 1.2]);
            let radius_m = height_m * self.draw.between([0.55, 0.9]);
            let place = self.place();
            self.tables.rock(place, radius_m, 2.0 * radius_m - height_m);
        }
        vec!["rocks"]
    }

    fn posts(&mut self, per_m2: [f64; 2]) -> Vec<&'static str> {
        let mut placed: Vec<DVec2> = Vec::new();
        for _ in 0..self.count(per_m2) {
            let (place, radius_m) = (self.place(), self.size([0.05, 0.3]));
            let height_m = self.draw.between([1.5, 6.0]);
            if placed.iter().all(|other| other.distance(place) >= TRUNKS_APART_M) {
                placed.push(place);
                self.tables.post(place, radius_m, height_m);
            }
        }
        vec!["posts"]
    }

    /// Walls from border to border with openings, half of them gates; then short ones with a corner or two.
    fn walls(&mut self, long: [u32; 2], short: [u32; 2]) -> Vec<&'static str> {
        for _ in 0..self.draw.whole(long) {
            self.long_wall();
        }
        for _ in 0..self.draw.whole(short) {
            let (begin, along) = (self.place(), self.direction());
            let aside = along.perp() * if self.draw.happens(0.5) { 1.0 } else { -1.0 };
            let (length_m, depth_m) = (self.draw.between([3.0, 8.0]), self.draw.between([2.0, 5.0]));
            let mut points =
                vec![begin, begin + along * length_m, begin + along * length_m + aside * depth_m];
            if self.draw.happens(0.5) {
                // A dead end.
                points.insert(0, begin + aside * depth_m);
            }
            let height_m = self.draw.between([0.4, 2.0]);
            for pair in points.windows(2) {
                let (from, to) = (self.clamped(pair[0]), self.clamped(pair[1]));
                self.wall(from, to, height_m);
            }
        }
        vec!["walls"]
    }

    fn long_wall(&mut self) {
        let along = self.direction();
        let middle = DVec2::splat(self.side_m / 2.0);
        let offset_m = self.draw.between([-0.35, 0.35]) * self.side_m;
        let height_m = self.draw.between([0.5, 2.0]);
        let end_m = 0.75 * self.side_m;
        let at = |along_m: f64| middle + along.perp() * offset_m + along * along_m;
        let mut from_m = -end_m;
        while from_m < end_m {
            let to_m = from_m + self.draw.between([6.0, 12.0]);
            if let Some((from, to)) = self.within(at(from_m), at(to_m)) {
                self.wall(from, to, height_m);
            }
            let opening_m = self.draw.between([1.5, 2.5]);
            let is_gate = self.draw.happens(0.5);
            let beam_m = self.draw.between([1.2, 2.2]);
            from_m = to_m + opening_m;
            let gate = at(to_m + opening_m / 2.0);
            if is_gate && self.clamped(gate) == gate {
                // Its posts stand between the wall's ends.
                self.tables.gate(gate, along.perp(), opening_m - 0.35, beam_m);
            }
        }
    }

    /// The part of a straight line that lies inside the border.
    fn within(&self, from: DVec2, to: DVec2) -> Option<(DVec2, DVec2)> {
        let step = to - from;
        let (mut begin, mut end) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let (low, high) = (BORDER_M - from[axis], self.side_m - BORDER_M - from[axis]);
            if step[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (low / step[axis], high / step[axis]);
            (begin, end) = (begin.max(a.min(b)), end.min(a.max(b)));
        }
        (begin < end).then(|| (from + step * begin, from + step * end))
    }

    fn wall(&mut self, from: DVec2, to: DVec2, height_m: f64) {
        if from.distance(to) > 0.5 {
            self.tables.wall(from, to, height_m);
        }
    }

    /// Ditches from border to border that run out at every third or fourth point, and narrow ones that do
    /// not.
    fn ditches(&mut self, wide: [u32; 2], narrow: [u32; 2]) -> Vec<&'static str> {
        for _ in 0..self.draw.whole(wide) {
            let (depth_m, width_m) = (self.draw.between([0.5, 1.2]), self.draw.between([0.18, 0.4]));
            self.ditch(depth_m, width_m, true);
        }
        for _ in 0..self.draw.whole(narrow) {
            let (depth_m, width_m) = (self.draw.between([0.08, 0.15]), self.draw.between([0.1, 0.14]));
            self.ditch(depth_m, width_m, false);
        }
        vec!["ditches"]
    }

    fn ditch(&mut self, depth_m: f64, width_m: f64, has_crossings: bool) {
        let along = self.direction();
        let middle = DVec2::splat(self.side_m / 2.0);
        let offset_m = self.draw.between([-0.35, 0.35]) * self.side_m;
        let (reach_m, every) = (0.75 * self.side_m, self.draw.whole([3, 4]));
        let count = (2.0 * reach_m / self.draw.between([4.0, 6.0])).round() as u32;
        let first = self.draw.whole([0, every - 1]);
        let (mut points, mut depths_m) = (Vec::new(), Vec::new());
        for index in 0..=count {
            let along_m = reach_m * (2.0 * f64::from(index) / f64::from(count) - 1.0);
            let aside_m = offset_m + self.draw.between([-1.0, 1.0]);
            points.push(middle + along * along_m + along.perp() * aside_m);
            let is_crossing = has_crossings && index % every == first;
            depths_m.push(if is_crossing { 0.0 } else { depth_m * self.draw.between([0.8, 1.2]) });
        }
        self.tables.valley(&points, &depths_m, width_m);
    }

    /// People on the move, half of whom set out when the robot is near.
    fn movers(&mut self, count: [u32; 2]) -> Vec<&'static str> {
        for _ in 0..self.draw.whole(count) {
            let (from, along) = (self.place(), self.direction());
            let length_m = self.draw.between([8.0, 20.0]);
            let to = self.clamped(from + along * length_m);
            let speed_m_s = self.draw.between([0.5, 1.4]);
            let near_m = self.draw.between([5.0, 9.0]);
            let waits = self.draw.happens(0.5);
            self.tables.walker(from, PERSON_M, to, speed_m_s, waits.then_some(near_m));
        }
        vec!["people on the move"]
    }
}
