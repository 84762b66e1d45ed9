//! Fields of a cloud: where in a point a number stands, and how it is written.

use super::error::CloudError;

/// A field of a cloud (`sensor_msgs/PointField`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Where it begins in a point, bytes.
    pub offset: u32,
    /// How its number is written, of several the first: 1 to 8 for i8, u8, i16, u16, i32, u32, f32 and f64.
    pub datatype: u8,
}

/// How to read a field of any point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reader {
    offset: usize,
    datatype: u8,
    is_big_endian: bool,
}

impl Reader {
    /// Checks that a field lies within a point.
    pub(crate) fn new(field: &Field, point_step: usize, is_big_endian: bool) -> Result<Self, CloudError> {
        let bytes = match field.datatype {
            1 | 2 => 1,
            3 | 4 => 2,
            5..=7 => 4,
            8 => 8,
            datatype => return Err(CloudError::Datatype { name: field.name.clone(), datatype }),
        };
        let offset = field.offset as usize;
        if offset.checked_add(bytes).is_none_or(|end| end > point_step) {
            let (name, offset) = (field.name.clone(), field.offset);
            return Err(CloudError::Offset { name, offset, bytes, point_step });
        }
        Ok(Self { offset, datatype: field.datatype, is_big_endian })
    }

    /// The number of a point; NaN if the point is too short, which [`Reader::new`] rules out.
    pub(crate) fn read(&self, point: &[u8]) -> f64 {
        let value = match self.datatype {
            1 => self.bytes(point).map(|bytes| f64::from(i8::from_le_bytes(bytes))),
            2 => self.bytes(point).map(|bytes| f64::from(u8::from_le_bytes(bytes))),
            3 => self.bytes(point).map(|bytes| f64::from(i16::from_le_bytes(bytes))),
            4 => self.bytes(point).map(|bytes| f64::from(u16::from_le_bytes(bytes))),
            5 => self.bytes(point).map(|bytes| f64::from(i32::from_le_bytes(bytes))),
            6 => self.bytes(point).map(|bytes| f64::from(u32::from_le_bytes(bytes))),
            7 => self.bytes(point).map(|bytes| f64::from(f32::from_le_bytes(bytes))),
            _ => self.bytes(point).map(f64::from_le_bytes),
        };
        value.unwrap_or(f64::NAN)
    }

    /// The bytes of the number, lowest first.
    fn bytes<const N: usize>(&self, point: &[u8]) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = point.get(self.offset..)?.get(..N)?.try_into().ok()?;
        if self.is_big_endian {
            bytes.reverse();
        }
        Some(bytes)
    }
}
