//! Limits on a commanded speed and on its changes.

/// One axis of a command: a speed that follows its target within limits on acceleration and jerk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limiter {
    most: f64,
    /// What the speed may be now: a limit that was lowered is not reached yet.
    reach: f64,
    most_acceleration: f64,
    most_jerk: f64,
    speed: f64,
    acceleration: f64,
}

impl Limiter {
    /// An axis that stands still.
    pub(crate) fn new([most, most_acceleration, most_jerk]: [f64; 3]) -> Self {
        Self { most, reach: most, most_acceleration, most_jerk, speed: 0.0, acceleration: 0.0 }
    }

    /// Takes other limits. A speed above them is brought down within those on acceleration and jerk.
    pub(crate) fn limit(&mut self, [most, most_acceleration, most_jerk]: [f64; 3]) {
        *self = Self { most, reach: self.reach.max(most), most_acceleration, most_jerk, ..*self };
    }

    /// Stands still at once: a stop is bound by no limit.
    pub(crate) fn stop(&mut self) {
        (self.speed, self.acceleration, self.reach) = (0.0, 0.0, self.most);
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
        self.speed = (self.speed + self.acceleration * elapsed_s).clamp(-self.reach, self.reach);
        // What the speed reaches until the acceleration is brought to zero.
        let gained = 0.5 * self.acceleration * self.acceleration.abs() / self.most_jerk;
        if self.speed.abs().max((self.speed + gained).abs()) <= self.most {
            self.reach = self.most;
        }
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

    #[test]
    fn a_lowered_limit_is_reached_without_a_step() {
        // Lowered while it still speeds up, and once it is fast.
        for lowered in 10..80 {
            let mut axis = Limiter::new([1.0, 1.0, 5.0]);
            let (mut before, mut rate_before) = (0.0, 0.0);
            for tick in 0..200 {
                if tick == lowered {
                    axis.limit([0.4, 0.8, 5.0]);
                }
                let speed = axis.follow(0.9, 0.02);
                let rate: f64 = (speed - before) / 0.02;
                assert!(speed < 0.9 + 1e-9 && rate.abs() < 1.0 + 1e-9, "{lowered}, {tick}: {speed}, {rate}");
                assert!((rate - rate_before).abs() < 5.0 * 0.02 + 1e-9, "{lowered}, {tick}: jerk");
                assert!(tick < lowered + 75 || speed < 0.4 + 1e-9, "{lowered}, {tick}: {speed}");
                (before, rate_before) = (speed, rate);
            }
            axis.limit([1.0, 1.0, 5.0]);
            let raised = (0..100).fold(0.0, |_, _| axis.follow(0.9, 0.02));
            assert!((raised - 0.9).abs() < 1e-6);
        }
    }
}
