//! The places around the robot, on a lattice that is fixed in the world, and the ground queried at each.

use glam::{DVec2, IVec2};

use crate::config::StateLatticeConfig;
use crate::math::elementary::floor;
use crate::terrain::elevation_window::TerrainQuery;
use crate::terrain::headings::{AXES, DIRECTIONS};
use crate::terrain::plane::Plane;
use crate::terrain::rolling_grid::RollingGrid;
use crate::terrain::slopes::Slopes;

/// A place is queried again after this many scans: the ground is static, and the robot drives about a step
/// meanwhile.
const LOOKS: i32 = 4;
/// The body keeps this far from what is upright, and shuns it up to a larger distance.
const LEAST_ROOM_M: f64 = 0.1;
const SOUGHT_ROOM_M: f64 = 0.5;

/// The last query's result at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub(crate) plane: Option<Plane>,
    /// Footprint slopes, for each axis of travel.
    pub(crate) footprint_slopes: [Option<Slopes>; AXES],
    /// Whether the place is a negative obstacle: it drops off, or ground is missing, which is remembered.
    pub(crate) is_negative_obstacle: bool,
    lacks_ground: bool,
    /// Whether the ground is to be queried again at the next scan.
    is_stale: bool,
    /// Whether the body would touch something upright or set its underside down, for each axis of travel.
    pub(crate) is_blocked: [bool; AXES],
    /// The share of the sought room beside what is upright that the body lacks, for each axis of travel.
    pub(crate) lacks_room: [f32; AXES],
}

/// Places by their offset from the one nearest to the robot.
#[derive(Clone, Debug)]
pub(crate) struct PlaceLattice {
    step_m: f64,
    avoids_negative_obstacles: bool,
    half: i32,
    centre: IVec2,
    known: RollingGrid<Known>,
    looks: i32,
}

impl PlaceLattice {
    /// The places within `radius_m`; none is known yet.
    pub(crate) fn new(config: &StateLatticeConfig, radius_m: f64) -> Self {
        let half = (radius_m / config.step_m).ceil() as i32 + 1;
        Self {
            step_m: config.step_m,
            avoids_negative_obstacles: config.avoids_negative_obstacles,
            half,
            centre: IVec2::ZERO,
            known: RollingGrid::new((2 * half + 1) as usize),
            looks: 0,
        }
    }

    /// Forgets the ground.
    pub(crate) fn clear(&mut self) {
        self.known.clear();
        self.looks = 0;
    }

    /// Has the ground queried again everywhere; the order of the queries goes on.
    pub(crate) fn query_again(&mut self) {
        self.known.clear();
    }

    /// Has the ground within `radius_m` of a place queried again at the next scan.
    pub(crate) fn query_again_near(&mut self, place_m: DVec2, radius_m: f64) {
        let (low, high) = (self.world_index(place_m - radius_m), self.world_index(place_m + radius_m));
        for y in low.y..=high.y {
            for x in low.x..=high.x {
                if let Some(known) = self.known.get_mut(IVec2::new(x, y)) {
                    known.is_stale = true;
                }
            }
        }
    }

    /// Moves the lattice to the robot, and queries the ground around it.
    pub(crate) fn look(&mut self, ground: &dyn TerrainQuery, here_m: DVec2) {
        self.centre = self.world_index(here_m);
        self.looks = (self.looks + 1) % LOOKS;
        for y in -self.half..=self.half {
            for x in -self.half..=self.half {
                let offset = IVec2::new(x, y);
                if offset.length_squared() > self.half * self.half {
                    continue;
                }
                let world = self.centre + offset;
                let due = (world.x + 2 * world.y).rem_euclid(LOOKS) == self.looks;
                let before = self.known.get(world);
                if due || before.is_none_or(|known| known.is_stale) {
                    let lacked_ground = before.is_some_and(|known| known.lacks_ground);
                    let known = self.query(ground, self.position_m(offset), here_m, lacked_ground);
                    self.known.set(world, known);
                }
            }
        }
    }

