//! What learning does to the skyline: within the default bounds the edge of the variance surface stays just
//! above the returns, and without bounds it leaves them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use glam::DVec2;
use mapless::PlannerConfig;
use mapless::gp::hyperparameters::Hyperparameters;
use mapless::gp::learning::{HyperparameterBounds, Learner, LearningConfig, Stop};
use mapless::gp::sparse::SparseGp;
use mapless_tests::{gpflow, learned_bits};

/// Mean height of the edge, in degrees, over the highest return of a column, at the default threshold.
fn edge_deg(inputs: &[DVec2], targets: &[f64], inducing: &[DVec2], hyperparameters: &Hyperparameters) -> f64 {
    let threshold = PlannerConfig::default().perception.variance_threshold * hyperparameters.kernel.variance;
    let mut gp = SparseGp::new(hyperparameters.kernel, hyperparameters.noise_variance);
    gp.fit(inputs, targets, inducing).unwrap();
    let mut columns: Vec<f64> = inputs.iter().map(|input| input.x).collect();
    columns.sort_by(f64::total_cmp);
    columns.dedup();
    let step = 0.1_f64.to_radians();
    let heights: Vec<f64> = columns
        .iter()
        .filter_map(|&azimuth| {
            let in_column = inputs.iter().filter(|input| input.x.to_bits() == azimuth.to_bits());
            let top = in_column.map(|input| input.y).fold(f64::NEG_INFINITY, f64::max);
            let queries: Vec<DVec2> =
                (-20..300).map(|k| DVec2::new(azimuth, top + step * f64::from(k))).collect();
            let (mut mean, mut variance) = (vec![0.0; queries.len()], vec![0.0; queries.len()]);
            gp.predict(&queries, &mut mean, &mut variance);
            // Beside the inducing inputs of the scene nothing is below the threshold.
            let row = variance.iter().rposition(|v| *v < threshold)?;
            Some((queries[row].y - top).to_degrees())
        })
        .collect();
    heights.iter().sum::<f64>() / heights.len() as f64
}

#[test]
fn bounds_keep_the_edge_where_the_returns_are() {
    let gpflow::Problem { inputs, targets, inducing } = gpflow::problem().unwrap();
    let perception = PlannerConfig::default().perception;
    let start = Hyperparameters { kernel: perception.kernel, noise_variance: perception.noise_variance_m2 };
    let learn = |start: &Hyperparameters, bounds| {
        let config = LearningConfig { bounds, evaluations_per_scan: 60, ..LearningConfig::default() };
        let learned = Learner::new(config).learn(&inputs, &targets, &inducing, start).unwrap();
        assert_eq!(learned.stop, Stop::Converged);
        edge_deg(&inputs, &targets, &inducing, &learned.hyperparameters)
    };

    let fixed = edge_deg(&inputs, &targets, &inducing, &start);
    let bounded = learn(&start, HyperparameterBounds::default());
    let anything = [1e-4, 1e4];
    // With less noise to begin with, so that the climb goes the usual way: up in variance and length-scales.
    let little_noise = Hyperparameters { noise_variance: 1.0, ..start };
    let unbounded = learn(
        &little_noise,
        HyperparameterBounds {
            variance_m2: anything,
            azimuth_length_scale_rad: anything,
            elevation_length_scale_rad: anything,
            alpha: [0.1, 1e3],
            noise_variance_m2: anything,
        },
    );
    println!(
        "edge over the highest return: fixed {fixed:.2}°, bounded {bounded:.2}°, unbounded {unbounded:.2}°"
    );
    assert!((fixed - bounded).abs() < 0.75, "fixed {fixed}°, bounded {bounded}°");
    assert!(unbounded > bounded + 2.0, "bounded {bounded}°, unbounded {unbounded}°");
}

/// After a change that is meant to change the bits, the failure says what to record.
#[test]
fn learning_gives_the_recorded_bits() {
    assert_eq!(learned_bits::digest().unwrap(), learned_bits::RECORDED);
}
