//! Topics, services and names on the DDS network.

mod action;
mod alive;
mod entities;
mod heartbeat;
mod parameters;
mod presence;
mod spin;

pub(crate) use action::ActionServer;
pub(crate) use alive::Alive;
pub(crate) use entities::{Entities, Incoming, published_qos, streamed_qos};
pub(crate) use heartbeat::Heartbeat;
pub(crate) use parameters::ParameterServices;
pub(crate) use presence::Presence;
pub(crate) use spin::Spin;

/// An error of the middleware, with what was being made.
#[derive(Debug, thiserror::Error)]
#[error("{what}: {error}")]
pub struct RosError {
    /// What was being made.
    pub what: String,
    /// What the middleware said.
    pub error: String,
}

/// Adds what was being made to an error of the middleware.
pub(crate) fn making<E: std::fmt::Display>(what: impl Into<String>) -> impl FnOnce(E) -> RosError {
    move |error| RosError { what: what.into(), error: error.to_string() }
}
