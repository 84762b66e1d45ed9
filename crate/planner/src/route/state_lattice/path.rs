//! Queries of the searched lattice: reach along a direction, the path to a place, and the lookahead point.

use core::time::Duration;

use glam::DVec2;

use super::{BEGIN, MILLIMETRES, PathPoint, ReachedState, StateLattice, UNREACHED};
use crate::route::forecast::{Forecast, ReachEnd};
use crate::terrain::headings::{DIRECTIONS, HEADINGS, STEPS, nearest};
use crate::terrain::slopes::Slopes;
use crate::terrain::traversability::RiskBetween;

/// Tilt utilisation is predicted this far ahead. Ground that is unseen or unsafe counts as this utilisation.
const AHEAD_M: f64 = 1.0;
const BLIND_UTILISATION: f64 = 0.75;
/// The attitude's rate of change is extrapolated over this time.
const EXTRAPOLATION_TIME: Duration = Duration::from_millis(500);

/// Length of a path.
pub(crate) fn length_m(path: &[PathPoint]) -> f64 {
    path.windows(2).map(|leg| (leg[1].position_m - leg[0].position_m).length()).sum()
}

/// The first leg of a path: up to its first cusp, where it changes between forward and reverse or turns back
/// on the spot.
pub(crate) fn first_leg(path: &[PathPoint]) -> &[PathPoint] {
    let is_cusp = |at: &[PathPoint]| {
        let [to_m, on_m] = [at[1].position_m - at[0].position_m, at[2].position_m - at[1].position_m];
        at[1].reverse != at[2].reverse || to_m.dot(on_m) < 0.0
    };
    let points = path.windows(3).position(is_cusp).map_or(path.len(), |before| before + 2);
    &path[..points]
}

/// A state that a path enters by a drive from another, which is `BEGIN` for the robot's pose.
pub(super) struct Entered {
    pub(super) state: u32,
    pub(super) from: u32,
    pub(super) position_m: DVec2,
    pub(super) heading: usize,
    pub(super) reverse: bool,
}

impl StateLattice {
    /// The cheapest path to the place nearest to a point; `None` if there is none.
    pub(crate) fn to(&self, point_m: DVec2) -> Option<ReachedState> {
        self.cheapest(self.traversability.places.index(self.traversability.places.nearest(point_m)?))
    }

    /// The cheapest path to a place; `None` if there is none.
    pub(super) fn cheapest(&self, place: usize) -> Option<ReachedState> {
        let states = place * HEADINGS..(place + 1) * HEADINGS;
        let state = states.min_by_key(|&state| self.costs_mm[state])?;
        (self.costs_mm[state] != UNREACHED).then_some(ReachedState { state: state as u32 })
    }

