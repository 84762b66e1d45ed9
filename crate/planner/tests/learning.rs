//! Learning: the bound never falls, bounds and budget hold, both methods agree, a warm start is cheaper, and
//! every degenerate problem has a named result.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use glam::DVec2;
use mapless::PlannerConfig;
use mapless::gp::bound::CollapsedBound;
use mapless::gp::hyperparameters::{Hyperparameters, RegressionError};
use mapless::gp::kernel::RationalQuadratic;
use mapless::gp::learning::{
    HyperparameterBounds, Learned, Learner, LearningConfig, LearningError, LearningMode, Optimiser, Stop,
};
use proptest::prelude::*;

const START: Hyperparameters = Hyperparameters {
    kernel: RationalQuadratic { variance: 1.0, length_scales_rad: [0.12, 0.04], alpha: 10.0 },
    noise_variance: 3.0,
};

const WIDE: HyperparameterBounds = HyperparameterBounds {
    variance_m2: [0.01, 1e3],
    azimuth_length_scale_rad: [0.01, 3.0],
    elevation_length_scale_rad: [0.01, 3.0],
    alpha: [0.1, 100.0],
    noise_variance_m2: [1e-3, 10.0],
};

/// A wavy surface with a little noise of its own, on a lattice of five rings like a scan's, and every
/// `stride`-th input.
fn scan(columns: u32, stride: usize) -> (Vec<DVec2>, Vec<f64>, Vec<DVec2>) {
    let mut state = 7_u32;
    let (inputs, targets): (Vec<DVec2>, Vec<f64>) = (0..columns * 5)
        .map(|k| {
            let (column, ring) = (k / 5, k % 5);
            let input = DVec2::new(f64::from(column) * 0.0175, f64::from(ring) * 0.035 - 0.26);
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f64::from(state >> 16) / 65_536.0 - 0.5;
            (input, libm::sin(6.0 * input.x) + 3.0 * libm::cos(9.0 * input.y) + 0.3 * noise)
        })
        .unzip();
    let inducing = inputs.iter().copied().step_by(stride).collect();
    (inputs, targets, inducing)
}

fn config(optimiser: Optimiser, evaluations_per_scan: u32, bounds: HyperparameterBounds) -> LearningConfig {
    let mode = LearningMode::EveryScan;
    LearningConfig { mode, optimiser, evaluations_per_scan, bounds, ..LearningConfig::default() }
}

fn is_within(learned: &Learned, bounds: &HyperparameterBounds) -> bool {
    let RationalQuadratic { variance, length_scales_rad: [azimuth, elevation], alpha } =
        learned.hyperparameters.kernel;
    let inside = |value: f64, [lowest, highest]: [f64; 2]| (lowest..=highest).contains(&value);
    inside(variance, bounds.variance_m2)
        && inside(azimuth, bounds.azimuth_length_scale_rad)
        && inside(elevation, bounds.elevation_length_scale_rad)
        && inside(alpha, bounds.alpha)
        && inside(learned.hyperparameters.noise_variance, bounds.noise_variance_m2)
}

#[test]
fn both_methods_reach_about_the_same_optimum() {
    let (inputs, targets, inducing) = scan(40, 3);
    let learn = |optimiser| {
        let config = config(optimiser, 2000, WIDE);
        Learner::new(config).learn(&inputs, &targets, &inducing, &START).unwrap()
    };
    let (lbfgs, adam) = (learn(Optimiser::Lbfgs), learn(Optimiser::Adam));
    for learned in [&lbfgs, &adam] {
        assert_ne!(learned.stop, Stop::Budget);
        assert!(learned.bound_after > learned.bound_before + 100.0 && is_within(learned, &WIDE));
    }
    assert!((lbfgs.bound_after - adam.bound_after).abs() < 0.1);
    assert!(lbfgs.evaluations < adam.evaluations);
    // The result is what the bound says of it.
    let again = CollapsedBound::new().evaluate(&inputs, &targets, &inducing, &lbfgs.hyperparameters).unwrap();
    assert!((again - lbfgs.bound_after).abs() < 1e-9 * again.abs());
}

