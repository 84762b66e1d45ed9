//! The traversability map: the risk of the robot's attitude at the places of the state lattice, for each
//! heading.

use glam::{DVec2, IVec2};

use crate::config::StateLatticeConfig;
use crate::pose::FrameChange;
use crate::robot_model::RobotModel;
use crate::terrain::headings::{AXES, DIRECTIONS, STEPS, heading_below, passed};
use crate::terrain::place_lattice::{PlaceLattice, around};
use crate::terrain::plane::Plane;
use crate::terrain::slopes::Slopes;

/// Caution of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Caution {
    /// As configured.
    Usual,
    /// Recovery: near the robot, the smallest margin suffices.
    Recovery,
}

/// The risk at a pose between places: the mean of those around it that are safe, weighted by nearness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RiskBetween {
    /// (slope / limit)², the worse of roll and pitch, with what penalties and the lack of room add.
    pub(crate) price: f64,
    /// The root of the price: on free ground the utilisation of the tilt limits, in slope.
    pub(crate) utilisation: f64,
}

/// One place of the lattice.
#[derive(Clone, Copy, Debug)]
struct Place {
    plane: Option<Plane>,
    /// (slope / limit)² for each axis of travel, the worse of roll and pitch, and what penalties and lacking
    /// room add; infinite if that is not safe.
    risk: [f32; AXES],
    is_at_cliff: bool,
}

const UNKNOWN: Place = Place { plane: None, risk: [f32::INFINITY; AXES], is_at_cliff: false };

/// Places around the robot, on a lattice that is fixed in the world.
#[derive(Clone, Debug)]
pub(crate) struct TraversabilityMap {
    config: StateLatticeConfig,
    tilt_limits: RobotModel,
    /// The tilt limits, and the limits less the usual margin, less the smallest one, and less half of that.
    limits: Slopes,
    allowed: Slopes,
    most: Slopes,
    most_when_begun: Slopes,
    /// The places, and the ground at each.
    pub(crate) places: PlaceLattice,
    judged: Vec<Place>,
    /// Places with a penalty, some of them with inflated variance around, the newest last.
    marked: Vec<Marked>,
}

#[derive(Clone, Copy, Debug)]
struct Marked {
    place_m: DVec2,
    /// Inflation of the slopes' standard deviations around: 1 doubles them.
    inflation: f64,
}

/// Number of places kept, radius of a penalty, and risk of the first penalty; ground at the tilt limit has 1.
/// Each further penalty adds twice as much as the last, up to this many.
const MOST_MARKED: usize = 128;
const PENALTY_RADIUS_M: f64 = 0.6;
const PENALTY_RISK: f32 = 2.0;
const MOST_TIMES: usize = 3;
/// Risk where the body has the least room beside what is upright; it falls with the square of what lacks.
const ROOM_RISK: f32 = 1.0;
/// Inflation at a place, radius (standard deviation of a Gaussian) of it, and bound on the sum; the distance
/// driven over which it decays to e⁻¹, and the least that counts.
const INFLATION: f64 = 1.0;
const INFLATION_RADIUS_M: f64 = 1.5;
const MOST_INFLATION: f64 = 2.0;
const INFLATION_FADES_M: f64 = 20.0;
const LEAST_INFLATION: f64 = 0.05;
/// Places this near to the border of the lattice are its horizon; those beside them count as well.
const HORIZON: i32 = 2;
/// Tight ground keeps only the smallest margin, with this share of the deviations. It is the last choice,
/// with this much more risk.
const TIGHT_SHARE: f64 = 0.5;
const TIGHT_RISK: f64 = 2.0;
/// A turn that was begun keeps this share of a margin: of the smallest one to the tilt limits, and of that to
/// what is upright.
pub(crate) const BEGUN_SHARE: f64 = 0.5;
/// A slope with a larger standard deviation is extrapolated, not seen.
const GUESS_DEVIATION: f64 = 0.15;
/// Standard deviation of a slope between wheels with averaged returns under them.
const WHEELS_DEVIATION: f64 = 0.05;

impl TraversabilityMap {
    /// A map of the places within `radius_m`.
    pub(crate) fn new(config: StateLatticeConfig, limits: &RobotModel, radius_m: f64) -> Self {
        let places = PlaceLattice::new(&config, radius_m);
        Self {
            config,
            tilt_limits: *limits,
            limits: Slopes::of_limits(limits, 0.0),
            allowed: Slopes::of_limits(limits, config.tilt_margin_rad),
            most: Slopes::of_limits(limits, config.recovery_margin_rad),
            most_when_begun: Slopes::of_limits(limits, BEGUN_SHARE * config.recovery_margin_rad),
            judged: vec![UNKNOWN; places.count()],
            places,
            marked: Vec::with_capacity(MOST_MARKED),
        }
    }

    /// Sets the smallest margin.
    pub(crate) fn keep_margin(&mut self, least_margin_rad: f64) {
        self.most = Slopes::of_limits(&self.tilt_limits, least_margin_rad);
        self.most_when_begun = Slopes::of_limits(&self.tilt_limits, BEGUN_SHARE * least_margin_rad);
    }

