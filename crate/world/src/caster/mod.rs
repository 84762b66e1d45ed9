//! Exact ray casting against the bilinear height field.
//!
//! A ray walks over the plan view of a pyramid of highest points (Tevs, Ihrke and Seidel, "Maximum mipmaps for fast,
//! accurate, and scalable dynamic height field rendering", 2008). A node that lies wholly below the ray is skipped in one
//! step; in a single cell the meeting with the bilinear patch is the first root of a quadratic. A ray starts above
//! the ground and must cross it from above, so the lowest points of the nodes would decide nothing and are not kept.

mod fan;
mod patch;
mod pyramid;

use crate::config::ConfigError;
use crate::height_field::HeightField;
use crate::sculpt::{Brush, SampleRect};
use glam::DVec3;
use pyramid::Pyramid;

pub(crate) use fan::Fan;

/// A height field prepared for ray casting.
///
/// It owns the field, so that the ground and its hierarchy cannot part: sculpt through [`Caster::sculpt`].
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

/// What a stretch of a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Trace {
    /// The ground, at this distance in metres.
    Ground(f64),
    /// Nothing up to this distance in metres, where the stretch, the terrain or all chance of ground ends.
    Nothing(f64),
}

/// Where a ray stands: parameter, cell, and level of the hierarchy.
struct Cursor {
    t: f64,
    cell: [usize; 2],
    level: usize,
}

/// The level at which a walk begins: rays begin close above the ground, where large nodes are never clear.
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

    /// Gives the field back.
    #[must_use]
    pub fn into_field(self) -> HeightField {
        self.field
    }

    /// Shapes the ground with a brush and updates the hierarchy where it changed; see [`HeightField::sculpt`].
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

    /// Distance in metres from `origin` along the unit vector `direction` to the first point of the ground, at most
    /// `max_range_m`.
    ///
    /// Rules at the edges: a ray that starts below the ground has no return; a ray that starts beside the terrain
    /// sees it from outside, but not through the cut below its border; a non-finite ray has no return.
    #[must_use]
    pub fn cast(&self, origin: DVec3, direction: DVec3, max_range_m: f64) -> Option<f64> {
        match self.trace(origin, direction, 0.0, max_range_m) {
            Trace::Ground(range_m) => Some(range_m),
            Trace::Nothing(_) => None,
        }
    }

    /// The first ground on a ray from `begin_m` to `end_m`; before `begin_m` the ray must be known to be free.
    fn trace(&self, origin: DVec3, direction: DVec3, begin_m: f64, end_m: f64) -> Trace {
        if !(origin.is_finite() && direction.is_finite() && end_m >= begin_m) {
            return Trace::Nothing(begin_m);
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
        let cells = [self.field.columns() - 1, self.field.rows() - 1];
        let Some((mut begin, mut end)) = ray.clip(cells, begin_m, end_m) else {
            return Trace::Nothing(begin_m);
        };
        let starts_below = || ray.clearance(&self.field, ray.cell_at(begin, cells), begin) < 0.0;
        if begin_m <= 0.0 && starts_below() {
            return Trace::Nothing(begin);
        }
        // Above the highest point there is nothing to hit.
        let ceiling = (self.pyramid.highest() - ray.z_m) / ray.z_step;
        if ray.z_step < 0.0 {
            begin = begin.max(ceiling);
        } else if ray.z_step > 0.0 {
            end = end.min(ceiling);
        }
        if begin > end {
            return Trace::Nothing(end);
        }
        let start =
            Cursor { t: begin, cell: ray.cell_at(begin, cells), level: FIRST_LEVEL.min(self.pyramid.top()) };
        match self.walk(&ray, start, end, cells) {
            Some(range_m) => Trace::Ground(range_m),
            None => Trace::Nothing(end),
        }
    }

    fn walk(&self, ray: &GridRay, mut at: Cursor, end: f64, cells: [usize; 2]) -> Option<f64> {
        let forward = [ray.step[0] >= 0.0, ray.step[1] >= 0.0];
        let top = self.pyramid.top();
        loop {
            let level = at.level;
            let node = [at.cell[0] >> level, at.cell[1] >> level];
            let exit_at = |axis: usize| {
                let edge = (node[axis] + usize::from(forward[axis])) << level;
                (edge as f64 - ray.origin[axis]) * ray.inverse[axis]
            };
            let exits = [exit_at(0), exit_at(1)];
            // `min` drops the NaN of a ray that runs along an edge.
            let exit = exits[0].min(exits[1]).min(end);
            let lowest = ray.z_m + ray.z_step * if ray.z_step < 0.0 { exit } else { at.t };
            if level > 0 {
                if lowest <= self.pyramid.max(level, node) {
                    at.level -= 1;
                    continue;
                }
            } else if let Some(t) = patch::first_meeting(&self.field, ray, at.cell, at.t, exit, lowest) {
                return Some(t);
            }
            if exit >= end {
                return None;
            }
            let through = usize::from(exits[0] > exit || exits[0].is_nan());
            let along = 1 - through;
            at.cell[through] = if forward[through] {
                (node[through] + 1) << level
            } else {
                (node[through] << level).checked_sub(1)?
            };
            if at.cell[through] >= cells[through] {
                return None;
            }
            let low = node[along] << level;
            let high = (((node[along] + 1) << level) - 1).min(cells[along] - 1);
            let position = ray.origin[along] + ray.step[along] * exit;
            at.cell[along] = (position as usize).clamp(low, high);
            at.t = exit;
            // A new parent may be clear as a whole.
            if at.cell[through] >> (level + 1) != node[through] >> 1 && level < top {
                at.level += 1;
            }
        }
    }
}

impl GridRay {
    /// The part of the ray from `begin` to `end` that is over the terrain.
    fn clip(&self, cells: [usize; 2], mut begin: f64, mut end: f64) -> Option<(f64, f64)> {
        for (axis, &count) in cells.iter().enumerate() {
            let side = count as f64;
            if self.step[axis].abs() > 0.0 {
                let a = -self.origin[axis] * self.inverse[axis];
                let b = (side - self.origin[axis]) * self.inverse[axis];
                begin = begin.max(a.min(b));
                end = end.min(a.max(b));
            } else if !(0.0..=side).contains(&self.origin[axis]) {
                return None;
            }
        }
        (begin <= end).then_some((begin, end))
    }

    fn cell_at(&self, t: f64, cells: [usize; 2]) -> [usize; 2] {
        // A cast to an integer saturates at 0, so a point a rounding error outside lands in the border cell.
        [0, 1].map(|axis| ((self.origin[axis] + self.step[axis] * t) as usize).min(cells[axis] - 1))
    }

    /// Height of the ray above the ground of `cell`, in metres.
    fn clearance(&self, field: &HeightField, cell: [usize; 2], t: f64) -> f64 {
        let [u, v] = self.within(cell, t);
        self.z_m + self.z_step * t - field.patch(cell[0], cell[1]).height(u, v)
    }

    fn within(&self, cell: [usize; 2], t: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.origin[axis] + self.step[axis] * t - cell[axis] as f64)
    }
}

#[cfg(test)]
mod tests;
