//! What the last scans saw of the ground around the robot.
//!
//! Not a map: a window of cells that moves with the robot, holds returns of the last seconds within r_oc and the ground
//! under the wheels, and forgets the rest. It answers one question: what would the robot's roll and pitch be there?

use glam::{DVec2, DVec3, IVec2};
use nalgebra::{Matrix2, Vector2};

use crate::config::GroundConfig;

/// Cells per side of the window.
pub(crate) const SIDE: usize = 96;
/// Returns that a cell averages before new ones begin to outweigh old ones.
const MOST_RETURNS: f64 = 30.0;
/// Ground around a place that carries the robot: its four wheels are within the first distance. Where the rings of a
/// scan lie further apart than that, a wider plane stands in.
const FOOTPRINT_RADII_M: [f64; 3] = [0.5, 0.8, 1.2];
/// A plane whose slope the cells leave more uncertain than this says nothing.
const LARGEST_SLOPE_DEVIATION: f64 = 0.08;
/// Cells a plane needs at least.
const FEWEST_CELLS: usize = 5;
/// Roughness that is always allowed for: sensor noise and what a cell averages away.
const LEAST_ROUGHNESS_M: f64 = 0.02;

#[derive(Clone, Copy, Debug)]
struct GroundCell {
    index: IVec2,
    seen_tick: u64,
    returns: f64,
    mean_m: DVec3,
}

/// The plane through the ground around a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// Height at the place asked for.
    pub(crate) height_m: f64,
    /// (dz/dx, dz/dy).
    pub(crate) gradient: DVec2,
    /// Standard deviation of the gradient in its least certain direction.
    pub(crate) gradient_deviation: f64,
}

/// The moving window.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    config: GroundConfig,
    tick: u64,
    cells: Vec<Option<GroundCell>>,
}

impl Ground {
    pub(crate) fn new(config: GroundConfig) -> Self {
        Self { config, tick: 0, cells: vec![None; SIDE * SIDE] }
    }

    pub(crate) fn clear(&mut self) {
        self.cells.fill(None);
    }

    /// Starts a new scan; what is older than the memory will no longer be found.
    pub(crate) fn advance(&mut self) {
        self.tick += 1;
    }

    /// Adds a point on the ground, in the world frame.
    pub(crate) fn add(&mut self, point_m: DVec3) {
        let index = self.index_of(point_m.truncate());
        let tick = self.tick;
        let slot = &mut self.cells[slot_of(index)];
        match slot {
            Some(cell) if cell.index == index && tick - cell.seen_tick <= self.config.memory_ticks => {
                cell.returns = (cell.returns + 1.0).min(MOST_RETURNS);
                cell.mean_m += (point_m - cell.mean_m) / cell.returns;
                cell.seen_tick = tick;
            }
            _ => *slot = Some(GroundCell { index, seen_tick: tick, returns: 1.0, mean_m: point_m }),
        }
    }

    /// The least-squares plane through the ground around `place_m`; `None` where too little was seen.
    pub(crate) fn plane_at(&self, place_m: DVec2) -> Option<Plane> {
        FOOTPRINT_RADII_M.iter().find_map(|&radius_m| self.plane_within(place_m, radius_m))
    }

    fn plane_within(&self, place_m: DVec2, radius_m: f64) -> Option<Plane> {
        let moments = self.moments_near(place_m, radius_m);
        if moments.count < FEWEST_CELLS {
            return None;
        }
        let count = moments.count as f64;
        let centroid = moments.sum / count;
        let central = |square: f64, a: f64, b: f64| square - a * b * count;
        let xx = central(moments.xx, centroid.x, centroid.x);
        let xy = central(moments.xy, centroid.x, centroid.y);
        let yy = central(moments.yy, centroid.y, centroid.y);
        let xz = central(moments.xz, centroid.x, centroid.z);
        let yz = central(moments.yz, centroid.y, centroid.z);
        let zz = central(moments.zz, centroid.z, centroid.z);
        let spread = Matrix2::new(xx, xy, xy, yy);
        let least_spread = spread.symmetric_eigenvalues().min();
        // Cells in a line, such as those of a single ring, say nothing of the slope across it.
        let least_variance = LEAST_ROUGHNESS_M * LEAST_ROUGHNESS_M;
        if least_spread * LARGEST_SLOPE_DEVIATION * LARGEST_SLOPE_DEVIATION < least_variance {
            return None;
        }
        let solved = spread.cholesky()?.solve(&Vector2::new(xz, yz));
        let gradient = DVec2::new(solved.x, solved.y);
        let residual = (zz - gradient.x * xz - gradient.y * yz).max(0.0) / (moments.count - 2) as f64;
        Some(Plane {
            height_m: moments.datum_m + centroid.z - gradient.dot(centroid.truncate()),
            gradient,
            gradient_deviation: (residual.max(least_variance) / least_spread).sqrt(),
        })
    }

