//! A* over the search space.

use core::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::voxels::VoxelMap;

/// Costs of the nodes.
#[derive(Clone, Debug)]
pub struct Prices {
    /// Added to a neighbour's place in the queue by the node it is reached from, not to the path's cost.
    pub priority: Vec<f64>,
    /// Cost of a path of one voxel, at least 1; between two nodes it is the mean of theirs.
    pub price: Vec<f64>,
}

/// The heuristic is a thousandth too large, which breaks ties towards the goal.
const TIE_BREAK: f64 = 1.0 + 1e-3;
const NO_PARENT: u32 = u32::MAX;

/// An entry of the queue, cheapest first and oldest first among equals.
#[derive(PartialEq)]
struct Queued {
    estimate: f64,
    age: u64,
    node: u32,
}

impl Eq for Queued {}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> Ordering {
        self.estimate.total_cmp(&other.estimate).then(self.age.cmp(&other.age))
    }
}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The nodes of a path from `start` to `goal`, both included; `None` if there is none.
///
/// The queue is ordered by f = g + h + the priority of the parent, as in the release, with g the path's cost
/// and h the octile distance in voxels. Without priorities the path is the cheapest, to a thousandth.
#[must_use]
pub fn search(map: &VoxelMap, prices: &Prices, start: usize, goal: usize) -> Option<Vec<usize>> {
    let count = map.nodes().len();
    let mut path_cost = vec![f64::INFINITY; count];
    let mut queued_at = vec![f64::INFINITY; count];
    let mut parent = vec![NO_PARENT; count];
    let mut queue = BinaryHeap::new();
    let mut age = 0;
    path_cost[start] = 0.0;
    queued_at[start] = octile(map, start, goal);
    queue.push(Reverse(Queued { estimate: queued_at[start], age, node: start as u32 }));
    while let Some(Reverse(Queued { estimate, node, .. })) = queue.pop() {
        let here = node as usize;
        // Already taken from the queue at a better place.
        if estimate > queued_at[here] {
            continue;
        }
        if here == goal {
            return Some(path_to(&parent, here));
        }
        queued_at[here] = f64::NEG_INFINITY;
        for (there, length) in neighbours(map, here) {
            let price = path_cost[here] + length * 0.5 * (prices.price[here] + prices.price[there]);
            if price >= path_cost[there] {
                continue;
            }
            path_cost[there] = price;
            parent[there] = node;
            let estimate = price + octile(map, there, goal) + prices.priority[here];
            // A queued node is only moved up; one that was taken before is queued again.
            if estimate < queued_at[there] || queued_at[there] == f64::NEG_INFINITY {
                queued_at[there] = estimate;
                age += 1;
                queue.push(Reverse(Queued { estimate, age, node: there as u32 }));
            }
        }
    }
    None
}

fn path_to(parent: &[u32], goal: usize) -> Vec<usize> {
    let mut nodes = vec![goal];
    let mut here = goal;
    while parent[here] != NO_PARENT {
        here = parent[here] as usize;
        nodes.push(here);
    }
    nodes.reverse();
    nodes
}

/// The 26 neighbours that are in the search space, and the distance to each, in voxels.
fn neighbours(map: &VoxelMap, node: usize) -> impl Iterator<Item = (usize, f64)> {
    let here = map.nodes()[node];
    (-1..=1_i64)
        .flat_map(|up| (-1..=1_i64).map(move |across| (across, up)))
        .flat_map(move |(across, up)| {
            map.nodes_in(i64::from(here.column) + across, i64::from(here.row) + up)
                .map(move |there| (there, across * across + up * up))
        })
        .filter_map(move |(there, plan)| {
            let climb = i64::from(map.nodes()[there].level) - i64::from(here.level);
            (there != node && climb.abs() <= 1).then(|| (there, ((plan + climb * climb) as f64).sqrt()))
        })
}

