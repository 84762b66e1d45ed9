//! Factoring covariances that are nearly singular, with jitter on their diagonal as gpflow adds it, and what can go wrong.

use crate::math::cholesky::NotPositiveDefinite;

/// Why a fit gave no posterior.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GpError {
    /// The inducing covariance stayed indefinite at the largest jitter.
    #[error("the covariance of {inducing} inducing inputs is not positive definite at jitter {jitter:e}")]
    IllConditioned {
        /// Number of inducing inputs.
        inducing: usize,
        /// The last jitter tried.
        jitter: f64,
    },
    /// No bound to climb: the covariance could not be factored at the start.
    #[error("nothing can be learned through {inducing} inducing inputs")]
    NothingLearned {
        /// Number of inducing inputs.
        inducing: usize,
    },
    /// There was nothing to fit.
    #[error("no inducing inputs")]
    NoInducingInputs,
}

/// Jitter tried first and last; gpflow adds the first one.
const FIRST_JITTER: f64 = 1e-6;
const LAST_JITTER: f64 = 1e-2;

/// Tries to `factor` the covariance of `inducing` inputs with ever more jitter on its diagonal; gives the jitter that did.
pub(crate) fn with_rising_jitter(
    inducing: usize,
    mut factor: impl FnMut(f64) -> Result<(), NotPositiveDefinite>,
) -> Result<f64, GpError> {
    let mut jitter = FIRST_JITTER;
    while factor(jitter).is_err() {
        if jitter >= LAST_JITTER {
            return Err(GpError::IllConditioned { inducing, jitter });
        }
        jitter *= 10.0;
    }
    Ok(jitter)
}
