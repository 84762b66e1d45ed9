//! Ground in parts of half a cell: what returns tell of its height, and where none comes from it, what the
//! beams do that passed over it. Ground that was seen through is lower than the beam.

use core::time::Duration;

use glam::{DVec2, DVec3, IVec2};

use super::{ElevationWindow, MOST_RETURNS};
use crate::math::elementary::floor;
use crate::pose::FrameChange;
use crate::terrain::rolling_grid::RollingGrid;

/// Parts of a cell's side.
pub(super) const PARTS_PER_CELL: i32 = 2;
/// A beam bounds the ground this far before the place that it met.
const BOUNDED_M: f64 = 1.5;

/// A part of the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroundPart {
    /// Time of the last return or beam, on the window's clock.
    seen: Duration,
    returns: f64,
    mean_m: f64,
    /// The lowest beam that passed over its middle; infinite if none did.
    lowest_beam_m: f64,
}

impl GroundPart {
    const fn new(seen: Duration) -> Self {
        Self { seen, returns: 0.0, mean_m: 0.0, lowest_beam_m: f64::INFINITY }
    }

    /// Mean height of its returns.
    pub(super) fn height_m(&self) -> Option<f64> {
        (self.returns > 0.0).then_some(self.mean_m)
    }

    /// Mean height of its returns; without any, what it is lower than.
    pub(super) fn height_at_most_m(&self) -> f64 {
        self.height_m().unwrap_or(self.lowest_beam_m)
    }
}

impl ElevationWindow {
    /// Adds a return on the ground, in the world frame.
    pub(super) fn add_to_part(&mut self, point_m: DVec3) {
        let part = self.part_to_change(point_m.truncate());
        part.returns = (part.returns + 1.0).min(MOST_RETURNS);
        part.mean_m += (point_m.z - part.mean_m) / part.returns;
    }

    /// Notes that a beam from `sensor_m` met ground at `end_m`, in the world frame, and that nothing was met
    /// before it from `free_share` of the way on.
    pub(crate) fn see_through(&mut self, sensor_m: DVec3, end_m: DVec3, free_share: f64) {
        let path_m = end_m - sensor_m;
        let plan_m = path_m.truncate().length();
        let part_m = self.part_m();
        let count = ((plan_m * (1.0 - free_share)).min(BOUNDED_M) / part_m) as usize;
        for step in 1..=count {
            let point_m = end_m - path_m * (step as f64 * part_m / plan_m);
            let part = self.part_to_change(point_m.truncate());
            part.lowest_beam_m = part.lowest_beam_m.min(point_m.z);
        }
    }

    /// The fresh parts in a square around a place, with their middles.
    pub(super) fn parts_around(
        &self,
        place_m: DVec2,
        half_m: f64,
    ) -> impl Iterator<Item = (DVec2, &GroundPart)> {
        let (low, high) = (self.part_index(place_m - half_m), self.part_index(place_m + half_m));
        let fresh = self.parts.between(low, high).filter(|(_, part)| self.is_fresh_part(part));
        fresh.map(|(index, part)| ((index.as_dvec2() + 0.5) * self.part_m(), part))
    }

    /// Forgets the parts of the cell that a place is in.
    pub(super) fn forget_parts(&mut self, place_m: DVec2) {
        let first = self.index_of(place_m) * PARTS_PER_CELL;
        for y in 0..PARTS_PER_CELL {
            for x in 0..PARTS_PER_CELL {
                self.parts.remove(first + IVec2::new(x, y));
            }
        }
    }

    /// The parts in another world frame.
    pub(super) fn relocalised_parts(&self, change: &FrameChange) -> RollingGrid<GroundPart> {
        let mut moved = RollingGrid::new(self.parts_per_side());
        for (index, part) in self.parts.iter().filter(|(_, part)| self.is_fresh_part(part)) {
            let middle_m = (index.as_dvec2() + 0.5) * self.part_m();
            let height_m = |height_m: f64| change.point_m(middle_m.extend(height_m)).z;
            let place_m = change.place_m(middle_m);
            let lowest_beam_m =
                if part.lowest_beam_m.is_finite() { height_m(part.lowest_beam_m) } else { f64::INFINITY };
            moved.set(
                self.part_index(place_m),
                GroundPart { mean_m: height_m(part.mean_m), lowest_beam_m, ..*part },
            );
        }
        moved
    }

    pub(super) fn parts_per_side(&self) -> usize {
        self.config.cells_per_side() * PARTS_PER_CELL as usize
    }

    pub(super) fn part_m(&self) -> f64 {
        self.config.cell_m / f64::from(PARTS_PER_CELL)
    }

