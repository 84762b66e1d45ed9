//! How the robot would stand at the places of a lattice, for each heading.

use glam::{DVec2, IVec2};

use super::headings::{DIRECTIONS, HEADINGS, STEPS, passed};
use crate::config::{ForecastConfig, TiltLimits};
use crate::elementary::floor;
use crate::ground::SeenGround;
use crate::plane::Plane;
use crate::slopes::Slopes;

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
    mistrusted_m: Vec<DVec2>,
}

/// Mistrusted places that are remembered, how much around each is meant, and the risk that each time adds; ground at the tilt limit has 1.
const MOST_MISTRUSTED: usize = 128;
const MISTRUSTED_RADIUS_M: f64 = 0.6;
const MISTRUST_RISK: f32 = 2.0;
/// Standard deviation of a slope between wheels under which returns were averaged.
const WHEELS_DEVIATION: f64 = 0.05;

/// What was last found at a place of the world's lattice.
#[derive(Clone, Copy, Debug)]
struct Known {
    index: IVec2,
    plane: Option<Plane>,
    /// On the wheels, for each axis of travel.
    on_wheels: [Option<Slopes>; HEADINGS / 2],
}

impl Known {
    const NOTHING: Self = Self { index: IVec2::MAX, plane: None, on_wheels: [None; HEADINGS / 2] };
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
            planes: vec![Known::NOTHING; side * side],
            looks: 0,
            mistrusted_m: Vec::with_capacity(MOST_MISTRUSTED),
        }
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.planes.fill(Known::NOTHING);
        self.looks = 0;
        self.mistrusted_m.clear();
    }

    /// Mistrusts a place, until the ground is forgotten: each time it costs more to drive there.
    pub(crate) fn mistrust(&mut self, place_m: DVec2) {
        if self.mistrusted_m.len() == MOST_MISTRUSTED {
            self.mistrusted_m.remove(0);
        }
        self.mistrusted_m.push(place_m);
    }

    fn mistrust_risk(&self, place_m: DVec2) -> f32 {
        let squared = MISTRUSTED_RADIUS_M * MISTRUSTED_RADIUS_M;
        let near = self.mistrusted_m.iter().filter(|other| (**other - place_m).length_squared() < squared);
        MISTRUST_RISK * near.count() as f32
    }

    /// Looks at the ground around the robot.
    pub(crate) fn look(&mut self, ground: &dyn SeenGround, here_m: DVec2) {
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
                    let place_m = self.position_m(offset);
                    let plane = ground.plane_at(place_m);
                    let on_wheels = plane.map_or(Known::NOTHING.on_wheels, |plane| {
                        DIRECTIONS.map(|direction| ground.slopes_at(place_m, &plane, direction))
                    });
                    self.planes[slot] = Known { index: world, plane, on_wheels };
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
            let known = self.planes[self.slot(self.centre + offset)];
            self.places[index] = match known.plane {
                Some(plane) if known.index == self.centre + offset => {
                    let place_m = self.position_m(offset);
                    let away = place_m - here_m;
                    let (allowed, deviations) =
                        if away.length_squared() < near_squared { near } else { usual };
                    let mistrust = match caution {
                        Caution::Usual => self.mistrust_risk(place_m),
                        Caution::Escape => 0.0,
                    };
                    let risk = self.risk_of(&plane, &known.on_wheels, &allowed, deviations);
                    Place { plane: Some(plane), risk: risk.map(|risk| risk + mistrust) }
                }
                _ => UNKNOWN,
            };
        }
    }

    fn risk_of(
        &self,
        plane: &Plane,
        on_wheels: &[Option<Slopes>; HEADINGS / 2],
        allowed: &Slopes,
        deviations: f64,
    ) -> [f32; HEADINGS / 2] {
        core::array::from_fn(|axis| {
            let (slopes, deviation) = match on_wheels[axis] {
                Some(slopes) => (slopes, WHEELS_DEVIATION),
                None => (Slopes::facing(plane.gradient, DIRECTIONS[axis]), plane.gradient_deviation),
            };
            if !slopes.within(allowed, deviations * deviation) {
                return f32::INFINITY;
            }
            let share = slopes.share_of(&self.limits);
            (share * share) as f32
        })
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

    /// What of the limits may be used to get away, as slopes.
    pub(crate) fn allowed_to_escape(&self) -> &Slopes {
        &self.allowed_near
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
