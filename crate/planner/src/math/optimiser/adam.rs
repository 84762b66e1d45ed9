//! Adam inside a box (Kingma and Ba 2015, <https://arxiv.org/abs/1412.6980>); the best place visited counts.

use super::{Bounds, NEGLIGIBLE_SLOPE, Objective, Optimum, Place, Stop};

/// First and last rate of Adam, and the evaluations without a new best place after which it is halved.
const FIRST_RATE: f64 = 0.1;
const LAST_RATE: f64 = 1e-4;
const PATIENCE: u32 = 8;

/// Maximises from `start` with at most `budget` evaluations, the first one made already.
pub(super) fn maximise(start: Place, bounds: &Bounds, budget: u32, mut objective: impl Objective) -> Optimum {
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
            return here.optimum(evaluations, Stop::Converged);
        }
        if evaluations >= budget {
            return best.optimum(evaluations, Stop::Budget);
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
                return best.optimum(evaluations, stop);
            }
        }
    }
}
