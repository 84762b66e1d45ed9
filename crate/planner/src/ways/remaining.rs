//! How far the goal is from every place that was reached, by what was seen and by what was learned of where that ends.

use glam::DVec2;

use super::headings::HEADINGS;
use super::{MILLIMETRES, Prices, Reached, UNREACHED, Ways};

/// What is unseen this near to the robot will not be seen from a place nearer by.
const NEAR_M: f64 = 1.2;

impl Ways {
    /// Every place that was reached, and how far the goal is from there by the best of the ways on, back from the `ends` and what is
    /// left from each. With the prices the same in both directions, steps back are steps.
    pub(crate) fn remaining(
        &mut self,
        ends: &[(Reached, f64)],
        tilt_price: f64,
        climb_price: f64,
    ) -> impl Iterator<Item = (DVec2, f64)> + use<'_> {
        self.remaining_mm.fill(UNREACHED);
        self.queue.clear();
        let prices = Prices { tilt: tilt_price, climb: climb_price, reverse: 1.0 };
        let least_m = ends.iter().map(|end| end.1).fold(f64::INFINITY, f64::min);
        for &(reached, left_m) in ends {
            let place = reached.state as usize / HEADINGS;
            let left_mm = ((left_m - least_m) * MILLIMETRES) as u32;
            for heading in 0..HEADINGS {
                if self.footing.risk(self.footing.offset(place), heading).is_finite() {
                    self.come_back(place * HEADINGS + heading, left_mm);
                }
            }
        }
        while let Some((state, left_mm)) = self.queue.pop() {
            if self.remaining_mm[state as usize] != left_mm {
                continue;
            }
            for (next, price_mm) in self.steps(state, &prices).into_iter().flatten() {
                self.come_back(next, left_mm.saturating_add(price_mm));
            }
        }
        let ways = &*self;
        let states = ways.costs_mm.chunks_exact(HEADINGS).zip(ways.remaining_mm.chunks_exact(HEADINGS));
        states.enumerate().filter_map(move |(place, (costs_mm, remaining_mm))| {
            let remaining_mm = remaining_mm.iter().copied().min().filter(|&left| left != UNREACHED)?;
            let reached = costs_mm.iter().any(|&cost| cost != UNREACHED);
            let position_m = ways.footing.position_m(ways.footing.offset(place));
            reached.then_some((position_m, least_m + f64::from(remaining_mm) / MILLIMETRES))
        })
    }

    /// The places that were reached and where what was seen ends, by where they lie.
    pub(crate) fn frontier(&self) -> impl Iterator<Item = (Reached, DVec2)> {
        let reached = self.costs_mm.chunks_exact(HEADINGS).enumerate();
        let reached = reached.filter(|(_, costs_mm)| costs_mm.iter().any(|&cost| cost != UNREACHED));
        reached.filter_map(|(place, _)| {
            let offset = self.footing.offset(place);
            let position_m = self.footing.position_m(offset);
            let is_end = (position_m - self.here_m).length() > NEAR_M && self.footing.is_frontier(offset);
            is_end.then_some((Reached { state: (place * HEADINGS) as u32 }, position_m))
        })
    }

    fn come_back(&mut self, state: usize, left_mm: u32) {
        if left_mm < self.remaining_mm[state] && self.queue.takes(left_mm) {
            self.remaining_mm[state] = left_mm;
            self.queue.push(state as u32, left_mm);
        }
    }
}
