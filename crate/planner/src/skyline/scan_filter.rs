//! The kind of each return of a scan: a surface, the robot itself, a stray return or something overhead.
//!
//! Every kind is judged within the one scan, on the grid of directions of the occupancy surface.
//!
//! - A return on a surface has neighbours on it. One in rain, dust or on an insect, or by multipath, stands
//!   alone in front of what its neighbours hit: it has no *support*. This is the idea of the dynamic radius
//!   outlier removal of Charron, Phillips and Waslander, "De-noising of lidar point clouds corrupted by
//!   snowfall" (CRV 2018), with directions of beams in place of a radius.
//! - A return is overhead if a beam passed below it, with room for the robot between.
//!
//! Upright faces higher than the wheels climb are found here as well: walls, posts, people, steps. They are
//! no ground.

use core::ops::Range;

use glam::{DVec2, DVec3, Vec3};

use crate::robot_model::RobotModel;
use crate::sensor_model::SensorModel;
use crate::skyline::beam_grid::{BeamGrid, MOST_RINGS};
use crate::skyline::columns::{COLUMNS, column_azimuth_rad, column_of};

/// Two returns of neighbouring directions lie on one surface if their ranges differ by no more than this part
/// of the range and this length,
const SAME_RANGE_SHARE: f64 = 0.03;
const SAME_RANGE_M: f64 = 0.1;
/// or, on ground met at a small angle, by no more than this part of the range, at heights that differ by no
/// more than this.
const SAME_GROUND_SHARE: f64 = 0.2;
const SAME_HEIGHT_M: f64 = 0.08;
/// A return on a surface has this share of the returns around it on the same surface, and no fewer than this.
const SUPPORT_SHARE: f64 = 0.08;
const LEAST_SUPPORT: usize = 2;
/// Cells in and beside that of a return, and the most returns of a cell that are told apart.
const CELLS_AROUND: f64 = 9.0;
const MOST_RETURNS: usize = 64;
/// A return is seen through from below if no more than this share of the beams below it ends before or at it.
const BLOCKED_SHARE: f64 = 0.2;
/// A beam passes a place if it goes on for this far behind it.
const PASSING_M: f64 = 0.3;
/// A place is refuted by beams that pass this far below it.
const REFUTED_BELOW_M: f64 = 0.2;
/// Rows stand above one another if their distances differ by no more than this part of the rise between them,
/// as on a face of 70°, and this length.
const FACE_SLANT: f64 = 0.36;
const FACE_NOISE_M: f64 = 0.03;
/// The echoes of a cell are of one place if none is farther than this from their mean.
const ONE_PLACE_M: f64 = 0.15;
/// The robot passes below what leaves it this much room above its height.
const HEADROOM_M: f64 = 0.1;

/// What a return of a scan is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReturnKind {
    /// Ground or an object.
    Surface,
    /// No return: not finite, or nearer or farther than the sensor measures.
    Invalid,
    /// Beyond the planner's sight.
    Far,
    /// The robot itself or its load.
    Body,
    /// A stray return: rain, dust, an insect, multipath.
    Stray,
    /// Part of something that the robot can pass below.
    Overhead,
}

/// A return within sight, from the sensor along the robot's axes.
#[derive(Clone, Copy, Debug)]
struct Echo {
    /// Its index in the scan.
    index: u32,
    cell: u32,
    /// Whether it is within the grid's elevations.
    is_in_view: bool,
    range_m: f64,
    /// Distance seen from above.
    plan_m: f64,
    height_m: f64,
}

/// Sorts the returns of a scan by kind.
#[derive(Clone, Debug)]
pub(crate) struct ScanFilter {
    grid: BeamGrid,
    body: Body,
    sight_m: f64,
    max_range_m: f64,
    kinds: Vec<ReturnKind>,
    surface_m: Vec<Vec3>,
    echoes: Vec<Echo>,
    /// The echoes by cell, and the first one of each cell.
    by_cell: Vec<Echo>,
    starts: Vec<u32>,
    /// Highest step that the wheels climb.
    max_step_m: f64,
    faces_m: Vec<DVec3>,
    /// Returns of a cell, and other returns on its surface that a return needs.
    density: usize,
    needed: usize,
}