    fn part_to_change(&mut self, place_m: DVec2) -> &mut GroundPart {
        let index = self.part_index(place_m);
        let (now, memory) = (self.now, self.memory);
        let part = self.parts.get_or_insert(index, GroundPart::new(now));
        if now - part.seen > memory {
            *part = GroundPart::new(now);
        }
        part.seen = now;
        part
    }

    fn part_index(&self, place_m: DVec2) -> IVec2 {
        let parts = place_m / self.part_m();
        IVec2::new(floor(parts.x), floor(parts.y))
    }

    fn is_fresh_part(&self, part: &GroundPart) -> bool {
        self.now - part.seen <= self.memory
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use crate::pose::Pose;
    use crate::testing::STEP;
    use proptest::prelude::*;

    const SENSOR_M: DVec3 = DVec3::new(0.0, 0.0, 0.8);

    fn window() -> ElevationWindow {
        let mut window = ElevationWindow::new(&PlannerConfig::default());
        window.advance(STEP);
        window
    }

    fn at_most_m(window: &ElevationWindow, place_m: DVec2) -> Option<f64> {
        let index = window.part_index(place_m);
        window.parts.get(index).map(GroundPart::height_at_most_m)
    }

    proptest! {
        #[test]
        fn ground_is_lower_than_the_lowest_beam_over_it(
            ends in prop::collection::vec((-3.1..3.1_f64, 1.0..6.0_f64, -1.0..0.5_f64, 0.0..0.95_f64), 1..20),
        ) {
            let mut window = window();
            let ends = ends.into_iter().map(|(azimuth, plan_m, height_m, free_share)| {
                ((DVec2::from_angle(azimuth) * plan_m).extend(height_m), free_share)
            });
            let ends: Vec<_> = ends.collect();
            for &(end_m, free_share) in &ends {
                window.see_through(SENSOR_M, end_m, free_share);
            }
            for (index, part) in window.parts.iter() {
                let middle_m = (index.as_dvec2() + 0.5) * 0.1;
                // A beam counts where it passes nearer than a part's diagonal, up to its slope times that.
                let over = ends.iter().filter_map(|&(end_m, free_share)| {
                    let path_m = end_m - SENSOR_M;
                    let plan_m = path_m.truncate().length();
                    let share = middle_m.dot(path_m.truncate()) / (plan_m * plan_m);
                    let away_m = (SENSOR_M.truncate() + path_m.truncate() * share - middle_m).length();
                    let slack = 0.15 / plan_m;
                    let is_free = share > free_share - slack
                        && share > 1.0 - (BOUNDED_M + 0.15) / plan_m
                        && share < 1.0 + slack;
                    (is_free && away_m < 0.08).then(|| (SENSOR_M + path_m * share).z)
                });
                let lowest_m = over.fold(f64::INFINITY, f64::min);
                prop_assert!(lowest_m.is_finite());
                prop_assert!(part.height_at_most_m() > lowest_m - 0.16, "{lowest_m} {part:?}");
            }
        }
    }

    #[test]
    fn a_return_counts_for_more_than_any_beam() {
        let mut window = window();
        let place_m = DVec2::new(1.05, 0.05);
        window.see_through(SENSOR_M, DVec3::new(2.05, 0.05, -0.4), 0.0);
        let beam_m = at_most_m(&window, place_m).unwrap();
        assert!((beam_m - 0.185).abs() < 0.07, "{beam_m}");
        window.see_through(SENSOR_M, DVec3::new(2.05, 0.05, -0.2), 0.0);
        assert_eq!(at_most_m(&window, place_m), Some(beam_m), "a higher beam says nothing new");
        for height_m in [-0.1, -0.3] {
            window.add_return(place_m.extend(height_m));
        }
        assert_eq!(at_most_m(&window, place_m), Some(-0.2));
        window.forget_parts(place_m);
        assert_eq!(at_most_m(&window, place_m), None);
    }

    #[test]
    fn the_parts_move_with_the_frame() {
        let mut window = window();
        window.add_return(DVec3::new(1.05, 0.05, 0.2));
        window.see_through(SENSOR_M, DVec3::new(0.05, 2.0, 0.0), 0.9);
        let at = |x, z, yaw_rad| Pose {
            position_m: DVec3::new(x, 0.0, z),
            roll_rad: 0.0,
            pitch_rad: 0.0,
            yaw_rad,
        };
        let change = FrameChange::between(&at(0.0, 0.0, 0.0), &at(4.0, 0.5, core::f64::consts::FRAC_PI_2));
        window.relocalise(&change);
        let moved_m = at_most_m(&window, DVec2::new(3.95, 1.05)).unwrap();
        assert!((moved_m - 0.7).abs() < 1e-9, "{moved_m}");
        let moved_m = at_most_m(&window, DVec2::new(2.1, 0.05)).unwrap();
        assert!((0.5..0.6).contains(&moved_m), "{moved_m}");
    }
}
