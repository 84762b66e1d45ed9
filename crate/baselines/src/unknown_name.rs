//! The error for a name that names nothing.

/// A name that names nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} \"{name}\": expected one of {expected}")]
pub struct UnknownName {
    what: &'static str,
    name: String,
    expected: String,
}

impl UnknownName {
    pub(crate) fn new(what: &'static str, name: &str, expected: &[&str]) -> Self {
        Self { what, name: name.to_owned(), expected: expected.join(", ") }
    }
}
