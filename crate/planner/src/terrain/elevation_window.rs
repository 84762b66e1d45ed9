//! The elevation window: ground around the robot, from the last scans.
//!
//! It is no global map: a grid of cells that moves with the robot, holds returns within its radius and the
//! ground under the wheels, and forgets cells that were not seen again for its memory time. It answers two
//! questions: the roll and pitch of the robot at a place, and whether a place is a negative obstacle.

mod cliffs;
mod footprint;

use core::time::Duration;
use std::collections::VecDeque;

use glam::{DVec2, DVec3, IVec2};

use crate::config::{ElevationWindowConfig, PlannerConfig};
use crate::math::elementary::floor;
use crate::pose::FrameChange;
use crate::robot_model::distance_from_body_m;
use crate::sensor_model::SensorModel;
use crate::terrain::headings::{AXES, DIRECTIONS};
use crate::terrain::plane::{Moments, Plane};
use crate::terrain::rolling_grid::RollingGrid;
use crate::terrain::slopes::Slopes;
use cliffs::{DROP_RADIUS_M, MOST_VIEWS, View};

/// Weight of the past in a cell's average, in returns.
const MOST_RETURNS: f64 = 30.0;
/// A scan looks for ground that it refutes in one of so many parts of the window.
const PARTS: usize = 4;
/// A cell is upright once so many rows of beams met a face in it.
const FEWEST_FACES: u32 = 3;
/// The body keeps this far from what is upright.
const UPRIGHT_MARGIN_M: f64 = 0.1;
/// Radii of the ground around a place that carries the robot, as multiples of the footprint's radius. A wider
/// plane replaces a narrower one if the rings of a scan lie farther apart.
const FOOTPRINT_RADII: [f64; 3] = [1.0, 1.6, 2.4];

/// Queries of the terrain by a search.
pub(crate) trait TerrainQuery {
    /// The least-squares plane through the ground around a place; `None` if too little was seen.
    fn plane_at(&self, place_m: DVec2) -> Option<Plane>;

    /// The largest slopes of the robot on its wheels around a place with this plane, facing along a unit
    /// vector; `None` if only the plane is known.
    fn slopes_at(&self, place_m: DVec2, plane: &Plane, direction: DVec2) -> Option<Slopes>;

    /// Whether a place is a negative obstacle: no ground under a wheel that would have been seen from the
    /// side of `here_m`, or a drop. It stays one, `was_negative_obstacle`, while no returns come from it.
    fn is_negative_obstacle(&self, place_m: DVec2, here_m: DVec2, was_negative_obstacle: bool) -> bool;

    /// Whether the body at a place would touch something upright, a wall, a post or a step, for each axis of
    /// travel.
    fn touches_upright(&self, place_m: DVec2) -> [bool; AXES];

    /// Calls `visit` with the place of each upright thing within `radius_m` of a place.
    fn each_upright(&self, place_m: DVec2, radius_m: f64, visit: &mut dyn FnMut(DVec2));
}

/// Terrain given by its planes alone.
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

    fn touches_upright(&self, _: DVec2) -> [bool; AXES] {
        [false; AXES]
    }

    fn each_upright(&self, _: DVec2, _: f64, _: &mut dyn FnMut(DVec2)) {}
}

#[derive(Clone, Copy, Debug)]
struct ElevationCell {
    /// Time of the last return, on the window's clock.
    seen: Duration,
    returns: f64,
    mean_m: DVec3,
    /// Rows of beams that met an upright face here.
    faces: u32,
}

impl ElevationCell {
    /// Whether something upright stands here: no ground.
    fn is_upright(&self) -> bool {
        self.faces >= FEWEST_FACES
    }
}

/// The moving window.
#[derive(Clone, Debug)]
pub(crate) struct ElevationWindow {
    config: ElevationWindowConfig,
    wheelbase_m: f64,
    track_m: f64,
    footprint_m: f64,
    /// Half the body's length and width, with its load.
    half_body_m: DVec2,
    /// Spacing of the places of the state lattice.
    step_m: f64,
    sensor: SensorModel,
    /// The window's clock; cells are kept for [`ElevationWindowConfig::memory`].
    now: Duration,
    memory: Duration,
    cells: RollingGrid<ElevationCell>,
    /// The part of the cells that the last scan looked at.
    part: usize,
    /// Where the last scan refuted cells.
    refuted_m: Vec<DVec2>,
    /// Sensor poses of the last scans, the newest last.
    views: VecDeque<View>,
}

