//! The place map: what the ground around the robot does to its attitude, on a lattice that is fixed in the
//! world.

use glam::{DVec2, IVec2};

use crate::config::StateLatticeConfig;
use crate::robot_model::RobotModel;
use crate::terrain::elevation_window::TerrainQuery;
use crate::terrain::headings::{DIRECTIONS, STEPS, heading_below};
use crate::terrain::place_lattice::{AXES, PlaceLattice, around};
use crate::terrain::plane::Plane;
use crate::terrain::rolling_grid::RollingGrid;
use crate::terrain::slopes::Slopes;

/// Unseen ground is bridged between seen places no farther apart than the first; under the lowest beams,
/// where no look can settle it, than the second. Standard deviation of its slope per metre of the bridge.
const GAP_M: f64 = 2.5;
const GAP_DEVIATION_PER_M: f64 = 0.1;
/// Price of a metre over bridged ground, as a risk.
const GAP_RISK: f64 = 0.25;
/// Standard deviation of a slope between wheels with averaged returns under them.
const WHEELS_DEVIATION: f64 = 0.05;
/// A slope with a larger standard deviation is extrapolated, not seen.
const GUESS_DEVIATION: f64 = 0.15;
/// Tight ground keeps only the smallest margin, with this share of the deviations, at this much more risk.
const TIGHT_SHARE: f64 = 0.5;
const TIGHT_RISK: f64 = 2.0;

/// Places this near to the border of the lattice are its horizon, in steps.
const HORIZON: i32 = 2;
/// Places on a side of the memory of where the robot stood.
const STOOD_SIDE: usize = 64;
/// A robot that stands unsafe may drive over unsafe ground within so many steps, at this risk.
const ESCAPE_STEPS: i32 = 4;
const ESCAPE_RISK: f64 = 10.0;

/// The risk at a pose between places.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Risk {
    /// (slope / limit)², the worse of roll and pitch.
    pub(crate) price: f64,
    /// Utilisation of the tilt limits, in slope.
    pub(crate) utilisation: f64,
    /// Share of the places around, by nearness, that are not safe.
    pub(crate) unsafe_share: f64,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    plane: Option<Plane>,
    is_bridged: bool,
    is_blocked: bool,
    risk: [f32; AXES],
}

const UNKNOWN: Place =
    Place { plane: None, is_bridged: false, is_blocked: false, risk: [f32::INFINITY; AXES] };

/// Places around the robot.
#[derive(Clone, Debug)]
pub(crate) struct PlaceMap {
    config: StateLatticeConfig,
    limits: Slopes,
    allowed: Slopes,
    most: Slopes,
    /// The places, and the ground at each.
    pub(crate) places: PlaceLattice,
    judged: Vec<Place>,
    /// The ground where the robot stood, by its attitude.
    stood: RollingGrid<Plane>,
}

impl PlaceMap {
    /// A map of the places within `radius_m`.
    pub(crate) fn new(config: StateLatticeConfig, robot: &RobotModel, radius_m: f64) -> Self {
        let places = PlaceLattice::new(&config, radius_m);
        Self {
            config,
            limits: Slopes::of_limits(robot, 0.0),
            allowed: Slopes::of_limits(robot, config.tilt_margin_rad),
            most: Slopes::of_limits(robot, config.recovery_margin_rad),
            judged: vec![UNKNOWN; places.count()],
            stood: RollingGrid::new(STOOD_SIDE),
            places,
        }
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.places.clear();
        self.stood.clear();
    }

    /// Queries the ground around the robot, bridges what is hidden, and judges every place.
    pub(crate) fn look(&mut self, ground: &dyn TerrainQuery, here_m: DVec2, own: Plane, blind_m: f64) {
        self.places.look(ground, here_m);
        self.stood.set(self.places.world_index(here_m), own);
        for index in 0..self.judged.len() {
            let offset = self.places.offset(index);
            let seen = self.places.known(offset).and_then(|known| {
                let plane = known.plane?;
                let is_safe = |direction| self.risk_of(&plane, None, direction, false).is_finite();
                let is_seen = plane.gradient_deviation <= GUESS_DEVIATION
                    || known.footprint_slopes.iter().any(Option::is_some)
                    || DIRECTIONS.into_iter().any(is_safe);
                is_seen.then_some(plane)
            });
            let world = self.places.world_index(self.places.position_m(offset));
            self.judged[index] = Place { plane: seen.or_else(|| self.stood.get(world).copied()), ..UNKNOWN };
        }
        self.bridge(here_m, blind_m);
        for index in 0..self.judged.len() {
            let offset = self.places.offset(index);
            let known = self.places.known(offset).copied();
            let place = self.judged[index];
            let is_blocked =
                known.is_some_and(|known| known.touches_upright) || self.places.is_at_cliff(offset);
            let Some(plane) = place.plane else {
                self.judged[index].is_blocked = is_blocked;
                continue;
            };
            let slopes =
                known.filter(|_| !place.is_bridged).map_or([None; AXES], |known| known.footprint_slopes);
            self.judged[index].is_blocked = is_blocked;
            self.judged[index].risk = core::array::from_fn(|axis| {
                if is_blocked {
                    return f32::INFINITY;
                }
                self.risk_of(&plane, slopes[axis], DIRECTIONS[axis], place.is_bridged) as f32
            });
        }
    }

