//! What a value must hold to mean anything.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

use crate::{ConfigError, Value};

/// What a value must hold to mean anything. Both numbers of a pair are checked, and no check takes infinity or NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Check {
    /// Its type says it all: a switch or a choice.
    ByType,
    /// A number.
    Finite,
    /// Above zero.
    Positive,
    /// Zero or above.
    NotNegative,
    /// Above 0 and below 1.
    Share,
    /// Above 0 and below π/2.
    Angle,
    /// This or above.
    AtLeast(f64),
    /// From 0 to below this.
    Below(f64),
    /// Above 0, up to this.
    UpTo(f64),
    /// From the first to the second.
    Within(f64, f64),
    /// Two positive numbers, the lower one first.
    Ascending,
}

impl Check {
    /// Checks one value; `place` is its table.
    ///
    /// # Errors
    /// [`ConfigError`] with the value and what was expected.
    pub fn require(self, place: &str, name: &'static str, value: Value) -> Result<(), ConfigError> {
        let ok = match value {
            Value::Number(number) => self.takes(number),
            Value::Whole(number) => self.takes(number as f64),
            Value::Pair([first, second]) => {
                self.takes(first) && self.takes(second) && (self != Self::Ascending || first <= second)
            }
            Value::Switch(_) | Value::Word(_) => true,
        };
        if ok {
            return Ok(());
        }
        Err(ConfigError {
            place: place.to_owned(),
            name,
            value: value.to_string(),
            expected: self.to_string(),
        })
    }

    fn takes(self, number: f64) -> bool {
        let holds = match self {
            Self::ByType => return true,
            Self::Finite => true,
            Self::Positive | Self::Ascending => number > 0.0,
            Self::NotNegative => number >= 0.0,
            Self::Share => number > 0.0 && number < 1.0,
            Self::Angle => number > 0.0 && number < FRAC_PI_2,
            Self::AtLeast(least) => number >= least,
            Self::Below(most) => number >= 0.0 && number < most,
            Self::UpTo(most) => number > 0.0 && number <= most,
            Self::Within(least, most) => number >= least && number <= most,
        };
        holds && number.is_finite()
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ByType | Self::Finite => f.write_str("a finite number"),
            Self::Positive => f.write_str("a positive number"),
            Self::NotNegative => f.write_str("zero or a positive number"),
            Self::Share => f.write_str("a share between 0 and 1"),
            Self::Angle => f.write_str("an angle between 0 and π/2 rad"),
            Self::AtLeast(least) => write!(f, "at least {least}"),
            Self::Below(most) => write!(f, "a number from 0 to below {most}"),
            Self::UpTo(most) => write!(f, "a number above 0 and at most {most}"),
            Self::Within(least, most) => write!(f, "a number from {least} to {most}"),
            Self::Ascending => f.write_str("two positive numbers, the lower one first"),
        }
    }
}
