//! Rows for tests.

use std::path::PathBuf;

use crate::report::Results;
use crate::results::{Manifest, ManifestRoute};
use crate::row::TrialRow;

/// A row without metrics.
pub(crate) fn row(planner: &str, route: &str, truth: &str, seed: u64, outcome: &str) -> TrialRow {
    TrialRow {
        id: format!("{planner}-{route}-{truth}-{seed}"),
        campaign: "c".to_owned(),
        planner: planner.to_owned(),
        route: route.to_owned(),
        truth: truth.to_owned(),
        parameters: String::new(),
        reality: String::new(),
        seed,
        outcome: outcome.to_owned(),
        stop_reason: None,
        error: None,
        distance_m: None,
        max_abs_roll_rad: None,
        max_abs_pitch_rad: None,
        mean_vibration_rad_s: None,
        mean_elevation_rate_cm_s: None,
        curvature_change_rad_m: None,
        mean_abs_roll_rad: None,
        mean_abs_pitch_rad: None,
        longest_standstill_s: None,
        sim_time_s: Some(1.5),
        ticks: Some(15),
        straight_m: 2.0,
        oracle_length_m: None,
        digest: Some("0f".to_owned()),
        configuration: "{\"a\":1}".to_owned(),
    }
}

/// A campaign of these planners and routes with these rows.
pub(crate) fn results(planners: &[&str], routes: &[&str], rows: Vec<TrialRow>) -> Results {
    let route = |name: &&str| ManifestRoute { name: (*name).to_owned(), file: format!("{name}.toml") };
    Results {
        folder: PathBuf::new(),
        manifest: Manifest {
            name: "test".to_owned(),
            file: "test.toml".to_owned(),
            hash: "c".to_owned(),
            planners: planners.iter().map(|name| (*name).to_owned()).collect(),
            routes: routes.iter().map(route).collect(),
            seeds: vec![1],
            realities: Vec::new(),
            benchmark: None,
        },
        rows,
    }
}
