//! The underside: whether belly or bumpers come down on the ground between the wheels, or a wheel in a hole.

use glam::{DVec2, IVec2};

use super::ElevationWindow;
use super::footprint::SHIFT_STEPS;
use super::parts::GroundParts;
use crate::math::elementary::floor;
use crate::terrain::headings::{AXES, DIRECTIONS};
use crate::terrain::plane::Plane;
use crate::terrain::slopes::Slopes;

/// The underside keeps this far from the ground.
const MARGIN_M: f64 = 0.02;
/// Ground this far beside the underside counts as well: the robot drives between the places that are judged.
const BESIDE_M: f64 = 0.1;
/// A wheel is as low as the lowest ground this far before and behind its contact.
const WHEEL_REACH_M: f64 = 0.08;
/// Most squares of a patch's side.
const MOST_SQUARES: usize = 32;

/// The ground under and around the robot at a place, as heights over the plane there.
struct Patch<'a> {
    window: &'a ElevationWindow,
    place_m: DVec2,
    plane: &'a Plane,
    corner_m: DVec2,
    square_m: f64,
    /// The height of each square's returns; NaN without any.
    returns_m: [f64; MOST_SQUARES * MOST_SQUARES],
    /// What the ground of each square is lower than.
    at_most_m: [f64; MOST_SQUARES * MOST_SQUARES],
}

impl ElevationWindow {
    /// Whether the robot on its wheels at a place, or just before or behind it, would set its underside down
    /// or be beyond its tilt limits, for each axis of travel. `plane` is that of the ground around.
    pub(super) fn underside_touches(
        &self,
        parts: &GroundParts,
        place_m: DVec2,
        plane: &Plane,
    ) -> [bool; AXES] {
        // Most ground is too smooth for it.
        if self.relief_m(parts, place_m, plane) <= self.robot.ground_clearance_m - MARGIN_M {
            return [false; AXES];
        }
        let patch = Patch::new(self, parts, place_m, plane);
        let shift_m = SHIFT_STEPS * self.step_m;
        let limits = Slopes::of_limits(&self.robot, 0.0);
        DIRECTIONS.map(|direction| {
            [-shift_m, 0.0, shift_m].into_iter().any(|shift_m| patch.touches(direction, shift_m, &limits))
        })
    }

    /// How much the heights over the plane differ around the robot at a place.
    fn relief_m(&self, parts: &GroundParts, place_m: DVec2, plane: &Plane) -> f64 {
        let radius_m = (self.half_body_m + BESIDE_M).length() + SHIFT_STEPS * self.step_m;
        let (mut lowest_m, mut highest_m) = (f64::INFINITY, f64::NEG_INFINITY);
        for (middle_m, part) in parts.around(place_m, radius_m, self.now) {
            let from_place_m = middle_m - place_m;
            if from_place_m.length_squared() > radius_m * radius_m {
                continue;
            }
            let plane_m = plane.height_m + plane.gradient.dot(from_place_m);
            lowest_m = lowest_m.min(part.height_at_most_m() - plane_m);
            highest_m = part.height_m().map_or(highest_m, |height_m| highest_m.max(height_m - plane_m));
        }
        highest_m - lowest_m
    }

    fn is_upright_at(&self, point_m: DVec2) -> bool {
        self.cells.get(self.index_of(point_m)).is_some_and(|cell| self.is_fresh(cell) && cell.is_upright())
    }
}

impl<'a> Patch<'a> {
    fn new(window: &'a ElevationWindow, parts: &GroundParts, place_m: DVec2, plane: &'a Plane) -> Self {
        let part_m = parts.part_m;
        let half_m = window.half_body_m.x + BESIDE_M + SHIFT_STEPS * window.step_m + part_m;
        let square_m = part_m * (2.0 * half_m / (part_m * (MOST_SQUARES - 1) as f64)).ceil().max(1.0);
        let mut patch = Self {
            window,
            place_m,
            plane,
            corner_m: ((place_m - half_m) / part_m).floor() * part_m,
            square_m,
            returns_m: [f64::NAN; MOST_SQUARES * MOST_SQUARES],
            at_most_m: [f64::INFINITY; MOST_SQUARES * MOST_SQUARES],
        };
        for (middle_m, part) in parts.around(place_m, half_m, window.now) {
            let Some(square) = patch.square(middle_m) else { continue };
            let plane_m = patch.plane_m(middle_m);
            patch.at_most_m[square] = patch.at_most_m[square].min(part.height_at_most_m() - plane_m);
            if let Some(height_m) = part.height_m().filter(|_| !window.is_upright_at(middle_m)) {
                patch.returns_m[square] = patch.returns_m[square].max(height_m - plane_m);
            }
        }
        patch
    }

