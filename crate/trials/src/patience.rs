//! When a trial is given up: its robot does not get anywhere, or takes too long.

use glam::DVec2;

use crate::outcome::Outcome;

/// A robot that stays within this distance for this long is stuck.
const STUCK_RADIUS_M: f64 = 0.5;
const STUCK_AFTER_S: f64 = 30.0;
/// A trial may last this long plus this many times the straight way at full speed.
const BASE_TIME_LIMIT_S: f64 = 60.0;
const STRAIGHT_TIMES: f64 = 4.0;

/// How long the robot may still take.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Patience {
    /// Where it was when it last got on, and when.
    anchor_m: DVec2,
    since_s: f64,
    limit_s: f64,
}

impl Patience {
    /// With a robot that starts here and now towards a place that it could reach in `straight_s` at full speed.
    pub(crate) fn new(here_m: DVec2, time_s: f64, straight_s: f64) -> Self {
        Self {
            anchor_m: here_m,
            since_s: time_s,
            limit_s: time_s + BASE_TIME_LIMIT_S + STRAIGHT_TIMES * straight_s,
        }
    }

    /// Whether it is lost, with the robot here and now, and why.
    pub(crate) fn lost(&mut self, here_m: DVec2, time_s: f64) -> Option<Outcome> {
        if (here_m - self.anchor_m).length() > STUCK_RADIUS_M {
            (self.anchor_m, self.since_s) = (here_m, time_s);
        } else if time_s - self.since_s > STUCK_AFTER_S {
            return Some(Outcome::Stuck);
        }
        (time_s > self.limit_s).then_some(Outcome::Timeout)
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
        let mut patience = Patience::new(at(0.0), 100.0, 1000.0);
        assert_eq!(patience.lost(at(0.5), 130.0), None);
        assert_eq!(patience.lost(at(0.6), 130.1), None);
        assert_eq!(patience.lost(at(0.2), 160.0), None);
        assert_eq!(patience.lost(at(0.2), 160.2), Some(Outcome::Stuck));
    }

    #[test]
    fn time_ends_after_four_times_the_straight_way_and_a_minute() {
        let mut patience = Patience::new(at(0.0), 100.0, 20.0);
        assert!((0..=240).all(|second| patience.lost(at(f64::from(second)), f64::from(second)).is_none()));
        assert_eq!(patience.lost(at(241.0), 240.1), Some(Outcome::Timeout));
    }
}
