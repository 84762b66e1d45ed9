//! Progress toward the goal: whether the robot gets anywhere, and nearer to a goal in sight.

use core::time::Duration;

use glam::DVec2;

use crate::decision::step::StopReason;

/// Nearer by less than this is no progress.
const LEAST_GAIN_M: f64 = 0.25;
/// A goal in sight, or one at which the body has no room, is out of reach once the robot has driven this far
/// without coming nearer.
const MOST_DRIVEN_M: f64 = 40.0;
/// A robot that is commanded to move must leave a circle of this radius within this time.
const CIRCLE_M: f64 = 0.5;
const MOST_TIME: Duration = Duration::from_secs(30);
/// After lost scans, or since a goal before, no more than this counts: nobody lets the robot move on for so
/// long.
pub(crate) const MOST_ELAPSED: Duration = Duration::from_secs(1);

/// How near the robot has come to its goal, how far it has driven about it since, and how long it was
/// commanded to move within a circle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GoalProgress {
    nearest_m: f64,
    driven_m: f64,
    /// Whether the body has room at the goal, as last seen.
    has_room: bool,
    last_m: Option<DVec2>,
    centre_m: Option<DVec2>,
    within: Duration,
}

impl GoalProgress {
    /// Nothing driven yet.
    pub(crate) const NONE: Self = Self {
        nearest_m: f64::INFINITY,
        driven_m: 0.0,
        has_room: true,
        last_m: None,
        centre_m: None,
        within: Duration::ZERO,
    };

    /// Notes whether the body has room at the goal, if that is known.
    pub(crate) fn notice_room(&mut self, has_room: Option<bool>) {
        self.has_room = has_room.unwrap_or(self.has_room);
    }

    /// Notes where the robot is, after it was `commanded` to move for some time, which is zero if it was to
    /// stand. Returns why it is to stop, if there is no progress: it stays where it is, or the goal is out of
    /// reach. Driving farther from the goal than `sight_m` may be a way around, if the body has room there.
    pub(crate) fn check(
        &mut self,
        here_m: DVec2,
        goal_m: DVec2,
        sight_m: f64,
        commanded: Duration,
    ) -> Result<(), StopReason> {
        let distance_m = (goal_m - here_m).length();
        let moved_m = self.last_m.map_or(0.0, |last_m| (here_m - last_m).length());
        self.last_m = Some(here_m);
        if distance_m < self.nearest_m - LEAST_GAIN_M {
            (self.nearest_m, self.driven_m) = (distance_m, 0.0);
        } else if distance_m < sight_m || !self.has_room {
            self.driven_m += moved_m;
        }
        let centre_m = *self.centre_m.get_or_insert(here_m);
        if (here_m - centre_m).length() > CIRCLE_M {
            (self.centre_m, self.within) = (Some(here_m), Duration::ZERO);
        }
        self.within = self.within.saturating_add(commanded.min(MOST_ELAPSED));
        if self.within > MOST_TIME {
            Err(StopReason::NoProgress)
        } else if self.driven_m > MOST_DRIVEN_M {
            Err(StopReason::GoalUnreachable)
        } else {
            Ok(())
        }
    }

