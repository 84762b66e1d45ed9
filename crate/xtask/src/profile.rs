//! The elevation profile against the truth, for several settings of the perception, written up in
//! `docs/PROFILE.md`.

use std::collections::BTreeMap;
use std::env::consts::EXE_EXTENSION;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, ensure};
use xshell::{Shell, cmd};

use crate::setup;
use crate::work::run_all;
use mapless_figures::plot::{Line, Plot, Scale};

const REPORT: &str = "docs/PROFILE.md";
const FIGURE: &str = "docs/profile.svg";
const TERRAINS: [&str; 5] = ["cht", "ml", "vta", "gsb", "ht"];
/// Terrains made of noise alone: seed, height of the hills and distance between them in metres.
const FRESH: [(u64, f64, f64); 5] =
    [(11, 2.0, 16.0), (12, 3.0, 18.0), (13, 4.5, 22.0), (14, 1.5, 9.0), (15, 6.0, 30.0)];
/// The thresholds of the figure.
const THRESHOLDS: [f64; 9] = [0.22, 0.24, 0.26, 0.28, 0.3, 0.32, 0.34, 0.36, 0.38];
const DEFAULT_THRESHOLD: f64 = 0.3;

/// A setting of the perception to measure.
#[derive(Clone, Debug, PartialEq)]
struct Setting {
    name: String,
    preset: &'static str,
    /// The `[planner.perception]` section of the scenario.
    perception: String,
}

/// What `mapless profile --json` prints.
#[derive(Clone, Debug, Default, serde::Deserialize)]
struct Accuracy {
    poses: usize,
    mean_abs_error_rad: f64,
    bias_rad: f64,
    worst_pose_error_rad: f64,
    confusion: [[usize; 3]; 3],
    holes: usize,
    no_perception: usize,
}

/// One measurement: which setting on which terrain.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Job {
    setting: usize,
    terrain: String,
}

/// Measures the presets at `poses` poses on each terrain and other settings at as many, and writes the report
/// with its figure.
pub(crate) fn run(sh: &Shell, poses: usize) -> anyhow::Result<()> {
    cmd!(sh, "cargo build --release --package mapless-cli").run()?;
    let target = setup::target_dir(sh);
    let program = target.join("release/mapless").with_extension(EXE_EXTENSION);
    let folder = target.join("profile");
    sh.create_dir(&folder)?;
    let terrains = terrains(sh, &folder)?;
    let settings = settings();
    let mut jobs = Vec::new();
    for setting in 0..settings.len() {
        jobs.extend(terrains.keys().map(|terrain| Job { setting, terrain: terrain.clone() }));
    }
    let measured = run_all(
        jobs,
        |job| {
            measure(&program, &folder, &settings[job.setting], &job.terrain, &terrains[&job.terrain], poses)
        },
        |job, accuracy: &Accuracy| {
            let name = &settings[job.setting].name;
            format!("{name} on {}: {:.3}°", job.terrain, accuracy.mean_abs_error_rad.to_degrees())
        },
    )?;
    sh.write_file(REPORT, report(&settings, &measured, poses)?)?;
    sh.write_file(FIGURE, figure(&settings, &measured))?;
    println!("{REPORT} and {FIGURE} written");
    Ok(())
}

/// The terrains by name: those of the repository, and fresh ones.
fn terrains(sh: &Shell, folder: &Path) -> anyhow::Result<BTreeMap<String, PathBuf>> {
    let own = sh.current_dir().join("terrains");
    let mut files: BTreeMap<String, PathBuf> =
        TERRAINS.iter().map(|name| ((*name).to_owned(), own.join(name).with_extension("toml"))).collect();
    for (seed, height_m, wavelength_m) in FRESH {
        let name = format!("fresh-{seed}");
        let path = folder.join(&name).with_extension("toml");
        sh.write_file(
            &path,
            format!(
                "name = \"{name}\"\ndescription = \"Noise.\"\nsize_m = [60.0, 60.0]\ncell_m = 0.2\nseed = {seed}\n\n\
                 [[noise]]\namplitude_m = {height_m:.1}\nwavelength_m = {wavelength_m:.1}\noctaves = 4\n"
            ),
        )?;
        files.insert(name, path);
    }
    Ok(files)
}

