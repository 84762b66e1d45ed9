//! The elevation window: ground around the robot, from the last scans.
//!
//! It is no global map: a grid of cells that moves with the robot, holds returns within its radius and the
//! ground under the wheels, and forgets cells that were not seen again for its memory time. It answers
//! three questions: the roll and pitch of the robot at a place, whether something is in its body's way there,
//! and whether the place is a negative obstacle.

mod cliffs;
mod footprint;
mod parts;
mod underside;

use core::f64::consts::SQRT_2;
use core::time::Duration;
use std::collections::VecDeque;

use glam::{DVec2, DVec3, IVec2};

use crate::config::{ElevationWindowConfig, PlannerConfig};
use crate::math::elementary::floor;
use crate::pose::FrameChange;
use crate::robot_model::{RobotModel, distance_from_body_m};
use crate::sensor_model::SensorModel;
use crate::terrain::headings::{AXES, DIRECTIONS};
use crate::terrain::plane::{Moments, Plane};
use crate::terrain::remembered_ground::RememberedGround;
use crate::terrain::rolling_grid::RollingGrid;
use crate::terrain::slopes::Slopes;
use cliffs::{DROP_RADIUS_M, MOST_VIEWS, View};
use parts::GroundParts;

/// Weight of the past in a cell's average, in returns.
const MOST_RETURNS: f64 = 30.0;
/// A scan looks for ground that it refutes in one of so many parts of the window.
const PARTS: usize = 4;
/// A cell is upright once so many rows of beams met a face in it.
const FEWEST_FACES: u32 = 3;
/// Parts of a cell's side: where in the cell the faces stand.
const FACE_PARTS: i32 = 4;
/// Radii of the ground around a place that carries the robot, as multiples of the footprint's radius. A wider
/// plane replaces a narrower one if the rings of a scan lie farther apart.
const FOOTPRINT_RADII: [f64; 3] = [1.0, 1.6, 2.4];

/// Queries of the terrain by a search. What an implementation leaves out is that of ground given by its
/// planes alone.
pub(crate) trait TerrainQuery {
    /// The least-squares plane through the ground around a place; `None` if too little was seen.
    fn plane_at(&self, place_m: DVec2) -> Option<Plane>;

    /// The largest slopes of the robot on its wheels around a place with this plane, facing along a unit
    /// vector; `None` if only the plane is known.
    fn slopes_at(&self, _place_m: DVec2, _plane: &Plane, _direction: DVec2) -> Option<Slopes> {
        None
    }

    /// Whether ground is missing at a place: it would have been seen under a wheel from the side of `here_m`,
    /// and no returns came. Where it `lacked` ground before, it does so while no returns come.
    fn lacks_ground(&self, _place_m: DVec2, _here_m: DVec2, _lacked: bool) -> bool {
        false
    }

    /// Whether the returns show a drop at a place, away from `here_m`.
    fn drops_off(&self, _place_m: DVec2, _here_m: DVec2) -> bool {
        false
    }

    /// The distance of the body at a place with this plane from what is upright, a wall, a post or a step,
    /// for each axis of travel; at most `most_m`.
    fn room_m(&self, _place_m: DVec2, _plane: Option<&Plane>, most_m: f64) -> [f64; AXES] {
        [most_m; AXES]
    }

    /// Whether the robot at a place with this plane, or just before or behind it, would be beyond its tilt
    /// limits with a wheel in a hole, or would set its underside down, for each axis of travel.
    fn sets_down(&self, _place_m: DVec2, _plane: &Plane) -> [bool; AXES] {
        [false; AXES]
    }

    /// Calls `visit` with the place of each upright thing within `radius_m` of a place.
    fn each_upright(&self, _place_m: DVec2, _radius_m: f64, _visit: &mut dyn FnMut(DVec2)) {}
}

/// Terrain given by its planes alone.
impl<F: Fn(DVec2) -> Option<Plane>> TerrainQuery for F {
    fn plane_at(&self, place_m: DVec2) -> Option<Plane> {
        self(place_m)
    }
}

