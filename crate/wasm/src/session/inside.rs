//! A look into the Gaussian process of the decision that is shown.

use js_sys::{Float32Array, Uint16Array};
use mapless::config::PerceptionConfig;
use mapless::gp::hyperparameters::Hyperparameters;
use mapless::skyline::inspection::{self, Inspection, LatticeDirection, relative_covariances};
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::Session;
use crate::decision;
use crate::shared::{give, read};

/// Where the inducing inputs are.
#[derive(Clone, Copy, Debug, Deserialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum Placement {
    /// On the lattice of the sensor's columns and rows.
    Lattice,
    /// Among the returns, each the farthest from those before it.
    FarthestPoints,
    /// One return in so many.
    Strided,
}

impl From<Placement> for inspection::Placement {
    fn from(placement: Placement) -> Self {
        match placement {
            Placement::Lattice => Self::Lattice,
            Placement::FarthestPoints => Self::FarthestPoints,
            Placement::Strided => Self::Strided,
        }
    }
}

/// What to look at.
#[derive(Debug, Deserialize, Tsify)]
pub struct InsideQuestion {
    /// The planner's own without it.
    #[tsify(optional)]
    placement: Option<Placement>,
    /// The inducing inputs to leave out, by their numbers in the answer without this.
    #[tsify(type = "readonly number[]")]
    without: Vec<usize>,
}

/// The process over the scan, with these inducing inputs.
#[derive(Debug, Serialize, Tsify)]
pub struct Inside {
    /// Column and row of each inducing input, those left out among them.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Uint16Array<ArrayBuffer>")]
    inducing: Uint16Array,
    /// As in `FrameBuffers`.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    occupancy: Float32Array,
    /// As in `FrameBuffers`.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    variance: Float32Array,
    /// As in `FrameBuffers`.
    #[serde(with = "serde_wasm_bindgen::preserve")]
    #[tsify(type = "Float32Array<ArrayBuffer>")]
    profile: Float32Array,
}

/// One step of learning.
#[derive(Debug, Serialize, Tsify)]
pub struct ClimbStep {
    /// Nats.
    bound: f64,
    variance_m2: f64,
    /// Over azimuth and elevation.
    length_scales_rad: [f64; 2],
    alpha: f64,
    noise_variance_m2: f64,
}

impl From<&inspection::ClimbStep> for ClimbStep {
    fn from(step: &inspection::ClimbStep) -> Self {
        let Hyperparameters { kernel, noise_variance } = step.hyperparameters;
        Self {
            bound: step.bound,
            variance_m2: kernel.variance,
            length_scales_rad: kernel.length_scales_rad,
            alpha: kernel.alpha,
            noise_variance_m2: noise_variance,
        }
    }
}

#[wasm_bindgen]
impl Session {
    /// Predicts the surfaces of the scan that is shown with inducing inputs of one's own choice. Nothing
    /// changes for the run.
    ///
    /// # Errors
    /// No posterior with these inducing inputs.
    pub fn look_inside(&self, question: Ts<InsideQuestion>) -> Result<Ts<Inside>, JsError> {
        let InsideQuestion { placement, without } = read(question)?;
        let config = self.perception();
        let observed = self.shown().trial.step().observed;
        let placement = placement.map_or_else(|| config.inducing_inputs.into(), inspection::Placement::from);
        let mut inspection = Inspection::new(&config, observed, placement);
        let inducing: Vec<u16> = inspection
            .inducing_inputs()
            .iter()
            .flat_map(|input| [input.column as u16, input.row as u16])
            .collect();
        let (surface, profile) = inspection.predict(observed, &without)?;
        let profile: Vec<f32> = profile.iter().map(decision::column_elevation_rad).collect();
        give(&Inside {
            inducing: Uint16Array::from(inducing.as_slice()),
            occupancy: floats(&surface.mean_m),
            variance: floats(&surface.relative_variance),
            profile: Float32Array::from(profile.as_slice()),
        })
    }

    /// The covariance of every direction of the surfaces with one of them, as a share of the signal variance.
    pub fn kernel_from(&self, column: usize, row: usize) -> Float32Array {
        let rows = self.shown().trial.step().observed.grid().rows();
        floats(&relative_covariances(&self.perception().kernel, LatticeDirection { column, row }, rows))
    }

    /// The climb of the bound on this scan with nothing to hold the hyperparameters, the start first.
    ///
    /// # Errors
    /// The bound has no value, as without returns.
    pub fn climb(&self) -> Result<Vec<Ts<ClimbStep>>, JsError> {
        // From where the run's planner would begin, whatever is tried at present.
        let config = &self.now.trial.planner_config().perception;
        let steps = inspection::unbounded_climb(config, self.shown().trial.step().observed)?;
        steps.iter().map(ClimbStep::from).map(|step| give(&step)).collect()
    }

    /// With what was learned.
    fn perception(&self) -> PerceptionConfig {
        let trial = &self.shown().trial;
        let mut config = trial.planner_config().perception;
        if let Some(learned) = trial.step().diagnostics.learned {
            config.kernel = learned.hyperparameters.kernel;
            config.noise_variance_m2 = learned.hyperparameters.noise_variance;
        }
        config
    }
}

fn floats(values: &[f64]) -> Float32Array {
    let values: Vec<f32> = values.iter().map(|&value| value as f32).collect();
    Float32Array::from(values.as_slice())
}
