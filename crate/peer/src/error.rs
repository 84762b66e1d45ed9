//! Errors of the middleware.

use anyhow::anyhow;

/// Names what an error of the middleware is about.
pub(crate) fn making<E: std::fmt::Display>(what: &str) -> impl FnOnce(E) -> anyhow::Error {
    move |error| anyhow!("{what}: {error}")
}
