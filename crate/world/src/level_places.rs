//! Safe places on a terrain without chosen ones.

use crate::height_field::HeightField;
use crate::objects::Solid;
use glam::DVec2;

/// Radius around a place within which the ground is checked: a Husky turns within it.
const REACH_M: f64 = 0.8;
/// Candidates along a side of the corner that is searched.
const CANDIDATES: u32 = 24;
/// The corner that is searched, as shares of the terrain's sides.
const NEAREST: f64 = 0.08;
const FARTHEST: f64 = 0.38;

impl HeightField {
    /// The most level places near the south-western and the north-eastern corner, with room to turn among the
    /// `solids`.
    #[must_use]
    pub fn level_places(&self, solids: &[Solid]) -> [DVec2; 2] {
        [false, true].map(|opposite| {
            let extent = self.extent_m();
            let mut best = (f64::INFINITY, extent / 2.0);
            for row in 0..CANDIDATES {
                for column in 0..CANDIDATES {
                    let step = DVec2::new(f64::from(column), f64::from(row)) / f64::from(CANDIDATES - 1);
                    let share = DVec2::splat(NEAREST) + (FARTHEST - NEAREST) * step;
                    let place = extent * if opposite { DVec2::ONE - share } else { share };
                    // Centimetres read well in a file.
                    let place = (place * 100.0).round() / 100.0;
                    let steepest = self.steepest_around(place);
                    if steepest < best.0 && solids.iter().all(|solid| leaves_room(solid, place)) {
                        best = (steepest, place);
                    }
                }
            }
            best.1
        })
    }

    /// The steepest rise over run at and around a place; infinite where the terrain ends.
    fn steepest_around(&self, place: DVec2) -> f64 {
        let mut steepest: f64 = 0.0;
        for north in -2..=2 {
            for east in -2..=2 {
                let at = place + DVec2::new(f64::from(east), f64::from(north)) * (REACH_M / 2.0);
                steepest = steepest.max(self.gradient(at).map_or(f64::INFINITY, DVec2::length));
            }
        }
        steepest
    }
}

/// Whether a robot can turn at a place, seen from above.
fn leaves_room(solid: &Solid, place: DVec2) -> bool {
    let nearest = solid.nearest(place.extend(solid.centre_m.z));
    nearest.truncate().distance(place) > REACH_M
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::objects::Shape;

    #[test]
    fn start_and_goal_stand_on_the_level_part_of_their_corner() {
        // Everything slopes but two shelves.
        let shelf = |c: usize, r: usize| (14..22).contains(&c) && (16..24).contains(&r);
        let heights_m = (0..101 * 101).map(|i| {
            let (c, r) = (i % 101, i / 101);
            if shelf(c, r) || shelf(100 - c, 100 - r) { 3.0 } else { 0.2 * c as f32 }
        });
        let field = HeightField::new(101, 101, 0.5, heights_m.collect()).unwrap();
        let [start, goal] = field.level_places(&[]);
        for (place, mirrored) in [(start, start), (goal, field.extent_m() - goal)] {
            assert_eq!(field.height_m(place), Some(3.0), "{place}");
            assert!((7.0..11.0).contains(&mirrored.x) && (8.0..12.0).contains(&mirrored.y), "{place}");
        }
    }

    #[test]
    fn a_terrain_too_small_to_stand_on_has_its_middle() {
        let field = HeightField::new(2, 2, 0.5, vec![0.0; 4]).unwrap();
        assert_eq!(field.level_places(&[]), [DVec2::splat(0.25); 2]);
    }

    #[test]
    fn neither_stands_on_or_near_an_object() {
        let field = HeightField::new(101, 101, 0.5, vec![0.0; 101 * 101]).unwrap();
        let [start, goal] = field.level_places(&[]);
        let shape = Shape::Cylinder { radius_m: 1.0, half_height_m: 0.5 };
        let solids =
            [start, goal].map(|at| Solid { centre_m: at.extend(0.5), shape, object: 0, is_grounded: true });
        let moved = field.level_places(&solids);
        for place in moved {
            assert!(solids.iter().all(|solid| solid.centre_m.truncate().distance(place) > 1.8), "{place}");
        }
    }
}
