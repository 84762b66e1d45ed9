//! How the robot would stand at the places of a lattice, for each heading.

use glam::{DVec2, IVec2};

use crate::config::StateLatticeConfig;
use crate::math::elementary::floor;
use crate::pose::FrameChange;
use crate::robot_model::RobotModel;
use crate::terrain::elevation_window::TerrainQuery;
use crate::terrain::headings::{DIRECTIONS, HEADINGS, STEPS, passed};
use crate::terrain::plane::Plane;
use crate::terrain::rolling_grid::RollingGrid;
use crate::terrain::slopes::Slopes;

/// How careful a search is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Caution {
    /// As configured.
    Usual,
    /// Near the robot, what gets it away.
    Escape,
}

/// One place of the lattice.
#[derive(Clone, Copy, Debug)]
struct Place {
    plane: Option<Plane>,
    /// (slope / limit)² for each axis of travel, the worse of roll and pitch; infinite where that is not safe.
    risk: [f32; HEADINGS / 2],
    is_at_cliff: bool,
}

const UNKNOWN: Place = Place { plane: None, risk: [f32::INFINITY; HEADINGS / 2], is_at_cliff: false };

/// Places around the robot, on a lattice that stands still in the world.
#[derive(Clone, Debug)]
pub(crate) struct TraversabilityMap {
    config: StateLatticeConfig,
    tilt_limits: RobotModel,
    /// The tilt limits, what of them may be used, and the most that may be where there is nothing better.
    limits: Slopes,
    allowed: Slopes,
    most: Slopes,
    half: i32,
    centre: IVec2,
    places: Vec<Place>,
    /// The ground at each place of the world's lattice, by remainder of its index.
    planes: RollingGrid<Known>,
    looks: i32,
    /// Places that turned out steeper than they had looked, the newest last.
    mistrusted: Vec<Mistrusted>,
}

#[derive(Clone, Copy, Debug)]
struct Mistrusted {
    place_m: DVec2,
    /// Deviations of slopes around are larger than they look by this share.
    doubt: f64,
}

/// Mistrusted places that are remembered, how much around each is meant, and the risk that the first time adds; ground at the tilt limit
/// has 1. Each further time adds twice as much as the one before, up to so many.
const MOST_MISTRUSTED: usize = 128;
const MISTRUSTED_RADIUS_M: f64 = 0.6;
const MISTRUST_RISK: f32 = 2.0;
const MOST_TIMES: usize = 3;
/// Each surprise adds this much doubt around it, with this standard deviation of a Gaussian, up to a most; driving this far takes it
/// down to e⁻¹. What is left of it below the least counts no more.
const SURPRISE: f64 = 1.0;
const DOUBT_RADIUS_M: f64 = 1.5;
const MOST_DOUBT: f64 = 2.0;
const DOUBT_FADES_M: f64 = 20.0;
const LEAST_DOUBT: f64 = 0.05;
/// Places this near the border of the lattice are its horizon; those beside them lie on it, too.
const HORIZON: i32 = 2;
/// Ground that keeps no more than the margin for an escape, with this share of the deviations, is the last choice: it counts as this much
/// more risk.
const TIGHT_SHARE: f64 = 0.5;
const TIGHT_RISK: f64 = 2.0;
/// A slope with a larger standard deviation is a guess.
const GUESS_DEVIATION: f64 = 0.15;
/// Standard deviation of a slope between wheels under which returns were averaged.
const WHEELS_DEVIATION: f64 = 0.05;

/// What was last found at a place of the world's lattice.
#[derive(Clone, Copy, Debug)]
struct Known {
    plane: Option<Plane>,
    /// On the wheels, for each axis of travel.
    footprint_slopes: [Option<Slopes>; HEADINGS / 2],
    /// Under a wheel there is nothing, as it would have been seen, or the ground drops off.
    is_negative_obstacle: bool,
}

/// A place is looked at anew after so many looks: the ground stands still, and a robot drives a step in this time.
const LOOKS: i32 = 4;