    /// The cheapest path to a point or else to the nearest reached place within `distance_m`, and the
    /// position of its end.
    pub(crate) fn to_within(&self, point_m: DVec2, distance_m: f64) -> Option<(ReachedState, DVec2)> {
        let around = || {
            let places =
                self.reached().map(|(reached, place_m)| ((place_m - point_m).length(), reached, place_m));
            let next = places.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|next| next.0 <= distance_m);
            next.map(|(_, reached, place_m)| (reached, place_m))
        };
        self.to(point_m).map(|reached| (reached, point_m)).or_else(around)
    }

    /// Distance that the robot can get along the straight line in a direction, up to `length_m`, by whatever
    /// path.
    pub(crate) fn reach_along(&self, direction: DVec2, length_m: f64) -> (f64, ReachEnd) {
        let steps = (length_m / self.config.step_m).ceil() as usize;
        let distance_m = |step: usize| (self.config.step_m * step as f64).min(length_m);
        let at = |step: usize| self.here_m + direction * distance_m(step);
        let last = (1..=steps).rev().find(|&step| self.to(at(step)).is_some()).unwrap_or(0);
        if last == steps {
            return (length_m, ReachEnd::Whole);
        }
        let known = self
            .traversability
            .places
            .nearest(at(last + 1))
            .is_some_and(|place| self.traversability.plane(place).is_some());
        let end = if known { ReachEnd::Tilt } else { ReachEnd::Unseen };
        // Stop short of steep or unseen ground: the body reaches further than its centre.
        let most_m = distance_m(last) - self.config.clearance_m;
        let reach = (1..=last).rev().find(|&step| distance_m(step) <= most_m && self.to(at(step)).is_some());
        (reach.map_or(0.0, distance_m), end)
    }

    /// The states that the path to a reached place enters by a drive, the last one first.
    pub(super) fn entered(&self, reached: ReachedState) -> impl Iterator<Item = Entered> {
        let position_m = |state: u32| {
            let places = &self.traversability.places;
            places.position_m(places.offset(state as usize / HEADINGS))
        };
        let before = |&state: &u32| Some(self.came_from[state as usize]).filter(|&from| from != BEGIN);
        core::iter::successors(Some(reached.state), before).filter_map(move |state| {
            let (from, heading) = (self.came_from[state as usize], state as usize % HEADINGS);
            let turned = from != BEGIN && from as usize / HEADINGS == state as usize / HEADINGS;
            let from_m = if from == BEGIN { self.here_m } else { position_m(from) };
            let reverse = (position_m(state) - from_m).dot(STEPS[heading].as_dvec2()) < 0.0;
            (!turned).then(|| Entered { state, from, position_m: position_m(state), heading, reverse })
        })
    }

    /// Writes the path to a reached place, from the robot's position on, to `path`, and returns its forecast.
    pub(crate) fn follow(&self, reached: ReachedState, path: &mut Vec<PathPoint>) -> Forecast {
        path.clear();
        let (mut across, mut along) = (0.0_f64, 0.0_f64);
        let (mut risk_sum, mut count, mut climb_m) = (0.0, 0.0, 0.0);
        for Entered { state, from, position_m, heading, reverse } in self.entered(reached) {
            let offset = self.traversability.places.offset(state as usize / HEADINGS);
            risk_sum += self.traversability.risk(offset, heading);
            count += 1.0;
            if let Some(plane) = self.traversability.plane(offset) {
                let slopes = Slopes::facing(plane.gradient, DIRECTIONS[heading % DIRECTIONS.len()]);
                across = across.max(slopes.across);
                along = along.max(slopes.along);
            }
            let height_m = |state: u32| self.height_m(ReachedState { state });
            let last_height_m = if from != BEGIN { height_m(from) } else { self.attitude.height_m };
            climb_m += (height_m(state) - last_height_m).abs();
            let cost_m = f64::from(self.costs_mm[state as usize]) / MILLIMETRES;
            path.push(PathPoint { position_m, cost_m, reverse });
        }
        path.push(PathPoint { position_m: self.here_m, cost_m: 0.0, reverse: false });
        path.reverse();
        Forecast {
            path_m: length_m(path),
            climb_m,
            mean_risk: if count > 0.0 { risk_sum / count } else { 0.0 },
            max_roll_rad: libm::atan(across),
            max_pitch_rad: libm::atan(along),
            ..Forecast::default()
        }
    }

    /// Cost of the path to a reached place.
    pub(crate) fn cost_m(&self, reached: ReachedState) -> f64 {
        f64::from(self.costs_mm[reached.state as usize]) / MILLIMETRES
    }

    /// Height of the ground at a reached place.
    pub(crate) fn height_m(&self, reached: ReachedState) -> f64 {
        let offset = self.traversability.places.offset(reached.state as usize / HEADINGS);
        self.traversability.plane(offset).map_or(self.attitude.height_m, |plane| plane.height_m)
    }

    /// The lookahead point on a path: the farthest point of its first leg to which the straight line costs no
    /// more than the path.
    pub(crate) fn lookahead(&self, path: &[PathPoint]) -> PathPoint {
        let stay = PathPoint { position_m: self.here_m, cost_m: 0.0, reverse: false };
        let Some(&first) = path.get(1) else { return stay };
        let blind_m = (first.position_m - self.here_m).length();
        let mut leg = first_leg(path)[1..].iter();
        let straight = |point: &&PathPoint| self.straight_cost_m(point, blind_m) <= point.cost_m;
        leg.rfind(straight).copied().unwrap_or(first)
    }

    /// Cost of the straight line to a point of a path, whose first `blind_m` is taken as safe; infinite if
    /// the robot may not turn to it.
    pub(super) fn straight_cost_m(&self, point: &PathPoint, blind_m: f64) -> f64 {
        let path = point.position_m - self.here_m;
        let facing = if point.reverse { -path } else { path };
        if !self.may_turn_to(facing) {
            return f64::INFINITY;
        }
        let length_m = path.length();
        let heading = nearest(facing);
        let count = (2.0 * length_m / self.config.step_m).ceil();
        let (mut risk, mut climb_m) = (0.0, 0.0);
        let mut height_m = self.attitude.height_m;
        for k in 1..=count as usize {
            let share = k as f64 / count;
            let at = self.traversability.places.nearest(self.here_m + path * share);
            if let Some(plane) = at.and_then(|at| self.traversability.plane(at)) {
                climb_m += (plane.height_m - height_m).abs();
                height_m = plane.height_m;
            }
            if share * length_m <= blind_m {
                continue;
            }
            risk += at.map_or(f64::INFINITY, |at| self.traversability.risk(at, heading));
        }
        let price = if point.reverse { self.prices.reverse } else { 1.0 };
        price * length_m * (1.0 + self.prices.tilt * risk / count) + self.prices.climb * climb_m
    }

    /// The risk at a pose in the plane, between the places around it.
    pub(crate) fn risk_at(&self, place_m: DVec2, yaw_rad: f64) -> RiskBetween {
        self.traversability.risk_at(place_m, yaw_rad)
    }

    /// Whether the place nearest to a pose in the plane is safe at its heading, or hidden.
    pub(crate) fn is_safe(&self, place_m: DVec2, yaw_rad: f64) -> bool {
        let heading = nearest(DVec2::from_angle(yaw_rad));
        self.traversability.places.nearest(place_m).is_some_and(|offset| {
            self.traversability.risk(offset, heading).is_finite()
                || self.traversability.is_hidden(offset, heading)
        })
    }

    /// Whether the body at a pose near the robot is too near to something upright.
    pub(crate) fn is_too_near_upright(&self, place_m: DVec2, yaw_rad: f64) -> bool {
        let (sin, cos) = libm::sincos(yaw_rad);
        self.body.is_too_near(place_m, DVec2::new(cos, sin), self.traversability.places.gradient_at(place_m))
    }

    /// Tilt utilisation here, in slope: the larger of the attitude's and of the attitude extrapolated at its
    /// present rate.
    pub(crate) fn utilisation_here(&self) -> f64 {
        self.attitude.slopes_within(EXTRAPOLATION_TIME).share_of(self.traversability.limits())
    }

    /// Tilt utilisation here and ahead, in slope: along the path, and on the straight line to the point that
    /// the robot drives to, which may lie off it.
    pub(crate) fn utilisation_ahead(&self, path: &[PathPoint], ahead: &PathPoint) -> f64 {
        let here = PathPoint { position_m: self.here_m, ..*ahead };
        self.utilisation_here().max(self.utilisation_along(path)).max(self.utilisation_along(&[here, *ahead]))
    }

    fn utilisation_along(&self, path: &[PathPoint]) -> f64 {
        let mut share = 0.0_f64;
        for leg in path.windows(2) {
            let (from_m, path_m) = (leg[0].position_m, leg[1].position_m - leg[0].position_m);
            let steps = (path_m.length() / self.config.step_m).ceil();
            for step in 1..=steps as usize {
                let at_m = from_m + path_m * (step as f64 / steps);
                if (at_m - self.here_m).length() > AHEAD_M {
                    return share;
                }
                let place = self.traversability.places.nearest(at_m);
                let risk =
                    place.map_or(f64::INFINITY, |place| self.traversability.risk(place, nearest(path_m)));
                share = share.max(if risk.is_finite() { risk.sqrt() } else { BLIND_UTILISATION });
            }
        }
        share
    }
}
