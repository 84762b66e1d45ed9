//! The committed target: the last chosen subgoal stays a candidate until the robot arrives or makes no
//! progress.
//!
//! On a tilted robot the skyline changes with the heading: a subgoal may be gone once the robot has turned
//! towards it. So the target stays a candidate as long as a path leads to it.

use core::time::Duration;

use glam::DVec2;

use crate::decision::candidates::Candidates;
use crate::decision::goal_progress::MOST_ELAPSED;
use crate::decision::subgoals::Subgoal;
use crate::pose::{FrameChange, Pose};

/// Within this distance the robot has arrived.
const ARRIVAL_RADIUS_M: f64 = 0.5;
/// Progress check: the robot must leave a circle of this radius within this time.
const PROGRESS_RADIUS_M: f64 = 1.0;
const PROGRESS_TIME: Duration = Duration::from_secs(12);

/// The committed target and its progress check.
#[derive(Clone, Debug, Default)]
pub(crate) struct CommittedTarget {
    subgoal: Option<Subgoal>,
    left_m: DVec2,
    /// Time since the robot last made progress.
    time: Duration,
}

impl CommittedTarget {
    /// The committed target as a candidate seen from the present pose. `Err` has its position if no path
    /// leads there any more.
    pub(crate) fn reconsider(&mut self, candidates: &mut Candidates<'_>) -> Result<Option<Subgoal>, DVec2> {
        let Some(last) = self.subgoal else { return Ok(None) };
        let place_m = last.position_m.truncate();
        if (place_m - candidates.pose.plan_m()).length() < ARRIVAL_RADIUS_M {
            self.subgoal = None;
            return Ok(None);
        }
        let Some(reached) = candidates.lattice.to(place_m) else {
            self.subgoal = None;
            return Err(place_m);
        };
        Ok(Some(candidates.place(place_m, reached, last.forecast.unwrap_or_default().end)))
    }

    /// Commits to a subgoal and checks progress. If there was none for too long, releases the target and
    /// returns its position.
    pub(crate) fn commit(&mut self, subgoal: &Subgoal, pose: &Pose, elapsed: Duration) -> Option<DVec2> {
        self.subgoal = Some(*subgoal);
        if (pose.plan_m() - self.left_m).length() > PROGRESS_RADIUS_M {
            self.left_m = pose.plan_m();
            self.time = Duration::ZERO;
        }
        self.time = self.time.saturating_add(elapsed.min(MOST_ELAPSED));
        (self.time > PROGRESS_TIME).then(|| {
            *self = Self { left_m: self.left_m, ..Self::default() };
            subgoal.position_m.truncate()
        })
    }

    /// Moves the target from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        self.left_m = change.place_m(self.left_m);
        if let Some(subgoal) = &mut self.subgoal {
            subgoal.position_m = change.point_m(subgoal.position_m);
        }
    }

    /// Releases the target.
    pub(crate) fn release(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: Duration = Duration::from_millis(100);
    use crate::config::PlannerConfig;
    use crate::route::forecast::Forecast;
    use crate::route::state_lattice::StateLattice;
    use crate::terrain::plane::Plane;
    use glam::DVec3;

    fn pose(x_m: f64) -> Pose {
        Pose { position_m: DVec3::new(x_m, 0.0, 0.0), roll_rad: 0.0, pitch_rad: 0.0, yaw_rad: 0.0 }
    }

    fn subgoal(x_m: f64) -> Subgoal {
        Subgoal {
            segment: Some(3),
            azimuth_rad: 0.0,
            elevation_rad: 0.0,
            position_m: DVec3::new(x_m, 0.0, 0.0),
            bearing_rad: 0.0,
            forecast: Some(Forecast::default()),
            refusal: None,
            cost: None,
        }
    }

    /// The committed target as seen from `here_x_m`, on level ground that ends at `end_x_m`.
    fn reconsider(
        committed: &mut CommittedTarget,
        here_x_m: f64,
        end_x_m: f64,
    ) -> Result<Option<Subgoal>, DVec2> {
        let (config, pose) = (PlannerConfig::default(), pose(here_x_m));
        let mut lattice = StateLattice::new(config.state_lattice, &config.robot, 7.0);
        let ground = |place_m: DVec2| {
            let plane = Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.0 };
            (place_m.x < end_x_m).then_some(plane)
        };
        lattice.search(&ground, &pose, STEP);
        let path = &mut Vec::new();
        committed.reconsider(&mut Candidates { config: &config, pose: &pose, lattice: &lattice, path })
    }

    #[test]
    fn the_committed_target_stays_a_candidate_until_arrival() {
        let mut committed = CommittedTarget::default();
        assert_eq!(reconsider(&mut committed, 0.0, 9.0), Ok(None));
        assert_eq!(committed.commit(&subgoal(5.0), &pose(0.0), STEP), None);
        for x_m in [0.5, 2.0, 4.0] {
            let target = reconsider(&mut committed, x_m, 9.0).unwrap().unwrap();
            assert!(target.position_m == subgoal(5.0).position_m && target.segment.is_none());
            let forecast = target.forecast.unwrap();
            assert!((forecast.reach_m - (5.0 - x_m)).abs() < 1e-12 && forecast.path_m > 0.5);
        }
        assert_eq!(reconsider(&mut committed, 4.6, 9.0), Ok(None));
    }

    #[test]
    fn an_unreachable_target_is_reported_once() {
        let mut committed = CommittedTarget::default();
        committed.commit(&subgoal(5.0), &pose(0.0), STEP);
        assert_eq!(reconsider(&mut committed, 0.0, 3.0), Err(DVec2::new(5.0, 0.0)));
        assert_eq!(reconsider(&mut committed, 0.0, 3.0), Ok(None));
    }

    #[test]
    fn the_time_of_lost_scans_does_not_count() {
        let mut committed = CommittedTarget::default();
        let late = Duration::from_secs(60);
        assert!((0..5).all(|_| committed.commit(&subgoal(5.0), &pose(0.0), late).is_none()));
    }

    #[test]
    fn a_robot_that_does_not_get_on_lets_go() {
        let mut committed = CommittedTarget::default();
        let lets_go = |committed: &mut CommittedTarget, x_m: f64| {
            committed.commit(&subgoal(5.0), &pose(x_m), STEP).is_some()
        };
        for _ in 0..3 {
            assert!((0..120).all(|_| !lets_go(&mut committed, 0.1)));
            assert!(lets_go(&mut committed, 0.1));
        }
        assert!((0..1200).all(|tick| !lets_go(&mut committed, 0.02 * f64::from(tick))));
    }
}
