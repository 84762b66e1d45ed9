//! Numbers and points, as every format of point clouds has them.

use glam::{DVec3, Vec3};

use crate::error::ScanFault;

/// Type of a number in a binary record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Number {
    pub(crate) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number that `bytes` begins with; `None` if they end before it does.
    pub(crate) fn read(self, bytes: &[u8], big_endian: bool) -> Option<f64> {
        let mut word = [0; 8];
        let (word_part, value) = (word.get_mut(..self.size())?, bytes.get(..self.size())?);
        word_part.copy_from_slice(value);
        if big_endian {
            word_part.reverse();
        }
        let bits = u64::from_le_bytes(word);
        Some(match self {
            Self::I8 => f64::from(bits as i8),
            Self::U8 => f64::from(bits as u8),
            Self::I16 => f64::from(bits as i16),
            Self::U16 => f64::from(bits as u16),
            Self::I32 => f64::from(bits as i32),
            Self::U32 => f64::from(bits as u32),
            Self::I64 => bits as i64 as f64,
            Self::U64 => bits as f64,
            Self::F32 => f64::from(f32::from_bits(bits as u32)),
            Self::F64 => f64::from_bits(bits),
        })
    }
}

/// A point in metres; `None` for a beam without a return, whose coordinates are not finite.
pub(crate) fn point(place: impl FnOnce() -> String, metres: DVec3) -> Result<Option<Vec3>, ScanFault> {
    if !metres.is_finite() {
        return Ok(None);
    }
    let point = metres.as_vec3();
    match (0..3).find(|&axis| !point[axis].is_finite()) {
        None => Ok(Some(point)),
        Some(axis) => {
            let place = format!("{}, {}", place(), AXES[axis]);
            Err(ScanFault::value(place, metres[axis], "a number of metres"))
        }
    }
}

/// Names of the axes.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

/// The beginning of a value, since a wrong file may be one long line.
pub(crate) fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let text = text.trim();
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_beyond_metres_is_named() {
        let far = point(|| "point 3".to_owned(), DVec3::new(1.0, -1e200, 2.0)).unwrap_err();
        assert!(far.to_string().starts_with("point 3, y = -1"), "{far}");
        assert_eq!(point(String::new, DVec3::new(1.0, f64::INFINITY, 2.0)), Ok(None));
    }

    proptest! {
        #[test]
        fn numbers_of_both_orders_are_read(value in any::<i64>(), real in any::<f64>()) {
            let both = |number: Number, little: &[u8], expected: f64| {
                let big: Vec<u8> = little.iter().rev().copied().collect();
                assert_eq!(number.size(), little.len());
                assert_eq!(number.read(little, false), Some(expected));
                assert_eq!(number.read(&big, true), Some(expected));
                assert_eq!(number.read(&little[1..], false), None);
            };
            both(Number::I8, &(value as i8).to_le_bytes(), (value as i8).into());
            both(Number::U8, &(value as u8).to_le_bytes(), (value as u8).into());
            both(Number::I16, &(value as i16).to_le_bytes(), (value as i16).into());
            both(Number::U16, &(value as u16).to_le_bytes(), (value as u16).into());
            both(Number::I32, &(value as i32).to_le_bytes(), (value as i32).into());
            both(Number::U32, &(value as u32).to_le_bytes(), (value as u32).into());
            both(Number::I64, &value.to_le_bytes(), value as f64);
            both(Number::U64, &(value as u64).to_le_bytes(), (value as u64) as f64);
            both(Number::F32, &(real as f32).to_le_bytes(), (real as f32).into());
            both(Number::F64, &real.to_le_bytes(), real);
        }
    }
}