impl ScanFilter {
    /// A filter for a sensor on a robot; returns beyond `sight_m` are of no use.
    pub(crate) fn new(sensor: &SensorModel, robot: &RobotModel, sight_m: f64) -> Self {
        let grid = BeamGrid::new(sensor);
        let cells = COLUMNS * grid.rings();
        Self {
            grid,
            body: Body::new(sensor, robot),
            sight_m,
            max_range_m: sensor.max_range_m,
            max_step_m: robot.max_step_m,
            faces_m: Vec::new(),
            kinds: Vec::new(),
            surface_m: Vec::new(),
            echoes: Vec::new(),
            by_cell: Vec::new(),
            starts: vec![0; cells + 1],
            density: 1,
            needed: LEAST_SUPPORT,
        }
    }

    /// Sorts a scan: points in the sensor frame, metres, in any order.
    pub(crate) fn sort(&mut self, points_m: &[Vec3]) {
        self.kinds.clear();
        self.echoes.clear();
        for point_m in points_m {
            let kind = self.sort_alone(*point_m);
            self.kinds.push(kind);
        }
        self.arrange();
        self.density = self.median_density();
        let around = CELLS_AROUND * self.density as f64;
        self.needed = ((SUPPORT_SHARE * around).ceil() as usize).max(LEAST_SUPPORT);
        self.find_stray();
        // Rain below a roof does not close the way.
        self.keep_surfaces();
        self.find_overhead();
        self.keep_surfaces();
        self.find_faces();
        self.surface_m.clear();
        let kinds = self.kinds.iter().zip(points_m);
        self.surface_m
            .extend(kinds.filter(|(kind, _)| **kind == ReturnKind::Surface).map(|(_, point_m)| *point_m));
    }

    /// The kind of each point of the last scan, in its order.
    pub(crate) fn kinds(&self) -> &[ReturnKind] {
        &self.kinds
    }

    /// The returns on surfaces within sight, in the order of the scan, in the sensor frame.
    pub(crate) fn surface_m(&self) -> &[Vec3] {
        &self.surface_m
    }

    /// Whether any beam came back from outside the robot.
    pub(crate) fn has_returns(&self) -> bool {
        self.kinds.iter().any(|kind| !matches!(kind, ReturnKind::Invalid | ReturnKind::Body))
    }

    /// Whether beams passed well below a place, in its direction, and met surfaces only behind it: nothing
    /// stands there. The place is given from the sensor along the robot's axes.
    pub(crate) fn refutes(&self, place_m: DVec3) -> bool {
        let plan_m = (place_m.x * place_m.x + place_m.y * place_m.y).sqrt();
        let below_rad = libm::atan2(place_m.z - REFUTED_BELOW_M, plan_m);
        let Some(highest) = self.grid.ring_below(below_rad) else { return false };
        let column = column_of(libm::atan2(place_m.y, place_m.x));
        // Beams that go out of sight say nothing; the next lower ones may.
        let rows = (0..=highest).rev().map(|ring| self.column_part(column, &(ring..ring + 1)));
        rows.into_iter()
            .find(|beams| 2 * beams.len() >= self.density.max(2))
            .is_some_and(|beams| beams.iter().all(|beam| beam.plan_m > plan_m + PASSING_M))
    }

