//! Learning on the repository's scene gives recorded bits; native and browser tests compare with the same
//! number, so a pass of both shows that bound, gradient and both optimisers agree on every target.

use mapless::gp::hyperparameters::Hyperparameters;
use mapless::gp::kernel::RationalQuadratic;
use mapless::gp::learning::{Learned, Learner, LearningConfig, Optimiser};

use crate::gpflow;

/// The digest of what L-BFGS and Adam learn in twenty evaluations, with every inducing input free.
pub const RECORDED: u64 = 17_714_151_122_878_875_295;

/// Learns with both and gives the digest.
///
/// # Errors
/// Says why the scene could not be read or learned from.
pub fn digest() -> Result<u64, String> {
    let gpflow::Problem { inputs, targets, inducing } = gpflow::problem()?;
    let start = Hyperparameters { kernel: RationalQuadratic::default(), noise_variance: 3.0 };
    let mut digest = 0;
    for optimiser in [Optimiser::Lbfgs, Optimiser::Adam] {
        let config = LearningConfig { optimiser, learn_inducing_inputs: true, ..LearningConfig::default() };
        let learned = Learner::new(config)
            .learn(&inputs, &targets, &inducing, &start)
            .map_err(|e| format!("{optimiser:?}: {e}"))?;
        digest = numbers(&learned).into_iter().fold(digest, fold);
    }
    Ok(digest)
}

fn numbers(learned: &Learned) -> Vec<f64> {
    let Hyperparameters { kernel, noise_variance } = learned.hyperparameters;
    let [azimuth, elevation] = kernel.length_scales_rad;
    let mut numbers = vec![learned.bound_before, learned.bound_after];
    numbers.extend([kernel.variance, azimuth, elevation, kernel.alpha, noise_variance]);
    numbers.extend(learned.inducing.iter().flat_map(|z| z.to_array()));
    numbers
}

/// One step of a multiply-and-rotate hash.
fn fold(digest: u64, number: f64) -> u64 {
    (digest ^ number.to_bits()).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(29)
}
