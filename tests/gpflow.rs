//! gpflow's numbers (version 2.9.2, float64) beside ours: the fixtures' form and the comparison.

use glam::DVec2;
use mapless::kernel::RationalQuadratic;
use mapless::sparse_gp::SparseGp;
use serde::Deserialize;

/// One scene with gpflow's posterior for several hyperparameters.
#[derive(Debug, Deserialize)]
struct Scene {
    scene: String,
    #[serde(rename = "X")]
    inputs: Vec<[f64; 2]>,
    #[serde(rename = "y")]
    targets: Vec<f64>,
    #[serde(rename = "Z")]
    inducing: Vec<[f64; 2]>,
    #[serde(rename = "XS")]
    queries: Vec<[f64; 2]>,
    cases: Vec<Case>,
}

#[derive(Debug, Deserialize)]
struct Case {
    label: String,
    hyper: Hyperparameters,
    #[serde(rename = "cond_Kuu")]
    condition: f64,
    mean: Vec<f64>,
    #[serde(rename = "var_f")]
    variance: Vec<f64>,
}

#[derive(Debug, Deserialize)]
struct Hyperparameters {
    variance: f64,
    lengthscales: LengthScales,
    alpha: f64,
    noise: f64,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
enum LengthScales {
    Isotropic(f64),
    PerAxis([f64; 2]),
}

impl LengthScales {
    fn per_axis(self) -> [f64; 2] {
        match self {
            Self::Isotropic(length_scale) => [length_scale; 2],
            Self::PerAxis(length_scales) => length_scales,
        }
    }
}

/// Kernel values between two sets of points.
#[derive(Debug, Deserialize)]
struct Kernels {
    #[serde(rename = "U")]
    left: Vec<[f64; 2]>,
    #[serde(rename = "V")]
    right: Vec<[f64; 2]>,
    cases: Vec<KernelCase>,
}

#[derive(Debug, Deserialize)]
struct KernelCase {
    variance: f64,
    lengthscales: LengthScales,
    alpha: f64,
    #[serde(rename = "K")]
    values: Vec<Vec<f64>>,
}

/// The fixtures in the repository: one scene, thinned, and the kernel values.
pub const SCENE: &str = include_str!("gpflow/crest.json");
/// See [`SCENE`].
pub const KERNELS: &str = include_str!("gpflow/rq_kernel.json");

/// Compares one fixture file of either form, given as its text; gives the number of cases compared.
///
/// # Errors
/// Says which case differs and by how much, or why the text is not a fixture.
pub fn compare(text: &str) -> Result<usize, String> {
    let value: serde_json::Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
    if value.get("XS").is_some() {
        compare_scene(&serde_json::from_value(value).map_err(|e| e.to_string())?)
    } else if value.get("U").is_some() {
        compare_kernels(&serde_json::from_value(value).map_err(|e| e.to_string())?)
    } else {
        Ok(0)
    }
}

fn compare_scene(scene: &Scene) -> Result<usize, String> {
    let points = |list: &[[f64; 2]]| -> Vec<DVec2> { list.iter().copied().map(DVec2::from_array).collect() };
    let (inputs, inducing, queries) =
        (points(&scene.inputs), points(&scene.inducing), points(&scene.queries));
    for case in &scene.cases {
        let kernel = RationalQuadratic {
            variance: case.hyper.variance,
            length_scales_rad: case.hyper.lengthscales.per_axis(),
            alpha: case.hyper.alpha,
        };
        let mut gp = SparseGp::new(kernel, case.hyper.noise);
        gp.fit(&inputs, &scene.targets, &inducing).map_err(|e| e.to_string())?;
        let (mut mean, mut variance) = (vec![0.0; queries.len()], vec![0.0; queries.len()]);
        gp.predict(&queries, &mut mean, &mut variance);

        // 1e-8, and no better than the conditioning of the inducing covariance allows any float64 program.
        let relative = 1e-8_f64.max(1e-15 * case.condition);
        let scale = 1.0 + case.mean.iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        let place = format!("{} / {}", scene.scene, case.label);
        within(&place, "mean", &mean, &case.mean, relative * scale)?;
        within(&place, "variance", &variance, &case.variance, relative * kernel.variance.max(1.0))?;
    }
    Ok(scene.cases.len())
}

fn compare_kernels(kernels: &Kernels) -> Result<usize, String> {
    for case in &kernels.cases {
        let kernel = RationalQuadratic {
            variance: case.variance,
            length_scales_rad: case.lengthscales.per_axis(),
            alpha: case.alpha,
        };
        let place = format!("kernel with alpha {}", case.alpha);
        for (left, row) in kernels.left.iter().zip(&case.values) {
            let ours: Vec<f64> = kernels
                .right
                .iter()
                .map(|right| kernel.covariance(DVec2::from_array(*left), DVec2::from_array(*right)))
                .collect();
            within(&place, "covariance", &ours, row, 1e-11 * case.variance)?;
        }
    }
    Ok(kernels.cases.len())
}

fn within(place: &str, what: &str, ours: &[f64], theirs: &[f64], tolerance: f64) -> Result<(), String> {
    if ours.len() != theirs.len() {
        return Err(format!("{place}: {} values of {what}, gpflow has {}", ours.len(), theirs.len()));
    }
    for (index, (a, b)) in ours.iter().zip(theirs).enumerate() {
        // NaN is never within.
        if (a - b).abs().partial_cmp(&tolerance).is_none_or(std::cmp::Ordering::is_gt) {
            return Err(format!(
                "{place}: {what}[{index}] = {a:e}, gpflow has {b:e} (tolerance {tolerance:e})"
            ));
        }
    }
    Ok(())
}
