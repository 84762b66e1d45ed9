//! Climbing a smooth function inside a box with a budget of evaluations: limited-memory BFGS and Adam, both projected.
//!
//! The marginal likelihood of a scan usually grows up to the bounds of several hyperparameters, so the bounds must hold exactly
//! and cost nothing when they bind; an evaluation may fail, and none may go beyond the budget. Libraries that build for wasm
//! offer no box, read a clock, or count iterations in place of evaluations.

mod adam;
mod lbfgs;

/// Why an ascent ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum Stop {
    /// The slope inside the box, or the last gain, is negligible.
    Converged,
    /// All evaluations are used.
    Budget,
    /// No step from here, however short, goes up by more than rounding.
    NoAscent,
    /// Every step from here met a covariance that could not be factored.
    IllConditioned,
}

mapless_parameters::choices! {
    /// Which method climbs.
    pub enum Optimiser {
        /// Limited-memory BFGS with an active set of bounds and a backtracking search along the projected path.
        Lbfgs = "lbfgs",
        /// Adam (Kingma and Ba 2015), whose rate is halved when it stalls; the best place it visited counts.
        Adam = "adam",
    }
}

/// Lowest and highest values of each coordinate.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bounds {
    pub(crate) lowest: Vec<f64>,
    pub(crate) highest: Vec<f64>,
}

impl Bounds {
    fn project(&self, x: &mut [f64]) {
        for ((x, lowest), highest) in x.iter_mut().zip(&self.lowest).zip(&self.highest) {
            *x = x.min(*highest).max(*lowest);
        }
    }

    /// Whether coordinate `i` rests on a bound that the slope pushes against.
    fn blocks(&self, i: usize, x: f64, slope: f64) -> bool {
        (x <= self.lowest[i] && slope <= 0.0) || (x >= self.highest[i] && slope >= 0.0)
    }
}

/// Where an ascent ended.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Optimum {
    pub(crate) x: Vec<f64>,
    pub(crate) value: f64,
    pub(crate) evaluations: u32,
    pub(crate) stop: Stop,
}

/// The function climbed: gives its value and writes its gradient, or gives nothing where it has none.
pub(crate) trait Objective: FnMut(&[f64], &mut [f64]) -> Option<f64> {}
impl<F: FnMut(&[f64], &mut [f64]) -> Option<f64>> Objective for F {}

/// Relative gain of one step, and slope relative to the value, that count as negligible; the gain is SciPy's L-BFGS-B's.
const NEGLIGIBLE_GAIN: f64 = 2.2e-9;
const NEGLIGIBLE_SLOPE: f64 = 1e-8;

/// A place on the way, with the function's value and gradient there.
struct Place {
    x: Vec<f64>,
    gradient: Vec<f64>,
    value: f64,
}

impl Place {
    /// The gradient without the coordinates that the box blocks; gives its largest component.
    fn free_slope(&self, bounds: &Bounds, slope: &mut [f64]) -> f64 {
        let mut largest = 0.0_f64;
        for (i, slope) in slope.iter_mut().enumerate() {
            let blocked = bounds.blocks(i, self.x[i], self.gradient[i]);
            *slope = if blocked { 0.0 } else { self.gradient[i] };
            largest = largest.max(slope.abs());
        }
        largest
    }

    fn scale(&self) -> f64 {
        1.0 + self.value.abs()
    }

    fn optimum(self, evaluations: u32, stop: Stop) -> Optimum {
        Optimum { x: self.x, value: self.value, evaluations, stop }
    }
}

