//! A scan, which scan of a file is wanted, and what a reader left out.

use std::fmt;
use std::net::SocketAddr;

use glam::Vec3;

use crate::cloud_warning::CloudWarning;
use crate::source::SourceAddress;

/// One scan as a file holds it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scan {
    /// The returns in the sensor frame, metres, in the order of the file.
    pub points_m: Vec<Vec3>,
    /// What the reader left out or took for granted.
    pub warnings: Vec<ScanWarning>,
}

impl Scan {
    /// A word when no return is within `reach_m` of the sensor, the distance in which the planner looks at
    /// the ground. Returns nearer than `min_range_m`, the least range of the sensor, are none.
    pub fn out_of_reach(&self, min_range_m: f64, reach_m: f64) -> Option<ScanWarning> {
        let ranges_m = self.points_m.iter().map(|point: &Vec3| point.as_dvec3().length());
        let nearest_m = ranges_m.filter(|range_m| *range_m >= min_range_m).reduce(f64::min)?;
        (nearest_m > reach_m).then(|| {
            let (reach, nearest) = (reach_m.to_string(), format!("{nearest_m:.1}"));
            ScanWarning::Cloud(CloudWarning::OutOfReach { reach, nearest })
        })
    }
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
    /// Which sensor of a capture; without it, the capture must have one alone.
    pub source: Option<SourceAddress>,
}

impl ScanChoice {
    /// A revolution of the only sensor.
    pub fn of_revolution(revolution: usize) -> Self {
        Self { revolution, source: None }
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
    /// The capture is damaged at a packet, and what follows is not read.
    Unreadable {
        /// Place of that packet in the capture, from 1.
        packet: usize,
    },
    /// Packets of a link type that is not read, beside others.
    UnknownLink {
        /// The link type.
        link: u32,
        /// Number of its packets.
        packets: usize,
    },
    /// Packets of which the capture tool kept the beginning alone.
    Snaplen {
        /// Number of packets.
        packets: usize,
        /// Bytes kept of the longest.
        captured_bytes: usize,
        /// Bytes it had.
        wire_bytes: usize,
    },
    /// IP fragments whose datagram did not become whole.
    Fragments {
        /// Number of fragments.
        packets: usize,
    },
    /// Packets that are neither data nor position packets.
    OtherPackets {
        /// Number of packets.
        packets: usize,
    },
    /// Data packets of another sensor or model than the chosen one.
    OtherSensor {
        /// Its address.
        address: SocketAddr,
        /// The number of its model.
        product: u8,
        /// Number of its packets.
        packets: usize,
    },
    /// Packets that came later than they were sent.
    Reordered {
        /// Number of packets.
        packets: usize,
    },
    /// Packets with the same bytes as the one before.
    Duplicates {
        /// Number of packets.
        packets: usize,
    },
    /// Data packets that cannot be read.
    BadPackets {
        /// Number of packets.
        packets: usize,
        /// What is wrong with the first, and where.
        first: String,
    },
    /// Blocks of data packets that cannot be read.
    BadBlocks {
        /// Number of blocks.
        blocks: usize,
        /// What is wrong with the first, and where.
        first: String,
    },
    /// Data packets are missing.
    Gaps {
        /// Number of gaps.
        gaps: usize,
        /// The packet before the first.
        packet: usize,
        /// What is missing there.
        first: String,
    },
}

impl fmt::Display for ScanWarning {
    fn fmt(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cloud(warning) => warning.fmt(text),
            Self::CutOff { packet } => {
                write!(text, "the capture ends inside packet {packet}; what comes before is read")
            }
            Self::Unreadable { packet } => {
                write!(text, "the capture is damaged at packet {packet}; what comes before is read")
            }
            Self::UnknownLink { link, packets } => {
                write!(text, "{} of link type {link} left out", count(*packets, "packet"))
            }
            Self::Snaplen { packets, captured_bytes, wire_bytes } => {
                let packets = count(*packets, "packet");
                write!(text, "{packets} left out: cut at {captured_bytes} of {wire_bytes} bytes (snaplen)")
            }
            Self::Fragments { packets } => {
                let fragments = count(*packets, "IP fragment");
                write!(text, "{fragments} left out: the other fragments are missing")
            }
            Self::OtherPackets { packets } => {
                write!(text, "{} left out: not from a Velodyne sensor", count(*packets, "packet"))
            }
            Self::OtherSensor { address, product, packets } => {
                let packets = count(*packets, "data packet");
                write!(text, "{packets} left out: from {address}, product 0x{product:02x}")
            }
            Self::Reordered { packets } => {
                write!(text, "{} put back in the order of the sensor's clock", count(*packets, "packet"))
            }
            Self::Duplicates { packets } => {
                write!(text, "{} left out: the same bytes as the one before", count(*packets, "packet"))
            }
            Self::BadPackets { packets, first } => {
                write!(text, "{} left out; the first: {first}", count(*packets, "data packet"))
            }
            Self::BadBlocks { blocks, first } => {
                write!(text, "{} left out; the first: {first}", count(*blocks, "block"))
            }
            Self::Gaps { gaps, packet, first } => {
                let gaps = count(*gaps, "gap");
                write!(
                    text,
                    "{gaps}: the revolutions there are left out; the first, after packet {packet}: {first}"
                )
            }
        }
    }
}

/// A number of things.
fn count(number: usize, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_said_when_nothing_is_within_reach() {
        let word = |points_m: &[Vec3]| {
            let scan = Scan::from(points_m.to_vec());
            scan.out_of_reach(0.5, 7.0).map(|warning| warning.to_string())
        };
        let far = [Vec3::new(1700.0, 0.0, -700.0), Vec3::new(0.0, 3000.0, -700.0)];
        let said = word(&far).unwrap();
        assert!(said.starts_with("no return within 7 m, the nearest is 1838.5 m away: "), "{said}");
        assert_eq!(word(&[far[0], Vec3::ZERO, Vec3::X * 0.4]), Some(said), "too near to be returns");
        assert_eq!(word(&[far[0], Vec3::X * 6.9]), None);
        assert_eq!(word(&[Vec3::ZERO]), None, "an empty scan is another matter");
        assert_eq!(word(&[]), None);
    }
}
