//! How the robot would stand at the places of a lattice, for each heading.

use glam::{DVec2, IVec2};

use super::headings::{DIRECTIONS, HEADINGS, STEPS, passed};
use crate::config::{ForecastConfig, TiltLimits};
use crate::elementary::floor;
use crate::plane::Plane;

/// Slopes along and across the robot that stand for a pitch and a roll.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slopes {
    pub(crate) across: f64,
    pub(crate) along: f64,
}

impl Slopes {
    /// The slopes at which a robot is `margin_rad` inside its tilt limits.
    pub(crate) fn of_limits(limits: &TiltLimits, margin_rad: f64) -> Self {
        Self {
            across: libm::tan(limits.roll_rad - margin_rad),
            along: libm::tan(limits.pitch_rad - margin_rad),
        }
    }

    /// The slopes of ground with a gradient under a robot that faces along the unit vector `direction`.
    pub(crate) fn facing(gradient: DVec2, direction: DVec2) -> Self {
        Self { across: gradient.dot(direction.perp()).abs(), along: gradient.dot(direction).abs() }
    }

    /// The larger share of the two limits, in slope.
    pub(crate) fn share_of(&self, limits: &Self) -> f64 {
        (self.across / limits.across).max(self.along / limits.along)
    }

    /// Whether both stay within limits, with a margin for what is uncertain.
    pub(crate) fn within(&self, limits: &Self, margin: f64) -> bool {
        self.across + margin <= limits.across && self.along + margin <= limits.along
    }
}

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
}

const UNKNOWN: Place = Place { plane: None, risk: [f32::INFINITY; HEADINGS / 2] };

/// Places around the robot, on a lattice that stands still in the world.
#[derive(Clone, Debug)]
pub(crate) struct Footing {
    config: ForecastConfig,
    /// The tilt limits, and what of them may be used.
    limits: Slopes,
    allowed: Slopes,
    allowed_near: Slopes,
    half: i32,
    centre: IVec2,
    places: Vec<Place>,
    /// The ground at each place of the world's lattice, by remainder of its index.
    planes: Vec<Known>,
    looks: i32,
    /// Places that turned out steeper than they had looked, the newest last.
    barred_m: Vec<DVec2>,
}

/// Barred places that are remembered, and how much around each is barred.
const MOST_BARRED: usize = 128;
const BARRED_RADIUS_M: f64 = 0.6;

/// What was last found at a place of the world's lattice.
#[derive(Clone, Copy, Debug)]
struct Known {
    index: IVec2,
    plane: Option<Plane>,
}

/// A place is looked at anew after so many looks: the ground stands still, and a robot drives a step in this time.
const LOOKS: i32 = 4;

impl Footing {
    /// A lattice that reaches `radius_m`.
    pub(crate) fn new(config: ForecastConfig, limits: &TiltLimits, radius_m: f64) -> Self {
        let half = (radius_m / config.step_m).ceil() as i32 + 1;
        let side = (2 * half + 1) as usize;
        Self {
            config,
            limits: Slopes::of_limits(limits, 0.0),
            allowed: Slopes::of_limits(limits, config.tilt_margin_rad),
            allowed_near: Slopes::of_limits(limits, config.escape_margin_rad),
            half,
            centre: IVec2::ZERO,
            places: vec![UNKNOWN; side * side],
            planes: vec![Known { index: IVec2::MAX, plane: None }; side * side],
            looks: 0,
            barred_m: Vec::with_capacity(MOST_BARRED),
        }
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.planes.fill(Known { index: IVec2::MAX, plane: None });
        self.looks = 0;
        self.barred_m.clear();
    }

    /// Bars a place, until the ground is forgotten.
    pub(crate) fn bar(&mut self, place_m: DVec2) {
        if self.barred_m.len() == MOST_BARRED {
            self.barred_m.remove(0);
        }
        self.barred_m.push(place_m);
    }

    fn is_barred(&self, place_m: DVec2) -> bool {
        let squared = BARRED_RADIUS_M * BARRED_RADIUS_M;
        self.barred_m.iter().any(|barred| (*barred - place_m).length_squared() < squared)
    }

