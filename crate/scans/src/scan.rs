//! A scan, which scan of a file is wanted, and what a reader left out.

use std::fmt;

use glam::Vec3;

use crate::cloud_warning::CloudWarning;

/// One scan as a file holds it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scan {
    /// The returns in the sensor frame, metres, in the order of the file.
    pub points_m: Vec<Vec3>,
    /// What the reader left out or took for granted.
    pub warnings: Vec<ScanWarning>,
}

/// A scan without warnings.
impl From<Vec<Vec3>> for Scan {
    fn from(points_m: Vec<Vec3>) -> Self {
        Self { points_m, warnings: Vec::new() }
    }
}

/// Which scan of a file is wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScanChoice {
    /// Which whole revolution of a capture, from 0; a file of another format holds revolution 0 alone.
    pub revolution: usize,
}

impl ScanChoice {
    /// A revolution.
    pub fn of_revolution(revolution: usize) -> Self {
        Self { revolution }
    }
}

/// What a reader left out of a file that it could read. It names the place, the value and what was done, not
/// the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScanWarning {
    /// The capture ends inside a packet.
    CutOff {
        /// Place of that packet in the capture, from 1.
        packet: usize,
    },
    /// Of a point cloud.
    Cloud(CloudWarning),
}

impl fmt::Display for ScanWarning {
    fn fmt(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cloud(warning) => warning.fmt(text),
            Self::CutOff { packet } => {
                write!(text, "the capture ends inside packet {packet}; the {} before it are read", packet - 1)
            }
        }
    }
}
