//! What is wrong, or doubtful, with a cloud.

use std::fmt;

/// Why a cloud cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CloudError {
    /// There is no such field.
    #[error("fields = [{}]: expected one named {name}", found.join(", "))]
    NoField {
        /// The field's name.
        name: &'static str,
        /// The fields that there are.
        found: Vec<String>,
    },
    /// A datatype that there is not.
    #[error("field {name}.datatype = {datatype}: expected 1 to 8 (INT8 to FLOAT64)")]
    Datatype {
        /// The field's name.
        name: String,
        /// Its datatype.
        datatype: u8,
    },
    /// A field reaches beyond its point.
    #[error(
        "field {name}.offset = {offset}: expected its {bytes} bytes within the point_step of {point_step}"
    )]
    Offset {
        /// The field's name.
        name: String,
        /// Where it begins.
        offset: u32,
        /// Its length.
        bytes: usize,
        /// Length of a point.
        point_step: usize,
    },
    /// Points have no length.
    #[error("point_step = 0: expected the length of a point in bytes")]
    PointStep,
    /// A row is shorter than its points.
    #[error(
        "row_step = {row_step}: expected at least {least}, a row of {width} points of {point_step} bytes"
    )]
    RowStep {
        /// Length of a row.
        row_step: usize,
        /// Length of its points.
        least: usize,
        /// Points in a row.
        width: usize,
        /// Length of a point.
        point_step: usize,
    },
    /// The data is shorter than its points.
    #[error("data has {bytes} bytes: expected at least {least} for {height} rows of {width} points")]
    Data {
        /// Length of the data.
        bytes: usize,
        /// Length that the points need.
        least: usize,
        /// Rows.
        height: usize,
        /// Points in a row.
        width: usize,
    },
    /// The cloud's size is not a number of bytes.
    #[error("height = {height}, width = {width}: expected a cloud that fits into memory")]
    Size {
        /// Rows.
        height: usize,
        /// Points in a row.
        width: usize,
    },
}

/// What was left out of a cloud, or taken for granted.
#[derive(Clone, Debug, PartialEq)]
pub enum CloudWarning {
    /// The data has bytes after its last point.
    ExtraData {
        /// How many.
        bytes: usize,
    },
    /// The length of the only row is wrong.
    RowStep {
        /// The length that is said.
        row_step: usize,
        /// The length of its points.
        points: usize,
    },
    /// The field of times tells none: its values do not spread as those of a sweep do.
    Times {
        /// The field's name.
        name: String,
        /// How far its values spread.
        spread: f64,
    },
    /// The times are far from the stamp: they are of another clock. The first one was taken for the stamp.
    OtherClock {
        /// The field's name.
        name: String,
        /// The first time less the stamp, seconds.
        ahead_s: f64,
    },
}

impl fmt::Display for CloudWarning {
    fn fmt(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ExtraData { bytes } => {
                write!(text, "data has {bytes} bytes after the last point: left out")
            }
            Self::RowStep { row_step, points } => {
                write!(text, "row_step = {row_step}: the only row has {points} bytes; that was taken")
            }
            Self::Times { name, spread } => write!(
                text,
                "field {name} spreads over {spread}: in no unit of time the length of a sweep; taken for a cloud \
                 without times"
            ),
            Self::OtherClock { name, ahead_s } => write!(
                text,
                "field {name} is {ahead_s:.3} s off the stamp: of another clock; its first time was taken for the stamp"
            ),
        }
    }
}
