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
pub struct Plane {
    /// Height at the place asked for, metres.
    pub height_m: f64,
    /// (dz/dx, dz/dy).
    pub gradient: DVec2,
    /// Standard deviation of the gradient in its least certain direction.
    pub gradient_deviation: f64,
}

impl Plane {
    /// The least-squares plane through `points_m`, with its height at `place_m`; `None` where they say too little of a
    /// slope.
    pub fn fit(place_m: DVec2, points_m: &[DVec3]) -> Option<Self> {
        let mut centroid = Centroid::default();
        points_m.iter().for_each(|&point| centroid.add(point));
        let mut moments = centroid.moments()?;
        points_m.iter().for_each(|&point| moments.add(point));
        moments.plane(place_m)
    }
}

/// The first pass of a least-squares plane.
#[derive(Default)]
struct Centroid {
    count: usize,
    sum_m: DVec3,
}

impl Centroid {
    fn add(&mut self, point_m: DVec3) {
        self.count += 1;
        self.sum_m += point_m;
    }

    fn moments(self) -> Option<Moments> {
        let Self { count, sum_m } = self;
        let centroid_m = sum_m / count as f64;
        (count >= FEWEST_CELLS).then(|| Moments { count, centroid_m, ..Moments::default() })
    }
}

/// The second pass: sums of products about the centroid.
#[derive(Default)]
struct Moments {
    count: usize,
    centroid_m: DVec3,
    xx: f64,
    xy: f64,
    yy: f64,
    xz: f64,
    yz: f64,
    zz: f64,
}

impl Moments {
    fn add(&mut self, point_m: DVec3) {
        let d = point_m - self.centroid_m;
        self.xx += d.x * d.x;
        self.xy += d.x * d.y;
        self.yy += d.y * d.y;
        self.xz += d.x * d.z;
        self.yz += d.y * d.z;
        self.zz += d.z * d.z;
    }

    fn plane(&self, place_m: DVec2) -> Option<Plane> {
        let spread = Matrix2::new(self.xx, self.xy, self.xy, self.yy);
        let least_spread = spread.symmetric_eigenvalues().min();
        // Cells in a line, such as those of a single ring, say nothing of the slope across it.
        let least_variance = LEAST_ROUGHNESS_M * LEAST_ROUGHNESS_M;
        if least_spread * LARGEST_SLOPE_DEVIATION * LARGEST_SLOPE_DEVIATION < least_variance {
            return None;
        }
        let solved = spread.cholesky()?.solve(&Vector2::new(self.xz, self.yz));
        let gradient = DVec2::new(solved.x, solved.y);
        let unexplained = self.zz - gradient.x * self.xz - gradient.y * self.yz;
        let residual = unexplained.max(0.0) / (self.count - 2) as f64;
        Some(Plane {
            height_m: self.centroid_m.z + gradient.dot(place_m - self.centroid_m.truncate()),
            gradient,
            gradient_deviation: (residual.max(least_variance) / least_spread).sqrt(),
        })
    }
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
        let mut centroid = Centroid::default();
        self.each_cell_near(place_m, radius_m, |mean| centroid.add(mean));
        let mut moments = centroid.moments()?;
        self.each_cell_near(place_m, radius_m, |mean| moments.add(mean));
        moments.plane(place_m)
    }

    fn each_cell_near(&self, place_m: DVec2, radius_m: f64, mut visit: impl FnMut(DVec3)) {
        let reach = DVec2::splat(radius_m);
        let (low, high) = (self.index_of(place_m - reach), self.index_of(place_m + reach));
        for y in low.y..=high.y {
            for x in low.x..=high.x {
                let index = IVec2::new(x, y);
                let Some(cell) = self.cells[slot_of(index)] else { continue };
                let fresh = self.tick - cell.seen_tick <= self.config.memory_ticks;
                let near = (cell.mean_m.truncate() - place_m).length_squared() <= radius_m * radius_m;
                if cell.index == index && fresh && near {
                    visit(cell.mean_m);
                }
            }
        }
    }

    fn index_of(&self, place_m: DVec2) -> IVec2 {
        (place_m / self.config.cell_m).floor().as_ivec2()
    }
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
