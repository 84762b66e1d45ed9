//! Wheels against the gyro.

/// Compares the turn rate of the wheels with that of the gyro, both averaged.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slip {
    wheels_rad_s: f64,
    gyro_rad_s: f64,
}

impl Slip {
    /// Takes both rates for `elapsed_s`.
    pub(crate) fn take(&mut self, wheels_rad_s: f64, gyro_rad_s: f64, elapsed_s: f64, average_s: f64) {
        let share = elapsed_s / (average_s + elapsed_s);
        self.wheels_rad_s += share * (wheels_rad_s - self.wheels_rad_s);
        self.gyro_rad_s += share * (gyro_rad_s - self.gyro_rad_s);
    }

    /// Turn rate of the wheels that is not felt, rad/s.
    pub(crate) fn turn_rad_s(&self) -> f64 {
        self.wheels_rad_s - self.gyro_rad_s
    }

    /// Whether they differ by more than both limits.
    pub(crate) fn is_beyond(&self, least_rad_s: f64, share: f64) -> bool {
        self.turn_rad_s().abs() > least_rad_s.max(share * self.wheels_rad_s.abs())
    }
}
