//! The bound and the exact process against their definitions: finite differences, and each other.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use glam::DVec2;
use mapless::gp::bound::CollapsedBound;
use mapless::gp::exact::ExactGp;
use mapless::gp::hyperparameters::{Hyperparameters, LogGradient, RegressionError};
use mapless::gp::kernel::RationalQuadratic;
use mapless::gp::{GpError, sparse::SparseGp};
use proptest::prelude::*;

/// Hyperparameters from logarithms, in the order of [`as_array`].
fn hyperparameters(logs: [f64; 5]) -> Hyperparameters {
    let [variance, azimuth, elevation, alpha, noise_variance] = logs.map(libm::exp);
    let kernel = RationalQuadratic { variance, length_scales_rad: [azimuth, elevation], alpha };
    Hyperparameters { kernel, noise_variance }
}

fn as_array(gradient: &LogGradient) -> [f64; 5] {
    let [azimuth, elevation] = gradient.length_scales;
    [gradient.variance, azimuth, elevation, gradient.alpha, gradient.noise_variance]
}

fn points(count: impl Into<prop::collection::SizeRange>) -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((-0.5..0.5_f64, -0.25..0.25_f64).prop_map(DVec2::from), count)
}

#[derive(Clone, Debug)]
struct Problem {
    inputs: Vec<DVec2>,
    targets: Vec<f64>,
    inducing: Vec<DVec2>,
    logs: [f64; 5],
}

/// Small problems; more than one block of 256 columns, and counts that fill no panel, are among them.
fn problems(most: usize) -> impl Strategy<Value = Problem> {
    (1..most).prop_flat_map(|n| {
        let targets = prop::collection::vec(-3.0..3.0_f64, n);
        let logs = (-1.0..1.5_f64, -2.5..-0.5_f64, -3.0..-1.0_f64, -0.5..3.0_f64, -3.0..0.5_f64);
        (points(n), targets, points(1..14), logs).prop_map(|(inputs, targets, inducing, logs)| Problem {
            inputs,
            targets,
            inducing,
            logs: logs.into(),
        })
    })
}

/// Central differences of `f` at 0 with two steps, extrapolated.
fn slope(f: impl Fn(f64) -> f64) -> f64 {
    let central = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    let h = 2e-4;
    (4.0 * central(h) - central(2.0 * h)) / 3.0
}

fn close(ours: f64, difference: f64, scale: f64) -> Result<(), TestCaseError> {
    let tolerance = 3e-6 * (1.0 + scale + difference.abs());
    prop_assert!((ours - difference).abs() < tolerance, "{ours} but finite differences give {difference}");
    Ok(())
}

