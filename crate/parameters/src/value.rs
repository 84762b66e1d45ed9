//! The value of a parameter.

use std::fmt;

/// A parameter's value. Serialised, it is the plain number, list, truth value or word.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(untagged))]
pub enum Value {
    /// A number.
    Number(f64),
    /// A whole number.
    Whole(u64),
    /// Two numbers.
    Pair([f64; 2]),
    /// `true` or `false`.
    Switch(bool),
    /// The word of a choice.
    Word(&'static str),
}

/// As in an error message: a word has no quotes.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => fmt::Display::fmt(number, f),
            Self::Whole(number) => fmt::Display::fmt(number, f),
            Self::Pair([first, second]) => write!(f, "[{first}, {second}]"),
            Self::Switch(on) => fmt::Display::fmt(on, f),
            Self::Word(word) => f.write_str(word),
        }
    }
}