impl TraversabilityMap {
    /// A lattice that reaches `radius_m`.
    pub(crate) fn new(config: StateLatticeConfig, limits: &RobotModel, radius_m: f64) -> Self {
        let half = (radius_m / config.step_m).ceil() as i32 + 1;
        let side = (2 * half + 1) as usize;
        Self {
            config,
            tilt_limits: *limits,
            limits: Slopes::of_limits(limits, 0.0),
            allowed: Slopes::of_limits(limits, config.tilt_margin_rad),
            most: Slopes::of_limits(limits, config.recovery_margin_rad),
            half,
            centre: IVec2::ZERO,
            places: vec![UNKNOWN; side * side],
            planes: RollingGrid::new(side),
            looks: 0,
            mistrusted: Vec::with_capacity(MOST_MISTRUSTED),
        }
    }

    /// Uses the limits up to this margin where there is nothing better.
    pub(crate) fn keep_margin(&mut self, least_margin_rad: f64) {
        self.most = Slopes::of_limits(&self.tilt_limits, least_margin_rad);
    }

    /// Moves what is remembered from one world frame to another; the ground is looked at anew.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        self.planes.clear();
        for mistrusted in &mut self.mistrusted {
            mistrusted.place_m = change.place_m(mistrusted.place_m);
        }
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.planes.clear();
        self.looks = 0;
        self.mistrusted.clear();
    }

    /// The robot met steeper ground than it was told of, and `place_m` is where: what looks alike around it may deceive as much.
    pub(crate) fn surprise(&mut self, place_m: DVec2) {
        self.remember(Mistrusted { place_m, doubt: SURPRISE });
    }

    /// Mistrusts a place, until the ground is forgotten: each time it costs more to drive there, so that another way is soon cheaper.
    pub(crate) fn mistrust(&mut self, place_m: DVec2) {
        self.remember(Mistrusted { place_m, doubt: 0.0 });
    }

    fn remember(&mut self, mistrusted: Mistrusted) {
        if self.mistrusted.len() == MOST_MISTRUSTED {
            self.mistrusted.remove(0);
        }
        self.mistrusted.push(mistrusted);
    }

    /// The robot has driven on.
    pub(crate) fn drive_on(&mut self, distance_m: f64) {
        let left = libm::exp(-distance_m / DOUBT_FADES_M);
        for mistrusted in &mut self.mistrusted {
            mistrusted.doubt *= left;
        }
    }

    fn mistrust_risk(&self, place_m: DVec2) -> f32 {
        let squared = MISTRUSTED_RADIUS_M * MISTRUSTED_RADIUS_M;
        let near =
            self.mistrusted.iter().filter(|other| (other.place_m - place_m).length_squared() < squared);
        MISTRUST_RISK * (libm::exp2f(near.count().min(MOST_TIMES) as f32) - 1.0)
    }

    /// Deviations of slopes at a place are larger than they look by this share.
    fn doubt_at(&self, place_m: DVec2) -> f64 {
        let here = |surprise: &Mistrusted| {
            let away = (surprise.place_m - place_m) / DOUBT_RADIUS_M;
            surprise.doubt * libm::exp(-0.5 * away.length_squared())
        };
        let doubted = self.mistrusted.iter().filter(|mistrusted| mistrusted.doubt > LEAST_DOUBT);
        doubted.map(here).sum::<f64>().min(MOST_DOUBT)
    }

    /// Looks at the ground around the robot.
    pub(crate) fn look(&mut self, ground: &dyn TerrainQuery, here_m: DVec2) {
        let cells = here_m / self.config.step_m;
        self.centre = IVec2::new(floor(cells.x + 0.5), floor(cells.y + 0.5));
        self.looks = (self.looks + 1) % LOOKS;
        let (half, reach) = (self.half, self.half * self.half);
        for y in -half..=half {
            for x in -half..=half {
                let offset = IVec2::new(x, y);
                if offset.length_squared() > reach {
                    continue;
                }
                let world = self.centre + offset;
                let due = (world.x + 2 * world.y).rem_euclid(LOOKS) == self.looks;
                let before = self.planes.get(world);
                if due || before.is_none() {
                    let was_negative_obstacle = before.is_some_and(|known| known.is_negative_obstacle);
                    let place_m = self.position_m(offset);
                    let plane = ground.plane_at(place_m);
                    let footprint_slopes = plane.map_or([None; HEADINGS / 2], |plane| {
                        DIRECTIONS.map(|direction| ground.slopes_at(place_m, &plane, direction))
                    });
                    let is_negative_obstacle = self.config.avoids_negative_obstacles
                        && footprint_slopes.iter().any(Option::is_none)
                        && ground.is_negative_obstacle(place_m, here_m, was_negative_obstacle);
                    self.planes.set(world, Known { plane, footprint_slopes, is_negative_obstacle });
                }
            }
        }
    }

    /// Judges how the robot, which stands at `here_m`, would stand at the places looked at.
    pub(crate) fn judge(&mut self, here_m: DVec2, caution: Caution) {
        for index in 0..self.places.len() {
            let offset = self.offset(index);
            let known = self.planes.get(self.centre + offset).copied();
            let is_at_cliff = self.config.avoids_negative_obstacles && self.is_beside_missing(offset);
            self.places[index] = match known.and_then(|known| Some((known.plane?, known.footprint_slopes))) {
                Some((plane, footprint_slopes)) => {
                    let place_m = self.position_m(offset);
                    let away_m = (place_m - here_m).length();
                    let mistrust = match caution {
                        Caution::Usual => self.mistrust_risk(place_m),
                        // It has to get away, but rather not that way.
                        Caution::Escape => self.mistrust_risk(place_m).min(MISTRUST_RISK),
                    };
                    let deviations = self.deviations_at(place_m);
                    let risk = self.risk_of(&plane, &footprint_slopes, caution, away_m, deviations);
                    let falls = if is_at_cliff { f32::INFINITY } else { 0.0 };
                    Place { plane: Some(plane), risk: risk.map(|risk| risk + mistrust + falls), is_at_cliff }
                }
                _ => Place { is_at_cliff, ..UNKNOWN },
            };
        }
    }

    /// Whether the ground is missing at a place or beside it: the robot is wider than its wheels, and keeps to a way by half a step.
    fn is_beside_missing(&self, offset: IVec2) -> bool {
        around(self.centre + offset)
            .any(|world| self.planes.get(world).is_some_and(|known| known.is_negative_obstacle))
    }

    fn risk_of(
        &self,
        plane: &Plane,
        footprint_slopes: &[Option<Slopes>; HEADINGS / 2],
        caution: Caution,
        away_m: f64,
        deviations: f64,
    ) -> [f32; HEADINGS / 2] {
        core::array::from_fn(|axis| {
            let (slopes, deviation) = match footprint_slopes[axis] {
                Some(slopes) => (slopes, WHEELS_DEVIATION),
                None => (Slopes::facing(plane.gradient, DIRECTIONS[axis]), plane.gradient_deviation),
            };
            self.risk_on(&slopes, deviations * deviation, caution, away_m) as f32
        })
    }

    /// How many standard deviations of slopes are allowed for at a place.
    pub(crate) fn deviations_at(&self, place_m: DVec2) -> f64 {
        (1.0 + self.doubt_at(place_m)) * self.config.slope_deviations
    }

    /// The risk of standing on slopes, with what is allowed for what is uncertain of them, at a distance from the robot; infinite where
    /// that is not safe.
    pub(crate) fn risk_on(&self, slopes: &Slopes, uncertain: f64, caution: Caution, away_m: f64) -> f64 {
        let escapes = caution == Caution::Escape && away_m < self.config.recovery_radius_m;
        let (allowed, uncertain) = if escapes { (&self.most, 0.0) } else { (&self.allowed, uncertain) };
        let share = slopes.share_of(&self.limits);
        if slopes.within(allowed, uncertain) {
            share * share
        } else if slopes.within(&self.most, TIGHT_SHARE * uncertain) {
            share * share + TIGHT_RISK
        } else {
            f64::INFINITY
        }
    }

    /// The tilt limits as slopes.
    pub(crate) fn limits(&self) -> &Slopes {
        &self.limits
    }

    /// The most of the limits that may be used, as slopes.
    pub(crate) fn most(&self) -> &Slopes {
        &self.most
    }

    /// How many places there are.
    pub(crate) fn count(&self) -> usize {
        self.places.len()
    }

    fn side(&self) -> i32 {
        2 * self.half + 1
    }

    /// Index of the place at an offset from the centre, which lies on the lattice.
    pub(crate) fn index(&self, offset: IVec2) -> usize {
        ((offset.y + self.half) * self.side() + offset.x + self.half) as usize
    }

    /// Offset of the place with an index.
    pub(crate) fn offset(&self, index: usize) -> IVec2 {
        let index = index as i32;
        IVec2::new(index % self.side() - self.half, index / self.side() - self.half)
    }

    /// Whether an offset lies on the lattice.
    pub(crate) fn holds(&self, offset: IVec2) -> bool {
        offset.x.abs() <= self.half && offset.y.abs() <= self.half
    }

    /// Offset of the place nearest to a point; `None` off the lattice.
    pub(crate) fn nearest(&self, point_m: DVec2) -> Option<IVec2> {
        let cells = point_m / self.config.step_m;
        let offset = IVec2::new(floor(cells.x + 0.5), floor(cells.y + 0.5)) - self.centre;
        self.holds(offset).then_some(offset)
    }

    /// Whether what was seen ends at a place: at the border of the lattice, or with nothing known of a place beside it.
    pub(crate) fn is_frontier(&self, offset: IVec2) -> bool {
        let inner = self.half - HORIZON;
        offset.length_squared() > inner * inner || around(offset).any(|place| self.plane(place).is_none())
    }

    /// Where a place lies in the world, seen from above.
    pub(crate) fn position_m(&self, offset: IVec2) -> DVec2 {
        (self.centre + offset).as_dvec2() * self.config.step_m
    }

    /// The ground at a place, where it is known.
    pub(crate) fn plane(&self, offset: IVec2) -> Option<&Plane> {
        self.places[self.index(offset)].plane.as_ref()
    }

    /// Whether nothing can be said of a place for a heading: it was not seen, or is not safe only as it was guessed from afar. Of what is at
    /// the brink of missing ground enough is known.
    pub(crate) fn is_hidden(&self, offset: IVec2, heading: usize) -> bool {
        let place = &self.places[self.index(offset)];
        !place.is_at_cliff
            && place.plane.is_none_or(|plane| {
                plane.gradient_deviation > GUESS_DEVIATION
                    && self
                        .planes
                        .get(self.centre + offset)
                        .is_none_or(|known| known.footprint_slopes[heading % (HEADINGS / 2)].is_none())
                    && self.risk(offset, heading).is_infinite()
            })
    }

    /// Whether the ground is missing at a place or beside it.
    pub(crate) fn is_at_cliff(&self, offset: IVec2) -> bool {
        self.places[self.index(offset)].is_at_cliff
    }

    /// The risk of standing at a place with a heading; infinite where that is not safe.
    pub(crate) fn risk(&self, offset: IVec2, heading: usize) -> f64 {
        f64::from(self.places[self.index(offset)].risk[heading % (HEADINGS / 2)])
    }

    /// The place that one step along a heading, or against it, leads to and the mean risk on the way; `None` where that is
    /// not safe.
    pub(crate) fn drive(&self, from: IVec2, heading: usize, forward: bool) -> Option<(IVec2, f64)> {
        let step = if forward { STEPS[heading] } else { -STEPS[heading] };
        let to = from + step;
        if !self.holds(to) {
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

    /// How much higher or lower one place is than another.
    pub(crate) fn climb_m(&self, from: IVec2, to: IVec2) -> f64 {
        self.plane(from).zip(self.plane(to)).map_or(0.0, |(from, to)| (to.height_m - from.height_m).abs())
    }

    /// The next known place along a heading, beyond hidden ground; `None` where the ground goes on, or none is known
    /// within `gap_m`.
    pub(crate) fn beyond_gap(&self, from: IVec2, heading: usize, gap_m: f64) -> Option<IVec2> {
        let step = STEPS[heading];
        let steps = (gap_m / (step.as_dvec2().length() * self.config.step_m)) as i32;
        for k in 1..=steps {
            let to = from + step * k;
            if !self.holds(to) {
                return None;
            }
            if !self.is_hidden(to, heading) {
                return (k > 1 && self.risk(to, heading).is_finite()).then_some(to);
            }
        }
        None
    }
}

/// A cell and those beside it.
fn around(cell: IVec2) -> impl Iterator<Item = IVec2> {
    (-1..=1).flat_map(move |y| (-1..=1).map(move |x| cell + IVec2::new(x, y)))
}