    fn plane_m(&self, point_m: DVec2) -> f64 {
        self.plane.height_m + self.plane.gradient.dot(point_m - self.place_m)
    }

    fn square(&self, point_m: DVec2) -> Option<usize> {
        let square = (point_m - self.corner_m) / self.square_m;
        let square = IVec2::new(floor(square.x), floor(square.y));
        let side = MOST_SQUARES as i32;
        let is_inside = (0..side).contains(&square.x) && (0..side).contains(&square.y);
        is_inside.then(|| (square.y * side + square.x) as usize)
    }

    /// Whether the underside touches the ground, or the tilt exceeds its limits, of a robot that stands
    /// `shift_m` ahead of the place and faces along `direction`.
    fn touches(&self, direction: DVec2, shift_m: f64, limits: &Slopes) -> bool {
        let window = self.window;
        let middle_m = self.place_m + direction * shift_m;
        let across = direction.perp();
        let at_m = |along_m: f64, aside_m: f64| middle_m + direction * along_m + across * aside_m;
        let robot = &window.robot;
        let wheels_m = 0.5 * DVec2::new(robot.wheelbase_m, robot.track_m);
        let wheel_m =
            |along: f64, aside: f64| self.wheel_m(at_m(along * wheels_m.x, aside * wheels_m.y), direction);
        let (front_left, front_right) = (wheel_m(1.0, 1.0), wheel_m(1.0, -1.0));
        let (rear_left, rear_right) = (wheel_m(-1.0, 1.0), wheel_m(-1.0, -1.0));
        let rise = 0.5 * (front_left + front_right - rear_left - rear_right) / robot.wheelbase_m;
        let lean = 0.5 * (front_left + rear_left - front_right - rear_right) / robot.track_m;
        let tilt = Slopes {
            across: (self.plane.gradient.dot(across) + lean).abs(),
            along: (self.plane.gradient.dot(direction) + rise).abs(),
        };
        if !tilt.within(limits, 0.0) {
            return true;
        }
        // On warped ground two wheels carry it.
        let raised_m = 0.25 * (front_left + rear_right - front_right - rear_left).abs();
        let belly_m = 0.25 * (front_left + front_right + rear_left + rear_right) + raised_m - MARGIN_M;
        let half_m = window.half_body_m;
        let lowest_m = belly_m + robot.ground_clearance_m.min(robot.overhang_clearance_m)
            - rise.abs() * (half_m.x + BESIDE_M)
            - lean.abs() * (half_m.y + BESIDE_M);
        let inner_m = robot.track_m - 0.5 * robot.width_m;
        let mut bumps = self.returns_m.iter().enumerate().filter(|(_, height_m)| **height_m > lowest_m);
        bumps.any(|(square, height_m)| {
            let [x, y] = [square % MOST_SQUARES, square / MOST_SQUARES].map(|steps| steps as f64 + 0.5);
            let from_middle_m = self.corner_m + DVec2::new(x, y) * self.square_m - middle_m;
            let (along_m, aside_m) = (from_middle_m.dot(direction), from_middle_m.dot(across));
            let is_deck = along_m.abs() <= wheels_m.x + BESIDE_M;
            let (half_width_m, clearance_m) = if is_deck {
                (inner_m, robot.ground_clearance_m)
            } else {
                (half_m.y, robot.overhang_clearance_m)
            };
            along_m.abs() <= half_m.x + BESIDE_M
                && aside_m.abs() <= half_width_m + BESIDE_M
                && *height_m > belly_m + rise * along_m + lean * aside_m + clearance_m
        })
    }

    /// Height of a wheel's contact: that of the lowest ground at and just before and behind it.
    fn wheel_m(&self, contact_m: DVec2, direction: DVec2) -> f64 {
        [-WHEEL_REACH_M, 0.0, WHEEL_REACH_M]
            .into_iter()
            .map(|along_m| self.ground_m(contact_m + direction * along_m))
            .fold(f64::INFINITY, f64::min)
    }

