//! What may be wrong with a file of heights.

use thiserror::Error;

/// What is wrong with a file of heights.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Fault {
    /// The file could not be read.
    #[error("cannot be read: {reason}")]
    Read {
        /// Why.
        reason: String,
    },
    /// The file's extension is not that of a supported format.
    #[error("extension \"{extension}\": expected .png, .asc, .tif or .tiff, or .toml for a recipe")]
    Extension {
        /// The extension found, without the dot.
        extension: String,
    },
    /// The file is damaged or not of the format its extension says.
    #[error("not a valid {format} file: {reason}")]
    Damaged {
        /// The format expected.
        format: &'static str,
        /// What the reader met, with the place where known.
        reason: String,
    },
    /// A value is not allowed.
    #[error("{place} = {value}: expected {expected}")]
    Value {
        /// Where in the file.
        place: String,
        /// What stands there.
        value: String,
        /// What is allowed there.
        expected: String,
    },
    /// Too few samples, or too many.
    #[error("{columns} × {rows} samples: expected {expected}")]
    Size {
        /// Samples from west to east.
        columns: usize,
        /// Samples from south to north.
        rows: usize,
        /// How many are allowed.
        expected: String,
    },
}

impl Fault {
    /// A value that is not allowed.
    pub fn value(place: impl Into<String>, value: impl ToString, expected: impl Into<String>) -> Self {
        Self::Value { place: place.into(), value: value.to_string(), expected: expected.into() }
    }

    /// A file that is not of its format.
    pub fn damaged(format: &'static str, reason: impl ToString) -> Self {
        Self::Damaged { format, reason: reason.to_string() }
    }
}
