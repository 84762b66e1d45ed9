//! The travel cost: curvature of the surface, spread in the plane.

use super::voxels::{Node, VoxelMap};

/// The travel cost's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TravelCost {
    /// Per metre of second difference beyond one voxel.
    pub gain_per_m: f64,
    /// Smaller costs count as 0.
    pub least: f64,
    /// Upper bound of the cost.
    pub most: f64,
    /// A voxel's cost falls linearly to nothing over this distance, metres.
    pub spread_m: f64,
    /// Cost of a column that has no valid ground.
    pub refused: f64,
}

impl TravelCost {
    /// The cost of a voxel from the second differences of the surface's height along x and y, in metres:
    /// gain ((|Δ²ₓz| - res) + (|Δ²ᵧz| - res)), within bounds.
    #[must_use]
    pub fn of_bends(&self, bend_x_m: f64, bend_y_m: f64, voxel_m: f64) -> f64 {
        let cost = self.gain_per_m * ((bend_x_m.abs() - voxel_m) + (bend_y_m.abs() - voxel_m));
        if cost < self.least { 0.0 } else { cost.min(self.most) }
    }

    /// The cost of every node: the greatest that its own column or one around it spreads to it. A column
    /// spreads to nodes level with the air above it, so the top of a cliff does not warn those at its foot;
    /// refused ground in the cost, which has no level, does.
    pub(crate) fn of_nodes(&self, map: &VoxelMap) -> Vec<f64> {
        let mut costs = vec![0.0_f64; map.nodes().len()];
        let reach = (self.spread_m / map.voxel_m()).ceil() as i64;
        for (row, column) in
            (0..map.rows()).flat_map(|row| (0..map.columns()).map(move |column| (row, column)))
        {
            let source = self.of_column(map, column, row);
            if source == 0.0 {
                continue;
            }
            let top = map.top(column, row);
            let (column, row) = (column as i64, row as i64);
            for up in -reach..=reach {
                for across in -reach..=reach {
                    let distance_m = map.voxel_m() * ((up * up + across * across) as f64).sqrt();
                    let lent = source * (1.0 - distance_m / self.spread_m);
                    for node in map.nodes_in(column + across, row + up) {
                        let Node { level, .. } = map.nodes()[node];
                        if level > top || self.refused > 0.0 {
                            costs[node] = costs[node].max(lent);
                        }
                    }
                }
            }
        }
        costs
    }

    fn of_column(&self, map: &VoxelMap, column: usize, row: usize) -> f64 {
        if column == 0 || row == 0 || column + 1 == map.columns() || row + 1 == map.rows() {
            return 0.0;
        }
        if map.nodes_in(column as i64, row as i64).is_empty() && self.refused > 0.0 {
            return self.refused;
        }
        let top_m = |column: usize, row: usize| f64::from(map.top(column, row)) * map.voxel_m();
        let here_m = top_m(column, row);
        let bend_x_m = top_m(column + 1, row) - 2.0 * here_m + top_m(column - 1, row);
        let bend_y_m = top_m(column, row + 1) - 2.0 * here_m + top_m(column, row - 1);
        self.of_bends(bend_x_m, bend_y_m, map.voxel_m())
    }
}

#[cfg(test)]
mod tests {
    use super::super::VgfConfig;
    use super::*;
    use crate::cloud::Cloud;
    use crate::testing::field;
    use glam::DVec2;

    #[test]
    fn the_cost_by_hand() {
        let travel = VgfConfig::published().travel;
        // 40 · ((2.4 - 0.3) + (1.8 - 0.3)) = 144.
        assert!((travel.of_bends(2.4, -1.8, 0.3) - 144.0).abs() < 1e-9);
        // 40 · ((2.0 - 0.3) + (0.9 - 0.3)) = 92: less than 100 counts as nothing.
        assert_eq!(travel.of_bends(2.0, 0.9, 0.3), 0.0);
        assert_eq!(travel.of_bends(0.0, 0.0, 0.3), 0.0);
        assert_eq!(travel.of_bends(30.0, 0.0, 0.3), 400.0);
    }

    /// A cliff of this height at x = 6, level on both sides.
    fn cliff(height_m: f64) -> (VoxelMap, Vec<f64>) {
        let ground = move |place: DVec2| if place.x < 6.1 { 0.0 } else { height_m };
        let cloud = Cloud::new(&field(12.0, ground)).unwrap();
        let map = VoxelMap::new(&cloud, &vec![true; cloud.heights_m().len()], 0.3);
        let costs = VgfConfig::published().travel.of_nodes(&map);
        (map, costs)
    }

    #[test]
    fn a_cliff_costs_and_a_slope_does_not() {
        assert!(cliff(6.0).1.iter().any(|&cost| cost > 100.0));
        assert!(cliff(1.0).1.iter().all(|&cost| cost == 0.0));
    }

    #[test]
    fn the_cost_falls_linearly_with_the_distance_on_its_own_level() {
        let (map, costs) = cliff(6.0);
        let on_top = |column: i64| {
            let node = map.nodes_in(column, 20).last().unwrap();
            costs[node]
        };
        let most = (0..40).map(on_top).fold(0.0, f64::max);
        let source = (0..40).rposition(|column| on_top(i64::from(column)) == most).unwrap() as i64;
        assert!(most > 100.0);
        for away in 0..=12 {
            let expected = most * (1.0 - 0.3 * away as f64 / 2.5).max(0.0);
            assert!((on_top(source + away) - expected).abs() < 1e-9, "{away} voxels away");
        }
    }
}