    fn query(&self, ground: &dyn TerrainQuery, place_m: DVec2, here_m: DVec2, lacked_ground: bool) -> Known {
        let plane = ground.plane_at(place_m);
        let footprint_slopes = plane.map_or([None; AXES], |plane| {
            DIRECTIONS.map(|direction| ground.slopes_at(place_m, &plane, direction))
        });
        let room_m = ground.room_m(place_m, plane.as_ref(), SOUGHT_ROOM_M);
        let touches_upright = room_m.map(|room_m| room_m < LEAST_ROOM_M);
        let lacks_room =
            room_m.map(|room_m| ((SOUGHT_ROOM_M - room_m) / (SOUGHT_ROOM_M - LEAST_ROOM_M)) as f32);
        // What stands hides the ground behind it, and drops off at its side.
        let may_be = self.avoids_negative_obstacles
            && touches_upright.contains(&false)
            && footprint_slopes.iter().any(Option::is_none);
        let lacks_ground = may_be && ground.lacks_ground(place_m, here_m, lacked_ground);
        let is_negative_obstacle = lacks_ground || may_be && ground.drops_off(place_m, here_m);
        let sets_down = plane.map_or([false; AXES], |plane| ground.sets_down(place_m, &plane));
        let is_blocked = core::array::from_fn(|axis| touches_upright[axis] || sets_down[axis]);
        Known {
            plane,
            footprint_slopes,
            is_negative_obstacle,
            lacks_ground,
            is_stale: false,
            is_blocked,
            lacks_room,
        }
    }

    /// What the last query found at a place.
    pub(crate) fn known(&self, offset: IVec2) -> Option<&Known> {
        self.known.get(self.centre + offset)
    }

    /// Whether a body with some heading has room at a place within `distance_m` of a point, or at the one
    /// nearest to it, whatever the slope; `None` if that cannot be told from what is known.
    pub(crate) fn has_room_within(&self, point_m: DVec2, distance_m: f64) -> Option<bool> {
        let nearest = self.world_index(point_m) - self.centre;
        let low = self.world_index(point_m - distance_m) - self.centre;
        let high = self.world_index(point_m + distance_m) - self.centre;
        // What lies off the lattice is not known.
        let half = IVec2::splat(self.half);
        let (first, last) = (low.max(-half), high.min(half));
        let mut is_all_known = (first, last) == (low, high);
        let offsets = (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| IVec2::new(x, y)));
        for offset in offsets
            .filter(|&offset| offset == nearest || self.position_m(offset).distance(point_m) <= distance_m)
        {
            match self.known(offset).filter(|known| known.plane.is_some()) {
                _ if self.is_at_cliff(offset) => {}
                Some(known) if known.is_blocked.contains(&false) => return Some(true),
                Some(_) => {}
                None => is_all_known = false,
            }
        }
        is_all_known.then_some(false)
    }

    /// The four places around a point, each with its weight in a bilinear interpolation.
    pub(crate) fn four_around(&self, point_m: DVec2) -> [(IVec2, f64); 4] {
        let steps = point_m / self.step_m - self.centre.as_dvec2();
        let low = steps.floor();
        let (part, low) = (steps - low, low.as_ivec2());
        [IVec2::ZERO, IVec2::X, IVec2::Y, IVec2::ONE].map(|corner| {
            let share = DVec2::select(corner.cmpeq(IVec2::ONE), part, 1.0 - part);
            (low + corner, share.x * share.y)
        })
    }

    /// The ground's gradient at a point, between the places around it; zero where none is known.
    pub(crate) fn gradient_at(&self, point_m: DVec2) -> DVec2 {
        let (mut sum, mut weights) = (DVec2::ZERO, 0.0);
        for (offset, weight) in self.four_around(point_m) {
            if let Some(plane) = self.known(offset).and_then(|known| known.plane) {
                sum += weight * plane.gradient;
                weights += weight;
            }
        }
        if weights > 0.0 { sum / weights } else { DVec2::ZERO }
    }

    /// Whether the robot keeps away from a place because it, or one beside it, is a negative obstacle: the
    /// body is wider than the wheels, and follows a path to within half a step.
    pub(crate) fn is_at_cliff(&self, offset: IVec2) -> bool {
        self.avoids_negative_obstacles
            && around(offset).any(|place| self.known(place).is_some_and(|known| known.is_negative_obstacle))
    }

    /// Number of places.
    pub(crate) fn count(&self) -> usize {
        (self.side() * self.side()) as usize
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

    /// Whether a place is this near to the border of the lattice, in steps.
    pub(crate) fn is_within_of_border(&self, offset: IVec2, steps: i32) -> bool {
        let inner = self.half - steps;
        offset.length_squared() > inner * inner
    }

    /// Offset of the place nearest to a point; `None` off the lattice.
    pub(crate) fn nearest(&self, point_m: DVec2) -> Option<IVec2> {
        let offset = self.world_index(point_m) - self.centre;
        self.holds(offset).then_some(offset)
    }

    /// Position of a place in the world, seen from above.
    pub(crate) fn position_m(&self, offset: IVec2) -> DVec2 {
        (self.centre + offset).as_dvec2() * self.step_m
    }

    /// Index of the place nearest to a point on the whole world's lattice.
    pub(crate) fn world_index(&self, point_m: DVec2) -> IVec2 {
        let cells = point_m / self.step_m;
        IVec2::new(floor(cells.x + 0.5), floor(cells.y + 0.5))
    }
}