#[test]
fn a_warm_start_needs_fewer_evaluations() {
    let (inputs, targets, inducing) = scan(40, 3);
    let mut learner = Learner::new(config(Optimiser::Lbfgs, 1000, WIDE));
    let cold = learner.learn(&inputs, &targets, &inducing, &START).unwrap();
    let (next_inputs, next_targets) = (&inputs[10..], &targets[10..]);
    let next_cold = learner.learn(next_inputs, next_targets, &inducing, &START).unwrap();
    let warm = learner.learn(next_inputs, next_targets, &inducing, &cold.hyperparameters).unwrap();
    assert!(2 * warm.evaluations < next_cold.evaluations);
    assert!((warm.bound_after - next_cold.bound_after).abs() < 0.1);
}

#[test]
fn moving_the_inducing_inputs_raises_the_bound_further() {
    let (inputs, targets, inducing) = scan(40, 17);
    let still = config(Optimiser::Lbfgs, 300, HyperparameterBounds::default());
    let moving = LearningConfig { learn_inducing_inputs: true, ..still };
    let learn = |config| Learner::new(config).learn(&inputs, &targets, &inducing, &START).unwrap();
    let (still, moving) = (learn(still), learn(moving));
    assert_eq!(still.inducing, inducing);
    assert!(moving.inducing.iter().zip(&inducing).any(|(a, b)| a.distance(*b) > 0.01));
    assert!(moving.bound_after > still.bound_after + 0.5, "{} {}", moving.bound_after, still.bound_after);
    let (low, high) = (inputs[0], inputs[inputs.len() - 1]);
    let margin = DVec2::splat(1e-12);
    assert!(moving.inducing.iter().all(|z| z.cmpge(low - margin).all() && z.cmple(high + margin).all()));
}

#[test]
fn an_isotropic_length_scale_stays_one() {
    let (inputs, targets, inducing) = scan(40, 3);
    let isotropic = LearningConfig { isotropic: true, ..config(Optimiser::Lbfgs, 50, WIDE) };
    let mut learner = Learner::new(isotropic);
    let kernel = RationalQuadratic { length_scales_rad: [0.05; 2], ..START.kernel };
    let start = Hyperparameters { kernel, ..START };
    let [azimuth, elevation] =
        learner.learn(&inputs, &targets, &inducing, &start).unwrap().hyperparameters.kernel.length_scales_rad;
    assert_eq!(azimuth.to_bits(), elevation.to_bits());
    assert!((azimuth - 0.05).abs() > 0.01);
    let error = learner.learn(&inputs, &targets, &inducing, &START).unwrap_err();
    assert_eq!(
        error.to_string(),
        "length_scales_rad = [0.12, 0.04]: expected two equal ones, as learning is isotropic"
    );
}

#[test]
fn equal_bounds_hold_a_hyperparameter_to_the_bit() {
    let (inputs, targets, inducing) = scan(20, 3);
    let bounds =
        HyperparameterBounds { alpha: [10.0; 2], noise_variance_m2: [START.noise_variance; 2], ..WIDE };
    let learned = Learner::new(config(Optimiser::Lbfgs, 50, bounds))
        .learn(&inputs, &targets, &inducing, &START)
        .unwrap()
        .hyperparameters;
    assert_eq!(learned.kernel.alpha.to_bits(), 10.0_f64.to_bits());
    assert_eq!(learned.noise_variance.to_bits(), START.noise_variance.to_bits());
    assert!((learned.kernel.variance - 1.0).abs() > 0.1);
}

#[test]
fn degenerate_problems_have_a_named_result() {
    let point = DVec2::new(0.3, -0.1);
    let line: Vec<DVec2> = (0..30).map(|k| DVec2::new(f64::from(k) * 0.01, 0.0)).collect();
    let problems = [
        ("one point", vec![point], vec![2.0], vec![point]),
        ("one point many times", vec![point; 20], vec![2.0; 20], vec![point; 20]),
        ("contradicting duplicates", vec![point; 2], vec![-1.0, 1.0], vec![point; 2]),
        ("constant targets", line.clone(), vec![3.0; 30], line.clone()),
        ("zero targets", line.clone(), vec![0.0; 30], line.clone()),
    ];
    for optimiser in [Optimiser::Lbfgs, Optimiser::Adam] {
        for learn_inducing_inputs in [false, true] {
            for (name, inputs, targets, inducing) in &problems {
                let config = LearningConfig { learn_inducing_inputs, ..config(optimiser, 400, WIDE) };
                let learned = Learner::new(config).learn(inputs, targets, inducing, &START).unwrap();
                let what = format!("{name}, {optimiser:?}: {learned:?}");
                assert!(learned.bound_after >= learned.bound_before, "{what}");
                assert!(is_within(&learned, &WIDE), "{what}");
                assert!(learned.inducing.iter().all(|z| z.is_finite()), "{what}");
                if optimiser == Optimiser::Lbfgs {
                    assert_ne!(learned.stop, Stop::Budget, "{what}");
                }
            }
        }
    }
}

