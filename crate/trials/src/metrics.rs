//! The paper's six performance metrics (section VI-B).

use glam::DVec3;

/// Below this speed the curvature |ω / v| is undefined; such samples do not count in its change.
const LEAST_SPEED_M_S: f64 = 0.05;
/// Slower than this, a robot stands.
const STANDSTILL_M_S: f64 = 0.01;

/// The metrics of a trial so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Metrics {
    /// Length D of the path, in space.
    pub distance_m: f64,
    /// Largest |φ|.
    pub max_abs_roll_rad: f64,
    /// Largest |ψ|.
    pub max_abs_pitch_rad: f64,
    /// Mean of |φ'| + |ψ'| over time.
    pub mean_vibration_rad_s: f64,
    /// Mean of |z'| over time, centimetres a second.
    pub mean_elevation_rate_cm_s: f64,
    /// C_chg = 1/T ∫ |k'(t)| dt with k = |ω / v|. The unit of the integral is rad/m, which the paper gives
    /// for the mean too.
    pub curvature_change_rad_m: f64,
}

impl Metrics {
    /// All six, in the order of the fields.
    pub fn values(&self) -> [f64; 6] {
        [
            self.distance_m,
            self.max_abs_roll_rad,
            self.max_abs_pitch_rad,
            self.mean_vibration_rad_s,
            self.mean_elevation_rate_cm_s,
            self.curvature_change_rad_m,
        ]
    }
}

/// What others measure of a drive beside the paper's metrics.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ride {
    /// Mean of |φ| over time.
    pub mean_abs_roll_rad: f64,
    /// Mean of |ψ| over time.
    pub mean_abs_pitch_rad: f64,
    /// The longest time without a move from the place, turns on the spot included, seconds.
    pub longest_standstill_s: f64,
}

/// Computes the metrics from evenly spaced samples of the motion.
#[derive(Clone, Debug)]
pub(crate) struct MetricsRecorder {
    last: Sample,
    time_s: f64,
    distance_m: f64,
    max_abs_roll_rad: f64,
    max_abs_pitch_rad: f64,
    tilt_travel_rad: f64,
    climb_m: f64,
    curvature_travel_rad_m: f64,
    /// Of |φ| and |ψ| over time.
    abs_roll_rad_s: f64,
    abs_pitch_rad_s: f64,
    standstill_s: f64,
    longest_standstill_s: f64,
}

/// One sample of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) position_m: DVec3,
    pub(crate) roll_rad: f64,
    pub(crate) pitch_rad: f64,
    pub(crate) speed_m_s: f64,
    pub(crate) turn_rate_rad_s: f64,
}

impl Sample {
    fn curvature_rad_m(&self) -> Option<f64> {
        (self.speed_m_s.abs() >= LEAST_SPEED_M_S).then(|| (self.turn_rate_rad_s / self.speed_m_s).abs())
    }
}

impl MetricsRecorder {
    pub(crate) fn new(first: Sample) -> Self {
        Self {
            last: first,
            time_s: 0.0,
            distance_m: 0.0,
            max_abs_roll_rad: first.roll_rad.abs(),
            max_abs_pitch_rad: first.pitch_rad.abs(),
            tilt_travel_rad: 0.0,
            climb_m: 0.0,
            curvature_travel_rad_m: 0.0,
            abs_roll_rad_s: 0.0,
            abs_pitch_rad_s: 0.0,
            standstill_s: 0.0,
            longest_standstill_s: 0.0,
        }
    }