/// A cell and those beside it.
pub(crate) fn around(cell: IVec2) -> impl Iterator<Item = IVec2> {
    (-1..=1).flat_map(move |y| (-1..=1).map(move |x| cell + IVec2::new(x, y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::testing::Standing;

    #[test]
    fn what_stands_blocks_and_is_no_negative_obstacle_and_room_lacks_beside_it() {
        let mut places = PlaceLattice::new(&PlannerConfig::default().state_lattice, 3.0);
        places.look(&Standing { at_m: DVec2::ZERO, radius_m: 0.5, is_void: true }, DVec2::ZERO);
        let known = |x| places.known(IVec2::new(x, 0)).unwrap();
        assert_eq!(places.position_m(IVec2::new(2, 0)), DVec2::X);
        assert!(known(0).is_blocked[0] && !known(0).is_negative_obstacle);
        assert!(known(1).is_blocked[0] && !known(1).is_negative_obstacle, "0 m from the body");
        assert!(!known(2).is_blocked[0] && known(2).is_negative_obstacle, "beside it");
        assert!((0..=3).all(|x| (known(x).lacks_room[0] > 0.0) == (x < 2)));
    }

    #[test]
    fn room_is_told_where_the_ground_is_known() {
        let mut places = PlaceLattice::new(&PlannerConfig::default().state_lattice, 3.0);
        let has_room = |places: &PlaceLattice, x_m: f64| places.has_room_within(DVec2::new(x_m, 0.0), 0.4);
        assert_eq!(has_room(&places, 0.0), None);
        places.look(&Standing { at_m: DVec2::ZERO, radius_m: 0.5, is_void: false }, DVec2::ZERO);
        assert_eq!(has_room(&places, 0.0), Some(false));
        assert_eq!(has_room(&places, 2.0), Some(true));
        assert_eq!(has_room(&places, 9.0), None);
        assert_eq!(places.has_room_within(DVec2::X * 1e6, 1e5), None, "at once");
    }

    /// Level ground of which all is missing, or drops off, as noticed from nearby.
    #[derive(Clone, Copy)]
    struct Edge {
        lacks_ground: bool,
    }

    impl TerrainQuery for Edge {
        fn plane_at(&self, _: DVec2) -> Option<Plane> {
            Some(Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.0 })
        }

        fn lacks_ground(&self, place_m: DVec2, here_m: DVec2, lacked: bool) -> bool {
            self.lacks_ground && (lacked || place_m.distance(here_m) < 0.7)
        }

        fn drops_off(&self, place_m: DVec2, here_m: DVec2) -> bool {
            !self.lacks_ground && place_m.distance(here_m) < 0.7
        }
    }

    #[test]
    fn missing_ground_is_remembered_when_the_ground_beside_it_is_refuted_and_a_drop_is_not() {
        for lacks_ground in [true, false] {
            let edge = Edge { lacks_ground };
            let mut places = PlaceLattice::new(&PlannerConfig::default().state_lattice, 3.0);
            let is_obstacle = |places: &PlaceLattice| {
                let offset = places.nearest(DVec2::new(0.5, 0.0)).unwrap();
                places.known(offset).unwrap().is_negative_obstacle
            };
            places.look(&edge, DVec2::ZERO);
            assert!(is_obstacle(&places));
            places.query_again_near(DVec2::ZERO, 1.0);
            places.look(&edge, DVec2::new(-1.0, 0.0));
            assert_eq!(is_obstacle(&places), lacks_ground);
            places.clear();
            places.look(&edge, DVec2::new(-1.0, 0.0));
            assert!(!is_obstacle(&places));
        }
    }
}