#[test]
fn a_start_that_cannot_be_used_is_named() {
    let (inputs, targets, inducing) = scan(10, 3);
    let mut learner = Learner::new(config(Optimiser::Lbfgs, 10, HyperparameterBounds::default()));
    let error = learner
        .learn(&inputs, &targets, &inducing, &Hyperparameters { noise_variance: 1e4, ..START })
        .unwrap_err();
    assert!(matches!(error, LearningError::OutsideBounds { name: "noise_variance", .. }));
    assert!(error.to_string().starts_with("noise_variance = 10000: expected a start between "), "{error}");
    let nan =
        learner.learn(&inputs, &targets, &inducing, &Hyperparameters { noise_variance: f64::NAN, ..START });
    assert!(matches!(nan, Err(LearningError::OutsideBounds { name: "noise_variance", .. })));
    assert_eq!(
        learner.learn(&[], &[], &inducing, &START),
        Err(LearningError::Regression(RegressionError::NoInputs))
    );
}

#[test]
fn both_presets_start_within_their_bounds() {
    let (inputs, targets, inducing) = scan(10, 3);
    for (planner, learning) in [
        (PlannerConfig::default(), LearningConfig::default()),
        (PlannerConfig::paper(), LearningConfig::paper()),
    ] {
        assert_eq!(learning.validate("learning"), Ok(()));
        let perception = planner.perception;
        let start =
            Hyperparameters { kernel: perception.kernel, noise_variance: perception.noise_variance_m2 };
        let learned = Learner::new(learning).learn(&inputs, &targets, &inducing, &start).unwrap();
        assert!(learned.bound_after > learned.bound_before && is_within(&learned, &learning.bounds));
    }
}

#[test]
fn a_configuration_that_makes_no_sense_is_named() {
    let good = LearningConfig::default();
    assert_eq!(good.validate("learning"), Ok(()));
    let error = |config: LearningConfig| config.validate("learning").unwrap_err().to_string();
    assert_eq!(
        error(LearningConfig { evaluations_per_scan: 1, ..good }),
        "learning.evaluations_per_scan = 1: expected at least 2"
    );
    let alpha = [2.0, 1.0];
    assert_eq!(
        error(LearningConfig { bounds: HyperparameterBounds { alpha, ..good.bounds }, ..good }),
        "learning.bounds.alpha = [2, 1]: expected two positive numbers, the lower one first"
    );
    let apart = HyperparameterBounds { azimuth_length_scale_rad: [0.5, 0.6], ..good.bounds };
    assert!(
        error(LearningConfig { isotropic: true, bounds: apart, ..good })
            .starts_with("learning.isotropic = true: ")
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_bound_never_falls_and_bounds_and_budget_hold(
        columns in 1..12_u32, stride in 1..12_usize, budget in 2..25_u32, noise in 2.5..4.0_f64,
        learn_inducing_inputs: bool, first: bool,
    ) {
        let (inputs, targets, inducing) = scan(columns, stride);
        let optimiser = if first { Optimiser::Lbfgs } else { Optimiser::Adam };
        let bounds = HyperparameterBounds::default();
        let config = LearningConfig { learn_inducing_inputs, ..config(optimiser, budget, bounds) };
        let start = Hyperparameters { noise_variance: noise, ..START };
        let mut learner = Learner::new(config);
        let learned = learner.learn(&inputs, &targets, &inducing, &start).unwrap();
        prop_assert!(learned.bound_after >= learned.bound_before);
        prop_assert!(learned.evaluations <= budget && is_within(&learned, &bounds));
        // What was learned can start the next scan.
        let next = learner.learn(&inputs, &targets, &learned.inducing, &learned.hyperparameters).unwrap();
        prop_assert!(next.bound_after >= learned.bound_after - 1e-9 * learned.bound_after.abs());
    }
}