/// Whether all inputs are a tenth of a length-scale from each other.
fn are_apart(inputs: &[DVec2], hyperparameters: &Hyperparameters) -> bool {
    let scales = DVec2::from_array(hyperparameters.kernel.length_scales_rad);
    let near = |(i, a): (usize, &DVec2)| inputs[..i].iter().any(|b| ((*a - *b) / scales).length() < 0.1);
    !inputs.iter().enumerate().any(near)
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: 10_000, ..ProptestConfig::with_cases(64) })]

    #[test]
    fn the_gradients_of_the_bound_are_its_slopes(problem in problems(300)) {
        let Problem { inputs, targets, inducing, logs } = problem;
        let mut bound = CollapsedBound::new();
        let base = bound.evaluate(&inputs, &targets, &inducing, &hyperparameters(logs)).unwrap();
        // Another jitter is another function, and so near to a singular covariance that the jitter matters,
        // differences say little.
        prop_assume!(bound.jitter() < 2e-6 && are_apart(&inducing, &hyperparameters(logs)));
        let evaluate = |inducing: &[DVec2], logs: [f64; 5]| {
            CollapsedBound::new().evaluate(&inputs, &targets, inducing, &hyperparameters(logs)).unwrap()
        };
        let scale = 1e-2 * base.abs();
        for (k, ours) in as_array(bound.gradient()).into_iter().enumerate() {
            let difference = slope(|step| {
                let mut moved = logs;
                moved[k] += step;
                evaluate(&inducing, moved)
            });
            close(ours, difference, scale)?;
        }
        let length_scale = libm::exp(logs[1].min(logs[2]));
        for (k, ours) in bound.inducing_gradient().iter().enumerate() {
            for axis in [DVec2::X, DVec2::Y] {
                let difference = slope(|step| {
                    let mut moved = inducing.clone();
                    moved[k] += length_scale * step * axis;
                    evaluate(&moved, logs)
                });
                close(ours.dot(axis) * length_scale, difference, scale)?;
            }
        }
    }

    #[test]
    fn the_gradient_of_the_likelihood_is_its_slope(problem in problems(40)) {
        let Problem { inputs, targets, logs, .. } = problem;
        let gradient = ExactGp::fit(&inputs, &targets, hyperparameters(logs)).unwrap().gradient();
        for (k, ours) in as_array(&gradient).into_iter().enumerate() {
            let difference = slope(|step| {
                let mut moved = logs;
                moved[k] += step;
                ExactGp::fit(&inputs, &targets, hyperparameters(moved)).unwrap().log_marginal_likelihood()
            });
            close(ours, difference, 0.0)?;
        }
    }

    #[test]
    fn the_bound_lies_below_the_likelihood_and_meets_it_when_every_input_is_inducing(
        problem in problems(40),
    ) {
        let Problem { inputs, targets, inducing, logs } = problem;
        let hyperparameters = hyperparameters(logs);
        let exact = ExactGp::fit(&inputs, &targets, hyperparameters).unwrap();
        let likelihood = exact.log_marginal_likelihood();
        let mut bound = CollapsedBound::new();
        let sparse = bound.evaluate(&inputs, &targets, &inducing, &hyperparameters).unwrap();
        let rounding = 1e-9 * (1.0 + likelihood.abs());
        prop_assert!(sparse <= likelihood + rounding, "{sparse} {likelihood}");
        let full = bound.evaluate(&inputs, &targets, &inputs, &hyperparameters).unwrap();
        // What remains is the jitter j, which makes an eigenvalue λ of the covariance λ²/(λ + j), less by j
        // at most. So the trace and the logarithms of the determinant take n j/σ² at most, and the quadratic
        // form |y|² j/(2 σ⁴).
        let Hyperparameters { kernel, noise_variance } = hyperparameters;
        let square: f64 = targets.iter().map(|target| target * target).sum();
        let jitter = bound.jitter();
        let taken = jitter / noise_variance * (inputs.len() as f64 + 0.5 * square / noise_variance);
        prop_assert!((full - likelihood).abs() <= taken + rounding, "{full} {likelihood}");

        let mut gp = SparseGp::new(kernel, noise_variance);
        gp.fit(&inputs, &targets, &inputs).unwrap();
        let (mut mean, mut variance) = ([0.0], [0.0]);
        gp.predict(&inducing[..1], &mut mean, &mut variance);
        let (exact_mean, exact_variance) = exact.predict(inducing[0]);
        // The jitter changes the weight of an eigenvector by j/(λ + j)/σ² at most, and the squares of k*'s
        // shares of them over λ sum up to the variance at most. √λ j/(λ + j) is largest at λ = j.
        let tolerance = 0.5 * (kernel.variance * gp.jitter() * square).sqrt() / noise_variance + 1e-9;
        prop_assert!((mean[0] - exact_mean).abs() <= tolerance, "{mean:?} {exact_mean} {tolerance}");
        let tolerance = 2.0 * kernel.variance * gp.jitter() / noise_variance + 1e-9;
        prop_assert!((variance[0] - exact_variance).abs() <= tolerance, "{variance:?} {exact_variance} {tolerance}");
    }

    #[test]
    fn a_used_workspace_changes_no_bit(first in problems(300), second in problems(300)) {
        let evaluate = |bound: &mut CollapsedBound, p: &Problem| {
            let value = bound.evaluate(&p.inputs, &p.targets, &p.inducing, &hyperparameters(p.logs));
            (value, *bound.gradient(), bound.inducing_gradient().to_vec())
        };
        let mut used = CollapsedBound::new();
        evaluate(&mut used, &first).0.unwrap();
        prop_assert_eq!(evaluate(&mut used, &second), evaluate(&mut CollapsedBound::new(), &second));
    }
}

#[test]
fn what_cannot_be_evaluated_is_named() {
    let good = hyperparameters([0.0, -2.0, -3.0, 2.0, -1.0]);
    let (inputs, targets) = ([DVec2::ZERO, DVec2::X], [1.0, 2.0]);
    let mut bound = CollapsedBound::new();
    let mut evaluate = |inputs: &[DVec2], targets: &[f64], inducing: &[DVec2], h: &Hyperparameters| {
        bound.evaluate(inputs, targets, inducing, h).unwrap_err()
    };
    assert_eq!(evaluate(&[], &[], &inputs, &good), RegressionError::NoInputs);
    assert_eq!(
        evaluate(&inputs, &targets[..1], &inputs, &good).to_string(),
        "1 targets for 2 inputs: expected as many"
    );
    assert_eq!(evaluate(&inputs, &targets, &[], &good), RegressionError::Sparse(GpError::NoInducingInputs));
    let broken = [DVec2::ZERO, DVec2::new(0.0, f64::INFINITY)];
    assert_eq!(
        evaluate(&inputs, &targets, &broken, &good).to_string(),
        "inducing[1] = inf: expected a finite number"
    );
    assert!(matches!(
        evaluate(&inputs, &[1.0, f64::NAN], &inputs, &good),
        RegressionError::NotFinite { what: "targets", index: 1, .. }
    ));
    let negative = Hyperparameters { noise_variance: -1.0, ..good };
    assert_eq!(
        evaluate(&inputs, &targets, &inputs, &negative),
        RegressionError::NotPositive { name: "noise_variance", value: -1.0 }
    );
    let huge = [1e200, 1.0];
    assert!(matches!(
        evaluate(&inputs, &huge, &inputs, &good),
        RegressionError::IllConditioned { inputs: 2, .. }
    ));
    assert!(matches!(
        ExactGp::fit(&[DVec2::ZERO; 2], &targets, Hyperparameters { noise_variance: 1e-30, ..good }),
        Err(RegressionError::IllConditioned { inputs: 2, .. })
    ));
}