fn settings() -> Vec<Setting> {
    let preset = |preset| Setting { name: format!("preset `{preset}`"), preset, perception: String::new() };
    let other = |name: &str, lines: &str| Setting {
        name: name.to_owned(),
        preset: "default",
        perception: lines.to_owned(),
    };
    let kernel = |azimuth: f64, elevation: f64, noise: f64, threshold: f64| {
        other(
            &format!("{azimuth}, {elevation} rad; noise {noise} m²; V > {threshold}"),
            &format!(
                "kernel = {{ length_scales_rad = [{azimuth}, {elevation}] }}\nnoise_variance_m2 = {noise:?}\n\
                 variance_threshold = {threshold:?}\n"
            ),
        )
    };
    let mut settings = vec![
        preset("default"),
        preset("paper"),
        kernel(0.1, 0.025, 0.01, 0.7),
        kernel(0.15, 0.05, 1.0, 0.2),
        kernel(0.12, 0.04, 1.0, 0.2),
        kernel(0.15, 0.035, 3.0, 0.32),
        kernel(0.18, 0.04, 4.0, 0.31),
        other("default, spacing 0.6", "inducing_spacing_length_scales = 0.6\n"),
        other("default, spacing 1.3", "inducing_spacing_length_scales = 1.3\n"),
        other("default, farthest points", "inducing_inputs = \"farthest_points\"\n"),
    ];
    settings.extend(
        THRESHOLDS
            .iter()
            .map(|v| other(&format!("default, V > {v}"), &format!("variance_threshold = {v:?}\n"))),
    );
    settings
}

fn measure(
    program: &Path,
    folder: &Path,
    setting: &Setting,
    terrain: &str,
    recipe: &Path,
    poses: usize,
) -> anyhow::Result<Accuracy> {
    let slug: String =
        setting.name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let scenario = folder.join(format!("{slug}-on-{terrain}.scenario.toml"));
    let text = format!(
        "terrain = '{}'\nstart = [10.0, 10.0, 0.0]\ngoal = [20.0, 20.0]\nseed = 1\n\n[planner.perception]\n{}",
        recipe.display(),
        setting.perception
    );
    std::fs::write(&scenario, text).with_context(|| scenario.display().to_string())?;
    let output = Command::new(program)
        .arg("profile")
        .arg(&scenario)
        .args(["--json", "--planner", setting.preset, "--poses", &poses.to_string()])
        .output()
        .with_context(|| program.display().to_string())?;
    ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).context("output of mapless profile --json")
}

/// Several terrains together, each with the same weight for each column.
fn together(all: &[&Accuracy]) -> Accuracy {
    let mut sum = Accuracy::default();
    let mut columns = 0.0;
    for one in all {
        let weight = one.confusion[0][0] as f64;
        columns += weight;
        sum.poses += one.poses;
        sum.holes += one.holes;
        sum.no_perception += one.no_perception;
        sum.mean_abs_error_rad += weight * one.mean_abs_error_rad;
        sum.bias_rad += weight * one.bias_rad;
        sum.worst_pose_error_rad = sum.worst_pose_error_rad.max(one.worst_pose_error_rad);
        for (row, other) in sum.confusion.iter_mut().zip(one.confusion) {
            for (count, more) in row.iter_mut().zip(other) {
                *count += more;
            }
        }
    }
    sum.mean_abs_error_rad /= columns;
    sum.bias_rad /= columns;
    sum
}

fn row(name: &str, accuracy: &Accuracy) -> String {
    format!(
        "| {name} | {:.3} | {:+.3} | {:.2} | {} | {} |",
        accuracy.mean_abs_error_rad.to_degrees(),
        accuracy.bias_rad.to_degrees(),
        accuracy.worst_pose_error_rad.to_degrees(),
        accuracy.holes,
        accuracy.no_perception
    )
}

const HEADINGS: &str = "mean abs. error, ° | bias, ° | worst pose, ° | holes | no perception |\n\
                        |---|---:|---:|---:|---:|---:|";

fn of_setting(measured: &BTreeMap<Job, Accuracy>, setting: usize) -> Accuracy {
    let all: Vec<&Accuracy> =
        measured.iter().filter(|(job, _)| job.setting == setting).map(|(_, accuracy)| accuracy).collect();
    together(&all)
}