    /// Forgets the last place, as after a jump of the localisation. The goal keeps its coordinates, so it is
    /// another place now, `farther_m` farther from the robot.
    pub(crate) fn relocalise(&mut self, farther_m: f64) {
        self.nearest_m += farther_m;
        if self.nearest_m < 0.0 {
            // Nearer than any place: nothing that was driven before compares.
            (self.nearest_m, self.driven_m) = (f64::INFINITY, 0.0);
        }
        self.has_room = true;
        self.last_m = None;
        self.centre_m = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: Duration = Duration::from_millis(100);

    /// Steps of 0.1 m around the goal until it is out of reach.
    fn circles(radius_m: f64) -> Option<f64> {
        let mut progress = GoalProgress::NONE;
        (0..2000).map(|step| 0.1 * f64::from(step)).find(|&driven_m| {
            let here_m = DVec2::from_angle(driven_m / radius_m) * radius_m;
            progress.check(here_m, DVec2::ZERO, 7.0, STEP) == Err(StopReason::GoalUnreachable)
        })
    }

    #[test]
    fn circling_about_a_goal_in_sight_ends_and_driving_far_from_it_does_not() {
        let ended_m = circles(1.5).unwrap();
        assert!((ended_m - MOST_DRIVEN_M).abs() < 1.0, "{ended_m}");
        assert_eq!(circles(8.0), None);
    }

    #[test]
    fn a_goal_without_room_is_out_of_reach_on_any_way_around_until_room_is_seen() {
        let mut progress = GoalProgress::NONE;
        let drive_on = |progress: &mut GoalProgress, metres: f64| {
            (0..(10.0 * metres) as usize).all(|step| {
                let here_m = DVec2::new(9.0, 0.1 * (step % 2) as f64);
                progress.check(here_m, DVec2::ZERO, 7.0, Duration::ZERO).is_ok()
            })
        };
        progress.notice_room(Some(false));
        assert!(drive_on(&mut progress, 39.0));
        progress.notice_room(Some(true));
        assert!(drive_on(&mut progress, 39.0));
        progress.notice_room(Some(false));
        progress.notice_room(None);
        let mut moved = progress;
        moved.relocalise(0.0);
        assert!(!drive_on(&mut progress, 2.0));
        assert!(drive_on(&mut moved, 50.0), "room may be where the goal is now");
    }

    #[test]
    fn a_goal_that_a_correction_put_farther_off_is_approached_anew() {
        let mut progress = GoalProgress::NONE;
        // Six metres towards the goal.
        let drive = |progress: &mut GoalProgress, from_m: f64| {
            (0..60).all(|step| {
                let here_m = DVec2::X * (from_m - 0.1 * f64::from(step));
                progress.check(here_m, DVec2::ZERO, 20.0, Duration::ZERO).is_ok()
            })
        };
        assert!((0..3).all(|_| drive(&mut progress, 7.0)));
        let mut untold = progress;
        progress.relocalise(11.0);
        assert!((0..2).all(|_| drive(&mut progress, 12.0)));
        assert!(!(0..2).all(|_| drive(&mut untold, 12.0)));
        // It came to 1.1 m of where the goal was, and the goal is 5 m nearer than it was told.
        let mut nearer = untold;
        nearer.relocalise(-5.0);
        assert!((0..3).all(|_| drive(&mut nearer, 7.0)));
    }

    #[test]
    fn whoever_comes_nearer_may_go_on() {
        let mut progress = GoalProgress::NONE;
        for step in 0..10_000 {
            // A spiral that gains 0.3 m a turn.
            let turns = f64::from(step) * 0.002;
            let here_m = DVec2::from_angle(turns * core::f64::consts::TAU) * (6.5 - 0.3 * turns);
            assert_eq!(progress.check(here_m, DVec2::ZERO, 7.0, STEP), Ok(()));
        }
    }

    /// The step at which a robot is stopped that sways by this distance about a place.
    fn stopped_at_step(sway_m: f64) -> Option<usize> {
        let mut progress = GoalProgress::NONE;
        (0..1000).find(|&step| {
            let here_m = DVec2::X * if step % 2 == 0 { 0.0 } else { sway_m };
            progress.check(here_m, DVec2::X * 30.0, 7.0, STEP) == Err(StopReason::NoProgress)
        })
    }

    #[test]
    fn half_a_minute_within_half_a_metre_is_no_progress_and_more_is() {
        assert_eq!((stopped_at_step(0.0), stopped_at_step(0.4)), (Some(300), Some(300)));
        assert_eq!(stopped_at_step(0.6), None);
    }

    #[test]
    fn the_time_of_lost_scans_does_not_count() {
        let mut progress = GoalProgress::NONE;
        for lost_s in [20, 20, 60] {
            assert_eq!(progress.check(DVec2::ZERO, DVec2::X, 7.0, Duration::from_secs(lost_s)), Ok(()));
        }
    }
}
