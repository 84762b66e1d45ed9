//! What the machine can do at most: multiplications and additions that wait for nothing but themselves.

use std::hint::black_box;

use multiversion::multiversion;

use crate::BenchError;
use crate::work::{Values, Work};

/// Numbers of one chain, as many as in the planner's panels.
const LANES: usize = 8;
const STEPS: u32 = 1_000_000;

/// As many as keep the machine busiest while they fit its registers.
const CHAINS: usize = 8;

/// Chains of multiply, then add, unfused like all arithmetic here, in the widest registers that the planner
/// uses.
pub(crate) struct Peak;

impl Work for Peak {
    fn run(&mut self) -> Result<(), BenchError> {
        multiply_and_add(&mut black_box([[1.0; LANES]; CHAINS]), black_box(0.999), black_box(0.001));
        Ok(())
    }

    fn values(&mut self) -> Values {
        Values::from([("operations", vec![2.0 * (LANES * CHAINS) as f64 * f64::from(STEPS)])])
    }
}

/// Leaves the chains where the caller can see them: a sum over them would make the compiler shuffle them in
/// every step.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn multiply_and_add(chains: &mut [[f64; LANES]; CHAINS], factor: f64, summand: f64) {
    let mut values = *chains;
    for _ in 0..STEPS {
        for chain in &mut values {
            for value in chain {
                *value = *value * factor + summand;
            }
        }
    }
    *chains = black_box(values);
}