fn report(settings: &[Setting], measured: &BTreeMap<Job, Accuracy>, poses: usize) -> anyhow::Result<String> {
    let mut text = format!(
        "# The elevation profile against the truth\n\n\
         Written by `cargo xtask profile --poses {poses}`: {poses} random poses, at which \
         the Husky can stand within its limits, on each of the five terrains and of five that are made of noise alone; range noise 0.02 m. The truth is the highest direction, at each of the 360 \
         azimuths, in which there is ground within 7 m of the sensor. A hole is ground taken for unknown between columns that were seen.\n\n\
         ## Preset `default`, terrain by terrain\n\n| terrain | {HEADINGS}\n"
    );
    for (job, accuracy) in measured.iter().filter(|(job, _)| job.setting == 0) {
        writeln!(text, "{}", row(&job.terrain, accuracy))?;
    }
    let whole = of_setting(measured, 0);
    writeln!(text, "{}", row("**all**", &whole))?;
    text.push_str(
        "\nColumns by truth (rows) and as perceived:\n\n| | ground | unknown | wall |\n|---|---:|---:|---:|\n",
    );
    for (name, [ground, unknown, wall]) in ["ground", "unknown", "wall"].iter().zip(whole.confusion) {
        writeln!(text, "| {name} | {ground} | {unknown} | {wall} |")?;
    }
    write!(
        text,
        "\n## Other settings, all terrains\n\nLength-scales are of azimuth and elevation; the variance is 1 m² and α is 10. \
         Settings other than the presets have their inducing inputs on the lattice.\n\n| setting | {HEADINGS}\n"
    )?;
    for (index, setting) in settings.iter().enumerate() {
        writeln!(text, "{}", row(&setting.name, &of_setting(measured, index)))?;
    }
    text.push_str("\n![Error and bias over the threshold](profile.svg)\n");
    Ok(text)
}

/// Error and bias of the default over its threshold.
fn figure(settings: &[Setting], measured: &BTreeMap<Job, Accuracy>) -> String {
    let first = settings.len() - THRESHOLDS.len();
    let line = |name: &str, value: fn(&Accuracy) -> f64| Line {
        name: name.to_owned(),
        points: THRESHOLDS
            .iter()
            .enumerate()
            .map(|(index, &v)| (v, value(&of_setting(measured, first + index)).to_degrees()))
            .collect(),
    };
    Plot {
        x_label: "threshold V_th, share of the signal variance".to_owned(),
        y_label: "elevation, °".to_owned(),
        lines: vec![
            line("worst pose", |a| a.worst_pose_error_rad),
            line("mean absolute error", |a| a.mean_abs_error_rad),
            line("bias", |a| a.bias_rad),
        ],
        mark_x: Some(DEFAULT_THRESHOLD),
        scale: Scale::Linear,
    }
    .svg()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accuracy(error_rad: f64, bias_rad: f64, columns: usize) -> Accuracy {
        Accuracy {
            poses: 1,
            mean_abs_error_rad: error_rad,
            bias_rad,
            worst_pose_error_rad: error_rad,
            confusion: [[columns, 1, 0], [0, 2, 0], [0, 0, 3]],
            holes: 1,
            no_perception: 0,
        }
    }

    #[test]
    fn terrains_count_by_their_columns() {
        let sum = together(&[&accuracy(0.1, 0.1, 300), &accuracy(0.2, -0.1, 100)]);
        assert!((sum.mean_abs_error_rad - 0.125).abs() < 1e-12);
        assert!((sum.bias_rad - 0.05).abs() < 1e-12);
        assert!((sum.worst_pose_error_rad - 0.2).abs() < 1e-12);
        assert_eq!((sum.poses, sum.holes, sum.confusion[0]), (2, 2, [400, 2, 0]));
    }

    #[test]
    fn the_report_has_every_terrain_and_setting() {
        let settings = settings();
        let mut measured = BTreeMap::new();
        for setting in 0..settings.len() {
            for terrain in TERRAINS {
                measured.insert(Job { setting, terrain: terrain.to_owned() }, accuracy(0.005, 0.001, 10));
            }
        }
        let report = report(&settings, &measured, 7).unwrap();
        for name in TERRAINS.into_iter().chain(settings.iter().map(|setting| setting.name.as_str())) {
            assert!(report.contains(&format!("| {name} | 0.286 | +0.057 | 0.29 |")), "{name}\n{report}");
        }
        assert!(figure(&settings, &measured).contains("worst pose"));
    }
}
