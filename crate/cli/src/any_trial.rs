//! The trial that `mapless run` drives.

use mapless_trials::{Navigator, Trial};

/// A trial driven by any navigator.
pub(crate) type AnyTrial = Trial<Box<dyn Navigator>>;
