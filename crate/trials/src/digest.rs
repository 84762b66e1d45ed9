//! Digest of a whole trajectory: equal bits give equal digests.

use sha2::{Digest, Sha256};

use crate::metrics::Sample;
use crate::outcome::Outcome;

#[derive(Clone, Debug, Default)]
pub(crate) struct TrajectoryDigest(Sha256);

impl TrajectoryDigest {
    pub(crate) fn add(&mut self, sample: &Sample, yaw_rad: f64) {
        let position = sample.position_m.to_array();
        let motion = [yaw_rad, sample.roll_rad, sample.pitch_rad, sample.speed_m_s, sample.turn_rate_rad_s];
        for value in position.into_iter().chain(motion) {
            self.0.update(value.to_bits().to_le_bytes());
        }
    }

    /// SHA-256 over the added values and the outcome so far; its first 16 bytes in hexadecimal.
    pub(crate) fn hex(&self, outcome: Option<Outcome>) -> String {
        let mut hash = self.0.clone();
        hash.update(outcome.map_or("running", Outcome::name));
        hash.finalize()[..16].iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
