//! How far the goal is from every place that was reached, by what was seen and by what was learned of where that ends.

use glam::DVec2;

use super::{MILLIMETRES, Prices, ReachedState, StateLattice, UNREACHED};
use crate::terrain::headings::HEADINGS;

/// What is unseen this near to the robot will not be seen from a place nearer by.
const NEAR_M: f64 = 1.2;

impl StateLattice {
    /// Every place that was reached, and how far the goal is from there by the best of the ways on, back from the `ends` and what is
    /// left from each. With the prices the same in both directions, steps back are steps.
    pub(crate) fn remaining(
        &mut self,
        ends: &[(ReachedState, f64)],
        tilt_price: f64,
        climb_price: f64,
    ) -> impl Iterator<Item = (DVec2, f64)> + use<'_> {
        self.cost_to_go_mm.fill(UNREACHED);
        self.queue.clear();
        let prices = Prices { tilt: tilt_price, climb: climb_price, reverse: 1.0 };
        let least_m = ends.iter().map(|end| end.1).fold(f64::INFINITY, f64::min);
        for &(reached, left_m) in ends {
            let place = reached.state as usize / HEADINGS;
            let cost_to_go_mm_ = ((left_m - least_m) * MILLIMETRES) as u32;
            for heading in 0..HEADINGS {
                if self.traversability.risk(self.traversability.offset(place), heading).is_finite() {
                    self.come_back(place * HEADINGS + heading, cost_to_go_mm_);
                }
            }
        }
        while let Some((state, cost_to_go_mm_)) = self.queue.pop() {
            if self.cost_to_go_mm[state as usize] != cost_to_go_mm_ {
                continue;
            }
            for (next, price_mm) in self.steps(state, &prices).into_iter().flatten() {
                self.come_back(next, cost_to_go_mm_.saturating_add(price_mm));
            }
        }
        let lattice = &*self;
        lattice.reached().filter_map(move |(reached, position_m)| {
            let place = reached.state as usize / HEADINGS;
            let headings = &lattice.cost_to_go_mm[place * HEADINGS..][..HEADINGS];
            let cost_to_go_mm = headings.iter().copied().min().filter(|&left| left != UNREACHED)?;
            Some((position_m, least_m + f64::from(cost_to_go_mm) / MILLIMETRES))
        })
    }

    /// Every place that was reached by its cheapest way, and where it lies.
    pub(crate) fn reached(&self) -> impl Iterator<Item = (ReachedState, DVec2)> {
        (0..self.traversability.count()).filter_map(|place| {
            Some((self.cheapest(place)?, self.traversability.position_m(self.traversability.offset(place))))
        })
    }

    /// Those of the places that were reached where what was seen ends.
    pub(crate) fn frontier(&self) -> impl Iterator<Item = (ReachedState, DVec2)> {
        self.reached().filter(|&(reached, position_m)| {
            let offset = self.traversability.offset(reached.state as usize / HEADINGS);
            (position_m - self.here_m).length() > NEAR_M && self.traversability.is_frontier(offset)
        })
    }

    fn come_back(&mut self, state: usize, cost_to_go_mm_: u32) {
        if cost_to_go_mm_ < self.cost_to_go_mm[state] && self.queue.takes(cost_to_go_mm_) {
            self.cost_to_go_mm[state] = cost_to_go_mm_;
            self.queue.push(state as u32, cost_to_go_mm_);
        }
    }
}