/// Climbs from `start`, whose value and gradient took the first evaluation, for at most `budget` evaluations in all.
pub(crate) fn maximise(
    optimiser: Optimiser,
    start: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
    bounds: &Bounds,
    budget: u32,
    objective: impl Objective,
) -> Optimum {
    let start = Place { x: start, gradient, value };
    match optimiser {
        Optimiser::Lbfgs => lbfgs::maximise(start, bounds, budget, objective),
        Optimiser::Adam => adam::maximise(start, bounds, budget, objective),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Rosenbrock's valley turned upside down; its top is at (1, 1).
    fn valley(x: &[f64], gradient: &mut [f64]) -> Option<f64> {
        let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
        gradient[0] = 2.0 * a + 400.0 * x[0] * b;
        gradient[1] = -200.0 * b;
        Some(-a * a - 100.0 * b * b)
    }

    fn run(
        optimiser: Optimiser,
        start: [f64; 2],
        bounds: &Bounds,
        budget: u32,
        f: impl Objective,
    ) -> Optimum {
        let mut f = f;
        let mut gradient = vec![0.0; 2];
        let value = f(&start, &mut gradient).unwrap();
        maximise(optimiser, start.to_vec(), value, gradient, bounds, budget, f)
    }

    fn square(lowest: f64, highest: f64) -> Bounds {
        Bounds { lowest: vec![lowest; 2], highest: vec![highest; 2] }
    }

    #[test]
    fn lbfgs_reaches_the_top_of_a_bent_ridge() {
        let optimum = run(Optimiser::Lbfgs, [-1.2, 1.0], &square(-5.0, 5.0), 200, valley);
        assert_eq!(optimum.stop, Stop::Converged);
        assert!((optimum.x[0] - 1.0).abs() < 1e-3 && (optimum.x[1] - 1.0).abs() < 1e-3, "{optimum:?}");
        assert!(optimum.evaluations < 80, "{optimum:?}");
    }

    #[test]
    fn a_failing_neighbourhood_is_named() {
        for optimiser in [Optimiser::Lbfgs, Optimiser::Adam] {
            let mut first = true;
            let fails_later = |_: &[f64], gradient: &mut [f64]| {
                gradient.fill(1.0);
                core::mem::take(&mut first).then_some(0.0)
            };
            let optimum = run(optimiser, [0.0; 2], &square(-1.0, 1.0), 500, fails_later);
            assert_eq!((optimum.stop, optimum.value), (Stop::IllConditioned, 0.0));
            // The gradient promises what the value does not keep.
            let flat = |_: &[f64], gradient: &mut [f64]| {
                gradient.fill(1.0);
                Some(0.0)
            };
            assert_eq!(run(optimiser, [0.0; 2], &square(-1.0, 1.0), 500, flat).stop, Stop::NoAscent);
        }
    }

    proptest! {
        #[test]
        fn a_concave_function_is_climbed_to_its_highest_place_in_the_box(
            (centre, stretch) in ([-2.0..2.0_f64, -2.0..2.0_f64], [0.1..10.0_f64, 0.1..10.0_f64]),
            start in [-1.0..1.0_f64, -1.0..1.0_f64],
        ) {
            let hill = |x: &[f64], gradient: &mut [f64]| {
                let mut value = 0.0;
                for i in 0..2 {
                    gradient[i] = -2.0 * stretch[i] * (x[i] - centre[i]);
                    value -= stretch[i] * (x[i] - centre[i]) * (x[i] - centre[i]);
                }
                Some(value)
            };
            for optimiser in [Optimiser::Lbfgs, Optimiser::Adam] {
                let optimum = run(optimiser, start, &square(-1.0, 1.0), 1000, hill);
                for (x, centre) in optimum.x.iter().zip(centre) {
                    prop_assert!((x - centre.clamp(-1.0, 1.0)).abs() < 1e-3, "{optimiser:?} {optimum:?}");
                }
            }
        }

        #[test]
        fn the_budget_holds_and_the_value_never_falls(
            start in [-1.0..0.9_f64, -1.0..0.9_f64], budget in 1..40_u32,
        ) {
            for optimiser in [Optimiser::Lbfgs, Optimiser::Adam] {
                let mut calls = 0;
                let counted = |x: &[f64], gradient: &mut [f64]| {
                    calls += 1;
                    valley(x, gradient)
                };
                let optimum = run(optimiser, start, &square(-1.0, 0.9), budget, counted);
                prop_assert_eq!(calls, optimum.evaluations);
                prop_assert!(optimum.evaluations <= budget);
                let before = valley(&start, &mut [0.0; 2]).unwrap();
                prop_assert!(optimum.value >= before && optimum.x.iter().all(|x| (-1.0..=0.9).contains(x)));
            }
        }
    }
}
