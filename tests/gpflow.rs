//! gpflow's numbers (version 2.9.2, float64) beside ours: the fixtures' form and the comparison.

use glam::DVec2;
use mapless::gp::bound::CollapsedBound;
use mapless::gp::exact::ExactGp;
use mapless::gp::hyperparameters::{Hyperparameters as Ours, LogGradient};
use mapless::gp::kernel::RationalQuadratic;
use mapless::gp::sparse::SparseGp;
use serde::Deserialize;

/// One scene with gpflow's posterior and bound for several hyperparameters, and its exact process on a part
/// of the inputs.
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
    #[serde(rename = "gpr")]
    exact: ExactCase,
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
    elbo: f64,
    grad_log: Gradient,
    #[serde(rename = "grad_Z")]
    inducing_gradient: Vec<[f64; 2]>,
}

/// The exact process on the inputs `idx`.
#[derive(Debug, Deserialize)]
struct ExactCase {
    idx: Vec<usize>,
    hyper: Hyperparameters,
    log_marginal_likelihood: f64,
    grad_log: Gradient,
    mean: Vec<f64>,
    #[serde(rename = "var_f")]
    variance: Vec<f64>,
}

/// With respect to log-hyperparameters.
#[derive(Debug, Deserialize)]
struct Gradient {
    variance: f64,
    lengthscales: OneOrMore,
    alpha: f64,
    noise: f64,
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum OneOrMore {
    One(f64),
    More(Vec<f64>),
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

impl Hyperparameters {
    fn ours(&self) -> Ours {
        let kernel = RationalQuadratic {
            variance: self.variance,
            length_scales_rad: self.lengthscales.per_axis(),
            alpha: self.alpha,
        };
        Ours { kernel, noise_variance: self.noise }
    }
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

/// A regression problem: (azimuth, elevation) in radians, occupancy in metres.
#[derive(Debug)]
pub struct Problem {
    /// Training inputs.
    pub inputs: Vec<DVec2>,
    /// Their targets.
    pub targets: Vec<f64>,
    /// Inducing inputs.
    pub inducing: Vec<DVec2>,
}

/// The problem of [`SCENE`].
///
/// # Errors
/// Says why the text is not a scene.
pub fn problem() -> Result<Problem, String> {
    let scene: Scene = serde_json::from_str(SCENE).map_err(|e| e.to_string())?;
    let (inputs, inducing) = (points(&scene.inputs), points(&scene.inducing));
    Ok(Problem { inputs, targets: scene.targets, inducing })
}

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

fn points(list: &[[f64; 2]]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from_array).collect()
}

fn compare_scene(scene: &Scene) -> Result<usize, String> {
    let (inputs, inducing, queries) =
        (points(&scene.inputs), points(&scene.inducing), points(&scene.queries));
    for case in &scene.cases {
        let place = format!("{} / {}", scene.scene, case.label);
        let hyperparameters = case.hyper.ours();
        let kernel = hyperparameters.kernel;
        let mut gp = SparseGp::new(kernel, hyperparameters.noise_variance);
        gp.fit(&inputs, &scene.targets, &inducing).map_err(|e| e.to_string())?;
        let (mut mean, mut variance) = (vec![0.0; queries.len()], vec![0.0; queries.len()]);
        gp.predict(&queries, &mut mean, &mut variance);

        // 1e-8, and no better than the conditioning of the inducing covariance allows any float64 program.
        let relative = 1e-8_f64.max(1e-15 * case.condition);
        let scale = 1.0 + case.mean.iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        within(&place, "mean", &mean, &case.mean, relative * scale)?;
        within(&place, "variance", &variance, &case.variance, relative * kernel.variance.max(1.0))?;

        let mut bound = CollapsedBound::new();
        let elbo = bound
            .evaluate(&inputs, &scene.targets, &inducing, &hyperparameters)
            .map_err(|e| format!("{place}: {e}"))?;
        compare_bound(&place, case, elbo, &bound)?;
    }
    compare_exact(scene, &inputs, &queries)?;
    Ok(scene.cases.len() + 1)
}

/// The bound and its gradients; a condition above 1e9 leaves gpflow four digits of the bound and two of the
/// gradient, as 80-bit arithmetic shows.
fn compare_bound(place: &str, case: &Case, elbo: f64, bound: &CollapsedBound) -> Result<(), String> {
    let lost = case.condition > 1e9;
    let relative = if lost { 1e-4 } else { 1e-8 };
    within(place, "bound", &[elbo], &[case.elbo], relative * case.elbo.abs())?;
    let (mut ours, mut theirs) = (gradient_of(&case.grad_log, bound.gradient()), case.grad_log.list());
    if lost {
        // And none of the derivative with respect to the variance.
        ours[0] = 0.0;
        theirs[0] = 0.0;
    }
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let relative = if lost { 1e-2 } else { 1e-6 };
    within(place, "log gradient", &ours, &theirs, relative * largest(&theirs))?;
    let ours: Vec<f64> = bound.inducing_gradient().iter().flat_map(|g| g.to_array()).collect();
    let theirs: Vec<f64> = case.inducing_gradient.iter().flatten().copied().collect();
    within(place, "gradient of Z", &ours, &theirs, 10.0 * relative * largest(&theirs))
}

fn compare_exact(scene: &Scene, inputs: &[DVec2], queries: &[DVec2]) -> Result<(), String> {
    let exact = &scene.exact;
    let inputs: Vec<DVec2> = exact.idx.iter().map(|&index| inputs[index]).collect();
    let targets: Vec<f64> = exact.idx.iter().map(|&index| scene.targets[index]).collect();
    let place = format!("{} / exact", scene.scene);
    let gp = ExactGp::fit(&inputs, &targets, exact.hyper.ours()).map_err(|e| format!("{place}: {e}"))?;
    let likelihood = exact.log_marginal_likelihood;
    within(&place, "likelihood", &[gp.log_marginal_likelihood()], &[likelihood], 1e-9 * likelihood.abs())?;
    let (ours, theirs) = (gradient_of(&exact.grad_log, &gp.gradient()), exact.grad_log.list());
    let largest = theirs.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    within(&place, "log gradient", &ours, &theirs, 1e-8 * largest)?;
    let (mean, variance): (Vec<f64>, Vec<f64>) = queries.iter().map(|&query| gp.predict(query)).unzip();
    within(&place, "mean", &mean, &exact.mean, 1e-9)?;
    within(&place, "variance", &variance, &exact.variance, 1e-9)
}

impl Gradient {
    fn list(&self) -> Vec<f64> {
        let lengths = match &self.lengthscales {
            OneOrMore::One(length) => core::slice::from_ref(length),
            OneOrMore::More(lengths) => lengths,
        };
        [&[self.variance], lengths, &[self.alpha, self.noise]].concat()
    }
}

/// Our gradient in the form of theirs: one length-scale for both axes has the sum of both derivatives.
fn gradient_of(theirs: &Gradient, ours: &LogGradient) -> Vec<f64> {
    let [azimuth, elevation] = ours.length_scales;
    match &theirs.lengthscales {
        OneOrMore::More(lengths) if lengths.len() == 2 => {
            vec![ours.variance, azimuth, elevation, ours.alpha, ours.noise_variance]
        }
        _ => vec![ours.variance, azimuth + elevation, ours.alpha, ours.noise_variance],
    }
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
