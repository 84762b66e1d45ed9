//! Settings of VGF beside each other, on scenario files: what `VgfConfig::tuned` was chosen from.
//!
//! ```sh
//! cargo run --release -p mapless-baselines --example settings terrains/scenarios/*.toml
//! ```

use std::path::Path;
use std::process::ExitCode;

use mapless_baselines::vgf::{Vgf, VgfConfig};
use mapless_baselines::{NavigatorKind, RouteNavigator};
use mapless_trials::{LoadedScenario, Trial};

/// The settings tried, each with its name.
fn settings() -> [(&'static str, VgfConfig); 9] {
    let (published, tuned) = (VgfConfig::published(), VgfConfig::tuned());
    let keep_off = tuned.travel;
    [
        ("published", published),
        ("published, filter off", VgfConfig { filter_slope_rad: core::f64::consts::FRAC_PI_2, ..published }),
        ("published, smoothed", VgfConfig { smoothing_m: tuned.smoothing_m, ..published }),
        (
            "penalty in the price",
            VgfConfig { smoothing_m: 0.0, slope_price: 0.0, travel: published.travel, ..tuned },
        ),
        ("... and slopes", VgfConfig { smoothing_m: 0.0, travel: published.travel, ..tuned }),
        ("... and refused ground", VgfConfig { smoothing_m: 0.0, travel: keep_off, ..tuned }),
        ("tuned: ... and smoothed", tuned),
        ("tuned, slopes × 1/4", VgfConfig { slope_price: tuned.slope_price / 4.0, ..tuned }),
        ("tuned, slopes × 4", VgfConfig { slope_price: tuned.slope_price * 4.0, ..tuned }),
    ]
}

fn run(file: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let LoadedScenario { scenario, terrain } = LoadedScenario::read(file)?;
    let config = NavigatorKind::Vgf.planner_config(&scenario)?;
    for (name, setting) in settings() {
        let navigator = RouteNavigator::new(Vgf::new(&terrain.field, &setting)?, &config);
        let mut trial = Trial::with_navigator(terrain.field.clone(), &scenario, navigator, scenario.seed)?;
        // A planner with a map needs no scans.
        let outcome = loop {
            trial.plan();
            if let Some(outcome) = trial.act() {
                break outcome.name();
            }
        };
        let metrics = trial.metrics();
        println!(
            "{:8} {name:24} {outcome:11} {:6.1} m, |roll| {:.3} rad, |pitch| {:.3} rad, {:.3} rad/s, {:5.2} cm/s, {:.2} rad/m",
            file.file_stem().unwrap_or_default().to_string_lossy(),
            metrics.distance_m,
            metrics.max_abs_roll_rad,
            metrics.max_abs_pitch_rad,
            metrics.mean_vibration_rad_s,
            metrics.mean_elevation_rate_cm_s,
            metrics.curvature_change_rad_m
        );
    }
    Ok(())
}

fn main() -> ExitCode {
    for file in std::env::args_os().skip(1) {
        if let Err(error) = run(Path::new(&file)) {
            eprintln!("error: {error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
