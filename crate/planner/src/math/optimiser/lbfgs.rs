//! Limited-memory BFGS inside a box: an active set of bounds, and a backtracking search along the projected
//! path.

use super::{Bounds, NEGLIGIBLE_GAIN, NEGLIGIBLE_SLOPE, Objective, Optimum, Place, Stop};

/// No coordinate moves further in one step: e in a hyperparameter, one length-scale in an inducing input.
const LONGEST_STEP: f64 = 1.0;
/// Steps remembered.
const MEMORY: usize = 10;
/// Share of the linear gain that a step must reach (Armijo).
const SUFFICIENT_GAIN: f64 = 1e-4;
/// Shortest step of a search, as a share of the first.
const SHORTEST_SHARE: f64 = 1e-9;

/// Maximises from `here` with at most `budget` evaluations, the first one made already.
pub(super) fn maximise(
    mut here: Place,
    bounds: &Bounds,
    budget: u32,
    mut objective: impl Objective,
) -> Optimum {
    let n = here.x.len();
    let mut next = Place { x: vec![0.0; n], gradient: vec![0.0; n], value: 0.0 };
    let (mut slope, mut direction) = (vec![0.0; n], vec![0.0; n]);
    let mut memory: Vec<Curvature> = Vec::new();
    let mut evaluations = 1;
    loop {
        let steepest = here.free_slope(bounds, &mut slope);
        if steepest <= NEGLIGIBLE_SLOPE * here.scale() {
            return here.optimum(evaluations, Stop::Converged);
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
                return here.optimum(evaluations, Stop::Budget);
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
                    // The maximum of the parabola through value, slope and this value, between a tenth and a
                    // half of the step.
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
                return here.optimum(evaluations, stop);
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
            return here.optimum(evaluations, Stop::Converged);
        }
    }
}

/// A step and the decrease of the slope along it.
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
        // NaN marks an unknown direction.
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
