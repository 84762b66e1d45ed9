//! A path as the course of the trajectory optimiser: the price of what a trajectory meets, and what is left
//! of the path at its end.

use core::f64::consts::{PI, TAU};

use glam::DVec2;

use crate::config::PlannerConfig;
use crate::control::trajectory_optimiser::{Course, Met, PlanPose};
use crate::route::state_lattice::{ON_PATH_M, PathPoint, StateLattice, first_leg};

/// The heading at a place of the path is that to the point of the path this far ahead.
const AHEAD_M: f64 = 0.8;
/// A metre of a path counts no more than this: turns on the spot, which its cost includes, are counted apart.
const MOST_PRICE: f64 = 10.0;

/// The first leg of a path.
pub(crate) struct PathCourse<'a> {
    lattice: &'a StateLattice,
    leg: &'a [PathPoint],
    reverse: bool,
    turn_m_rad: f64,
    aside_price: f64,
}

impl<'a> PathCourse<'a> {
    /// The course along a path that begins at the robot.
    pub(crate) fn new(lattice: &'a StateLattice, path: &'a [PathPoint], config: &PlannerConfig) -> Self {
        let reverse = path.get(1).is_some_and(|point| point.reverse);
        Self {
            lattice,
            leg: first_leg(path),
            reverse,
            turn_m_rad: config.state_lattice.turn_m_rad(),
            aside_price: config.controller.trajectory.aside_price,
        }
    }

    /// The nearest place of the leg: its segment, share of it, and distance.
    fn nearest(&self, position_m: DVec2) -> (usize, f64, f64) {
        let mut nearest = (0, 0.0, f64::INFINITY);
        for (index, ends) in self.leg.windows(2).enumerate() {
            let along_m = ends[1].position_m - ends[0].position_m;
            let share = ((position_m - ends[0].position_m).dot(along_m) / along_m.length_squared().max(1e-9))
                .clamp(0.0, 1.0);
            let away_m = position_m.distance(ends[0].position_m + along_m * share);
            if away_m < nearest.2 {
                nearest = (index, share, away_m);
            }
        }
        nearest
    }

    /// The point of the leg that is `ahead_m` beyond a place of it, or on the line beyond its end.
    fn ahead(&self, segment: usize, share: f64, ahead_m: f64) -> DVec2 {
        let mut left_m = ahead_m;
        let mut at_m = self.leg[segment].position_m.lerp(self.leg[segment + 1].position_m, share);
        let mut direction =
            (self.leg[segment + 1].position_m - self.leg[segment].position_m).normalize_or_zero();
        for end in &self.leg[segment + 1..] {
            let path_m = end.position_m - at_m;
            let length_m = path_m.length();
            if length_m > 1e-6 {
                direction = path_m / length_m;
            }
            if length_m >= left_m {
                return at_m + direction * left_m;
            }
            left_m -= length_m;
            at_m = end.position_m;
        }
        at_m + direction * left_m
    }

    /// Angle between a pose's heading and that to the leg ahead of a place of it.
    fn facing_off_from_rad(&self, segment: usize, share: f64, pose: &PlanPose) -> f64 {
        let ahead_m = self.ahead(segment, share, AHEAD_M) - pose.position_m;
        let bearing_rad = libm::atan2(ahead_m.y, ahead_m.x) + if self.reverse { PI } else { 0.0 };
        libm::remainder(bearing_rad - pose.yaw_rad, TAU).abs()
    }
}

