//! Errors of scan files.

use crate::scan::ScanWarning;

/// Why a scan could not be read: the file and what is wrong with it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}: {fault}{}", told(.warnings))]
pub struct ScanError {
    /// The file as it was named.
    pub file: String,
    /// What is wrong with it.
    pub fault: ScanFault,
    /// What the reader had left out by then.
    pub warnings: Vec<ScanWarning>,
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ScanFault {
    /// The file could not be read, or there is nothing in it.
    #[error("cannot be read: {reason}")]
    Read {
        /// Why.
        reason: String,
    },
    /// The file's extension is not that of a supported format.
    #[error(
        "extension \"{extension}\": expected .pcap, .pcapng, .pcd, .ply, .bin, .csv, .txt, .xyz, .asc or .pts"
    )]
    Extension {
        /// The extension found, in lower case and without the dot.
        extension: String,
    },
    /// The file is damaged or not of the format its extension says.
    #[error("not a valid {format} file: {reason}")]
    Damaged {
        /// The format expected.
        format: &'static str,
        /// The reader's message, with the place if known.
        reason: String,
    },
    /// A value is not allowed.
    #[error("{place} = {value}: expected {expected}")]
    Value {
        /// Where in the file.
        place: String,
        /// The value found.
        value: String,
        /// The values allowed there.
        expected: String,
    },
    /// A capture without a data packet.
    #[error(
        "expected data packets of a Velodyne sensor, 1206 bytes over UDP: none of its {packets} packets is one"
    )]
    NoDataPacket {
        /// Packets in the capture.
        packets: usize,
    },
    /// A capture without a whole revolution.
    #[error("expected a longer capture: its {data_packets} data packets hold no whole revolution")]
    NoRevolution {
        /// Data packets of the sensor.
        data_packets: usize,
    },
    /// There is no such revolution.
    #[error("revolution = {revolution}: expected {}", expected_revolution(*.whole))]
    Revolution {
        /// The revolution asked for.
        revolution: usize,
        /// Number of whole revolutions in the file.
        whole: usize,
    },
}

impl ScanFault {
    pub(crate) fn value(place: impl Into<String>, value: impl ToString, expected: impl Into<String>) -> Self {
        Self::Value { place: place.into(), value: value.to_string(), expected: expected.into() }
    }
}

fn told(warnings: &[ScanWarning]) -> String {
    warnings.iter().map(|warning| format!("; {warning}")).collect()
}

fn expected_revolution(whole: usize) -> String {
    match whole {
        1 => "0, the only one in the file".to_owned(),
        _ => format!("0 to {}: the capture has {whole} whole revolutions", whole - 1),
    }
}
