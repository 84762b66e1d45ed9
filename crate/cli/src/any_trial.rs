//! The trial that `mapless run` drives.

use mapless_trials::{Navigator, Trial};

/// A trial driven by whatever was asked for.
pub(crate) type AnyTrial = Trial<Box<dyn Navigator>>;
