//! Progress toward a goal that is near.

use glam::DVec2;

/// Nearer by less than this is no progress.
const LEAST_GAIN_M: f64 = 0.25;
/// A goal in sight is out of reach once the robot has driven this far about it without coming nearer.
const MOST_DRIVEN_M: f64 = 40.0;

/// How near the robot has come to its goal, and how far it has driven about it since.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GoalProgress {
    nearest_m: f64,
    driven_m: f64,
    last_m: Option<DVec2>,
}

impl GoalProgress {
    /// Nothing driven yet.
    pub(crate) const NONE: Self = Self { nearest_m: f64::INFINITY, driven_m: 0.0, last_m: None };

    /// Notes where the robot is; whether the goal is out of reach. Driving farther from the goal than
    /// `sight_m` does not count: a way around may lead there.
    pub(crate) fn is_out_of_reach(&mut self, here_m: DVec2, goal_m: DVec2, sight_m: f64) -> bool {
        let distance_m = (goal_m - here_m).length();
        let moved_m = self.last_m.map_or(0.0, |last_m| (here_m - last_m).length());
        self.last_m = Some(here_m);
        if distance_m < self.nearest_m - LEAST_GAIN_M {
            (self.nearest_m, self.driven_m) = (distance_m, 0.0);
        } else if distance_m < sight_m {
            self.driven_m += moved_m;
        }
        self.driven_m > MOST_DRIVEN_M
    }

    /// Forgets the last place, as after a jump of the localisation.
    pub(crate) fn relocalise(&mut self) {
        self.last_m = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of 0.1 m around the goal until it is out of reach.
    fn circles(radius_m: f64) -> Option<f64> {
        let mut progress = GoalProgress::NONE;
        (0..2000).map(|step| 0.1 * f64::from(step)).find(|&driven_m| {
            let here_m = DVec2::from_angle(driven_m / radius_m) * radius_m;
            progress.is_out_of_reach(here_m, DVec2::ZERO, 7.0)
        })
    }

    #[test]
    fn circling_about_a_goal_in_sight_ends_and_driving_far_from_it_does_not() {
        let ended_m = circles(1.5).unwrap();
        assert!((ended_m - MOST_DRIVEN_M).abs() < 1.0, "{ended_m}");
        assert_eq!(circles(8.0), None);
    }

    #[test]
    fn whoever_comes_nearer_may_go_on() {
        let mut progress = GoalProgress::NONE;
        for step in 0..10_000 {
            // A spiral that gains 0.3 m a turn.
            let turns = f64::from(step) * 0.002;
            let here_m = DVec2::from_angle(turns * core::f64::consts::TAU) * (6.5 - 0.3 * turns);
            assert!(!progress.is_out_of_reach(here_m, DVec2::ZERO, 7.0));
        }
    }
}
