//! Limits on a commanded speed and on its changes.

/// One axis of a command: a speed that follows its target within limits on acceleration and jerk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limiter {
    most: f64,
    most_acceleration: f64,
    most_jerk: f64,
    speed: f64,
    acceleration: f64,
}

impl Limiter {
    /// An axis that stands still.
    pub(crate) fn new([most, most_acceleration, most_jerk]: [f64; 3]) -> Self {
        Self { most, most_acceleration, most_jerk, speed: 0.0, acceleration: 0.0 }
    }

    /// Stands still at once: a stop is bound by no limit.
    pub(crate) fn stop(&mut self) {
        (self.speed, self.acceleration) = (0.0, 0.0);
    }

    /// The speed after `elapsed_s` on the way to `target`, which is finite.
    ///
    /// It keeps |speed| + acceleration² / 2 jerk within the limit of speed whenever it speeds up, so that the
    /// acceleration can always be brought to zero in time, however long the next ticks are.
    pub(crate) fn follow(&mut self, target: f64, elapsed_s: f64) -> f64 {
        if elapsed_s <= 0.0 {
            return self.speed;
        }
        let error = target.clamp(-self.most, self.most) - self.speed;
        // The largest a with a · t + a² / 2 jerk = |error|, in a form without cancellation.
        let excess = 2.0 * error.abs() / self.most_jerk;
        let steepest = excess * self.most_jerk / (elapsed_s + (elapsed_s * elapsed_s + excess).sqrt());
        let change = self.most_jerk * elapsed_s;
        let wanted = steepest.min(self.most_acceleration).copysign(error);
        self.acceleration = wanted.clamp(self.acceleration - change, self.acceleration + change);
        self.speed = (self.speed + self.acceleration * elapsed_s).clamp(-self.most, self.most);
        self.speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_is_reached_without_overshoot_and_left_for_zero() {
        let mut axis = Limiter::new([1.0, 1.0, 5.0]);
        let speeds: Vec<f64> =
            (0..200).map(|tick| axis.follow(if tick < 100 { 0.8 } else { 0.0 }, 0.02)).collect();
        assert!((speeds[99] - 0.8).abs() < 1e-6 && speeds[199].abs() < 1e-6);
        assert!(speeds.iter().all(|speed| (-1e-9..0.8 + 1e-9).contains(speed)));
        // 0.2 s to full acceleration, 0.6 s at it, 0.2 s to none.
        let reached = speeds.iter().position(|&speed| speed > 0.79).unwrap();
        assert!((45..55).contains(&reached), "{reached}");
    }
}
