//! Kept trajectories.

use std::path::Path;

use crate::error::CampaignError;

/// The robot's state at one planning period, as far as figures show it.
#[derive(Clone, Copy, Debug, serde::Deserialize)]
pub(super) struct State {
    pub(super) time_s: f64,
    pub(super) x_m: f64,
    pub(super) y_m: f64,
    pub(super) z_m: f64,
    pub(super) roll_rad: f64,
    pub(super) pitch_rad: f64,
}

/// Reads a trajectory; `None` if none was kept.
pub(super) fn read(path: &Path) -> Result<Option<Vec<State>>, CampaignError> {
    if !path.exists() {
        return Ok(None);
    }
    let mut reader = csv::Reader::from_path(path).map_err(|error| CampaignError::read(path, error))?;
    let states = reader.deserialize().collect::<Result<Vec<State>, _>>();
    states.map(Some).map_err(|error| CampaignError::content(path, error))
}
