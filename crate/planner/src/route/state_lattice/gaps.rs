//! ElevationWindow that was not seen, between ground that was.

use glam::{DVec2, IVec2};

use super::{Prices, StateLattice};
use crate::terrain::slopes::Slopes;

/// Unseen ground that is driven over between two places, what a metre of it costs, and the standard deviation of its slope with each
/// metre of it: behind a crest may be a step.
const GAP_M: f64 = 2.5;
const GAP_PRICE: f64 = 1.5;
const GAP_DEVIATION_PER_M: f64 = 0.1;

impl StateLattice {
    /// The place beyond unseen ground that a drive along a heading leads to, and what that costs.
    pub(super) fn cross_gap(&self, from: IVec2, heading: usize, prices: &Prices) -> Option<(IVec2, f64)> {
        let to = self.traversability.beyond_gap(from, heading, GAP_M)?;
        let (begin, end) = (self.traversability.plane(from)?, self.traversability.plane(to)?);
        let path = self.traversability.position_m(to) - self.traversability.position_m(from);
        let distance_m = path.length();
        let start = Station { distance_m: 0.0, height_m: begin.height_m, gradient: begin.gradient };
        let end = Station { distance_m, height_m: end.height_m, gradient: end.gradient };
        let uncertain = GAP_DEVIATION_PER_M
            * distance_m
            * self.traversability.deviations_at(self.traversability.position_m(to));
        let risk = self.risk_between(&start, &end, path / distance_m, uncertain);
        let climb_m = (end.height_m - start.height_m).abs();
        let price_m = GAP_PRICE * distance_m * (1.0 + prices.tilt * risk);
        risk.is_finite().then_some((to, price_m + prices.climb * climb_m))
    }

    /// Mean risk along a straight line over ground that was not seen, a cubic through both heights and slopes; infinite where
    /// it is not safe with what is `uncertain` of its slopes.
    pub(super) fn risk_between(&self, from: &Station, to: &Station, direction: DVec2, uncertain: f64) -> f64 {
        let count = (to.distance_m / self.config.step_m).ceil().max(1.0) as usize;
        let risk_at = |k: usize| {
            let slopes = from.slopes_towards(to, direction, k as f64 / count as f64);
            self.traversability.risk_on(&slopes, uncertain, self.caution, to.distance_m)
        };
        (1..=count).map(risk_at).sum::<f64>() / count as f64
    }
}

/// ElevationWindow under a place on a straight line.
pub(super) struct Station {
    pub(super) distance_m: f64,
    pub(super) height_m: f64,
    pub(super) gradient: DVec2,
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
