//! Regression: the posterior on a whole surface, and the bound with all its gradients.

use glam::DVec2;
use mapless::gp::bound::CollapsedBound;
use mapless::gp::sparse::SparseGp;

use crate::BenchError;
use crate::data::{farthest_points, full_scan, hyperparameters, level_scan, queries, regression};
use crate::work::{Values, Work};

/// Fits the process and predicts mean and variance on 360 × 30.
pub(crate) struct Posterior {
    gp: SparseGp,
    inputs: Vec<DVec2>,
    targets: Vec<f64>,
    inducing: Vec<DVec2>,
    queries: Vec<DVec2>,
    mean: Vec<f64>,
    variance: Vec<f64>,
}

impl Posterior {
    fn new(inputs: Vec<DVec2>, targets: Vec<f64>, inducing: usize) -> Self {
        let hyperparameters = hyperparameters();
        let queries = queries();
        Self {
            gp: SparseGp::new(hyperparameters.kernel, hyperparameters.noise_variance),
            inducing: farthest_points(&inputs, inducing),
            inputs,
            targets,
            mean: vec![0.0; queries.len()],
            variance: vec![0.0; queries.len()],
            queries,
        }
    }

    /// From the 1823 cells of level ground.
    pub(crate) fn of_level_scan(inducing: usize) -> Result<Self, BenchError> {
        let (inputs, targets) = regression(&level_scan());
        Ok(Self::new(inputs, targets, inducing))
    }

    /// From every `stride`-th of the 5760 cells inside a round wall, with 200 inducing inputs.
    pub(crate) fn of_full_scan(stride: usize) -> Result<Self, BenchError> {
        let (inputs, targets) = regression(&full_scan());
        let some = |index: usize| index.is_multiple_of(stride);
        let inputs = inputs.into_iter().enumerate().filter(|(index, _)| some(*index)).map(|(_, x)| x);
        let targets = targets.into_iter().enumerate().filter(|(index, _)| some(*index)).map(|(_, y)| y);
        Ok(Self::new(inputs.collect(), targets.collect(), 200))
    }
}

impl Work for Posterior {
    fn run(&mut self) -> Result<(), BenchError> {
        self.gp.fit(&self.inputs, &self.targets, &self.inducing)?;
        self.gp.predict(&self.queries, &mut self.mean, &mut self.variance);
        Ok(())
    }

    fn values(&mut self) -> Values {
        Values::from([
            ("mean", self.mean.clone()),
            ("variance", self.variance.clone()),
            ("inputs", vec![self.inputs.len() as f64]),
        ])
    }
}

/// Evaluates the bound and its gradients on the 1823 cells of level ground.
pub(crate) struct Bound {
    bound: CollapsedBound,
    inputs: Vec<DVec2>,
    targets: Vec<f64>,
    inducing: Vec<DVec2>,
    value: f64,
}

impl Bound {
    /// With this many inducing inputs.
    pub(crate) fn of_level_scan(inducing: usize) -> Result<Self, BenchError> {
        let (inputs, targets) = regression(&level_scan());
        let inducing = farthest_points(&inputs, inducing);
        Ok(Self { bound: CollapsedBound::new(), inputs, targets, inducing, value: 0.0 })
    }

    /// Additions and multiplications of the dense algebra, without those of the kernel: A = L⁻¹ K_uf and the
    /// lower half of A Aᵀ take n m² each and the product for ∂F/∂K_uf 2 n m²; two factors and five solves of
    /// m × m are left.
    fn operations(&self) -> f64 {
        let (n, m) = (self.inputs.len() as f64, self.inducing.len() as f64);
        4.0 * n * m * m + (2.0 / 3.0 + 5.0) * m * m * m
    }
}

impl Work for Bound {
    fn run(&mut self) -> Result<(), BenchError> {
        self.value = self.bound.evaluate(&self.inputs, &self.targets, &self.inducing, &hyperparameters())?;
        Ok(())
    }

    fn values(&mut self) -> Values {
        let g = self.bound.gradient();
        let [azimuth, elevation] = g.length_scales;
        let inducing = self.bound.inducing_gradient().iter().flat_map(|g| g.to_array());
        Values::from([
            ("bound", vec![self.value]),
            ("log_gradient", vec![g.variance, azimuth, elevation, g.alpha, g.noise_variance]),
            ("inducing_gradient", inducing.collect()),
            ("operations", vec![self.operations()]),
        ])
    }
}
