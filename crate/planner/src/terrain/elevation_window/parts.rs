//! Ground in parts of half a cell: what returns tell of its height, and where none comes from it, what the
//! beams do that passed over it. Ground that was seen through is lower than the beam.

use core::time::Duration;

use glam::{DVec2, DVec3, IVec2};

use super::MOST_RETURNS;
use crate::config::ElevationWindowConfig;
use crate::math::elementary::floor;
use crate::pose::FrameChange;
use crate::terrain::rolling_grid::RollingGrid;

/// Parts of a cell's side.
const PARTS_PER_CELL: i32 = 2;
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

/// The parts of the window.
#[derive(Clone, Debug)]
pub(super) struct GroundParts {
    /// Side of a part.
    pub(super) part_m: f64,
    memory: Duration,
    grid: RollingGrid<GroundPart>,
}

impl GroundParts {
    /// None is known yet.
    pub(super) fn new(config: &ElevationWindowConfig) -> Self {
        Self {
            part_m: config.cell_m / f64::from(PARTS_PER_CELL),
            memory: config.memory(),
            grid: RollingGrid::new(config.cells_per_side() * PARTS_PER_CELL as usize),
        }
    }

    pub(super) fn clear(&mut self) {
        self.grid.clear();
    }

    /// Adds a return on the ground, in the world frame.
    pub(super) fn add(&mut self, point_m: DVec3, now: Duration) {
        let part = self.part_to_change(point_m.truncate(), now);
        part.returns = (part.returns + 1.0).min(MOST_RETURNS);
        part.mean_m += (point_m.z - part.mean_m) / part.returns;
    }

    /// Notes that a beam from `sensor_m` met ground at `end_m`, in the world frame, and that nothing was met
    /// before it from `free_share` of the way on.
    pub(super) fn see_through(&mut self, sensor_m: DVec3, end_m: DVec3, free_share: f64, now: Duration) {
        let path_m = end_m - sensor_m;
        let plan_m = path_m.truncate().length();
        let count = ((plan_m * (1.0 - free_share)).min(BOUNDED_M) / self.part_m) as usize;
        for step in 1..=count {
            let point_m = end_m - path_m * (step as f64 * self.part_m / plan_m);
            let part = self.part_to_change(point_m.truncate(), now);
            part.lowest_beam_m = part.lowest_beam_m.min(point_m.z);
        }
    }

    /// The fresh parts in a square around a place, with their middles.
    pub(super) fn around(
        &self,
        place_m: DVec2,
        half_m: f64,
        now: Duration,
    ) -> impl Iterator<Item = (DVec2, &GroundPart)> {
        let (low, high) = (self.index_of(place_m - half_m), self.index_of(place_m + half_m));
        let fresh = self.grid.between(low, high).filter(move |(_, part)| now - part.seen <= self.memory);
        fresh.map(|(index, part)| (self.middle_m(index), part))
    }

    /// Forgets the parts of the cell that a place is in.
    pub(super) fn forget_cell(&mut self, place_m: DVec2) {
        let first = self.index_of(place_m).div_euclid(IVec2::splat(PARTS_PER_CELL)) * PARTS_PER_CELL;
        for y in 0..PARTS_PER_CELL {
            for x in 0..PARTS_PER_CELL {
                self.grid.remove(first + IVec2::new(x, y));
            }
        }
    }

    /// Moves the parts to another world frame.
    pub(super) fn relocalise(&mut self, change: &FrameChange, now: Duration) {
        let before = self.grid.clone();
        self.grid.clear();
        for (index, part) in before.iter().filter(|(_, part)| now - part.seen <= self.memory) {
            let middle_m = self.middle_m(index);
            let height_m = |height_m: f64| change.point_m(middle_m.extend(height_m)).z;
            let lowest_beam_m =
                if part.lowest_beam_m.is_finite() { height_m(part.lowest_beam_m) } else { f64::INFINITY };
            let moved = GroundPart { mean_m: height_m(part.mean_m), lowest_beam_m, ..*part };
            self.grid.set(self.index_of(change.place_m(middle_m)), moved);
        }
    }

