//! Exact ray casting against the bilinear height field.
//!
//! A ray traverses a pyramid in plan view like that of Tevs, Ihrke and Seidel ("Maximum mipmaps for fast,
//! accurate, and scalable dynamic height field rendering", 2008, <https://doi.org/10.1145/1342250.1342279>),
//! but of planes instead of maxima: a node whose plane lies wholly below the ray is crossed in one step;
//! otherwise the ray goes down to the plane, and on with a finer node from there. Within a single cell the
//! intersection with the bilinear patch is the first root of a quadratic. A ray starts above the ground and
//! must cross it from above, so planes below the ground would decide nothing.

mod fan;
mod patch;
mod pyramid;

use crate::height_field::{FieldError, HeightField};
use crate::sculpt::{Brush, SampleRect};
use glam::DVec3;
use mapless_parameters::ConfigError;
use pyramid::{Plane, Pyramid, shift};

pub(crate) use fan::Fan;

/// A height field prepared for ray casting.
///
/// It owns the field, so that ground and hierarchy stay consistent: change it through [`Caster::sculpt`] and
/// [`Caster::replace`].
#[derive(Clone, Debug)]
pub struct Caster {
    field: HeightField,
    pyramid: Pyramid,
}

/// A ray in grid units in the plan view (1 = one cell) and metres in height, over a parameter in metres.
struct GridRay {
    origin: [f64; 2],
    step: [f64; 2],
    inverse: [f64; 2],
    z_m: f64,
    z_step: f64,
}

/// The result of tracing an interval of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Trace {
    /// The ground, at this distance in metres.
    Ground(f64),
    /// Nothing up to this distance in metres, where the interval or the terrain ends; infinite for a ray that
    /// has risen above all ground.
    Nothing(f64),
}

/// The level at which a traversal begins: rays begin close above the ground, where large nodes are seldom
/// clear.
const FIRST_LEVEL: usize = 1;

impl Caster {
    /// Builds the hierarchy over a field.
    #[must_use]
    pub fn new(field: HeightField) -> Self {
        let pyramid = Pyramid::new(&field);
        Self { field, pyramid }
    }

    /// The ground.
    #[must_use]
    pub fn field(&self) -> &HeightField {
        &self.field
    }

    /// Returns the field.
    #[must_use]
    pub fn into_field(self) -> HeightField {
        self.field
    }

    /// Shapes the ground with a brush and updates the hierarchy where it changed; see
    /// [`HeightField::sculpt`].
    ///
    /// # Errors
    /// [`ConfigError`] when the brush is not valid.
    pub fn sculpt(&mut self, brush: &Brush) -> Result<Option<SampleRect>, ConfigError> {
        let changed = self.field.sculpt(brush)?;
        if let Some(rect) = changed {
            self.pyramid.update(&self.field, rect);
        }
        Ok(changed)
    }

    /// Puts other heights in place of those in a rectangle; see [`HeightField::replace`].
    ///
    /// # Errors
    /// [`FieldError`] when they do not fit; nothing then changes.
    pub fn replace(&mut self, rect: SampleRect, heights_m: &[f32]) -> Result<(), FieldError> {
        self.field.replace(rect, heights_m)?;
        self.pyramid.update(&self.field, rect);
        Ok(())
    }

    /// Distance in metres from `origin` along the unit vector `direction` to the first point of the ground,
    /// at most `max_range_m`.
    ///
    /// Rules at the edges: a ray that starts below the ground has no return; a ray that starts beside the
    /// terrain sees it from outside, but not through the cut below its border; a non-finite ray has no
    /// return.
    #[must_use]
    pub fn cast(&self, origin: DVec3, direction: DVec3, max_range_m: f64) -> Option<f64> {
        if !(origin.is_finite() && direction.is_finite() && max_range_m >= 0.0) {
            return None;
        }
        match self.trace(origin, direction, 0.0, max_range_m) {
            Trace::Ground(range_m) => Some(range_m),
            Trace::Nothing(_) => None,
        }
    }