    /// Height of the ground: of the returns from there, or from around if no beam saw it lower.
    fn ground_m(&self, point_m: DVec2) -> f64 {
        let (returns_m, at_most_m) = self
            .square(point_m)
            .map_or((f64::NAN, f64::INFINITY), |square| (self.returns_m[square], self.at_most_m[square]));
        if !returns_m.is_nan() {
            return returns_m;
        }
        let around_m = self.window.height_m(point_m, self.plane.gradient);
        around_m.map_or(0.0, |height_m| height_m - self.plane_m(point_m)).min(at_most_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::elevation_window::TerrainQuery;
    use crate::testing::strewn;
    use core::f64::consts::TAU;
    use glam::DVec3;
    use proptest::prelude::*;

    const EAST: usize = 0;
    const NORTH: usize = 4;

    fn touches(window: &ElevationWindow, place_m: DVec2) -> [bool; AXES] {
        window.sets_down(place_m, &window.plane_at(place_m).unwrap())
    }

    proptest! {
        #[test]
        fn on_a_plane_and_on_gentle_hills_nothing_touches(
            sx in -0.2..0.2_f64, sy in -0.2..0.2_f64, wave_m in 6.0..9.0_f64, turn in 0.0..6.2_f64,
        ) {
            let hill = |place_m: DVec2| {
                let along_m = place_m.dot(DVec2::from_angle(turn));
                Some(DVec2::new(sx, sy).dot(place_m) + 0.2 * libm::sin(TAU * along_m / wave_m))
            };
            prop_assert_eq!(touches(&strewn(hill), DVec2::ZERO), [false; AXES]);
        }
    }

    #[test]
    fn the_belly_comes_down_on_a_crest_between_the_wheels() {
        let crest =
            |high_m: f64| strewn(move |place_m| Some(if place_m.x.abs() < 0.1 { high_m } else { 0.0 }));
        assert!(touches(&crest(0.16), DVec2::ZERO)[EAST]);
        assert!(!touches(&crest(0.09), DVec2::ZERO)[EAST], "the belly is 0.13 m up");
        assert!(!touches(&crest(0.16), DVec2::new(1.2, 0.0))[NORTH], "beside it");
    }

    #[test]
    fn a_rut_is_straddled_and_not_crossed_by_wheels_that_fall_into_it() {
        let rut = strewn(|place_m| Some(if place_m.y.abs() < 0.15 { -0.25 } else { 0.0 }));
        let touches = touches(&rut, DVec2::ZERO);
        assert!(touches[NORTH] && !touches[EAST], "{touches:?}");
    }

    #[test]
    fn a_ditch_without_returns_is_known_by_the_beams_that_pass_over_it() {
        let mut ditch = strewn(|place_m| (place_m.y.abs() > 0.2).then_some(0.0));
        assert_eq!(touches(&ditch, DVec2::ZERO), [false; AXES], "a gap in the returns says nothing");
        let over_it = |ditch: &mut ElevationWindow, end_m: f64| {
            for step in -80..=80 {
                let east_m = f64::from(step) * 0.025;
                let end_m = DVec3::new(east_m, 0.25, end_m);
                ditch.see_through(DVec3::new(east_m, -3.0, 0.8), |line| line(end_m, 0.9));
            }
        };
        over_it(&mut ditch, -0.02);
        assert_eq!(touches(&ditch, DVec2::ZERO), [false; AXES], "barely over the ground");
        over_it(&mut ditch, -0.35);
        let touches = touches(&ditch, DVec2::ZERO);
        assert!(touches[NORTH], "{touches:?}");
    }

    #[test]
    fn bumpers_count_beyond_the_axles() {
        // A bank that begins 0.35 m ahead of the middle and rises by 0.25 m within a part.
        let bank = strewn(|place_m| Some(if place_m.x > 0.35 { 0.25 } else { 0.0 }));
        let place_m = DVec2::new(-0.25, 0.0);
        assert!(touches(&bank, place_m)[EAST], "from 0.6 m before it, the front shifted to 0.85 m");
        assert!(!touches(&bank, DVec2::new(-1.0, 0.0))[EAST]);
    }
}