    fn part_to_change(&mut self, place_m: DVec2, now: Duration) -> &mut GroundPart {
        let part = self.grid.get_or_insert(self.index_of(place_m), GroundPart::new(now));
        if now - part.seen > self.memory {
            *part = GroundPart::new(now);
        }
        part.seen = now;
        part
    }

    fn index_of(&self, place_m: DVec2) -> IVec2 {
        let parts = place_m / self.part_m;
        IVec2::new(floor(parts.x), floor(parts.y))
    }

    fn middle_m(&self, index: IVec2) -> DVec2 {
        (index.as_dvec2() + 0.5) * self.part_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::Pose;
    use proptest::prelude::*;

    const SENSOR_M: DVec3 = DVec3::new(0.0, 0.0, 0.8);

    const NOW: Duration = Duration::from_secs(1);

    fn no_parts() -> GroundParts {
        GroundParts::new(&ElevationWindowConfig::default())
    }

    fn at_most_m(parts: &GroundParts, place_m: DVec2) -> Option<f64> {
        parts.grid.get(parts.index_of(place_m)).map(GroundPart::height_at_most_m)
    }

    proptest! {
        #[test]
        fn ground_is_lower_than_the_lowest_beam_over_it(
            ends in prop::collection::vec((-3.1..3.1_f64, 1.0..6.0_f64, -1.0..0.5_f64, 0.0..0.95_f64), 1..20),
        ) {
            let mut parts = no_parts();
            let ends = ends.into_iter().map(|(azimuth, plan_m, height_m, free_share)| {
                ((DVec2::from_angle(azimuth) * plan_m).extend(height_m), free_share)
            });
            let ends: Vec<_> = ends.collect();
            for &(end_m, free_share) in &ends {
                parts.see_through(SENSOR_M, end_m, free_share, NOW);
            }
            for (index, part) in parts.grid.iter() {
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
        let mut parts = no_parts();
        let place_m = DVec2::new(1.05, 0.05);
        parts.see_through(SENSOR_M, DVec3::new(2.05, 0.05, -0.4), 0.0, NOW);
        let beam_m = at_most_m(&parts, place_m).unwrap();
        assert!((beam_m - 0.185).abs() < 0.07, "{beam_m}");
        parts.see_through(SENSOR_M, DVec3::new(2.05, 0.05, -0.2), 0.0, NOW);
        assert_eq!(at_most_m(&parts, place_m), Some(beam_m), "a higher beam says nothing new");
        for height_m in [-0.1, -0.3] {
            parts.add(place_m.extend(height_m), NOW);
        }
        assert_eq!(at_most_m(&parts, place_m), Some(-0.2));
        parts.forget_cell(place_m);
        assert_eq!(at_most_m(&parts, place_m), None);
    }

    #[test]
    fn the_parts_move_with_the_frame() {
        let mut parts = no_parts();
        parts.add(DVec3::new(1.05, 0.05, 0.2), NOW);
        parts.see_through(SENSOR_M, DVec3::new(0.05, 2.0, 0.0), 0.9, NOW);
        let at = |x, z, yaw_rad| Pose {
            position_m: DVec3::new(x, 0.0, z),
            roll_rad: 0.0,
            pitch_rad: 0.0,
            yaw_rad,
        };
        let change = FrameChange::between(&at(0.0, 0.0, 0.0), &at(4.0, 0.5, core::f64::consts::FRAC_PI_2));
        parts.relocalise(&change, NOW);
        let moved_m = at_most_m(&parts, DVec2::new(3.95, 1.05)).unwrap();
        assert!((moved_m - 0.7).abs() < 1e-9, "{moved_m}");
        let moved_m = at_most_m(&parts, DVec2::new(2.1, 0.05)).unwrap();
        assert!((0.5..0.6).contains(&moved_m), "{moved_m}");
    }
}