    pub(crate) fn record(&mut self, sample: Sample, dt_s: f64) {
        let last = core::mem::replace(&mut self.last, sample);
        self.time_s += dt_s;
        self.distance_m += (sample.position_m - last.position_m).length();
        self.max_abs_roll_rad = self.max_abs_roll_rad.max(sample.roll_rad.abs());
        self.max_abs_pitch_rad = self.max_abs_pitch_rad.max(sample.pitch_rad.abs());
        self.tilt_travel_rad +=
            (sample.roll_rad - last.roll_rad).abs() + (sample.pitch_rad - last.pitch_rad).abs();
        self.climb_m += (sample.position_m.z - last.position_m.z).abs();
        if let (Some(now), Some(before)) = (sample.curvature_rad_m(), last.curvature_rad_m()) {
            self.curvature_travel_rad_m += (now - before).abs();
        }
        self.abs_roll_rad_s += sample.roll_rad.abs() * dt_s;
        self.abs_pitch_rad_s += sample.pitch_rad.abs() * dt_s;
        let stands = sample.speed_m_s.abs() < STANDSTILL_M_S;
        self.standstill_s = if stands { self.standstill_s + dt_s } else { 0.0 };
        self.longest_standstill_s = self.longest_standstill_s.max(self.standstill_s);
    }

    /// The metrics up to the last sample; zeros before any time has passed.
    pub(crate) fn metrics(&self) -> Metrics {
        let per_second = |total: f64| if self.time_s > 0.0 { total / self.time_s } else { 0.0 };
        Metrics {
            distance_m: self.distance_m,
            max_abs_roll_rad: self.max_abs_roll_rad,
            max_abs_pitch_rad: self.max_abs_pitch_rad,
            mean_vibration_rad_s: per_second(self.tilt_travel_rad),
            mean_elevation_rate_cm_s: 100.0 * per_second(self.climb_m),
            curvature_change_rad_m: per_second(self.curvature_travel_rad_m),
        }
    }

    /// As [`MetricsRecorder::metrics`].
    pub(crate) fn ride(&self) -> Ride {
        let mean = |total: f64| if self.time_s > 0.0 { total / self.time_s } else { 0.0 };
        Ride {
            mean_abs_roll_rad: mean(self.abs_roll_rad_s),
            mean_abs_pitch_rad: mean(self.abs_pitch_rad_s),
            longest_standstill_s: self.longest_standstill_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(x: f64, z: f64, roll: f64, pitch: f64, speed: f64, turn_rate: f64) -> Sample {
        Sample {
            position_m: DVec3::new(x, 0.0, z),
            roll_rad: roll,
            pitch_rad: pitch,
            speed_m_s: speed,
            turn_rate_rad_s: turn_rate,
        }
    }

    #[test]
    fn the_metrics_of_a_short_motion_by_hand() {
        let mut recorder = MetricsRecorder::new(sample(0.0, 0.0, 0.0, 0.0, 1.0, 0.0));
        recorder.record(sample(3.0, 4.0, 0.1, -0.2, 1.0, 0.5), 1.0);
        recorder.record(sample(3.0, 2.0, -0.1, -0.2, 0.01, 0.5), 1.0);
        recorder.record(sample(3.0, 2.0, 0.0, 0.0, 0.5, 0.5), 2.0);
        let metrics = recorder.metrics();
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} is not {b}");
        close(metrics.distance_m, 7.0);
        close(metrics.max_abs_roll_rad, 0.1);
        close(metrics.max_abs_pitch_rad, 0.2);
        close(metrics.mean_vibration_rad_s, (0.3 + 0.2 + 0.3) / 4.0);
        close(metrics.mean_elevation_rate_cm_s, 100.0 * 6.0 / 4.0);
        // Only the first step lies between two samples fast enough to have a curvature.
        close(metrics.curvature_change_rad_m, 0.5 / 4.0);
        let ride = recorder.ride();
        close(ride.mean_abs_roll_rad, (0.1 + 0.1) / 4.0);
        close(ride.mean_abs_pitch_rad, (0.2 + 0.2) / 4.0);
    }

    #[test]
    fn the_longest_standstill_counts_turns_on_the_spot_and_no_drive() {
        let mut recorder = MetricsRecorder::new(sample(0.0, 0.0, 0.0, 0.0, 0.0, 0.0));
        let speeds_m_s = [0.005, -0.005, 0.0, 0.02, 0.0, 0.0, -0.02, 0.0];
        for speed_m_s in speeds_m_s {
            recorder.record(sample(0.0, 0.0, 0.0, 0.0, speed_m_s, 0.5), 0.5);
        }
        assert!((recorder.ride().longest_standstill_s - 1.5).abs() < 1e-12, "{:?}", recorder.ride());
    }
}
