//! The backward search: cost-to-go of every reached place, from the frontier and its learned cost-to-go.

use glam::DVec2;

use super::{MILLIMETRES, Prices, ReachedState, StateLattice, UNREACHED};
use crate::terrain::headings::HEADINGS;

/// The frontier begins this far from the robot: unseen ground nearer by stays unseen from any nearer place.
const NEAR_M: f64 = 1.2;

impl StateLattice {
    /// Every reached place with its cost-to-go: Dijkstra's algorithm backward from `ends`, each with its own
    /// cost-to-go. Reverse costs as much as forward here, so the steps of the lattice are their own inverses.
    pub(crate) fn backward_search(
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
            let cost_mm = ((left_m - least_m) * MILLIMETRES) as u32;
            for heading in 0..HEADINGS {
                if self.traversability.risk(self.traversability.places.offset(place), heading).is_finite() {
                    self.relax_backward(place * HEADINGS + heading, cost_mm);
                }
            }
        }
        while let Some((state, cost_mm)) = self.queue.pop() {
            if self.cost_to_go_mm[state as usize] != cost_mm {
                continue;
            }
            for (next, price_mm) in self.steps(state, &prices).into_iter().flatten() {
                self.relax_backward(next, cost_mm.saturating_add(price_mm));
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

    /// Every reached place, by its cheapest state and its position.
    pub(crate) fn reached(&self) -> impl Iterator<Item = (ReachedState, DVec2)> {
        (0..self.traversability.places.count()).filter_map(|place| {
            Some((
                self.cheapest(place)?,
                self.traversability.places.position_m(self.traversability.places.offset(place)),
            ))
        })
    }

    /// The reached places that border on unseen ground.
    pub(crate) fn frontier(&self) -> impl Iterator<Item = (ReachedState, DVec2)> {
        self.reached().filter(|&(reached, position_m)| {
            let offset = self.traversability.places.offset(reached.state as usize / HEADINGS);
            (position_m - self.here_m).length() > NEAR_M && self.traversability.is_frontier(offset)
        })
    }

    fn relax_backward(&mut self, state: usize, cost_mm: u32) {
        if cost_mm < self.cost_to_go_mm[state] && self.queue.takes(cost_mm) {
            self.cost_to_go_mm[state] = cost_mm;
            self.queue.push(state as u32, cost_mm);
        }
    }
}
