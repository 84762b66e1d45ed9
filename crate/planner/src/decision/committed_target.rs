//! Holding on to what the robot heads for, and letting go of it.
//!
//! From a tilted robot the skyline is another one at each heading: a subgoal that it turns to may not be there any more when it has
//! turned. So what it heads for stays a candidate until it is there, as long as a way over the ground that was seen leads there.

use glam::DVec2;

use crate::decision::candidates::Candidates;
use crate::decision::subgoals::Subgoal;
use crate::pose::Pose;

/// The robot is there when it is this near.
const THERE_M: f64 = 0.5;
/// It gets on while it leaves a place by this much within so many steps.
const GETS_ON_M: f64 = 1.0;
const PATIENCE_TICKS: u32 = 120;

/// What the robot heads for.
#[derive(Clone, Debug, Default)]
pub(crate) struct CommittedTarget {
    subgoal: Option<Subgoal>,
    left_m: DVec2,
    ticks: u32,
}

impl CommittedTarget {
    /// The subgoal that was chosen last as seen from here, a candidate again. `Err` is where it lies when no way leads there any more.
    pub(crate) fn again(&mut self, candidates: &mut Candidates<'_>) -> Result<Option<Subgoal>, DVec2> {
        let Some(last) = self.subgoal else { return Ok(None) };
        let place_m = last.position_m.truncate();
        if (place_m - candidates.pose.plan_m()).length() < THERE_M {
            self.subgoal = None;
            return Ok(None);
        }
        let Some(reached) = candidates.lattice.to(place_m) else {
            self.subgoal = None;
            return Err(place_m);
        };
        Ok(Some(candidates.place(place_m, reached, last.forecast.unwrap_or_default().end)))
    }

    /// Heads for a subgoal. Gives where it lies, and lets go of it, when the robot has not got on for too long.
    pub(crate) fn head_for(&mut self, subgoal: &Subgoal, pose: &Pose) -> Option<DVec2> {
        self.subgoal = Some(*subgoal);
        if (pose.plan_m() - self.left_m).length() > GETS_ON_M {
            self.left_m = pose.plan_m();
            self.ticks = 0;
        }
        self.ticks += 1;
        (self.ticks > PATIENCE_TICKS).then(|| {
            *self = Self { left_m: self.left_m, ..Self::default() };
            subgoal.position_m.truncate()
        })
    }

    /// Heads for nothing.
    pub(crate) fn stand(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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

    /// What was headed for as seen from `here_x_m`, on level ground that ends at `end_x_m`.
    fn again(committed: &mut CommittedTarget, here_x_m: f64, end_x_m: f64) -> Result<Option<Subgoal>, DVec2> {
        let (config, pose) = (PlannerConfig::default(), pose(here_x_m));
        let mut lattice = StateLattice::new(config.state_lattice, &config.robot, 7.0);
        let ground = |place_m: DVec2| {
            let plane = Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.0 };
            (place_m.x < end_x_m).then_some(plane)
        };
        lattice.search(&ground, &pose);
        let path = &mut Vec::new();
        committed.again(&mut Candidates { config: &config, pose: &pose, lattice: &lattice, path })
    }

    #[test]
    fn what_it_heads_for_stays_a_candidate_until_it_is_there() {
        let mut committed = CommittedTarget::default();
        assert_eq!(again(&mut committed, 0.0, 9.0), Ok(None));
        assert_eq!(committed.head_for(&subgoal(5.0), &pose(0.0)), None);
        for x_m in [0.5, 2.0, 4.0] {
            let again = again(&mut committed, x_m, 9.0).unwrap().unwrap();
            assert!(again.position_m == subgoal(5.0).position_m && again.segment.is_none());
            let forecast = again.forecast.unwrap();
            assert!((forecast.reach_m - (5.0 - x_m)).abs() < 1e-12 && forecast.path_m > 0.5);
        }
        assert_eq!(again(&mut committed, 4.6, 9.0), Ok(None));
    }

    #[test]
    fn where_no_way_leads_any_more_is_told_once() {
        let mut committed = CommittedTarget::default();
        committed.head_for(&subgoal(5.0), &pose(0.0));
        assert_eq!(again(&mut committed, 0.0, 3.0), Err(DVec2::new(5.0, 0.0)));
        assert_eq!(again(&mut committed, 0.0, 3.0), Ok(None));
    }

    #[test]
    fn a_robot_that_does_not_get_on_lets_go() {
        let mut committed = CommittedTarget::default();
        let lets_go = |committed: &mut CommittedTarget, x_m: f64| {
            committed.head_for(&subgoal(5.0), &pose(x_m)).is_some()
        };
        for _ in 0..3 {
            assert!((0..PATIENCE_TICKS).all(|_| !lets_go(&mut committed, 0.1)));
            assert!(lets_go(&mut committed, 0.1));
        }
        assert!((0..10 * PATIENCE_TICKS).all(|tick| !lets_go(&mut committed, 0.02 * f64::from(tick))));
    }
}