impl ElevationWindow {
    pub(crate) fn new(config: &PlannerConfig) -> Self {
        let PlannerConfig { elevation_window, robot, sensor, .. } = *config;
        Self {
            config: elevation_window,
            wheelbase_m: robot.wheelbase_m,
            track_m: robot.track_m,
            footprint_m: robot.footprint_radius_m(),
            half_body_m: robot.half_body_m(),
            step_m: config.state_lattice.step_m,
            sensor,
            now: Duration::ZERO,
            memory: elevation_window.memory(),
            cells: RollingGrid::new(elevation_window.cells_per_side()),
            part: 0,
            refuted_m: Vec::new(),
            views: VecDeque::with_capacity(MOST_VIEWS),
        }
    }

    pub(crate) fn clear(&mut self) {
        self.cells.clear();
        self.views.clear();
    }

    /// Starts a new scan: advances the clock, past which older cells expire.
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
            _ => self.cells.set(index, ElevationCell { seen: now, returns: 1.0, mean_m: point_m, faces: 0 }),
        }
    }

    /// Forgets the cells whose ground a scan refutes. Each scan looks at a part of the cells, in turn.
    pub(crate) fn forget_where(&mut self, is_refuted: impl Fn(DVec3) -> bool) {
        let (cells, refuted_m) = (&mut self.cells, &mut self.refuted_m);
        refuted_m.clear();
        self.part = (self.part + 1) % PARTS;
        cells.retain(self.part, PARTS, |cell| {
            let forgets = is_refuted(cell.mean_m);
            if forgets {
                refuted_m.push(cell.mean_m.truncate());
            }
            !forgets
        });
    }

    /// Where the last scan refuted ground.
    pub(crate) fn refuted_m(&self) -> &[DVec2] {
        &self.refuted_m
    }

    /// Notes that a scan shows an upright face at a place where it has returns.
    pub(crate) fn add_face(&mut self, place_m: DVec2) {
        let index = self.index_of(place_m);
        if let Some(cell) = self.cells.get_mut(index) {
            cell.faces = cell.faces.saturating_add(1);
        }
    }

    /// Moves the window from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        let mut moved = RollingGrid::new(self.config.cells_per_side());
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
        let plane = moments.plane(self.footprint_m)?;
        let unseen = self.config.slope_deviation_per_m * moments.distance_m();
        Some(Plane { gradient_deviation: libm::hypot(plane.gradient_deviation, unseen), ..plane })
    }

    /// Moments of the fresh cells whose mean is within `radius_m` of a place and, relative to it, accepted by
    /// `counts`.
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

    /// The fresh cells of ground whose mean is within `radius_m` of a place.
    fn cells_near(&self, place_m: DVec2, radius_m: f64) -> impl Iterator<Item = &ElevationCell> {
        self.fresh_cells_near(place_m, radius_m).filter(|cell| !cell.is_upright())
    }

    /// The fresh cells whose mean is within `radius_m` of a place.
    fn fresh_cells_near(&self, place_m: DVec2, radius_m: f64) -> impl Iterator<Item = &ElevationCell> {
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

impl ElevationWindow {
    /// The ground within this distance of a place decides what the window says of it.
    pub(crate) fn reach_m(&self) -> f64 {
        self.footprint_radii_m().into_iter().fold(DROP_RADIUS_M, f64::max)
    }

    /// The radii of the ground around a place, the narrowest first.
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

    fn touches_upright(&self, place_m: DVec2) -> [bool; AXES] {
        let mut touches = [false; AXES];
        let half_m = self.half_body_m + UPRIGHT_MARGIN_M;
        self.each_upright(place_m, half_m.length(), &mut |thing_m| {
            for (touches, direction) in touches.iter_mut().zip(DIRECTIONS) {
                *touches |= distance_from_body_m(half_m, thing_m - place_m, direction) < 0.0;
            }
        });
        touches
    }

    fn each_upright(&self, place_m: DVec2, radius_m: f64, visit: &mut dyn FnMut(DVec2)) {
        let upright = self.fresh_cells_near(place_m, radius_m).filter(|cell| cell.is_upright());
        upright.for_each(|cell| visit(cell.mean_m.truncate()));
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
