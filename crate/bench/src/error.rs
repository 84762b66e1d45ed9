//! Why a piece of work cannot be measured.

use mapless::gp::GpError;
use mapless::gp::hyperparameters::RegressionError;

/// Why a request has no measurement.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A line that is no request.
    #[error(
        "request {0:?}: expected the name of a piece of work, a space, and a number of repetitions or `values`"
    )]
    Request(String),
    /// A piece of work that does not exist.
    #[error("work {0:?}: expected a name that `mapless-bench` knows")]
    Unknown(String),
    /// The terrain cannot be made.
    #[error(transparent)]
    Field(#[from] mapless_world::FieldError),
    /// Sensor or planner cannot be made.
    #[error(transparent)]
    Config(#[from] mapless::ConfigError),
    /// The process has no posterior.
    #[error(transparent)]
    Posterior(#[from] GpError),
    /// The bound has no value.
    #[error(transparent)]
    Bound(#[from] RegressionError),
    /// A scenario of the repository cannot be run.
    #[error("scenario: {0}")]
    Scenario(String),
    /// The planner stopped.
    #[error("the planner stopped: {0}")]
    Stopped(mapless::StopReason),
    /// A file for the peers cannot be written.
    #[error("{file}: {reason}")]
    Write {
        /// The file.
        file: String,
        /// What the system says.
        reason: String,
    },
}
