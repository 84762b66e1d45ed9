//! What the machine can do at most: multiplications and additions that wait for nothing but themselves.

use std::hint::black_box;

use multiversion::multiversion;

use crate::BenchError;
use crate::work::{Values, Work};

/// Numbers of one chain, as many as in the planner's panels.
const LANES: usize = 8;
const STEPS: u32 = 1_000_000;

/// `CHAINS` chains of multiply, then add, unfused like all arithmetic here, in the widest registers that the planner uses. How
/// many chains keep the machine busiest depends on its registers.
pub(crate) struct Peak<const CHAINS: usize>;

impl<const CHAINS: usize> Work for Peak<CHAINS> {
    fn run(&mut self) -> Result<(), BenchError> {
        let chains = black_box([[1.0; LANES]; 12]);
        match CHAINS {
            6 => black_box(six(chains, black_box(0.999), black_box(0.001))),
            _ => black_box(twelve(chains, black_box(0.999), black_box(0.001))),
        };
        Ok(())
    }

    fn values(&mut self) -> Values {
        Values::from([("operations", vec![2.0 * (LANES * CHAINS) as f64 * f64::from(STEPS)])])
    }
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn six(chains: [[f64; LANES]; 12], factor: f64, summand: f64) -> f64 {
    multiply_and_add::<6>(chains, factor, summand)
}

#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn twelve(chains: [[f64; LANES]; 12], factor: f64, summand: f64) -> f64 {
    multiply_and_add::<12>(chains, factor, summand)
}

#[inline(always)]
fn multiply_and_add<const CHAINS: usize>(chains: [[f64; LANES]; 12], factor: f64, summand: f64) -> f64 {
    let mut sums: [[f64; LANES]; CHAINS] = core::array::from_fn(|chain| chains[chain]);
    for _ in 0..STEPS {
        for chain in &mut sums {
            for value in chain {
                *value = *value * factor + summand;
            }
        }
    }
    sums.as_flattened().iter().sum()
}