    /// Moves the penalties from one world frame to another; the ground is queried again.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        self.places.query_again();
        for marked in &mut self.marked {
            marked.place_m = change.place_m(marked.place_m);
        }
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.places.clear();
        self.marked.clear();
    }

    /// Inflates the variance around `place_m`, where the ground was steeper than predicted: similar ground
    /// nearby may be as well.
    pub(crate) fn inflate_variance(&mut self, place_m: DVec2) {
        self.remember(Marked { place_m, inflation: INFLATION });
    }

    /// Penalises a place until the ground is forgotten: each penalty raises the cost of driving there, so
    /// that another path becomes cheaper.
    pub(crate) fn penalise(&mut self, place_m: DVec2) {
        self.remember(Marked { place_m, inflation: 0.0 });
    }

    fn remember(&mut self, marked: Marked) {
        if self.marked.len() == MOST_MARKED {
            self.marked.remove(0);
        }
        self.marked.push(marked);
    }

    /// Lets the inflation decay with the distance driven.
    pub(crate) fn drive_on(&mut self, distance_m: f64) {
        let left = libm::exp(-distance_m / INFLATION_FADES_M);
        for marked in &mut self.marked {
            marked.inflation *= left;
        }
    }

    fn penalty_risk(&self, place_m: DVec2) -> f32 {
        let squared = PENALTY_RADIUS_M * PENALTY_RADIUS_M;
        let near = self.marked.iter().filter(|other| (other.place_m - place_m).length_squared() < squared);
        PENALTY_RISK * (libm::exp2f(near.count().min(MOST_TIMES) as f32) - 1.0)
    }

    /// Inflation of the slopes' standard deviations at a place.
    fn inflation_at(&self, place_m: DVec2) -> f64 {
        let here = |marked: &Marked| {
            let away = (marked.place_m - place_m) / INFLATION_RADIUS_M;
            marked.inflation * libm::exp(-0.5 * away.length_squared())
        };
        let inflated = self.marked.iter().filter(|marked| marked.inflation > LEAST_INFLATION);
        inflated.map(here).sum::<f64>().min(MOST_INFLATION)
    }

    /// Computes the risks of all places, for a robot at `here_m`.
    pub(crate) fn judge(&mut self, here_m: DVec2, caution: Caution) {
        for index in 0..self.judged.len() {
            let offset = self.places.offset(index);
            let known = self.places.known(offset).copied();
            let is_at_cliff = self.places.is_at_cliff(offset);
            self.judged[index] = match known.and_then(|known| Some((known.plane?, known))) {
                Some((plane, known)) => {
                    let place_m = self.places.position_m(offset);
                    let away_m = (place_m - here_m).length();
                    let penalty = match caution {
                        Caution::Usual => self.penalty_risk(place_m),
                        // The robot may have to pass here, but at the cost of one penalty.
                        Caution::Recovery => self.penalty_risk(place_m).min(PENALTY_RISK),
                    };
                    let deviations = self.deviations_at(place_m);
                    let risk = self.risk_of(&plane, &known.footprint_slopes, caution, away_m, deviations);
                    let risk = core::array::from_fn(|axis| {
                        let is_blocked = is_at_cliff || known.is_blocked[axis];
                        let near = ROOM_RISK * known.lacks_room[axis] * known.lacks_room[axis];
                        if is_blocked { f32::INFINITY } else { risk[axis] + penalty + near }
                    });
                    Place { plane: Some(plane), risk, is_at_cliff }
                }
                _ => Place { is_at_cliff, ..UNKNOWN },
            };
        }
    }

    fn risk_of(
        &self,
        plane: &Plane,
        footprint_slopes: &[Option<Slopes>; AXES],
        caution: Caution,
        away_m: f64,
        deviations: f64,
    ) -> [f32; AXES] {
        core::array::from_fn(|axis| {
            let (slopes, deviation) = match footprint_slopes[axis] {
                Some(slopes) => (slopes, WHEELS_DEVIATION),
                None => (Slopes::facing(plane.gradient, DIRECTIONS[axis]), plane.gradient_deviation),
            };
            self.risk_on(&slopes, deviations * deviation, caution, away_m) as f32
        })
    }

    /// Standard deviations of the slope that are added to it at a place.
    pub(crate) fn deviations_at(&self, place_m: DVec2) -> f64 {
        (1.0 + self.inflation_at(place_m)) * self.config.slope_deviations
    }

    /// The risk of slopes with a standard deviation `uncertain` added, `away_m` from the robot; infinite if
    /// that is not safe.
    pub(crate) fn risk_on(&self, slopes: &Slopes, uncertain: f64, caution: Caution, away_m: f64) -> f64 {
        let recovers = caution == Caution::Recovery && away_m < self.config.recovery_radius_m;
        let (allowed, uncertain) = if recovers { (&self.most, 0.0) } else { (&self.allowed, uncertain) };
        let share = slopes.share_of(&self.limits);
        if slopes.within(allowed, uncertain) {
            share * share
        } else if slopes.within(&self.most, TIGHT_SHARE * uncertain) {
            share * share + TIGHT_RISK
        } else {
            f64::INFINITY
        }
    }

    /// The risk at a pose in the plane, between the places around it.
    pub(crate) fn risk_at(&self, place_m: DVec2, yaw_rad: f64) -> RiskBetween {
        let (heading, turn) = heading_below(yaw_rad);
        let mut risk = RiskBetween { price: 0.0, utilisation: 0.0 };
        let mut weights = 0.0;
        for (offset, weight) in self.places.four_around(place_m) {
            for (heading, share) in [(heading, 1.0 - turn), (heading + 1, turn)] {
                let weight = weight * share;
                let price =
                    if self.places.holds(offset) { self.risk(offset, heading) } else { f64::INFINITY };
                if price.is_finite() {
                    risk.price += weight * price;
                    risk.utilisation += weight * price.sqrt().min(1.0);
                    weights += weight;
                }
            }
        }
        if weights > 0.0 {
            risk.price /= weights;
            risk.utilisation /= weights;
        }
        risk
    }

    /// The tilt limits as slopes.
    pub(crate) fn limits(&self) -> &Slopes {
        &self.limits
    }

    /// The limits less the smallest margin, as slopes.
    pub(crate) fn most(&self) -> &Slopes {
        &self.most
    }

    /// The limits for a turn that was begun inside [`most`](Self::most): it is not given up where the
    /// attitude changes by less than half of the smallest margin.
    pub(crate) fn most_when_begun(&self) -> &Slopes {
        &self.most_when_begun
    }

    /// Whether a place borders on unseen ground: at the border of the lattice, or beside a place without a
    /// plane.
    pub(crate) fn is_frontier(&self, offset: IVec2) -> bool {
        self.places.is_within_of_border(offset, HORIZON)
            || around(offset).any(|place| self.plane(place).is_none())
    }

    /// The ground at a place, if it is known.
    pub(crate) fn plane(&self, offset: IVec2) -> Option<&Plane> {
        self.judged[self.places.index(offset)].plane.as_ref()
    }

    /// Whether a place is unknown at a heading: unseen, or unsafe only by extrapolation. Places beside a
    /// negative obstacle are known.
    pub(crate) fn is_hidden(&self, offset: IVec2, heading: usize) -> bool {
        let place = &self.judged[self.places.index(offset)];
        !place.is_at_cliff
            && place.plane.is_none_or(|plane| {
                plane.gradient_deviation > GUESS_DEVIATION
                    && self.places.known(offset).is_none_or(|known| {
                        let axis = heading % AXES;
                        known.footprint_slopes[axis].is_none() && !known.is_blocked[axis]
                    })
                    && self.risk(offset, heading).is_infinite()
            })
    }

    /// Whether a place or one beside it is a negative obstacle.
    pub(crate) fn is_at_cliff(&self, offset: IVec2) -> bool {
        self.judged[self.places.index(offset)].is_at_cliff
    }

    /// The risk at a place with a heading; infinite if that is not safe.
    pub(crate) fn risk(&self, offset: IVec2, heading: usize) -> f64 {
        f64::from(self.judged[self.places.index(offset)].risk[heading % (AXES)])
    }

    /// The place one step along a heading, or against it, and the mean risk of the step; `None` if that is
    /// not safe.
    pub(crate) fn drive(&self, from: IVec2, heading: usize, forward: bool) -> Option<(IVec2, f64)> {
        let step = if forward { STEPS[heading] } else { -STEPS[heading] };
        let to = from + step;
        if !self.places.holds(to) {
            return None;
        }
        let mut risk = self.risk(to, heading);
        if let Some(sides) = passed(step) {
            for side in sides {
                risk = risk.max(self.risk(from + side, heading));
            }
        }
        let mean = 0.5 * (risk + self.risk(from, heading));
        mean.is_finite().then_some((to, mean))
    }

    /// Height difference between two places.
    pub(crate) fn climb_m(&self, from: IVec2, to: IVec2) -> f64 {
        self.plane(from).zip(self.plane(to)).map_or(0.0, |(from, to)| (to.height_m - from.height_m).abs())
    }

    /// The next known place along a heading beyond hidden ground; `None` if the ground is not hidden, or no
    /// place is known within `gap_m`.
    pub(crate) fn beyond_gap(&self, from: IVec2, heading: usize, gap_m: f64) -> Option<IVec2> {
        let step = STEPS[heading];
        let steps = (gap_m / (step.as_dvec2().length() * self.config.step_m)) as i32;
        for k in 1..=steps {
            let to = from + step * k;
            if !self.places.holds(to) {
                return None;
            }
            if !self.is_hidden(to, heading) {
                return (k > 1 && self.risk(to, heading).is_finite()).then_some(to);
            }
        }
        None
    }
}
