//! Steps over a virtual surface: ground that was not seen, between ground that was.

use glam::{DVec2, IVec2};

use super::{Prices, StateLattice};
use crate::terrain::slopes::Slopes;

/// Longest virtual surface, cost factor of a metre on it, and standard deviation of its slope per metre: a
/// step may hide behind a crest.
const GAP_M: f64 = 2.5;
const GAP_PRICE: f64 = 1.5;
const GAP_DEVIATION_PER_M: f64 = 0.1;

impl StateLattice {
    /// The first known place beyond unseen ground along a heading, and the cost of driving there.
    pub(super) fn cross_gap(&self, from: IVec2, heading: usize, prices: &Prices) -> Option<(IVec2, f64)> {
        let to = self.traversability.beyond_gap(from, heading, GAP_M)?;
        let (begin, end) = (self.traversability.plane(from)?, self.traversability.plane(to)?);
        let path = self.traversability.places.position_m(to) - self.traversability.places.position_m(from);
        let distance_m = path.length();
        let start = Station { distance_m: 0.0, height_m: begin.height_m, gradient: begin.gradient };
        let end = Station { distance_m, height_m: end.height_m, gradient: end.gradient };
        let uncertain = GAP_DEVIATION_PER_M
            * distance_m
            * self.traversability.deviations_at(self.traversability.places.position_m(to));
        let risk = self.risk_between(&start, &end, |_| path / distance_m, uncertain, 1);
        let climb_m = (end.height_m - start.height_m).abs();
        let price_m = GAP_PRICE * distance_m * (1.0 + prices.tilt * risk);
        risk.is_finite().then_some((to, price_m + prices.climb * climb_m))
    }

    /// Mean risk over the virtual surface, a cubic through the heights and slopes at both ends, of a robot
    /// that travels along `travel_at` each share of the way, at this many places at least. Infinite if it is
    /// not safe with `uncertain` added to its slopes.
    pub(super) fn risk_between(
        &self,
        from: &Station,
        to: &Station,
        travel_at: impl Fn(f64) -> DVec2,
        uncertain: f64,
        samples: usize,
    ) -> f64 {
        let along = (to.distance_m / self.config.step_m).ceil() as usize;
        let count = along.max(samples);
        let risk_at = |k: usize| {
            let slopes = from.slopes_towards(to, &travel_at, k as f64 / count as f64);
            self.traversability.risk_on(&slopes, uncertain, self.caution, to.distance_m)
        };
        (1..=count).map(risk_at).sum::<f64>() / count as f64
    }
}

/// Distance, height and gradient at a place on the way.
pub(super) struct Station {
    pub(super) distance_m: f64,
    pub(super) height_m: f64,
    pub(super) gradient: DVec2,
}

impl Station {
    /// Slopes at `share` of the distance to another station, on the cubic Hermite polynomial through both
    /// heights and slopes.
    fn slopes_towards(&self, to: &Self, travel_at: impl Fn(f64) -> DVec2, share: f64) -> Slopes {
        let t = share;
        let length_m = to.distance_m - self.distance_m;
        let across = self.gradient.lerp(to.gradient, t).dot(travel_at(t).perp()).abs();
        let (from_slope, to_slope) = (self.gradient.dot(travel_at(0.0)), to.gradient.dot(travel_at(1.0)));
        let along = 6.0 * t * (1.0 - t) * (to.height_m - self.height_m) / length_m
            + (1.0 - t) * (1.0 - 3.0 * t) * from_slope
            + t * (3.0 * t - 2.0) * to_slope;
        Slopes { across, along: along.abs() }
    }
}