    /// The first ground on a finite ray from `begin_m` to `end_m`; before `begin_m` the ray must be known to
    /// be free.
    fn trace(&self, origin: DVec3, direction: DVec3, begin_m: f64, end_m: f64) -> Trace {
        let (mut begin, mut end) = (begin_m, end_m);
        // Above the highest point there is nothing to hit.
        let ceiling = (self.pyramid.highest() - origin.z) / direction.z;
        if direction.z < 0.0 {
            begin = begin.max(ceiling);
        } else if direction.z > 0.0 {
            if ceiling < begin {
                return Trace::Nothing(f64::INFINITY);
            }
            end = end.min(ceiling);
        }
        let inverse_cell = 1.0 / self.field.cell_m();
        let step = [direction.x * inverse_cell, direction.y * inverse_cell];
        let ray = GridRay {
            origin: [origin.x * inverse_cell, origin.y * inverse_cell],
            step,
            inverse: [1.0 / step[0], 1.0 / step[1]],
            z_m: origin.z,
            z_step: direction.z,
        };
        let cells = [self.field.columns() as u32 - 1, self.field.rows() as u32 - 1];
        for axis in [0, 1] {
            let (near, far) = if ray.is_forward(axis) { (0, cells[axis]) } else { (cells[axis], 0) };
            begin = begin.max(ray.reaches(axis, near));
            end = lesser(ray.reaches(axis, far), end);
        }
        if begin > end {
            return Trace::Nothing(begin_m);
        }
        // At the ceiling nothing is above the ray, though rounding may say so on a level top.
        let is_under_ceiling = direction.z >= 0.0 || begin > ceiling;
        let starts_below = || ray.clearance(&self.field, ray.cell_at(begin, cells), begin) < 0.0;
        if begin_m <= 0.0 && is_under_ceiling && starts_below() {
            return Trace::Nothing(begin);
        }
        match self.walk(&ray, begin, end, cells) {
            Some(range_m) => Trace::Ground(range_m),
            None if direction.z > 0.0 && end >= ceiling => Trace::Nothing(f64::INFINITY),
            None => Trace::Nothing(end),
        }
    }

    fn walk(&self, ray: &GridRay, begin: f64, end: f64, cells: [u32; 2]) -> Option<f64> {
        let forward = [ray.is_forward(0), ray.is_forward(1)];
        let top = self.pyramid.top();
        let mut level = FIRST_LEVEL.min(top);
        let mut t = begin;
        // Rounding may not carry the ray into other cells than these.
        let (mut first, mut last) = ([0, 0], cells.map(|count| count - 1));
        loop {
            let cell = [0, 1].map(|axis| (ray.position(axis, t) as u32).max(first[axis]).min(last[axis]));
            let scale = shift(level);
            let side = 1 << scale;
            let node = cell.map(|cell| cell >> scale);
            let corner = node.map(|index| index << scale);
            let exits =
                [0, 1].map(|axis| ray.reaches(axis, corner[axis] + if forward[axis] { side } else { 0 }));
            let exit = lesser(exits[1], lesser(exits[0], end));
            first = corner;
            last = [0, 1].map(|axis| (corner[axis] + side).min(cells[axis]) - 1);
            if level > 0 {
                let [at_origin, growth] = ray.clearance_above(self.pyramid.plane(level, node));
                let here = at_origin + growth * t;
                if here <= 0.0 || at_origin + growth * exit <= 0.0 {
                    if here > 0.0 {
                        t = -at_origin / growth;
                    }
                    level -= 1;
                    continue;
                }
            } else if let Some(t) = patch::first_meeting(&self.field, ray, cell, t, exit) {
                return Some(t);
            }
            if exit >= end {
                return None;
            }
            t = exit;
            let axis = usize::from(exits[0] > exit || exits[0].is_nan());
            let next = if forward[axis] { corner[axis] + side } else { corner[axis].wrapping_sub(1) };
            if next >= cells[axis] {
                return None;
            }
            (first[axis], last[axis]) = (next, next);
            // A new parent may be clear as a whole.
            if level < top && (next ^ corner[axis]) >> shift(level + 1) != 0 {
                level += 1;
            }
        }
    }
}

/// The lesser of two numbers; `known` where `other` is NaN, as for a ray along an edge.
fn lesser(other: f64, known: f64) -> f64 {
    if other < known { other } else { known }
}

impl GridRay {
    fn is_forward(&self, axis: usize) -> bool {
        self.step[axis].is_sign_positive()
    }

    /// Where the ray crosses a grid line; infinite or NaN for a ray along it.
    fn reaches(&self, axis: usize, line: u32) -> f64 {
        (f64::from(line) - self.origin[axis]) * self.inverse[axis]
    }

    fn position(&self, axis: usize, t: f64) -> f64 {
        self.origin[axis] + self.step[axis] * t
    }

    /// A point a rounding error outside lands in the border cell.
    fn cell_at(&self, t: f64, cells: [u32; 2]) -> [u32; 2] {
        [0, 1].map(|axis| (self.position(axis, t) as u32).min(cells[axis] - 1))
    }

    /// Height of the ray above the ground of `cell`, in metres.
    fn clearance(&self, field: &HeightField, cell: [u32; 2], t: f64) -> f64 {
        let [u, v] = self.within(cell, t);
        self.z_m + self.z_step * t - field.patch(cell[0] as usize, cell[1] as usize).height(u, v)
    }

    /// Height of the ray above a plane at its origin, in metres, and the growth of that height along the ray.
    fn clearance_above(&self, plane: &Plane) -> [f64; 2] {
        let [east_rise, north_rise] = plane.rise.map(f64::from);
        [
            self.z_m - plane.origin_m - (east_rise * self.origin[0] + north_rise * self.origin[1]),
            self.z_step - (east_rise * self.step[0] + north_rise * self.step[1]),
        ]
    }

    fn within(&self, cell: [u32; 2], t: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.position(axis, t) - f64::from(cell[axis]))
    }
}

#[cfg(test)]
mod tests;
