//! The voxel map and its search space.

use glam::{DVec2, DVec3};

use crate::cloud::{Cloud, SPACING_M};

/// A free voxel over an occupied one, which the robot may occupy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// From the west.
    pub column: u32,
    /// From the south.
    pub row: u32,
    /// Upwards; the lowest point of the map lies in level 0.
    pub level: i32,
}

/// The map: the surface of every column of voxels, and the search space over the valid ground.
#[derive(Clone, Debug)]
pub struct VoxelMap {
    columns: usize,
    rows: usize,
    voxel_m: f64,
    lowest_m: f64,
    /// Level of the highest occupied voxel of each column.
    tops: Vec<i32>,
    /// Mean height of the points of each column.
    means_m: Vec<f64>,
    /// Index of the first node of each column, and the number of all at the end.
    first_node: Vec<u32>,
    nodes: Vec<Node>,
}

impl VoxelMap {
    /// Sorts the points into voxels; one point makes a voxel occupied. Only `valid` points carry the search
    /// space.
    #[must_use]
    pub fn new(cloud: &Cloud, valid: &[bool], voxel_m: f64) -> Self {
        let count = (cloud.extent_m() / voxel_m - 1e-9).ceil().max(DVec2::ONE);
        let (columns, rows) = (count.x as usize, count.y as usize);
        let lowest_m = cloud.heights_m().iter().copied().fold(f64::INFINITY, f64::min);
        let column_of = |index: usize| {
            let voxel = |point: usize, count: usize| {
                ((point as f64 * SPACING_M / voxel_m + 1e-9) as usize).min(count - 1)
            };
            voxel(index / cloud.columns(), rows) * columns + voxel(index % cloud.columns(), columns)
        };
        let level_of = |height_m: f64| ((height_m - lowest_m) / voxel_m).floor() as i32;

        let mut tops = vec![0; columns * rows];
        let mut sums = vec![(0.0, 0.0); columns * rows];
        let mut valid_levels: Vec<(usize, i32)> = Vec::new();
        for (index, &height_m) in cloud.heights_m().iter().enumerate() {
            let (column, level) = (column_of(index), level_of(height_m));
            tops[column] = level.max(tops[column]);
            sums[column].0 += height_m;
            sums[column].1 += 1.0;
            if valid[index] {
                valid_levels.push((column, level));
            }
        }
        valid_levels.sort_unstable();
        valid_levels.dedup();
        let mut first_node = Vec::with_capacity(columns * rows + 1);
        let mut nodes = Vec::new();
        for (index, &(column, level)) in valid_levels.iter().enumerate() {
            // Free above, as far as valid points go.
            if valid_levels.get(index + 1) != Some(&(column, level + 1)) {
                while first_node.len() <= column {
                    first_node.push(nodes.len() as u32);
                }
                let (column, row) = ((column % columns) as u32, (column / columns) as u32);
                nodes.push(Node { column, row, level: level + 1 });
            }
        }
        first_node.resize(columns * rows + 1, nodes.len() as u32);
        let means_m = sums.into_iter().map(|(sum, count): (f64, f64)| sum / count.max(1.0)).collect();
        Self { columns, rows, voxel_m, lowest_m, tops, means_m, first_node, nodes }
    }

    /// Columns from west to east.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Rows from south to north.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Side of a voxel, metres.
    #[must_use]
    pub fn voxel_m(&self) -> f64 {
        self.voxel_m
    }

    /// The search space, sorted by row, column and level.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The indices of the nodes in a column; empty beyond the border.
    pub fn nodes_in(&self, column: i64, row: i64) -> core::ops::Range<usize> {
        let inside = |index: i64, count: usize| (0..count as i64).contains(&index);
        if !(inside(column, self.columns) && inside(row, self.rows)) {
            return 0..0;
        }
        let index = row as usize * self.columns + column as usize;
        self.first_node[index] as usize..self.first_node[index + 1] as usize
    }

    /// Level of the highest occupied voxel in a column, which must exist.
    pub(crate) fn top(&self, column: usize, row: usize) -> i32 {
        self.tops[row * self.columns + column]
    }

    /// The centre of a node's voxel in the world.
    #[must_use]
    pub fn centre_m(&self, node: usize) -> DVec3 {
        let Node { column, row, level } = self.nodes[node];
        let index = DVec3::new(f64::from(column), f64::from(row), f64::from(level));
        (index + 0.5) * self.voxel_m + DVec3::new(0.0, 0.0, self.lowest_m)
    }