    /// Looks at the ground around the robot.
    pub(crate) fn look(&mut self, plane_at: &dyn Fn(DVec2) -> Option<Plane>, here_m: DVec2) {
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
                let slot = self.slot(world);
                let due = (world.x + 2 * world.y).rem_euclid(LOOKS) == self.looks;
                if due || self.planes[slot].index != world {
                    let plane = plane_at(self.position_m(offset));
                    self.planes[slot] = Known { index: world, plane };
                }
            }
        }
    }

    /// Judges how the robot, which stands at `here_m`, would stand at the places looked at.
    pub(crate) fn judge(&mut self, here_m: DVec2, caution: Caution) {
        let usual = (self.allowed, self.config.deviations);
        let near = match caution {
            Caution::Usual => usual,
            Caution::Escape => (self.allowed_near, 0.0),
        };
        let near_squared = self.config.escape_m * self.config.escape_m;
        for index in 0..self.places.len() {
            let offset = self.offset(index);
            let Known { index: world, plane } = self.planes[self.slot(self.centre + offset)];
            self.places[index] = match plane {
                Some(plane) if world == self.centre + offset => {
                    let place_m = self.position_m(offset);
                    if caution == Caution::Usual && self.is_barred(place_m) {
                        self.places[index] = Place { plane: Some(plane), ..UNKNOWN };
                        continue;
                    }
                    let away = place_m - here_m;
                    let (allowed, deviations) =
                        if away.length_squared() < near_squared { near } else { usual };
                    self.stand(plane, &allowed, deviations)
                }
                _ => UNKNOWN,
            };
        }
    }

    fn stand(&self, plane: Plane, allowed: &Slopes, deviations: f64) -> Place {
        let margin = deviations * plane.gradient_deviation;
        let risk = DIRECTIONS.map(|direction| {
            let slopes = Slopes::facing(plane.gradient, direction);
            if !slopes.within(allowed, margin) {
                return f32::INFINITY;
            }
            let share = slopes.share_of(&self.limits);
            (share * share) as f32
        });
        Place { plane: Some(plane), risk }
    }

    /// The tilt limits as slopes.
    pub(crate) fn limits(&self) -> &Slopes {
        &self.limits
    }

    /// What of the limits may be used at a distance from the robot, as slopes.
    pub(crate) fn allowed(&self, caution: Caution, distance_m: f64) -> &Slopes {
        let near = caution == Caution::Escape && distance_m < self.config.escape_m;
        if near { &self.allowed_near } else { &self.allowed }
    }

    /// What of the limits may be used in a turn on the spot, as slopes.
    pub(crate) fn allowed_in_turn(&self, caution: Caution, has_begun: bool) -> &Slopes {
        if has_begun { &self.allowed_near } else { self.allowed(caution, 0.0) }
    }

    /// How many places there are.
    pub(crate) fn count(&self) -> usize {
        self.places.len()
    }

    fn slot(&self, world: IVec2) -> usize {
        let side = self.side();
        (world.y.rem_euclid(side) * side + world.x.rem_euclid(side)) as usize
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

    /// Where a place lies in the world, seen from above.
    pub(crate) fn position_m(&self, offset: IVec2) -> DVec2 {
        (self.centre + offset).as_dvec2() * self.config.step_m
    }

    /// The ground at a place, where it is known.
    pub(crate) fn plane(&self, offset: IVec2) -> Option<&Plane> {
        self.places[self.index(offset)].plane.as_ref()
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

    /// The next known place along a heading, beyond ground that was not seen; `None` where the ground goes on, or none is known
    /// within `gap_m`.
    pub(crate) fn beyond_gap(&self, from: IVec2, heading: usize, gap_m: f64) -> Option<IVec2> {
        let step = STEPS[heading];
        let steps = (gap_m / (step.as_dvec2().length() * self.config.step_m)) as i32;
        for k in 1..=steps {
            let to = from + step * k;
            if !self.holds(to) {
                return None;
            }
            if self.plane(to).is_some() {
                return (k > 1 && self.risk(to, heading).is_finite()).then_some(to);
            }
        }
        None
    }
}
