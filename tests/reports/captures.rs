//! Captures of sensors' packets.

use super::Check;

/// The check of each report, by its name.
pub(crate) const CHECKS: &[(&str, Check)] = &[];
