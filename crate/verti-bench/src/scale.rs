//! The factor for all lengths of a world.

use std::fmt;

use crate::fault::Fault;

/// Scales at which the pixels' spacing is one of a terrain.
const SCALES: std::ops::RangeInclusive<f64> = 0.01..=100.0;

/// A factor for all lengths: `1/5`, `0.2`, `1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(f64);

impl Scale {
    /// The factor.
    pub fn factor(self) -> f64 {
        self.0
    }
}

impl std::str::FromStr for Scale {
    type Err = Fault;

    fn from_str(text: &str) -> Result<Self, Fault> {
        let number = |text: &str| text.trim().parse::<f64>().ok();
        let factor = match text.split_once('/') {
            Some((above, below)) => number(above).zip(number(below)).map(|(above, below)| above / below),
            None => number(text),
        };
        let factor = factor.filter(|factor| SCALES.contains(factor));
        factor.map(Self).ok_or_else(|| Fault(format!("{text:?}: expected 0.01 to 100, such as 1/5 or 0.2")))
    }
}

impl fmt::Display for Scale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_fractions_or_numbers() {
        for text in ["1/5", "0.2", "1 / 5", "2/10"] {
            assert!((text.parse::<Scale>().unwrap().0 - 0.2).abs() < 1e-12, "{text}");
        }
        assert!(("1".parse::<Scale>().unwrap().0 - 1.0).abs() < 1e-12);
        for text in ["", "0", "-1", "1/0", "0/5", "a", "1/b", "1/2/3", "inf", "nan", "1/101"] {
            let error = text.parse::<Scale>().unwrap_err().to_string();
            assert_eq!(error, format!("{text:?}: expected 0.01 to 100, such as 1/5 or 0.2"));
        }
    }
}