    /// (dz/dx, dz/dy) of the mean heights about a node's column; of one side only at the border.
    #[must_use]
    pub fn gradient(&self, node: usize) -> DVec2 {
        let (column, row) = (self.nodes[node].column as usize, self.nodes[node].row as usize);
        let mean_m = |column: usize, row: usize| self.means_m[row * self.columns + column];
        let (west, east) = (column.saturating_sub(1), (column + 1).min(self.columns - 1));
        let (south, north) = (row.saturating_sub(1), (row + 1).min(self.rows - 1));
        let slope = |rise_m: f64, voxels: usize| rise_m / (voxels.max(1) as f64 * self.voxel_m);
        DVec2::new(
            slope(mean_m(east, row) - mean_m(west, row), east - west),
            slope(mean_m(column, north) - mean_m(column, south), north - south),
        )
    }

    /// The node nearest to a place seen from above, no further than `most_m`; the highest of its column.
    #[must_use]
    pub fn nearest(&self, place_m: DVec2, most_m: f64) -> Option<usize> {
        let index = (place_m / self.voxel_m).floor();
        let reach = (most_m / self.voxel_m).ceil() as i64 + 1;
        let mut best: Option<(usize, f64)> = None;
        for row in index.y as i64 - reach..=index.y as i64 + reach {
            for column in index.x as i64 - reach..=index.x as i64 + reach {
                let Some(node) = self.nodes_in(column, row).last() else { continue };
                let distance_m = self.centre_m(node).truncate().distance(place_m);
                if distance_m <= most_m && best.is_none_or(|(_, least_m)| distance_m < least_m) {
                    best = Some((node, distance_m));
                }
            }
        }
        best.map(|(node, _)| node)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::field;

    fn map(height_m: impl Fn(DVec2) -> f64, valid: impl Fn(f64) -> bool) -> VoxelMap {
        let cloud = Cloud::new(&field(6.0, height_m)).unwrap();
        let valid: Vec<bool> = cloud.heights_m().iter().map(|&height_m| valid(height_m)).collect();
        VoxelMap::new(&cloud, &valid, 0.3)
    }

    #[test]
    fn level_ground_is_one_layer() {
        let map = map(|_| 5.0, |_| true);
        assert_eq!((map.columns(), map.rows(), map.nodes().len()), (20, 20, 400));
        assert!(map.nodes().iter().all(|node| node.level == 1));
        let node = map.nodes_in(3, 7).next().unwrap();
        assert!((map.centre_m(node) - DVec3::new(1.05, 2.25, 5.45)).length() < 1e-12);
        assert_eq!(map.nodes_in(-1, 0), 0..0);
        assert_eq!(map.nodes_in(0, 20), 0..0);
        assert_eq!(map.nearest(DVec2::new(1.0, 2.2), 1.0), Some(node));
    }

    #[test]
    fn a_slope_is_climbed_level_by_level_and_has_its_gradient() {
        let map = map(|place| 0.5 * place.x, |_| true);
        for node in 0..map.nodes().len() {
            let Node { column, row, level } = map.nodes()[node];
            assert_eq!(level, map.top(column as usize, row as usize) + 1);
            if (1..18).contains(&column) {
                assert!((map.gradient(node) - DVec2::new(0.5, 0.0)).length() < 0.03);
            }
        }
        let level = |column: i64| map.nodes()[map.nodes_in(column, 4).next().unwrap()].level;
        assert_eq!(level(0), 1);
        assert!((level(19) - 10).abs() <= 1);
    }

    #[test]
    fn ground_that_is_not_valid_carries_nothing() {
        let map = map(|place| if place.x < 3.0 { 0.0 } else { 1.0 }, |height_m| height_m < 0.1);
        assert!(!map.nodes().is_empty());
        assert!(map.nodes().iter().all(|node| node.column < 10));
        assert_eq!(map.nearest(DVec2::new(5.0, 3.0), 1.0), None);
        assert_eq!(map.top(15, 5), 3);
    }

    #[test]
    fn two_levels_of_valid_ground_apart_are_two_nodes() {
        // Steps of 0.7 m in the middle of a column, both sides valid.
        let map = map(|place| if place.x < 3.1 { 0.0 } else { 0.7 }, |h| !(0.01..0.69).contains(&h));
        let levels: Vec<i32> = map.nodes_in(10, 5).map(|node| map.nodes()[node].level).collect();
        assert_eq!(levels, [1, 3]);
    }
}
