//! Factorisation of nearly singular covariances, with jitter on the diagonal as in gpflow, and its errors.

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
    /// Nothing to maximise: the covariance could not be factored at the start.
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

/// Tries to `factor` the covariance of `inducing` inputs with rising jitter on its diagonal; returns the
/// jitter that succeeded.
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
