//! Footprint slopes: the robot's attitude on its wheels, if the ground under each was seen.
//!
//! A plane through all ground around a place takes a ditch or a crest for roughness, at every heading. The
//! heights under four wheels give the tilt there, and the headings at which the robot passes.

use glam::{DVec2, IVec2};

use super::ElevationWindow;
use crate::math::elementary::floor;
use crate::terrain::slopes::Slopes;

/// The footprint is also tried this share of the lattice's step before and behind each place.
pub(super) const SHIFT_STEPS: f64 = 0.5;
/// Ground under a wheel counts as seen if a return lies this near.
const NEAR_M: f64 = 0.2;
/// Returns nearer than this to a wheel have equal weights.
const BLUR_M: f64 = 0.05;

impl ElevationWindow {
    /// The largest slopes of the robot at a place and just before and behind it, facing along the unit vector
    /// `direction`; `gradient` is that of the ground around. `None` if the ground under a wheel was not seen.
    pub(super) fn footprint_slopes(
        &self,
        place_m: DVec2,
        direction: DVec2,
        gradient: DVec2,
    ) -> Option<Slopes> {
        let stand = |shift_m: f64| self.stand(place_m + direction * shift_m, direction, gradient);
        let here = stand(0.0)?;
        let shift_m = SHIFT_STEPS * self.step_m;
        Some([-shift_m, shift_m].into_iter().filter_map(stand).fold(here, Slopes::max))
    }

    /// The least-squares plane through the ground under the four wheels.
    fn stand(&self, place_m: DVec2, direction: DVec2, gradient: DVec2) -> Option<Slopes> {
        let ahead = direction * (0.5 * self.robot.wheelbase_m);
        let left = direction.perp() * (0.5 * self.robot.track_m);
        let height_m = |wheel: DVec2| self.height_m(place_m + wheel, gradient);
        let (front_left, front_right) = (height_m(ahead + left)?, height_m(ahead - left)?);
        let (rear_left, rear_right) = (height_m(left - ahead)?, height_m(-left - ahead)?);
        let rise_m = 0.5 * (front_left + front_right - rear_left - rear_right);
        let lean_m = 0.5 * (front_left + rear_left - front_right - rear_right);
        Some(Slopes {
            across: (lean_m / self.robot.track_m).abs(),
            along: (rise_m / self.robot.wheelbase_m).abs(),
        })
    }

    /// Height of the ground at a point, from the cells around it.
    pub(super) fn height_m(&self, point_m: DVec2, gradient: DVec2) -> Option<f64> {
        let cells = point_m / self.config.cell_m - 0.5;
        let low = IVec2::new(floor(cells.x), floor(cells.y));
        let (mut sum, mut weights, mut nearest_squared) = (0.0, 0.0, f64::INFINITY);
        for step in [IVec2::ZERO, IVec2::X, IVec2::Y, IVec2::ONE] {
            let index = low + step;
            let Some(cell) = self.cells.get(index).filter(|cell| self.is_fresh(cell) && !cell.is_upright())
            else {
                continue;
            };
            let away = point_m - cell.mean_m.truncate();
            let squared = away.length_squared();
            let weight = 1.0 / (BLUR_M * BLUR_M + squared);
            sum += weight * (cell.mean_m.z + gradient.dot(away));
            weights += weight;
            nearest_squared = nearest_squared.min(squared);
        }
        (nearest_squared < NEAR_M * NEAR_M).then(|| sum / weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::elevation_window::TerrainQuery;
    use crate::testing::strewn;
    use proptest::prelude::*;

    fn slopes(ground: &ElevationWindow, place_m: DVec2, direction: DVec2) -> Option<Slopes> {
        ground.footprint_slopes(place_m, direction, ground.plane_at(place_m)?.gradient)
    }

    proptest! {
        #[test]
        fn on_a_plane_the_wheels_say_what_the_plane_says(
            sx in -0.7..0.7_f64, sy in -0.7..0.7_f64, x in -1.0..1.0_f64, y in -1.0..1.0_f64, heading in 0.0..6.2_f64,
        ) {
            let (gradient, place_m) = (DVec2::new(sx, sy), DVec2::new(x, y));
            let direction = DVec2::from_angle(heading);
            let found = slopes(&strewn(|place_m| Some(gradient.dot(place_m))), place_m, direction).unwrap();
            let expected = Slopes::facing(gradient, direction);
            prop_assert!((found.across - expected.across).abs() < 1e-9);
            prop_assert!((found.along - expected.along).abs() < 1e-9);
        }
    }

    #[test]
    fn a_ditch_is_passed_across_and_not_along() {
        // Along x, 0.3 m deep and a metre wide: sides of 0.6.
        let ditch = strewn(|place_m| Some(-(0.3 - 0.6 * place_m.y.abs()).max(0.0)));
        let across = slopes(&ditch, DVec2::ZERO, DVec2::Y).unwrap();
        assert!((0.4..0.6).contains(&across.along) && across.across < 0.02, "{across:?}");
        let side = slopes(&ditch, DVec2::new(0.0, 0.25), DVec2::X).unwrap();
        assert!(side.across > 0.3 && side.along < 0.02, "{side:?}");
        let plane = ditch.plane_at(DVec2::ZERO).unwrap();
        assert!(plane.gradient.length() < 0.15 && plane.gradient_deviation > 0.1, "{plane:?}");
    }

    #[test]
    fn where_a_wheel_stands_on_unseen_ground_nothing_is_said() {
        let ground = strewn(|_| Some(0.0));
        assert!(slopes(&ground, DVec2::new(1.5, 0.0), DVec2::X).is_some());
        assert!(slopes(&ground, DVec2::new(2.2, 0.0), DVec2::X).is_none());
    }
}