    /// Moments of the fresh cells whose mean is within `radius_m` of a place.
    fn moments_near(&self, place_m: DVec2, radius_m: f64) -> Moments {
        let reach = DVec2::splat(radius_m);
        let (low, high) = (self.index_of(place_m - reach), self.index_of(place_m + reach));
        let mut moments = Moments::default();
        for y in low.y..=high.y {
            let row = &self.cells[slot_of(IVec2::new(0, y))..][..SIDE];
            for x in low.x..=high.x {
                let Some(cell) = &row[slot_of(IVec2::new(x, 0))] else { continue };
                let fresh = self.tick - cell.seen_tick <= self.config.memory_ticks;
                let from_place = cell.mean_m.truncate() - place_m;
                let near = from_place.length_squared() <= radius_m * radius_m;
                if cell.index == IVec2::new(x, y) && fresh && near {
                    moments.add(from_place, cell.mean_m.z);
                }
            }
        }
        moments
    }

    fn index_of(&self, place_m: DVec2) -> IVec2 {
        let cells = place_m / self.config.cell_m;
        IVec2::new(floor(cells.x), floor(cells.y))
    }
}

/// Sums over cells, about the place asked for and the height of the first cell.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    count: usize,
    datum_m: f64,
    sum: DVec3,
    xx: f64,
    xy: f64,
    yy: f64,
    xz: f64,
    yz: f64,
    zz: f64,
}

impl Moments {
    fn add(&mut self, from_place: DVec2, height_m: f64) {
        if self.count == 0 {
            self.datum_m = height_m;
        }
        self.count += 1;
        let d = from_place.extend(height_m - self.datum_m);
        self.sum += d;
        self.xx += d.x * d.x;
        self.xy += d.x * d.y;
        self.yy += d.y * d.y;
        self.xz += d.x * d.z;
        self.yz += d.y * d.z;
        self.zz += d.z * d.z;
    }
}

/// The largest whole number not above a finite `value`. (`f64::floor` is a call where the processor's own is not assumed.)
fn floor(value: f64) -> i32 {
    let towards_zero = value as i32;
    towards_zero.saturating_sub(i32::from(value < f64::from(towards_zero)))
}

fn slot_of(index: IVec2) -> usize {
    let side = SIDE as i32;
    (index.y.rem_euclid(side) * side + index.x.rem_euclid(side)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use proptest::prelude::*;

    fn strewn(slope: DVec2, centre: DVec2) -> Ground {
        let mut ground = Ground::new(PlannerConfig::default().ground);
        ground.advance();
        for i in -20..=20 {
            for j in -20..=20 {
                let place = centre + DVec2::new(f64::from(i), f64::from(j)) * 0.11;
                ground.add(place.extend(slope.dot(place)));
            }
        }
        ground
    }

    proptest! {
        #[test]
        fn a_plane_is_found_again(
            sx in -0.7..0.7_f64, sy in -0.7..0.7_f64, x in -50.0..50.0_f64, y in -50.0..50.0_f64,
        ) {
            let (slope, place) = (DVec2::new(sx, sy), DVec2::new(x, y));
            let plane = strewn(slope, place).plane_at(place).unwrap();
            prop_assert!((plane.gradient - slope).length() < 1e-9);
            prop_assert!((plane.height_m - slope.dot(place)).abs() < 1e-9);
            prop_assert!(plane.gradient_deviation < 0.1);
        }
    }

    #[test]
    fn unseen_and_forgotten_ground_has_no_plane() {
        let mut ground = strewn(DVec2::ZERO, DVec2::ZERO);
        assert!(ground.plane_at(DVec2::new(6.0, 0.0)).is_none());
        assert!(ground.plane_at(DVec2::ZERO).is_some());
        for _ in 0..=PlannerConfig::default().ground.memory_ticks {
            ground.advance();
        }
        assert!(ground.plane_at(DVec2::ZERO).is_none());
    }
}