/// Length of the shortest path over 26 neighbours, in voxels.
fn octile(map: &VoxelMap, from: usize, to: usize) -> f64 {
    let (from, to) = (map.nodes()[from], map.nodes()[to]);
    let mut steps =
        [from.column.abs_diff(to.column), from.row.abs_diff(to.row), from.level.abs_diff(to.level)];
    steps.sort_unstable();
    let [least, middle, most] = steps.map(f64::from);
    (3f64.sqrt() * least + 2f64.sqrt() * (middle - least) + (most - middle)) * TIE_BREAK
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::Cloud;
    use crate::testing::field;
    use proptest::prelude::*;

    /// A level map of 10 × 10 columns, without the ground in `holes`.
    fn level(holes: &[(usize, usize)]) -> VoxelMap {
        let cloud = Cloud::new(&field(3.0, |_| 0.0)).unwrap();
        let voxel = |point: usize| ((point as f64 * 0.1 / 0.3 + 1e-9) as usize).min(9);
        let valid: Vec<bool> = (0..cloud.heights_m().len())
            .map(|index| !holes.contains(&(voxel(index % cloud.columns()), voxel(index / cloud.columns()))))
            .collect();
        VoxelMap::new(&cloud, &valid, 0.3)
    }

    fn at(map: &VoxelMap, column: i64, row: i64) -> usize {
        map.nodes_in(column, row).next().unwrap()
    }

    fn even(map: &VoxelMap) -> Prices {
        let count = map.nodes().len();
        Prices { priority: vec![0.0; count], price: vec![1.0; count] }
    }

    fn length(map: &VoxelMap, path: &[usize]) -> f64 {
        let step = |pair: &[usize]| map.centre_m(pair[0]).distance(map.centre_m(pair[1])) / map.voxel_m();
        path.windows(2).map(step).sum()
    }

    #[test]
    fn the_way_on_level_ground_is_the_octile_one() {
        let map = level(&[]);
        let path = search(&map, &even(&map), at(&map, 0, 0), at(&map, 9, 4)).unwrap();
        assert_eq!((path[0], path[path.len() - 1]), (at(&map, 0, 0), at(&map, 9, 4)));
        assert!((length(&map, &path) - (5.0 + 4.0 * 2f64.sqrt())).abs() < 1e-9);
    }

    #[test]
    fn it_goes_around_a_bar_and_not_through_a_whole_one() {
        let bar: Vec<(usize, usize)> = (0..9).map(|row| (5, row)).collect();
        let map = level(&bar);
        let path = search(&map, &even(&map), at(&map, 2, 0), at(&map, 8, 0)).unwrap();
        assert!(path.contains(&at(&map, 5, 9)));
        let whole: Vec<(usize, usize)> = (0..10).map(|row| (5, row)).collect();
        let map = level(&whole);
        assert_eq!(search(&map, &even(&map), at(&map, 2, 0), at(&map, 8, 0)), None);
    }

    #[test]
    fn a_price_is_paid_and_a_priority_is_not() {
        let map = level(&[]);
        let (start, goal) = (at(&map, 0, 5), at(&map, 9, 5));
        // A band across, two columns wide, but for its northern end.
        let mut dear = even(&map);
        let mut late = even(&map);
        for node in (0..8).flat_map(|row| [at(&map, 5, row), at(&map, 6, row)]) {
            dear.price[node] = 100.0;
            late.priority[node] = 100.0;
        }
        let north = |path: &[usize]| path.iter().any(|&node| map.nodes()[node].row >= 8);
        let paid = search(&map, &dear, start, goal).unwrap();
        assert!(north(&paid), "the cheapest path goes around");
        // The priority sends the search around first, and the first path found is taken.
        let first = search(&map, &late, start, goal).unwrap();
        assert!(north(&first) && length(&map, &first) > 9.5);
        // If there is no other path, a priority does not change its length.
        let mut all_late = even(&map);
        all_late.priority.fill(1e5);
        let path = search(&map, &all_late, start, goal).unwrap();
        assert!((length(&map, &path) - 9.0).abs() < 1e-9);
    }

    #[test]
    fn steps_of_one_level_are_climbed_and_of_two_are_not() {
        let stairs = |step_m: f64| {
            let cloud = Cloud::new(&field(3.0, |place| if place.x < 1.5 { 0.0 } else { step_m })).unwrap();
            // The face is no ground.
            let valid: Vec<bool> =
                cloud.heights_m().iter().map(|&height| height < 0.01 || height > step_m - 0.01).collect();
            let map = VoxelMap::new(&cloud, &valid, 0.3);
            search(&map, &even(&map), at(&map, 0, 5), at(&map, 9, 5)).map(|path| path.len())
        };
        assert_eq!(stairs(0.35), Some(10));
        assert_eq!(stairs(0.7), None);
    }

    proptest! {
        #[test]
        fn without_priorities_it_is_as_cheap_as_dijkstra(
            dear in prop::collection::vec(1.0..20.0f64, 100), start in 0..100usize, goal in 0..100usize,
        ) {
            let map = level(&[]);
            let prices = Prices { priority: vec![0.0; 100], price: dear };
            let path = search(&map, &prices, start, goal).unwrap();
            let step = |pair: &[usize]| {
                let length = map.centre_m(pair[0]).distance(map.centre_m(pair[1])) / map.voxel_m();
                length * 0.5 * (prices.price[pair[0]] + prices.price[pair[1]])
            };
            let found: f64 = path.windows(2).map(step).sum();
            // Relaxing every edge as often as there are nodes.
            let mut least = [f64::INFINITY; 100];
            least[start] = 0.0;
            for _ in 0..100 {
                for here in 0..100 {
                    for (there, _) in neighbours(&map, here) {
                        least[there] = least[there].min(least[here] + step(&[here, there]));
                    }
                }
            }
            prop_assert!(found <= least[goal] * 1.001 + 1e-9, "{} is not {}", found, least[goal]);
        }
    }
}
