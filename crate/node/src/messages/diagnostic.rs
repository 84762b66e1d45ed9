//! `diagnostic_msgs`.

use serde::{Deserialize, Serialize};

use super::Header;

/// The level of a `diagnostic_msgs/DiagnosticStatus`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Level {
    /// As it should be.
    Ok = 0,
    /// It goes on, but somebody should look.
    Warn = 1,
    /// It does not go on.
    Error = 2,
}

/// `diagnostic_msgs/KeyValue`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeyValue {
    /// What is told.
    pub key: String,
    /// Its value.
    pub value: String,
}

/// `diagnostic_msgs/DiagnosticStatus`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticStatus {
    /// A [`Level`].
    pub level: u8,
    /// What it is about.
    pub name: String,
    /// One line for people.
    pub message: String,
    /// The hardware, if there is any.
    pub hardware_id: String,
    /// Details.
    pub values: Vec<KeyValue>,
}

/// `diagnostic_msgs/DiagnosticArray`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosticArray {
    /// Stamp.
    pub header: Header,
    /// The statuses.
    pub status: Vec<DiagnosticStatus>,
}
