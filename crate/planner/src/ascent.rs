//! Climbing a smooth function inside a box with a budget of evaluations: limited-memory BFGS and Adam, both projected.
//!
//! The marginal likelihood of a scan usually grows up to the bounds of several hyperparameters, so the bounds must hold exactly
//! and cost nothing when they bind; an evaluation may fail, and none may go beyond the budget. Libraries that build for wasm
//! offer no box, read a clock, or count iterations in place of evaluations.

/// Why an ascent ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
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

/// Which method climbs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Optimiser {
    /// Limited-memory BFGS with an active set of bounds and a backtracking search along the projected path.
    Lbfgs,
    /// Adam (Kingma and Ba 2015), whose rate is halved when it stalls; the best place it visited counts.
    Adam,
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
pub(crate) struct Summit {
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
/// No coordinate moves further in one step: e in a hyperparameter, one length-scale in an inducing input.
const LONGEST_STEP: f64 = 1.0;

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

    fn summit(self, evaluations: u32, stop: Stop) -> Summit {
        Summit { x: self.x, value: self.value, evaluations, stop }
    }
}

/// Climbs from `start`, whose value and gradient took the first evaluation, for at most `budget` evaluations in all.
pub(crate) fn climb(
    optimiser: Optimiser,
    start: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
    bounds: &Bounds,
    budget: u32,
    objective: impl Objective,
) -> Summit {
    let start = Place { x: start, gradient, value };
    match optimiser {
        Optimiser::Lbfgs => lbfgs(start, bounds, budget, objective),
        Optimiser::Adam => adam(start, bounds, budget, objective),
    }
}

/// Steps remembered.
const MEMORY: usize = 10;
/// Share of the linear gain that a step must reach (Armijo).
const SUFFICIENT_GAIN: f64 = 1e-4;
/// Shortest step of a search, as a share of the first.
const SHORTEST_SHARE: f64 = 1e-9;

fn lbfgs(mut here: Place, bounds: &Bounds, budget: u32, mut objective: impl Objective) -> Summit {
    let n = here.x.len();
    let mut next = Place { x: vec![0.0; n], gradient: vec![0.0; n], value: 0.0 };
    let (mut slope, mut direction) = (vec![0.0; n], vec![0.0; n]);
    let mut memory: Vec<Curvature> = Vec::new();
    let mut evaluations = 1;
    loop {
        let steepest = here.free_slope(bounds, &mut slope);
        if steepest <= NEGLIGIBLE_SLOPE * here.scale() {
            return here.summit(evaluations, Stop::Converged);
        }
        quasi_newton_direction(&memory, &slope, &mut direction);
        // Scaled gradient where the curvature is not known yet or misleads.
        let uphill = dot(&direction, &slope);
        if memory.is_empty() || !(uphill > 0.0 && uphill.is_finite()) {
            memory.clear();
            for (d, g) in direction.iter_mut().zip(&slope) {
                *d = 0.1 * g / steepest;
            }
        }
        let reach = direction.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
        let mut share = (LONGEST_STEP / reach).min(1.0);
        let shortest = share * SHORTEST_SHARE;
        let mut any_value = false;
        let gain = loop {
            if evaluations >= budget {
                return here.summit(evaluations, Stop::Budget);
            }
            for ((x, from), d) in next.x.iter_mut().zip(&here.x).zip(&direction) {
                *x = from + share * d;
            }
            bounds.project(&mut next.x);
            let linear: f64 =
                next.x.iter().zip(&here.x).zip(&here.gradient).map(|((b, a), g)| (b - a) * g).sum();
            evaluations += 1;
            match objective(&next.x, &mut next.gradient) {
                Some(value) => {
                    any_value = true;
                    let gain = value - here.value;
                    if gain > 0.0 && gain >= SUFFICIENT_GAIN * linear {
                        next.value = value;
                        break Some(gain);
                    }
                    // The parabola through value, slope and this value, kept within a tenth and a half.
                    let best = 0.5 * linear / (linear - gain);
                    share *= if best.is_finite() { best.clamp(0.1, 0.5) } else { 0.5 };
                }
                None => share *= 0.25,
            }
            if share < shortest {
                break None;
            }
        };
        let Some(gain) = gain else {
            if memory.is_empty() {
                let stop = if any_value { Stop::NoAscent } else { Stop::IllConditioned };
                return here.summit(evaluations, stop);
            }
            memory.clear();
            continue;
        };
        if memory.len() == MEMORY {
            memory.rotate_left(1);
            memory.pop();
        }
        memory.push(Curvature {
            step: difference(&next.x, &here.x),
            bend: difference(&here.gradient, &next.gradient),
        });
        core::mem::swap(&mut here, &mut next);
        if gain <= NEGLIGIBLE_GAIN * here.scale() {
            return here.summit(evaluations, Stop::Converged);
        }
    }
}

