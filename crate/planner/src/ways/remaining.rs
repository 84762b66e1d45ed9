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
        ways.reached().filter_map(move |(reached, position_m)| {
            let place = reached.state as usize / HEADINGS;
            let headings = &ways.remaining_mm[place * HEADINGS..][..HEADINGS];
            let remaining_mm = headings.iter().copied().min().filter(|&left| left != UNREACHED)?;
            Some((position_m, least_m + f64::from(remaining_mm) / MILLIMETRES))
        })
    }

    /// Every place that was reached by its cheapest way, and where it lies.
    pub(crate) fn reached(&self) -> impl Iterator<Item = (Reached, DVec2)> {
        (0..self.footing.count()).filter_map(|place| {
            Some((self.cheapest(place)?, self.footing.position_m(self.footing.offset(place))))
        })
    }

    /// Those of the places that were reached where what was seen ends.
    pub(crate) fn frontier(&self) -> impl Iterator<Item = (Reached, DVec2)> {
        self.reached().filter(|&(reached, position_m)| {
            let offset = self.footing.offset(reached.state as usize / HEADINGS);
            (position_m - self.here_m).length() > NEAR_M && self.footing.is_frontier(offset)
        })
    }

    fn come_back(&mut self, state: usize, left_mm: u32) {
        if left_mm < self.remaining_mm[state] && self.queue.takes(left_mm) {
            self.remaining_mm[state] = left_mm;
            self.queue.push(state as u32, left_mm);
        }
    }
}