    /// Interpolates unseen ground between seen places.
    fn bridge(&mut self, here_m: DVec2, blind_m: f64) {
        for index in 0..self.judged.len() {
            let place = self.judged[index];
            if place.plane.is_some() {
                continue;
            }
            let offset = self.places.offset(index);
            let away_m = (self.places.position_m(offset) - here_m).length();
            let most_m = if away_m < blind_m { 2.0 * blind_m } else { GAP_M };
            let mut best: Option<(f64, Plane)> = None;
            for axis in 0..AXES {
                let step = STEPS[axis];
                let step_m = step.as_dvec2().length() * self.config.step_m;
                let steps = (most_m / step_m) as i32;
                let seen = |sign: i32| (1..=steps).find(|&k| self.seen(offset + step * (sign * k)).is_some());
                let (Some(ahead), Some(behind)) = (seen(1), seen(-1)) else { continue };
                let length_m = step_m * f64::from(ahead + behind);
                if length_m > most_m || best.is_some_and(|(least_m, _)| length_m >= least_m) {
                    continue;
                }
                let (Some(from), Some(to)) =
                    (self.seen(offset - step * behind), self.seen(offset + step * ahead))
                else {
                    continue;
                };
                let t = f64::from(behind) / f64::from(ahead + behind);
                best = Some((length_m, between(&from, &to, DIRECTIONS[axis], length_m, t)));
            }
            if let Some((_, plane)) = best {
                self.judged[index] = Place { plane: Some(plane), is_bridged: true, ..place };
            }
        }
    }

    fn seen(&self, offset: IVec2) -> Option<Plane> {
        if !self.places.holds(offset) {
            return None;
        }
        let place = &self.judged[self.places.index(offset)];
        place.plane.filter(|_| !place.is_bridged)
    }

    /// Risk of an attitude: (slope / limit)², the worse of roll and pitch, and more on tight or bridged
    /// ground; infinite if it is not safe.
    fn risk_of(&self, plane: &Plane, slopes: Option<Slopes>, direction: DVec2, is_bridged: bool) -> f64 {
        let (slopes, deviation) = match slopes {
            Some(slopes) => (slopes, WHEELS_DEVIATION),
            None => (Slopes::facing(plane.gradient, direction), plane.gradient_deviation),
        };
        let uncertain = deviation * self.config.slope_deviations;
        let share = slopes.share_of(&self.limits);
        let bridged = if is_bridged { GAP_RISK } else { 0.0 };
        if slopes.within(&self.allowed, uncertain) {
            share * share + bridged
        } else if slopes.within(&self.most, TIGHT_SHARE * uncertain) {
            share * share + bridged + TIGHT_RISK
        } else {
            f64::INFINITY
        }
    }

    /// The risk at a pose in the plane, between the places around it: its price and the share of the limits,
    /// averaged over those that are safe, and the weight of the others.
    pub(crate) fn risk_at(&self, ground: &dyn TerrainQuery, place_m: DVec2, yaw_rad: f64) -> Risk {
        let steps = self.places.steps_from_centre(place_m);
        let low = steps.floor();
        let part = steps - low;
        let low = low.as_ivec2();
        let (heading, turn) = heading_below(yaw_rad);
        let mut risk = Risk { price: 0.0, utilisation: 0.0, unsafe_share: 0.0 };
        let mut weights = 0.0;
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let wx = if dx == 1 { part.x } else { 1.0 - part.x };
            let wy = if dy == 1 { part.y } else { 1.0 - part.y };
            for (heading, wh) in [(heading, 1.0 - turn), (heading + 1, turn)] {
                let weight = wx * wy * wh;
                let price = self.risk(low + IVec2::new(dx, dy), heading);
                if price.is_finite() {
                    risk.price += weight * price;
                    // Tight ground counts as steep.
                    risk.utilisation += weight * price.sqrt().min(1.0);
                    weights += weight;
                } else {
                    risk.unsafe_share += weight;
                }
            }
        }
        if weights > 0.0 {
            risk.price /= weights;
            risk.utilisation /= weights;
        }
        let near = steps.round().as_ivec2();
        if let Some(plane) = self.seen(near) {
            let direction = DVec2::from_angle(yaw_rad);
            let slopes = ground
                .slopes_at(place_m, &plane, direction)
                .unwrap_or_else(|| Slopes::facing(plane.gradient, direction));
            risk.utilisation = slopes.share_of(&self.limits);
            risk.price = risk.utilisation * risk.utilisation;
        }
        risk
    }

    /// The limits less the smallest margin, as slopes.
    pub(crate) fn most(&self) -> &Slopes {
        &self.most
    }

    /// The ground at a place, if it is seen or bridged.
    pub(crate) fn plane(&self, offset: IVec2) -> Option<&Plane> {
        self.judged[self.places.index(offset)].plane.as_ref()
    }

    /// The risk at a place with a heading; infinite if that is not safe.
    pub(crate) fn risk(&self, offset: IVec2, heading: usize) -> f64 {
        if !self.places.holds(offset) {
            return f64::INFINITY;
        }
        f64::from(self.judged[self.places.index(offset)].risk[heading % AXES])
    }

    /// As [`PlaceMap::risk`], but known ground this near to a robot that stands unsafe costs much instead of
    /// being closed: the way off it leads over it.
    pub(crate) fn escape_risk(&self, offset: IVec2, heading: usize, from: IVec2) -> f64 {
        let risk = self.risk(offset, heading);
        let near = (offset - from).length_squared() <= ESCAPE_STEPS * ESCAPE_STEPS;
        if risk.is_infinite() && near && self.places.holds(offset) && self.plane(offset).is_some() {
            return ESCAPE_RISK;
        }
        risk
    }

    /// Whether a place borders on ground that is neither seen nor bridged, or on the border of the lattice.
    pub(crate) fn is_frontier(&self, offset: IVec2) -> bool {
        self.places.is_within_of_border(offset, HORIZON)
            || around(offset).filter(|&place| self.places.holds(place)).any(|place| {
                let place = &self.judged[self.places.index(place)];
                place.plane.is_none() && !place.is_blocked
            })
    }
}