/// A step and how much the slope fell along it.
struct Curvature {
    step: Vec<f64>,
    bend: Vec<f64>,
}

/// The two-loop recursion over the free coordinates, those where `slope` is not zero.
fn quasi_newton_direction(memory: &[Curvature], slope: &[f64], direction: &mut [f64]) {
    direction.copy_from_slice(slope);
    let free_dot = |a: &[f64], b: &[f64]| -> f64 {
        a.iter().zip(b).zip(slope).filter(|(_, g)| **g != 0.0).map(|((a, b), _)| a * b).sum()
    };
    let mut used: Vec<(&Curvature, f64, f64)> = Vec::with_capacity(memory.len());
    let mut scale = None;
    for pair in memory.iter().rev() {
        let curvature = free_dot(&pair.step, &pair.bend);
        let bend = free_dot(&pair.bend, &pair.bend);
        if curvature <= 1e-10 * bend {
            continue;
        }
        scale.get_or_insert(curvature / bend);
        let along = free_dot(&pair.step, direction) / curvature;
        for (d, b) in direction.iter_mut().zip(&pair.bend) {
            *d -= along * b;
        }
        used.push((pair, curvature, along));
    }
    let Some(scale) = scale else {
        // NaN tells the caller that nothing is known.
        direction.fill(f64::NAN);
        return;
    };
    for d in direction.iter_mut() {
        *d *= scale;
    }
    for (pair, curvature, along) in used.into_iter().rev() {
        let back = free_dot(&pair.bend, direction) / curvature;
        for (d, s) in direction.iter_mut().zip(&pair.step) {
            *d += (along - back) * s;
        }
    }
    for (d, g) in direction.iter_mut().zip(slope) {
        if *g == 0.0 {
            *d = 0.0;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// First and last rate of Adam, and the evaluations without a new best place after which it is halved.
const FIRST_RATE: f64 = 0.1;
const LAST_RATE: f64 = 1e-4;
const PATIENCE: u32 = 8;

fn adam(start: Place, bounds: &Bounds, budget: u32, mut objective: impl Objective) -> Summit {
    let n = start.x.len();
    let started = start.value;
    let mut best = Place { x: start.x.clone(), gradient: start.gradient.clone(), value: start.value };
    let mut here = start;
    let mut slope = vec![0.0; n];
    let (mut mean, mut square) = (vec![0.0; n], vec![0.0; n]);
    let (mut mean_decay, mut square_decay) = (1.0, 1.0);
    let (mut rate, mut stalled, mut evaluations) = (FIRST_RATE, 0, 1);
    let mut any_value = false;
    loop {
        if here.free_slope(bounds, &mut slope) <= NEGLIGIBLE_SLOPE * here.scale() && here.value >= best.value
        {
            return here.summit(evaluations, Stop::Converged);
        }
        if evaluations >= budget {
            return best.summit(evaluations, Stop::Budget);
        }
        mean_decay *= 0.9;
        square_decay *= 0.999;
        for i in 0..n {
            mean[i] = 0.9 * mean[i] + 0.1 * slope[i];
            square[i] = 0.999 * square[i] + 0.001 * slope[i] * slope[i];
            let deviation = (square[i] / (1.0 - square_decay)).sqrt() + 1e-8;
            here.x[i] += rate * mean[i] / (1.0 - mean_decay) / deviation;
        }
        bounds.project(&mut here.x);
        evaluations += 1;
        let value = objective(&here.x, &mut here.gradient);
        any_value |= value.is_some();
        match value {
            Some(value) if value > best.value => {
                here.value = value;
                best.x.copy_from_slice(&here.x);
                best.gradient.copy_from_slice(&here.gradient);
                best.value = value;
                stalled = 0;
                continue;
            }
            Some(value) => here.value = value,
            None => stalled = PATIENCE,
        }
        stalled += 1;
        if stalled > PATIENCE {
            // Back to the best place, with shorter steps and no momentum.
            rate *= 0.5;
            stalled = 0;
            here.x.copy_from_slice(&best.x);
            here.gradient.copy_from_slice(&best.gradient);
            here.value = best.value;
            mean.fill(0.0);
            square.fill(0.0);
            (mean_decay, square_decay) = (1.0, 1.0);
            if rate < LAST_RATE {
                let stop = match (best.value > started, any_value) {
                    (true, _) => Stop::Converged,
                    (false, true) => Stop::NoAscent,
                    (false, false) => Stop::IllConditioned,
                };
                return best.summit(evaluations, stop);
            }
        }
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

    fn run(optimiser: Optimiser, start: [f64; 2], bounds: &Bounds, budget: u32, f: impl Objective) -> Summit {
        let mut f = f;
        let mut gradient = vec![0.0; 2];
        let value = f(&start, &mut gradient).unwrap();
        climb(optimiser, start.to_vec(), value, gradient, bounds, budget, f)
    }

    fn square(lowest: f64, highest: f64) -> Bounds {
        Bounds { lowest: vec![lowest; 2], highest: vec![highest; 2] }
    }

    #[test]
    fn lbfgs_reaches_the_top_of_a_bent_ridge() {
        let summit = run(Optimiser::Lbfgs, [-1.2, 1.0], &square(-5.0, 5.0), 200, valley);
        assert_eq!(summit.stop, Stop::Converged);
        assert!((summit.x[0] - 1.0).abs() < 1e-3 && (summit.x[1] - 1.0).abs() < 1e-3, "{summit:?}");
        assert!(summit.evaluations < 80, "{summit:?}");
    }

    #[test]
    fn a_failing_neighbourhood_is_named() {
        for optimiser in [Optimiser::Lbfgs, Optimiser::Adam] {
            let mut first = true;
            let fails_later = |_: &[f64], gradient: &mut [f64]| {
                gradient.fill(1.0);
                core::mem::take(&mut first).then_some(0.0)
            };
            let summit = run(optimiser, [0.0; 2], &square(-1.0, 1.0), 500, fails_later);
            assert_eq!((summit.stop, summit.value), (Stop::IllConditioned, 0.0));
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
                let summit = run(optimiser, start, &square(-1.0, 1.0), 1000, hill);
                for (x, centre) in summit.x.iter().zip(centre) {
                    prop_assert!((x - centre.clamp(-1.0, 1.0)).abs() < 1e-3, "{optimiser:?} {summit:?}");
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
                let summit = run(optimiser, start, &square(-1.0, 0.9), budget, counted);
                prop_assert_eq!(calls, summit.evaluations);
                prop_assert!(summit.evaluations <= budget);
                let before = valley(&start, &mut [0.0; 2]).unwrap();
                prop_assert!(summit.value >= before && summit.x.iter().all(|x| (-1.0..=0.9).contains(x)));
            }
        }
    }
}