#[derive(Clone, Copy, Debug)]
struct ElevationCell {
    /// Time of the last return, on the window's clock.
    seen: Duration,
    returns: f64,
    mean_m: DVec3,
    /// Rows of beams that met an upright face here.
    faces: u32,
    /// The parts of the cell in which they met it: bit `FACE_PARTS` · north + east.
    face_parts: u16,
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
    footprint_m: f64,
    /// Half the body's length and width, with its load.
    half_body_m: DVec2,
    /// Spacing of the places of the state lattice.
    step_m: f64,
    robot: RobotModel,
    sensor: SensorModel,
    /// The window's clock; cells are kept for [`ElevationWindowConfig::memory`].
    now: Duration,
    memory: Duration,
    cells: RollingGrid<ElevationCell>,
    /// The ground under belly and bumpers, if the robot keeps them clear of it.
    parts: Option<GroundParts>,
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
            footprint_m: robot.footprint_radius_m(),
            half_body_m: robot.half_body_m(),
            step_m: config.state_lattice.step_m,
            robot,
            sensor,
            now: Duration::ZERO,
            memory: elevation_window.memory(),
            cells: RollingGrid::new(elevation_window.cells_per_side()),
            parts: config.state_lattice.keeps_underside_clear.then(|| GroundParts::new(&elevation_window)),
            part: 0,
            refuted_m: Vec::new(),
            views: VecDeque::with_capacity(MOST_VIEWS),
        }
    }

    pub(crate) fn clear(&mut self) {
        self.cells.clear();
        if let Some(parts) = &mut self.parts {
            parts.clear();
        }
        self.views.clear();
    }

    /// Starts a new scan: advances the clock, past which older cells expire.
    pub(crate) fn advance(&mut self, elapsed: Duration) {
        self.now = self.now.saturating_add(elapsed);
    }

    /// Adds a return on the ground, in the world frame.
    pub(crate) fn add_return(&mut self, point_m: DVec3) {
        self.add(point_m);
        if let Some(parts) = &mut self.parts {
            parts.add(point_m, self.now);
        }
    }

    /// Looks along the beams over ground without returns, from `sensor_m`, if the robot's underside is to be
    /// kept clear. `each_line` gives each beam's end and from which share of its way on it met nothing.
    pub(crate) fn see_through(
        &mut self,
        sensor_m: DVec3,
        each_line: impl FnOnce(&mut dyn FnMut(DVec3, f64)),
    ) {
        if let Some(parts) = &mut self.parts {
            each_line(&mut |end_m, free_share| parts.see_through(sensor_m, end_m, free_share, self.now));
        }
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
            _ => {
                let cell =
                    ElevationCell { seen: now, returns: 1.0, mean_m: point_m, faces: 0, face_parts: 0 };
                self.cells.set(index, cell);
            }
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
        if let Some(parts) = &mut self.parts {
            refuted_m.iter().for_each(|place_m| parts.forget_cell(*place_m));
        }
    }

    /// Where the last scan refuted ground.
    pub(crate) fn refuted_m(&self) -> &[DVec2] {
        &self.refuted_m
    }

    /// The cells that are not forgotten, in no particular order.
    pub(crate) fn remembered(&self) -> impl Iterator<Item = RememberedGround> {
        let fresh = self.cells.iter().map(|(_, cell)| cell).filter(|cell| self.is_fresh(cell));
        fresh.map(|cell| RememberedGround {
            mean_m: cell.mean_m,
            returns: cell.returns as u32,
            age: self.now - cell.seen,
            is_upright: cell.is_upright(),
        })
    }

    /// Notes that a scan shows an upright face at a place where it has returns.
    pub(crate) fn add_face(&mut self, place_m: DVec2) {
        let index = self.index_of(place_m);
        let part = self.face_part(place_m, index);
        if let Some(cell) = self.cells.get_mut(index) {
            cell.faces = cell.faces.saturating_add(1);
            cell.face_parts |= part;
        }
    }

    /// The bit of the part of a cell that a place is in.
    fn face_part(&self, place_m: DVec2, index: IVec2) -> u16 {
        let within = (place_m / self.config.cell_m - index.as_dvec2()) * f64::from(FACE_PARTS);
        let [east, north] = [within.x, within.y].map(|part| (part as i32).clamp(0, FACE_PARTS - 1));
        1 << (FACE_PARTS * north + east)
    }

    /// The middles of the parts of a cell in which faces stand.
    fn face_places_m(&self, index: IVec2, parts: u16) -> impl Iterator<Item = DVec2> {
        let part_m = self.config.cell_m / f64::from(FACE_PARTS);
        let corner_m = index.as_dvec2() * self.config.cell_m;
        let stands = (0..FACE_PARTS * FACE_PARTS).filter(move |bit| parts >> bit & 1 == 1);
        stands.map(move |bit| {
            let part = IVec2::new(bit % FACE_PARTS, bit / FACE_PARTS).as_dvec2();
            corner_m + (part + 0.5) * part_m
        })
    }

    /// Moves the window from one world frame to another.
    pub(crate) fn relocalise(&mut self, change: &FrameChange) {
        let mut moved = RollingGrid::new(self.config.cells_per_side());
        let fresh = || self.cells.iter().filter(|(_, cell)| self.is_fresh(cell));
        for (_, cell) in fresh() {
            let mean_m = change.point_m(cell.mean_m);
            let index = self.index_of(mean_m.truncate());
            moved.set(index, ElevationCell { mean_m, face_parts: 0, ..*cell });
        }
        for (index, cell) in fresh() {
            for place_m in self.face_places_m(index, cell.face_parts) {
                let place_m = change.place_m(place_m);
                let index = self.index_of(place_m);
                let face_parts = self.face_part(place_m, index);
                if let Some(there) = moved.get_mut(index) {
                    there.face_parts |= face_parts;
                    there.faces = there.faces.max(cell.faces);
                } else if cell.is_upright() {
                    let mean_m = place_m.extend(change.point_m(cell.mean_m).z);
                    moved.set(index, ElevationCell { mean_m, face_parts, ..*cell });
                }
            }
        }
        self.cells = moved;
        if let Some(parts) = &mut self.parts {
            parts.relocalise(change, self.now);
        }
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
        self.fresh_cells_near(place_m, radius_m).map(|(_, cell)| cell).filter(|cell| !cell.is_upright())
    }

    /// The fresh cells whose mean is within `radius_m` of a place.
    fn fresh_cells_near(
        &self,
        place_m: DVec2,
        radius_m: f64,
    ) -> impl Iterator<Item = (IVec2, &ElevationCell)> {
        let reach = DVec2::splat(radius_m);
        let (low, high) = (self.index_of(place_m - reach), self.index_of(place_m + reach));
        self.cells.between(low, high).filter(move |(_, cell)| {
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

    fn lacks_ground(&self, place_m: DVec2, here_m: DVec2, lacked: bool) -> bool {
        (lacked || self.would_be_seen(place_m, here_m)) && self.lacks_returns_beside(place_m)
    }

    fn drops_off(&self, place_m: DVec2, here_m: DVec2) -> bool {
        self.has_drop(place_m, (place_m - here_m).normalize_or_zero())
    }

    fn room_m(&self, place_m: DVec2, plane: Option<&Plane>, most_m: f64) -> [f64; AXES] {
        let mut room_m = [most_m; AXES];
        let lean_m = plane.map_or(DVec2::ZERO, |plane| self.robot.lean_m(plane.gradient));
        let radius_m = (self.half_body_m + most_m).length() + lean_m.length();
        self.each_upright(place_m, radius_m, &mut |thing_m| {
            for (room_m, direction) in room_m.iter_mut().zip(DIRECTIONS) {
                let from_middle_m = thing_m - place_m;
                let thing_room_m = distance_from_body_m(self.half_body_m, lean_m, from_middle_m, direction);
                *room_m = room_m.min(thing_room_m);
            }
        });
        room_m
    }

    fn sets_down(&self, place_m: DVec2, plane: &Plane) -> [bool; AXES] {
        self.parts.as_ref().map_or([false; AXES], |parts| self.underside_touches(parts, place_m, plane))
    }

    fn each_upright(&self, place_m: DVec2, radius_m: f64, visit: &mut dyn FnMut(DVec2)) {
        // A face may stand anywhere in a cell whose mean is farther away.
        let radius_m = radius_m + SQRT_2 * self.config.cell_m;
        let upright = self.fresh_cells_near(place_m, radius_m).filter(|(_, cell)| cell.is_upright());
        for (index, cell) in upright {
            self.face_places_m(index, cell.face_parts).for_each(&mut *visit);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::Pose;
    use crate::testing::STEP;
    use core::f64::consts::FRAC_PI_2;
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

    /// Upright faces all around a post of 0.2 m, with its middle at a place.
    fn post(middle_m: DVec2) -> ElevationWindow {
        let mut ground = ElevationWindow::new(&PlannerConfig::default());
        for step in 0..400 {
            let along = f64::from(step % 100) / 100.0 - 0.5;
            let on_face = DVec2::new(0.5, along).rotate(DVec2::from_angle(f64::from(step / 100) * FRAC_PI_2));
            let place_m = middle_m + 0.2 * on_face;
            ground.add(place_m.extend(0.4));
            ground.add_face(place_m);
        }
        ground
    }

    #[test]
    fn the_room_beside_a_post_is_that_of_the_body_along_each_axis_of_travel() {
        // A Husky is 0.99 m long and 0.67 m wide.
        let room_m = post(DVec2::new(0.0, 0.7)).room_m(DVec2::ZERO, None, 0.5);
        let along = DIRECTIONS.iter().position(|direction| direction.abs_diff_eq(DVec2::X, 1e-9)).unwrap();
        let across = DIRECTIONS.iter().position(|direction| direction.abs_diff_eq(DVec2::Y, 1e-9)).unwrap();
        assert!((room_m[along] - 0.265).abs() < 0.05 && (room_m[across] - 0.105).abs() < 0.05, "{room_m:?}");
        let alone_m = post(DVec2::new(0.0, 1.5)).room_m(DVec2::ZERO, None, 0.5);
        assert!(alone_m.iter().all(|room_m| (room_m - 0.5).abs() < 1e-12), "{alone_m:?}");
    }

    proptest! {
        #[test]
        fn what_is_upright_is_known_to_a_few_centimetres(
            x in -9.0..9.0_f64, y in -9.0..9.0_f64, turn_rad in -3.0..3.0_f64,
        ) {
            let mut middle_m = DVec2::new(x, y);
            let mut ground = post(middle_m);
            for part_m in [0.05, 0.1] {
                let mut things_m = Vec::new();
                ground.each_upright(middle_m, 1.0, &mut |thing_m| things_m.push(thing_m - middle_m));
                for corner in 0..4 {
                    let turned_rad = turn_rad * f64::from(u8::from(part_m > 0.05)) + f64::from(corner) * FRAC_PI_2;
                    let corner_m = DVec2::new(0.1, 0.1).rotate(DVec2::from_angle(turned_rad));
                    let nearest_m = things_m.iter().map(|thing_m| thing_m.distance(corner_m)).fold(9.0, f64::min);
                    prop_assert!(nearest_m < part_m, "{nearest_m}");
                }
                let farthest_m = things_m.iter().map(|thing_m| thing_m.length()).fold(0.0, f64::max);
                // The corners are 0.141 m from the middle.
                prop_assert!((farthest_m - 0.141).abs() < 0.75 * part_m, "{farthest_m}");
                let at = |place_m: DVec2, yaw_rad| {
                    Pose { position_m: place_m.extend(0.0), roll_rad: 0.0, pitch_rad: 0.0, yaw_rad }
                };
                let change = FrameChange::between(&at(middle_m, 0.0), &at(DVec2::new(y, x), turn_rad));
                ground.relocalise(&change);
                middle_m = change.place_m(middle_m);
            }
        }
    }

    #[test]
    fn what_is_remembered_is_told_until_it_is_forgotten() {
        let slope = DVec2::new(0.3, -0.2);
        let mut ground = strewn(slope, DVec2::ZERO);
        let remembered: Vec<_> = ground.remembered().collect();
        // 41 × 41 points over 4.4 m square.
        assert!((22 * 22..=24 * 24).contains(&remembered.len()), "{}", remembered.len());
        assert_eq!(remembered.iter().map(|cell| cell.returns).sum::<u32>(), 41 * 41);
        for cell in &remembered {
            assert!((cell.mean_m.z - slope.dot(cell.mean_m.truncate())).abs() < 1e-12);
            assert!(cell.age == Duration::ZERO && !cell.is_upright);
        }
        ground.advance(STEP);
        let again_m = DVec3::new(0.1, 0.1, 0.0);
        (0..100).for_each(|_| ground.add(again_m));
        let count = |holds: fn(&RememberedGround) -> bool| ground.remembered().filter(holds).count();
        assert_eq!(count(|cell| cell.age == Duration::ZERO && cell.returns == MOST_RETURNS as u32), 1);
        assert_eq!(count(|cell| cell.age == STEP), remembered.len() - 1);
        ground.advance(ground.memory);
        assert_eq!(ground.remembered().count(), 1, "all but the cell that was seen again is forgotten");
        assert!(post(DVec2::ONE).remembered().all(|cell| cell.is_upright));
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