impl Course for PathCourse<'_> {
    fn met(&self, pose: &PlanPose) -> Option<Met> {
        let on_path = || self.nearest(pose.position_m).2 < ON_PATH_M;
        let is_admissible = !self.lattice.is_too_near_upright(pose.position_m, pose.yaw_rad)
            && (self.lattice.is_safe(pose.position_m, pose.yaw_rad) || on_path());
        is_admissible.then(|| {
            let risk = self.lattice.risk_at(pose.position_m, pose.yaw_rad);
            Met { risk: risk.price, utilisation: risk.utilisation }
        })
    }

    fn cost_to_go_m(&self, pose: &PlanPose) -> f64 {
        if self.leg.len() < 2 {
            return 0.0;
        }
        let (segment, share, away_m) = self.nearest(pose.position_m);
        let cost_m = |ends: &[PathPoint]| {
            let length_m = ends[0].position_m.distance(ends[1].position_m);
            (ends[1].cost_m - ends[0].cost_m).max(length_m).min(MOST_PRICE * length_m)
        };
        let left_m = cost_m(&self.leg[segment..=segment + 1]) * (1.0 - share)
            + self.leg[segment + 1..].windows(2).map(cost_m).sum::<f64>();
        left_m
            + self.aside_price * away_m * away_m
            + self.turn_m_rad * self.facing_off_from_rad(segment, share, pose)
    }

    fn facing_off_rad(&self, pose: &PlanPose) -> f64 {
        if self.leg.len() < 2 {
            return 0.0;
        }
        let (segment, share, _) = self.nearest(pose.position_m);
        self.facing_off_from_rad(segment, share, pose)
    }

    fn path(&self) -> impl Iterator<Item = (DVec2, bool)> {
        self.leg.iter().skip(1).map(|point| (point.position_m, point.reverse))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;

    fn at(x: f64, y: f64, cost_m: f64, reverse: bool) -> PathPoint {
        PathPoint { position_m: DVec2::new(x, y), cost_m, reverse }
    }

    fn cost_to_go_m(path: &[PathPoint], x: f64, y: f64, yaw_rad: f64) -> f64 {
        let config = PlannerConfig::default();
        let lattice = StateLattice::new(config.state_lattice, &config.robot, 7.0);
        let pose = PlanPose { position_m: DVec2::new(x, y), yaw_rad };
        PathCourse::new(&lattice, path, &config).cost_to_go_m(&pose)
    }

    #[test]
    fn along_a_path_its_own_cost_is_left_and_less_the_farther_it_is_driven() {
        let path = [at(0.0, 0.0, 0.0, false), at(2.0, 0.0, 4.0, false), at(2.0, 1.0, 5.0, false)];
        assert!((cost_to_go_m(&path, 0.0, 0.0, 0.0) - 5.0).abs() < 1e-9);
        assert!((cost_to_go_m(&path, 1.0, 0.0, 0.0) - 3.0).abs() < 1e-9, "a metre that costs two");
        let end = cost_to_go_m(&path, 2.0, 1.0, core::f64::consts::FRAC_PI_2);
        assert!(end.abs() < 1e-9, "{end}");
        assert!(cost_to_go_m(&path, 0.0, 0.5, 0.0) > 5.0, "beside the path");
        assert!(cost_to_go_m(&path, 0.0, 0.0, 1.0) > 5.3, "facing off it");
    }

    #[test]
    fn in_reverse_the_robot_faces_away_from_the_path_and_the_leg_ends_where_the_direction_changes() {
        let path = [at(0.0, 0.0, 0.0, false), at(-1.0, 0.0, 2.0, true), at(2.0, 0.0, 5.0, false)];
        assert!((cost_to_go_m(&path, 0.0, 0.0, 0.0) - 2.0).abs() < 1e-9);
        assert!(cost_to_go_m(&path, 0.0, 0.0, PI) > 3.0);
    }

    #[test]
    fn what_lies_behind_a_turn_on_the_spot_is_not_reached_before_it() {
        // Forward to (1, 0), about, and back past the robot.
        let path = [at(0.0, 0.0, 0.0, false), at(1.0, 0.0, 1.0, false), at(-2.0, 0.1, 5.0, false)];
        assert!((cost_to_go_m(&path, 0.0, 0.0, 0.0) - 1.0).abs() < 1e-9);
        assert!(cost_to_go_m(&path, -1.0, 0.0, 0.0) > 1.5, "in reverse along what comes after the turn");
        assert!(cost_to_go_m(&path, 1.0, 0.0, 0.0).abs() < 1e-9);
    }

    #[test]
    fn a_path_without_a_second_point_is_at_its_end() {
        assert!(cost_to_go_m(&[at(0.0, 0.0, 0.0, false)], 3.0, 0.0, 0.0).abs() < 1e-9);
    }
}
