//! What the last scans saw of the ground around the robot.
//!
//! Not a map: a window of cells that moves with the robot, holds returns of the last seconds within r_oc and the ground
//! under the wheels, and forgets the rest. It answers two questions: what would the robot's roll and pitch be there, and would
//! ground have been seen there if there were any?

mod cliffs;
mod footprint;

use core::time::Duration;
use std::collections::VecDeque;

use glam::{DVec2, DVec3, IVec2};

use crate::config::{ElevationWindowConfig, PlannerConfig, WINDOW_CELLS};
use crate::math::elementary::floor;
use crate::pose::FrameChange;
use crate::terrain::plane::{Moments, Plane};
use crate::terrain::rolling_grid::RollingGrid;
use crate::terrain::slopes::Slopes;
use cliffs::{MOST_VIEWS, View};

/// Returns that a cell averages before new ones begin to outweigh old ones.
const MOST_RETURNS: f64 = 30.0;
/// Ground around a place that carries the robot: its four wheels are within the first distance. Where the rings of a
/// scan lie further apart than that, a wider plane stands in.
const FOOTPRINT_RADII_M: [f64; 3] = [0.5, 0.8, 1.2];

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

/// Ground of which the planes alone are known.
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
    /// When it was last seen, by the window's own time.
    seen: Duration,
    returns: f64,
    mean_m: DVec3,
}

/// The moving window.
#[derive(Clone, Debug)]
pub(crate) struct ElevationWindow {
    config: ElevationWindowConfig,
    wheelbase_m: f64,
    track_m: f64,
    /// The time that has passed, of which [`ElevationWindowConfig::memory`] is remembered.
    now: Duration,
    memory: Duration,
    cells: RollingGrid<ElevationCell>,
    /// From where the last scans were taken, the newest last.
    views: VecDeque<View>,
}

impl ElevationWindow {
    pub(crate) fn new(config: &PlannerConfig) -> Self {
        let PlannerConfig { elevation_window, robot, .. } = *config;
        Self {
            config: elevation_window,
            wheelbase_m: robot.wheelbase_m,
            track_m: robot.track_m,
            now: Duration::ZERO,
            memory: elevation_window.memory(),
            cells: RollingGrid::new(WINDOW_CELLS),
            views: VecDeque::with_capacity(MOST_VIEWS),
        }
    }

    pub(crate) fn clear(&mut self) {
        self.cells.clear();
        self.views.clear();
    }

    /// Starts a new scan; what is older than the memory will no longer be found.
    pub(crate) fn advance(&mut self, elapsed: Duration) {
        self.now = self.now.saturating_add(elapsed);
    }

    /// Adds a point on the ground, in the world frame.
    pub(crate) fn add(&mut self, point_m: DVec3) {
        let index = self.index_of(point_m.truncate());
        let (now, memory) = (self.now, self.memory);
        match self.cells.get_mut(index) {
            Some(cell) if now - cell.seen <= memory => {
                cell.returns = (cell.returns + 1.0).min(MOST_RETURNS);
                cell.mean_m += (point_m - cell.mean_m) * (1.0 / cell.returns);
                cell.seen = now;
            }
            _ => self.cells.set(index, ElevationCell { seen: now, returns: 1.0, mean_m: point_m }),
        }
    }

    /// Moves all that is remembered from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        let mut moved = RollingGrid::new(WINDOW_CELLS);
        for (_, cell) in self.cells.iter().filter(|(_, cell)| self.is_fresh(cell)) {
            let mean_m = change.point_m(cell.mean_m);
            moved.set(self.index_of(mean_m.truncate()), ElevationCell { mean_m, ..*cell });
        }
        self.cells = moved;
        for view in &mut self.views {
            view.relocalise(change);
        }
    }

    fn plane_within(&self, place_m: DVec2, radius_m: f64) -> Option<Plane> {
        let moments = self.moments_near(place_m, radius_m, |_| true);
        let plane = moments.plane()?;
        let unseen = self.config.slope_deviation_per_m * moments.distance_m();
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
        self.cells.between(low, high).filter(move |cell| {
            (cell.mean_m.truncate() - place_m).length_squared() <= radius_m * radius_m && self.is_fresh(cell)
        })
    }

    fn is_fresh(&self, cell: &ElevationCell) -> bool {
        self.now - cell.seen <= self.memory
    }

    fn index_of(&self, place_m: DVec2) -> IVec2 {
        let cells = place_m / self.config.cell_m;
        IVec2::new(floor(cells.x), floor(cells.y))
    }
}

impl TerrainQuery for ElevationWindow {
    fn plane_at(&self, place_m: DVec2) -> Option<Plane> {
        FOOTPRINT_RADII_M.iter().find_map(|&radius_m| self.plane_within(place_m, radius_m))
    }

    fn slopes_at(&self, place_m: DVec2, plane: &Plane, direction: DVec2) -> Option<Slopes> {
        self.footprint_slopes(place_m, direction, plane.gradient)
    }

    fn is_negative_obstacle(&self, place_m: DVec2, here_m: DVec2, was_negative_obstacle: bool) -> bool {
        self.is_cliff(place_m, here_m, was_negative_obstacle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::STEP;
    use proptest::prelude::*;

    fn strewn(slope: DVec2, centre: DVec2) -> ElevationWindow {
        let mut ground = ElevationWindow::new(&PlannerConfig::default());
        ground.advance(STEP);
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
        for _ in 0..=3000 {
            ground.advance(STEP);
        }
        assert!(ground.plane_at(DVec2::ZERO).is_none());
    }
}
