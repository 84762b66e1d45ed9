//! The progress checker: ends a trial whose robot makes no progress or takes too long.

use glam::DVec2;

use crate::outcome::Outcome;

/// A robot that stays within this distance for this long is stuck.
const STUCK_RADIUS_M: f64 = 0.5;
const STUCK_AFTER_S: f64 = 60.0;
/// The time limit, in seconds, without its share for the distance.
pub const BASE_TIME_LIMIT_S: f64 = 60.0;
/// Multiple of the straight-line time at full speed that the time limit adds to [`BASE_TIME_LIMIT_S`]. It
/// ends trials that would not end by themselves; a robot that is still searching for a path around has not
/// failed.
pub const MOST_STRAIGHT_TIMES: f64 = 48.0;

/// The progress and the time limit of a trial.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ProgressChecker {
    /// Place and tick of the last progress.
    anchor_m: DVec2,
    since_tick: u64,
    period_s: f64,
    limit_s: f64,
}

impl ProgressChecker {
    /// For a robot that sets out from `here_m` towards a place that it could reach in `straight_s` at full
    /// speed; a tick takes `period_s`.
    pub(crate) fn new(here_m: DVec2, tick: u64, period_s: f64, straight_s: f64) -> Self {
        let limit_s = tick as f64 * period_s + BASE_TIME_LIMIT_S + MOST_STRAIGHT_TIMES * straight_s;
        Self { anchor_m: here_m, since_tick: tick, period_s, limit_s }
    }

    /// The outcome, if the trial ends here for lack of progress or time.
    pub(crate) fn check(&mut self, here_m: DVec2, tick: u64) -> Option<Outcome> {
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
        let mut checker = ProgressChecker::new(at(0.0), 1000, 0.1, 1000.0);
        assert_eq!(checker.check(at(0.5), 1600), None);
        assert_eq!(checker.check(at(0.6), 1607), None);
        assert_eq!(checker.check(at(0.2), 2207), None);
        assert_eq!(checker.check(at(0.2), 2208), Some(Outcome::Stuck));
    }

    #[test]
    fn time_ends_after_a_multiple_of_the_straight_time_and_a_minute() {
        let mut checker = ProgressChecker::new(at(0.0), 100, 1.0, 20.0);
        let last = 100 + 60 + 48 * 20_u32;
        assert!((100..=last).all(|second| checker.check(at(f64::from(second)), second.into()).is_none()));
        assert_eq!(checker.check(at(f64::from(last + 1)), u64::from(last + 1)), Some(Outcome::Timeout));
    }
}
