//! What a parameter is, for people and for what shows it to them.

use std::fmt;

use crate::Check;

/// One parameter of a configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in its table.
    pub name: &'static str,
    /// The unit; empty for shares, counts and choices.
    pub unit: &'static str,
    /// What it may be.
    pub kind: Kind,
    /// What it must hold to mean anything.
    pub check: Check,
    /// What it does.
    pub text: &'static str,
    /// The value that the paper gives; nothing where it gives none.
    pub paper: Option<Value>,
}

/// What a parameter may be. The ranges are sensible ones; [`Check`] says what makes no sense at all.
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
