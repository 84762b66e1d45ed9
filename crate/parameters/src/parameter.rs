//! The description of a parameter.

use crate::Check;
use crate::value::Value;

/// One parameter of a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in its table.
    pub name: &'static str,
    /// The unit; empty for shares, counts and choices.
    pub unit: &'static str,
    /// Its kind and range.
    pub kind: Kind,
    /// The condition that its value must meet.
    pub check: Check,
    /// Its description.
    pub text: &'static str,
    /// The value that the paper gives; `None` if it gives none.
    pub paper: Option<Value>,
}

/// Kind and range of a parameter. The ranges are sensible ones, as for a slider; [`Check`] is the hard
/// condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number, from lowest to highest.
    Number(f64, f64),
    /// A whole number, from lowest to highest.
    Whole(u32, u32),
    /// Two numbers, each from lowest to highest.
    Pair(f64, f64),
    /// `true` or `false`.
    Switch,
    /// One of these words.
    Choice(&'static [&'static str]),
}