    /// The returns on surfaces within sight and the grid's elevations, in the order of the scan: the cell, as
    /// column × rings + ring, and the range.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (usize, f64)> {
        let in_view = self.echoes.iter().filter(|echo| echo.is_in_view);
        in_view.map(|echo| (echo.cell as usize, echo.range_m))
    }

    /// Places on upright faces higher than the wheels climb, from the sensor along the robot's axes: one for
    /// each cell of directions.
    pub(crate) fn faces_m(&self) -> &[DVec3] {
        &self.faces_m
    }

    /// Calls `visit` with the lines of sight that pass over ground without returns: in each column, those
    /// that end beyond all lower ones. Each has the place that it met, from the sensor along the robot's
    /// axes, and the share of the way up to which lower ones met something.
    pub(crate) fn each_sight_line(&self, mut visit: impl FnMut(DVec3, f64)) {
        for column in 0..COLUMNS {
            let direction = DVec2::from_angle(column_azimuth_rad(column));
            let mut met_m = 0.0;
            for end in (0..self.grid.rings()).filter_map(|ring| self.mean(column, ring)) {
                if end.x > met_m {
                    visit((direction * end.x).extend(end.y), met_m / end.x);
                    met_m = end.x;
                }
            }
        }
    }

    /// Finds the upright faces: in each column, runs of rows whose returns stand above one another, higher
    /// than the wheels climb.
    fn find_faces(&mut self) {
        self.faces_m.clear();
        let rings = self.grid.rings();
        let mut rows: [Option<DVec2>; MOST_RINGS] = [None; MOST_RINGS];
        for column in 0..COLUMNS {
            for (ring, row) in rows.iter_mut().enumerate().take(rings) {
                *row = self.mean(column, ring);
            }
            let direction = DVec2::from_angle(column_azimuth_rad(column));
            let mut rest = &rows[..rings];
            while !rest.is_empty() {
                let (run, others) = rest.split_at(upright_run(rest));
                if let (Some(Some(low)), Some(Some(high))) = (run.first(), run.last())
                    && high.y - low.y > self.max_step_m
                {
                    let places_m = run.iter().flatten().map(|row| (direction * row.x).extend(row.y));
                    self.faces_m.extend(places_m);
                }
                rest = others;
            }
        }
    }

    /// Mean distance seen from above and mean height of the echoes of a cell; `None` if they are not of one
    /// place.
    fn mean(&self, column: usize, ring: usize) -> Option<DVec2> {
        let echoes = self.column_part(column, &(ring..ring + 1));
        let sum: DVec2 = echoes.iter().map(|echo| DVec2::new(echo.plan_m, echo.height_m)).sum();
        let mean = (!echoes.is_empty()).then(|| sum / echoes.len() as f64)?;
        echoes.iter().all(|echo| (echo.plan_m - mean.x).abs() <= ONE_PLACE_M).then_some(mean)
    }

    /// The kind of a return by its place alone; keeps it if it is of use.
    fn sort_alone(&mut self, point_m: Vec3) -> ReturnKind {
        let point_m = self.grid.along_robot(point_m.as_dvec3());
        let range_m = point_m.length();
        // Also true for NaN.
        if !(range_m > 0.0 && (self.grid.min_range_m..=self.max_range_m).contains(&range_m)) {
            return ReturnKind::Invalid;
        }
        if range_m > self.sight_m {
            return ReturnKind::Far;
        }
        if self.body.holds(point_m) {
            return ReturnKind::Body;
        }
        let plan_m = (point_m.x * point_m.x + point_m.y * point_m.y).sqrt();
        let (ring, is_in_view) = self.grid.nearest_ring(libm::atan2(point_m.z, plan_m));
        let column = column_of(libm::atan2(point_m.y, point_m.x));
        self.echoes.push(Echo {
            index: self.kinds.len() as u32,
            cell: (column * self.grid.rings() + ring) as u32,
            is_in_view,
            range_m,
            plan_m,
            height_m: point_m.z,
        });
        ReturnKind::Surface
    }

    /// Marks the stray returns.
    fn find_stray(&mut self) {
        for cell in 0..COLUMNS * self.grid.rings() {
            let echoes = self.cell(cell);
            // Nearly every cell is full of returns on one surface.
            if echoes.len() > self.needed && spread_m(echoes) <= SAME_RANGE_M {
                continue;
            }
            let span = self.starts[cell] as usize..self.starts[cell + 1] as usize;
            for index in span {
                let echo = self.by_cell[index];
                if !self.is_supported(&echo) && self.is_seen_through(&echo) {
                    self.kinds[echo.index as usize] = ReturnKind::Stray;
                }
            }
        }
    }

    /// Marks what is overhead.
    fn find_overhead(&mut self) {
        let rings = self.grid.rings();
        for column in 0..COLUMNS {
            let mut farthest_below_m = 0.0_f64;
            for ring in 0..rings {
                let cell = column * rings + ring;
                let Some(nearest_m) = nearest(self.cell(cell)).map(|echo| echo.plan_m) else { continue };
                // On ground, what is higher in view is farther away.
                if farthest_below_m > nearest_m + PASSING_M {
                    for index in self.starts[cell] as usize..self.starts[cell + 1] as usize {
                        let echo = self.by_cell[index];
                        if self.is_overhead(&echo) {
                            self.kinds[echo.index as usize] = ReturnKind::Overhead;
                        }
                    }
                }
                farthest_below_m = farthest_below_m.max(nearest_m);
            }
        }
    }

    /// Drops the echoes that were found to be of another kind.
    fn keep_surfaces(&mut self) {
        let (kinds, count) = (&self.kinds, self.echoes.len());
        self.echoes.retain(|echo| kinds[echo.index as usize] == ReturnKind::Surface);
        if self.echoes.len() < count {
            self.arrange();
        }
    }

    /// Arranges the echoes by cell.
    fn arrange(&mut self) {
        self.starts.fill(0);
        for echo in &self.echoes {
            self.starts[echo.cell as usize + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        self.by_cell.clear();
        self.by_cell.resize(self.echoes.len(), Echo::NONE);
        for echo in &self.echoes {
            let slot = &mut self.starts[echo.cell as usize];
            self.by_cell[*slot as usize] = *echo;
            *slot += 1;
        }
        // Each start has moved to the next one's place.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// The median number of returns in the occupied cells, which tells how dense this scan is.
    fn median_density(&self) -> usize {
        let mut cells_with = [0_usize; MOST_RETURNS + 1];
        for cell in self.starts.windows(2) {
            cells_with[((cell[1] - cell[0]) as usize).min(MOST_RETURNS)] += 1;
        }
        let occupied: usize = cells_with[1..].iter().sum();
        let mut seen = 0;
        let median = (1..MOST_RETURNS).find(|&returns| {
            seen += cells_with[returns];
            2 * seen >= occupied
        });
        median.unwrap_or(MOST_RETURNS)
    }

    /// The echoes of a cell.
    fn cell(&self, cell: usize) -> &[Echo] {
        &self.by_cell[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// The echoes of the cells from `rings` in a column.
    fn column_part(&self, column: usize, rings: &Range<usize>) -> &[Echo] {
        let first = column * self.grid.rings();
        let (begin, end) = (self.starts[first + rings.start], self.starts[first + rings.end]);
        &self.by_cell[begin as usize..end as usize]
    }

    /// Whether enough of the returns in and beside the cell of an echo lie on one surface with it.
    fn is_supported(&self, echo: &Echo) -> bool {
        let (column, ring) = self.place_of(echo);
        let rings = ring.saturating_sub(1)..(ring + 2).min(self.grid.rings());
        let columns = [column, (column + 1) % COLUMNS, (column + COLUMNS - 1) % COLUMNS];
        let parts = columns.map(|column| self.column_part(column, &rings));
        // The echo itself is among them.
        let support = parts.into_iter().flatten().filter(|other| echo.is_on_surface_of(other));
        support.take(self.needed + 1).count() > self.needed
    }

    /// Whether the beams below an echo pass behind it, or go on without a return: it stands on nothing.
    fn is_seen_through(&self, echo: &Echo) -> bool {
        let (column, ring) = self.place_of(echo);
        let below = ring.saturating_sub(1);
        let rings = below..below + 1;
        let (mut blocked, mut count) = (0, 0);
        for column in [column, (column + 1) % COLUMNS, (column + COLUMNS - 1) % COLUMNS] {
            for other in self.column_part(column, &rings).iter().filter(|other| other.index != echo.index) {
                count += 1;
                blocked += usize::from(other.range_m <= echo.range_m + PASSING_M);
            }
        }
        blocked as f64 <= BLOCKED_SHARE * count.max(3 * self.density) as f64
    }

    /// Whether a beam of its column passed below an echo and nothing in the room that the robot needs above
    /// that beam stands in the way.
    fn is_overhead(&self, echo: &Echo) -> bool {
        let (column, ring) = self.place_of(echo);
        let clearance_m = self.body.height_m + HEADROOM_M;
        let mut floor_m = None;
        for below in 0..ring {
            let cell = self.column_part(column, &(below..below + 1));
            let Some(nearest) = nearest(cell) else { continue };
            if floor_m.is_none() && nearest.plan_m > echo.plan_m + PASSING_M {
                floor_m = Some(nearest.height_m * (echo.plan_m / nearest.plan_m));
            }
            let is_in_the_way = (nearest.plan_m - echo.plan_m).abs() <= PASSING_M;
            if floor_m.is_some_and(|floor_m| is_in_the_way && nearest.height_m - floor_m < clearance_m) {
                return false;
            }
        }
        floor_m.is_some_and(|floor_m| echo.height_m - floor_m >= clearance_m)
    }

    /// Column and ring of an echo.
    fn place_of(&self, echo: &Echo) -> (usize, usize) {
        let cell = echo.cell as usize;
        (cell / self.grid.rings(), cell % self.grid.rings())
    }
}

impl Echo {
    const NONE: Self =
        Self { index: 0, cell: 0, is_in_view: false, range_m: 0.0, plan_m: 0.0, height_m: 0.0 };

    /// Whether two echoes of neighbouring directions lie on one surface.
    fn is_on_surface_of(&self, other: &Self) -> bool {
        let apart_m = (self.range_m - other.range_m).abs();
        apart_m <= SAME_RANGE_M + SAME_RANGE_SHARE * self.range_m
            || apart_m <= SAME_GROUND_SHARE * self.range_m
                && (self.height_m - other.height_m).abs() <= SAME_HEIGHT_M
    }
}

/// The echo that is nearest, seen from above.
fn nearest(echoes: &[Echo]) -> Option<&Echo> {
    echoes.iter().min_by(|a, b| a.plan_m.total_cmp(&b.plan_m))
}

/// How much the ranges of echoes differ.
fn spread_m(echoes: &[Echo]) -> f64 {
    let ranges_m = || echoes.iter().map(|echo| echo.range_m);
    ranges_m().fold(f64::NEG_INFINITY, f64::max) - ranges_m().fold(f64::INFINITY, f64::min)
}

/// The number of rows at the beginning of `rows`, at least one, that stand above one another.
fn upright_run(rows: &[Option<DVec2>]) -> usize {
    let Some(&Some(low)) = rows.first() else { return 1 };
    let stands = |row: &&Option<DVec2>| {
        row.is_some_and(|row| (row.x - low.x).abs() <= FACE_SLANT * (row.y - low.y) + FACE_NOISE_M)
    };
    1 + rows[1..].iter().take_while(stands).count()
}

/// The outline of the robot and its load, from the sensor along the robot's axes.
#[derive(Clone, Copy, Debug)]
struct Body {
    /// Rear and right, front and left.
    low_m: [f64; 2],
    high_m: [f64; 2],
    /// Overall height.
    height_m: f64,
}

impl Body {
    fn new(sensor: &SensorModel, robot: &RobotModel) -> Self {
        let margin_m = robot.body_margin_m;
        let side_m = 0.5 * robot.width_m + robot.load_side_m + margin_m;
        let front_m = 0.5 * robot.length_m + robot.load_front_m + margin_m;
        let rear_m = 0.5 * robot.length_m + robot.load_rear_m + margin_m;
        Self {
            low_m: [-rear_m - sensor.forward_m, -side_m - sensor.left_m],
            high_m: [front_m - sensor.forward_m, side_m - sensor.left_m],
            height_m: robot.height_m.max(sensor.height_m),
        }
    }

    fn holds(&self, point_m: DVec3) -> bool {
        (self.low_m[0]..=self.high_m[0]).contains(&point_m.x)
            && (self.low_m[1]..=self.high_m[1]).contains(&point_m.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    /// Height of the sensor.
    const UP_M: f64 = 0.8;

    /// An object: the range at which a beam with this unit direction meets it.
    type Object = Box<dyn Fn(DVec3) -> Option<f64>>;

    fn ground() -> Object {
        Box::new(|beam| (beam.z < -0.01).then(|| UP_M / -beam.z))
    }

    /// An upright cylinder on the ground.
    fn cylinder(place_m: DVec2, radius_m: f64, height_m: f64) -> Object {
        Box::new(move |beam| {
            let along = beam.truncate();
            let half = along.dot(place_m) / along.length_squared();
            let apart =
                half * half - (place_m.length_squared() - radius_m * radius_m) / along.length_squared();
            let range_m = half - (apart >= 0.0).then(|| apart.sqrt())?;
            (range_m > 0.0 && (-UP_M..=height_m - UP_M).contains(&(range_m * beam.z))).then_some(range_m)
        })
    }

    fn sphere(centre_m: DVec3, radius_m: f64) -> Object {
        Box::new(move |beam| {
            let half = beam.dot(centre_m);
            let apart = half * half - centre_m.length_squared() + radius_m * radius_m;
            (apart >= 0.0).then(|| half - apart.sqrt()).filter(|range_m| *range_m > 0.0)
        })
    }

    /// A level ceiling over a square around a place, so high above the ground.
    fn ceiling(place_m: DVec2, half_side_m: f64, height_m: f64) -> Object {
        Box::new(move |beam| {
            let range_m = (height_m - UP_M) / beam.z;
            let from_place_m = beam.truncate() * range_m - place_m;
            (range_m > 0.0 && from_place_m.abs().max_element() < half_side_m).then_some(range_m)
        })
    }

    /// The scan of a VLP-16, and which object each return is on.
    fn scan(objects: &[Object]) -> (Vec<Vec3>, Vec<usize>) {
        let (mut points_m, mut hit) = (Vec::new(), Vec::new());
        for column in 0..1800 {
            let (sin_a, cos_a) = libm::sincos(f64::from(column) * PI / 900.0);
            for ring in 0..16 {
                let (sin_e, cos_e) = libm::sincos((f64::from(ring) * 2.0 - 15.0).to_radians());
                let beam = DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
                let ranges_m =
                    objects.iter().enumerate().filter_map(|(index, object)| Some((object(beam)?, index)));
                let Some((range_m, index)) = ranges_m.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
                // Noise of some 2 cm.
                let noise_m = 0.02 * libm::sin(f64::from(977 * column + 131 * ring));
                points_m.push((beam * (range_m + noise_m)).as_vec3());
                hit.push(index);
            }
        }
        (points_m, hit)
    }

    fn sort(points_m: &[Vec3]) -> Vec<ReturnKind> {
        let mut filter = ScanFilter::new(&SensorModel::vlp16(), &RobotModel::husky(), 9.0);
        filter.sort(points_m);
        let surfaces = filter.kinds().iter().filter(|kind| **kind == ReturnKind::Surface).count();
        assert_eq!(filter.surface_m().len(), surfaces);
        filter.kinds().to_vec()
    }

    /// The kinds of the returns on the object with an index.
    fn kinds_on(objects: &[Object], index: usize) -> Vec<ReturnKind> {
        let (points_m, hit) = scan(objects);
        let kinds = sort(&points_m);
        kinds.into_iter().zip(hit).filter(|(_, on)| *on == index).map(|(kind, _)| kind).collect()
    }

    #[test]
    fn ground_posts_people_and_stones_are_surfaces() {
        let places_m = [1.5, 3.0, 5.0, 6.8].map(|far_m| DVec2::from_angle(far_m) * far_m);
        let mut objects = vec![ground()];
        for place_m in places_m {
            let aside = |by: f64| DVec2::from_angle(by).rotate(place_m);
            objects.push(cylinder(place_m, 0.03, 1.2));
            objects.push(cylinder(aside(1.0), 0.2, 1.7));
            objects.push(sphere(aside(2.0).extend(0.15 - UP_M), 0.15));
        }
        for index in 0..objects.len() {
            let kinds = kinds_on(&objects, index);
            let wrong =
                kinds.iter().filter(|kind| !matches!(kind, ReturnKind::Surface | ReturnKind::Far)).count();
            assert_eq!(wrong, 0, "object {index}: {wrong} of {}", kinds.len());
        }
    }

    #[test]
    fn a_lone_return_in_the_air_is_stray() {
        let (clean_m, _) = scan(&[ground()]);
        for far_m in [1.0, 2.0, 3.5, 6.0] {
            for elevation_deg in [-13.0_f64, -9.0, -5.0, 1.0, 11.0] {
                let height_m = far_m * libm::tan(elevation_deg.to_radians());
                let above_m = height_m + UP_M;
                let place_m = DVec2::from_angle(2.0 * far_m) * far_m;
                let mut points_m = clean_m.clone();
                points_m.push(place_m.extend(height_m).as_vec3());
                let kinds = sort(&points_m);
                if above_m > 0.3 {
                    assert_eq!(kinds.last(), Some(&ReturnKind::Stray), "{far_m} m, {elevation_deg}°");
                }
                let others = &kinds[..clean_m.len()];
                assert!(others.iter().all(|kind| matches!(kind, ReturnKind::Surface | ReturnKind::Far)));
            }
        }
    }

    #[test]
    fn what_is_on_the_robot_is_its_body_and_what_stands_beside_it_is_not() {
        let (mut points_m, _) = scan(&[ground()]);
        let count = points_m.len();
        points_m.extend([Vec3::new(0.4, 0.4, -0.2), Vec3::new(-0.5, -0.3, -0.6), Vec3::ZERO, Vec3::NAN]);
        let kinds = sort(&points_m);
        let (body, none) = (ReturnKind::Body, ReturnKind::Invalid);
        assert_eq!(kinds[count..], [body, body, none, none]);
        let beside = kinds_on(&[ground(), cylinder(DVec2::new(0.0, 0.9), 0.2, 1.5)], 1);
        assert!(!beside.is_empty() && beside.iter().all(|kind| *kind == ReturnKind::Surface));
    }

    #[test]
    fn a_load_belongs_to_the_body() {
        let robot = RobotModel { load_rear_m: 0.6, ..RobotModel::husky() };
        let mut filter = ScanFilter::new(&SensorModel::vlp16(), &robot, 9.0);
        filter.sort(&[Vec3::new(-1.1, 0.2, -0.3)]);
        assert_eq!(filter.kinds(), [ReturnKind::Body]);
        assert!(!filter.has_returns());
        assert_eq!(sort(&[Vec3::new(-1.1, 0.2, -0.3)]), [ReturnKind::Stray]);
    }

    #[test]
    fn below_a_high_roof_the_way_is_free_and_below_a_low_one_it_is_not() {
        let roof = |height_m: f64| kinds_on(&[ground(), ceiling(DVec2::new(4.0, 0.0), 2.5, height_m)], 1);
        let high = roof(2.0);
        assert!(!high.is_empty() && high.iter().all(|kind| *kind == ReturnKind::Overhead), "{high:?}");
        let low = roof(0.9);
        assert!(!low.is_empty() && low.iter().all(|kind| *kind == ReturnKind::Surface), "{low:?}");
        let wall = kinds_on(&[ground(), cylinder(DVec2::new(5.0, 0.0), 1.0, 3.0)], 1);
        assert!(wall.iter().all(|kind| *kind == ReturnKind::Surface));
    }

    #[test]
    fn a_scan_of_nothing_has_no_returns() {
        let mut filter = ScanFilter::new(&SensorModel::vlp16(), &RobotModel::husky(), 9.0);
        filter.sort(&[Vec3::ZERO; 2000]);
        assert!(!filter.has_returns());
        filter.sort(&[Vec3::new(20.0, 0.0, 1.0)]);
        assert!(filter.has_returns() && filter.surface_m().is_empty());
    }
}
