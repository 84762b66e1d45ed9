//! When a trial is given up: its robot does not get anywhere, or takes too long.

use glam::DVec2;

use crate::outcome::Outcome;

/// A robot that stays within this distance for this long is stuck.
const STUCK_RADIUS_M: f64 = 0.5;
const STUCK_AFTER_S: f64 = 60.0;
/// A trial may last this long plus this many times the straight way at full speed.
const BASE_TIME_LIMIT_S: f64 = 60.0;
const STRAIGHT_TIMES: f64 = 12.0;

/// How long the robot may still take.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Patience {
    /// Where it was when it last got on, and when.
    anchor_m: DVec2,
    since_tick: u64,
    period_s: f64,
    limit_s: f64,
}

impl Patience {
    /// With a robot that starts here and now towards a place that it could reach in `straight_s` at full speed; a tick takes
    /// `period_s`.
    pub(crate) fn new(here_m: DVec2, tick: u64, period_s: f64, straight_s: f64) -> Self {
        let limit_s = tick as f64 * period_s + BASE_TIME_LIMIT_S + STRAIGHT_TIMES * straight_s;
        Self { anchor_m: here_m, since_tick: tick, period_s, limit_s }
    }

    /// Whether it is lost, with the robot here and now, and why.
    pub(crate) fn lost(&mut self, here_m: DVec2, tick: u64) -> Option<Outcome> {
        if (here_m - self.anchor_m).length() > STUCK_RADIUS_M {
            (self.anchor_m, self.since_tick) = (here_m, tick);
        } else if (tick - self.since_tick) as f64 * self.period_s > STUCK_AFTER_S {
            return Some(Outcome::Stuck);
        }
        (tick as f64 * self.period_s > self.limit_s).then_some(Outcome::Timeout)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x_m: f64) -> DVec2 {
        DVec2::new(x_m, 0.0)
    }

    #[test]
    fn a_robot_that_gets_nowhere_is_stuck() {
        let mut patience = Patience::new(at(0.0), 1000, 0.1, 1000.0);
        assert_eq!(patience.lost(at(0.5), 1600), None);
        assert_eq!(patience.lost(at(0.6), 1607), None);
        assert_eq!(patience.lost(at(0.2), 2207), None);
        assert_eq!(patience.lost(at(0.2), 2208), Some(Outcome::Stuck));
    }

    #[test]
    fn time_ends_after_twelve_times_the_straight_way_and_a_minute() {
        let mut patience = Patience::new(at(0.0), 100, 1.0, 20.0);
        assert!((100..=400_u32).all(|second| patience.lost(at(f64::from(second)), second.into()).is_none()));
        assert_eq!(patience.lost(at(401.0), 401), Some(Outcome::Timeout));
    }
}