/// The ground at a share of the way between two seen places: a cubic through both heights and slopes along
/// the direction, the mean of the slopes across.
fn between(from: &Plane, to: &Plane, direction: DVec2, length_m: f64, t: f64) -> Plane {
    let (s0, s1) = (from.gradient.dot(direction), to.gradient.dot(direction));
    let rise_m = to.height_m - from.height_m;
    let along =
        6.0 * t * (1.0 - t) * rise_m / length_m + (1.0 - t) * (1.0 - 3.0 * t) * s0 + t * (3.0 * t - 2.0) * s1;
    let across = from.gradient.lerp(to.gradient, t).dot(direction.perp());
    let (t2, t3) = (t * t, t * t * t);
    let height_m = (2.0 * t3 - 3.0 * t2 + 1.0) * from.height_m
        + (t3 - 2.0 * t2 + t) * length_m * s0
        + (3.0 * t2 - 2.0 * t3) * to.height_m
        + (t3 - t2) * length_m * s1;
    Plane {
        height_m,
        gradient: direction * along + direction.perp() * across,
        gradient_deviation: GAP_DEVIATION_PER_M * length_m.min(GAP_M),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE_M: DVec2 = DVec2::ZERO;
    const LEVEL: Plane = Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.0 };

    fn map_of(ground: impl Fn(DVec2) -> Option<Plane>) -> PlaceMap {
        let config = crate::config::PlannerConfig::default();
        let mut map = PlaceMap::new(config.state_lattice, &config.robot, 7.0);
        map.look(&ground, HERE_M, LEVEL, 3.0);
        map
    }

    #[test]
    fn a_side_slope_is_safe_along_the_heading_that_climbs_it() {
        let map = map_of(|_| Some(Plane { gradient: DVec2::new(0.6, 0.0), ..LEVEL }));
        assert!(map.risk(IVec2::new(2, 0), 0).is_finite(), "pitch of 31°");
        assert!(map.risk(IVec2::new(2, 0), 4).is_infinite(), "roll of 31°");
    }

    #[test]
    fn unseen_ground_between_seen_places_is_bridged_and_beyond_them_is_the_frontier() {
        let map = map_of(|place_m| (!(1.3..2.8).contains(&place_m.x) && place_m.x < 5.0).then_some(LEVEL));
        assert!(map.plane(IVec2::new(4, 0)).is_some());
        assert!(map.risk(IVec2::new(4, 0), 0) > map.risk(IVec2::new(1, 0), 0), "bridged ground costs more");
        assert!(map.plane(IVec2::new(11, 0)).is_none());
        assert!(map.is_frontier(IVec2::new(9, 0)) && !map.is_frontier(IVec2::new(4, 0)));
    }

    #[test]
    fn between_places_their_unsafe_share_is_that_of_the_nearer_ones() {
        let map = map_of(|place_m| {
            let gradient = if place_m.x > 1.2 { DVec2::new(2.0, 2.0) } else { DVec2::ZERO };
            Some(Plane { gradient, ..LEVEL })
        });
        let ground = |_: DVec2| None;
        let share = |x: f64| map.risk_at(&ground, DVec2::new(x, 0.0), 0.0).unsafe_share;
        assert!(share(1.0) < 1e-9 && (share(1.25) - 0.5).abs() < 1e-9 && share(1.5) > 1.0 - 1e-9);
    }
}
