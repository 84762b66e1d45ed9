//! What the last scans saw of the ground around the robot.
//!
//! Not a map: a window of cells that moves with the robot, holds returns of the last seconds within r_oc and the ground
//! under the wheels, and forgets the rest. It answers two questions: what would the robot's roll and pitch be there, and would
//! ground have been seen there if there were any?

mod cliffs;
mod footprint;

use std::collections::VecDeque;

use glam::{DVec2, DVec3, IVec2};

use crate::config::{ElevationWindowConfig, PlannerConfig};
use crate::math::elementary::floor;
use crate::sensor_model::SensorModel;
use crate::terrain::plane::{Moments, Plane};
use crate::terrain::slopes::Slopes;
use cliffs::{MOST_VIEWS, View};

/// Cells per side of the window, at least and at most, and how many more than its radius needs.
const LEAST_SIDE: usize = 96;
pub(crate) const MOST_SIDE: usize = 1024;
const SPARE_CELLS: usize = 6;
/// Returns that a cell averages before new ones begin to outweigh old ones.
const MOST_RETURNS: f64 = 30.0;
/// Ground around a place that carries the robot: its four wheels are within the footprint's radius. Where the rings of a scan lie
/// further apart than that, a wider plane stands in.
const FOOTPRINT_RADII: [f64; 3] = [1.0, 1.6, 2.4];

/// What a search asks of the ground.
pub(crate) trait TerrainQuery {
    /// The least-squares plane through the ground around a place; `None` where too little was seen.
    fn plane_at(&self, place_m: DVec2) -> Option<Plane>;

    /// How steep the robot stands on its wheels around a place, where the ground has this plane, facing along a unit vector; `None` where
    /// no more than the plane is known.
    fn slopes_at(&self, place_m: DVec2, plane: &Plane, direction: DVec2) -> Option<Slopes>;

    /// Whether there is no ground under a wheel at a place, as it would have been seen from the side of `here_m`, or it drops off there.
    /// What `was_missing` stays so while no returns come from it.
    fn is_negative_obstacle(&self, place_m: DVec2, here_m: DVec2, was_negative_obstacle: bool) -> bool;
}

/// ElevationWindow of which the planes alone are known.
impl<F: Fn(DVec2) -> Option<Plane>> TerrainQuery for F {
    fn plane_at(&self, place_m: DVec2) -> Option<Plane> {
        self(place_m)
    }

    fn slopes_at(&self, _: DVec2, _: &Plane, _: DVec2) -> Option<Slopes> {
        None
    }

    fn is_negative_obstacle(&self, _: DVec2, _: DVec2, _: bool) -> bool {
        false
    }
}

#[derive(Clone, Copy, Debug)]
struct ElevationCell {
    index: IVec2,
    seen_tick: u64,
    returns: f64,
    mean_m: DVec3,
}

/// The moving window.
#[derive(Clone, Debug)]
pub(crate) struct ElevationWindow {
    config: ElevationWindowConfig,
    wheelbase_m: f64,
    track_m: f64,
    footprint_m: f64,
    /// Spacing of the places that are asked for.
    step_m: f64,
    sensor: SensorModel,
    side: usize,
    tick: u64,
    cells: Vec<Option<ElevationCell>>,
    /// From where the last scans were taken, the newest last.
    views: VecDeque<View>,
}

impl ElevationWindow {
    pub(crate) fn new(config: &PlannerConfig) -> Self {
        let PlannerConfig { elevation_window, robot, sensor, .. } = *config;
        let views = VecDeque::with_capacity(MOST_VIEWS);
        let side = side_of(&elevation_window);
        Self {
            config: elevation_window,
            wheelbase_m: robot.wheelbase_m,
            track_m: robot.track_m,
            footprint_m: robot.footprint_radius_m(),
            step_m: config.state_lattice.step_m,
            sensor,
            side,
            tick: 0,
            cells: vec![None; side * side],
            views,
        }
    }

    pub(crate) fn clear(&mut self) {
        self.cells.fill(None);
        self.views.clear();
    }

    /// Starts a new scan; what is older than the memory will no longer be found.
    pub(crate) fn advance(&mut self) {
        self.tick += 1;
    }

    /// Adds a point on the ground, in the world frame.
    pub(crate) fn add(&mut self, point_m: DVec3) {
        let index = self.index_of(point_m.truncate());
        let tick = self.tick;
        let slot = self.slot_of(index);
        let slot = &mut self.cells[slot];
        match slot {
            Some(cell) if cell.index == index && tick - cell.seen_tick <= self.config.memory_ticks => {
                cell.returns = (cell.returns + 1.0).min(MOST_RETURNS);
                cell.mean_m += (point_m - cell.mean_m) * (1.0 / cell.returns);
                cell.seen_tick = tick;
            }
            _ => *slot = Some(ElevationCell { index, seen_tick: tick, returns: 1.0, mean_m: point_m }),
        }
    }

    fn plane_within(&self, place_m: DVec2, radius_m: f64) -> Option<Plane> {
        let moments = self.moments_near(place_m, radius_m, |_| true);
        let plane = moments.plane(self.footprint_m)?;
        let unseen = self.config.curvature_per_m * moments.distance_m();
        Some(Plane { gradient_deviation: libm::hypot(plane.gradient_deviation, unseen), ..plane })
    }

    /// Moments of the fresh cells whose mean is within `radius_m` of a place, as far as they count by where they lie from it.
    fn moments_near(&self, place_m: DVec2, radius_m: f64, counts: impl Fn(DVec2) -> bool) -> Moments {
        let mut moments = Moments::default();
        for cell in self.cells_near(place_m, radius_m) {
            let from_place = cell.mean_m.truncate() - place_m;
            if counts(from_place) {
                moments.add(from_place, cell.mean_m.z);
            }
        }
        moments
    }

    /// The fresh cells whose mean is within `radius_m` of a place.
    fn cells_near(&self, place_m: DVec2, radius_m: f64) -> impl Iterator<Item = &ElevationCell> {
        let reach = DVec2::splat(radius_m);
        let (low, high) = (self.index_of(place_m - reach), self.index_of(place_m + reach));
        let rows = (low.y..=high.y).map(|y| (y, &self.cells[self.slot_of(IVec2::new(0, y))..][..self.side]));
        rows.flat_map(move |(y, row)| {
            (low.x..=high.x).filter_map(move |x| {
                let cell = row[self.slot_of(IVec2::new(x, 0))].as_ref()?;
                let near = (cell.mean_m.truncate() - place_m).length_squared() <= radius_m * radius_m;
                (near && cell.index == IVec2::new(x, y) && self.is_fresh(cell)).then_some(cell)
            })
        })
    }

    fn is_fresh(&self, cell: &ElevationCell) -> bool {
        self.tick - cell.seen_tick <= self.config.memory_ticks
    }

    fn index_of(&self, place_m: DVec2) -> IVec2 {
        let cells = place_m / self.config.cell_m;
        IVec2::new(floor(cells.x), floor(cells.y))
    }

    fn slot_of(&self, index: IVec2) -> usize {
        let side = self.side as i32;
        (index.y.rem_euclid(side) * side + index.x.rem_euclid(side)) as usize
    }

    /// The radii within which the ground around a place is looked for, the narrowest first.
    fn footprint_radii_m(&self) -> [f64; 3] {
        FOOTPRINT_RADII.map(|times| times * self.footprint_m)
    }
}

impl TerrainQuery for ElevationWindow {
    fn plane_at(&self, place_m: DVec2) -> Option<Plane> {
        self.footprint_radii_m().into_iter().find_map(|radius_m| self.plane_within(place_m, radius_m))
    }

    fn slopes_at(&self, place_m: DVec2, plane: &Plane, direction: DVec2) -> Option<Slopes> {
        self.footprint_slopes(place_m, direction, plane.gradient)
    }

    fn is_negative_obstacle(&self, place_m: DVec2, here_m: DVec2, was_negative_obstacle: bool) -> bool {
        self.is_cliff(place_m, here_m, was_negative_obstacle)
    }
}

/// So many cells to a side that no two places inside the window share a slot.
pub(crate) fn side_of(config: &ElevationWindowConfig) -> usize {
    let spanned = (2.0 * config.radius_m / config.cell_m).ceil() as usize;
    spanned.saturating_add(SPARE_CELLS).max(LEAST_SIDE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn strewn(slope: DVec2, centre: DVec2) -> ElevationWindow {
        let mut ground = ElevationWindow::new(&PlannerConfig::default());
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
        for _ in 0..=PlannerConfig::default().elevation_window.memory_ticks {
            ground.advance();
        }
        assert!(ground.plane_at(DVec2::ZERO).is_none());
    }
}
