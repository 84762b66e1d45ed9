//! The tree of RRT*.

use glam::{DVec2, DVec3};
use rstar::RTree;
use rstar::primitives::GeomWithData;

use super::plane::{FittedPlane, PlaneConfig};
use crate::cloud::Cloud;

/// A place for the robot's centre, over the plane around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    centre_m: DVec3,
    ground_m: DVec3,
    normal: DVec3,
    traversability: f64,
}

/// The body must be free of ground this far to either side of the centre's path and below it.
const HALF_WIDTH_M: f64 = 0.3;
const HALF_HEIGHT_M: f64 = 0.2;
/// Spacing of the places that are checked along a path.
const CHECK_M: f64 = 0.1;

impl Place {
    pub(crate) fn on(plane: &FittedPlane, config: &PlaneConfig) -> Self {
        Self {
            centre_m: plane.place_m + plane.normal * config.centre_height_m,
            ground_m: plane.place_m,
            normal: plane.normal,
            traversability: plane.traversability(config),
        }
    }

    /// The cost of a straight path: its length, and more if traversability is near 1.
    #[must_use]
    pub fn price_to(&self, other: &Self) -> f64 {
        let hard = |place: &Self| 1.0 / (1.0001 - place.traversability);
        self.centre_m.distance(other.centre_m) * (1.0 + 0.1 * (hard(self) + hard(other)))
    }

    /// Whether the straight path is free of ground and no steeper than the gradient `steepest`.
    #[must_use]
    pub fn is_joined_to(&self, other: &Self, cloud: &Cloud, steepest: f64) -> bool {
        let rise_m = other.ground_m - self.ground_m;
        if rise_m.z.abs() > steepest * rise_m.truncate().length() {
            return false;
        }
        let along = other.centre_m - self.centre_m;
        let steps = (along.length() / CHECK_M).ceil().max(1.0);
        let aside = DVec2::new(-along.y, along.x).normalize_or(DVec2::ZERO) * HALF_WIDTH_M;
        (0..=steps as usize).all(|step| {
            let share = step as f64 / steps;
            let up = self.normal.lerp(other.normal, share);
            let lowest_m = self.centre_m + along * share - up * HALF_HEIGHT_M;
            // Sideways the body follows the plane.
            [-1.0, 0.0, 1.0].into_iter().all(|side| {
                let offset = aside * side;
                let height_m = lowest_m.z - up.truncate().dot(offset) / up.z;
                let (column, row) = cloud.nearest(lowest_m.truncate() + offset);
                cloud.height_m(column, row).is_some_and(|ground_m| ground_m < height_m)
            })
        })
    }
}

#[derive(Clone, Debug)]
struct Node {
    place: Place,
    parent: Option<usize>,
    children: Vec<usize>,
    price: f64,
}

/// The tree, from the start on.
#[derive(Clone, Debug)]
pub struct Tree {
    nodes: Vec<Node>,
    index: RTree<GeomWithData<[f64; 2], usize>>,
    goal: Place,
    goal_radius_m: f64,
    /// Nodes from which the goal can be reached straight, and the cost of that.
    last: Vec<(usize, f64)>,
    /// Length of the best path when its cost was last improved.
    length_m: Option<f64>,
    best_price: f64,
}

impl Tree {
    /// A tree that is its root.
    #[must_use]
    pub fn new(start: Place, goal: Place, goal_radius_m: f64) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            index: RTree::new(),
            goal,
            goal_radius_m,
            last: Vec::new(),
            length_m: None,
            best_price: f64::INFINITY,
        };
        tree.add(Node { place: start, parent: None, children: Vec::new(), price: 0.0 });
        tree
    }

    /// The node nearest to a place seen from above.
    #[must_use]
    pub fn nearest_m(&self, plan_m: DVec2) -> DVec2 {
        let nearest = self.index.nearest_neighbor(&plan_m.to_array());
        nearest.map_or(plan_m, |found| DVec2::from(*found.geom()))
    }

    /// Length of the best path found; `None` while there is none.
    #[must_use]
    pub fn length_m(&self) -> Option<f64> {
        self.length_m
    }

    /// Adds a place below the neighbour that makes it cheapest, and makes it the parent of neighbours that
    /// become cheaper by that. A place that can be joined to no neighbour is left out.
    pub fn grow(&mut self, place: Place, radius_m: f64, joined: impl Fn(&Place, &Place) -> bool) {
        let around =
            self.index.locate_within_distance(place.centre_m.truncate().to_array(), radius_m * radius_m);
        let near = |node: &usize| self.nodes[*node].place.centre_m.distance(place.centre_m) < radius_m;
        let mut neighbours: Vec<(usize, f64)> = around
            .map(|found| found.data)
            .filter(near)
            .map(|node| (node, self.nodes[node].place.price_to(&place)))
            .collect();
        // Cheapest first, so that the ground between is checked only if it decides something.
        let through = |&(node, step): &(usize, f64)| self.nodes[node].price + step;
        neighbours.sort_unstable_by(|a, b| through(a).total_cmp(&through(b)).then(a.0.cmp(&b.0)));
        let parent = neighbours.iter().find(|(node, _)| joined(&self.nodes[*node].place, &place));
        let Some(&(parent, step)) = parent else { return };
        let price = self.nodes[parent].price + step;
        let new = self.add(Node { place, parent: Some(parent), children: Vec::new(), price });
        self.nodes[parent].children.push(new);
        for (node, step) in neighbours {
            if price + step < self.nodes[node].price && joined(&place, &self.nodes[node].place) {
                self.rewire(node, new, price + step);
            }
        }
        if place.centre_m.distance(self.goal.centre_m) < self.goal_radius_m && joined(&place, &self.goal) {
            self.last.push((new, place.price_to(&self.goal)));
        }
        self.better();
    }

    /// The places of the cheapest path found, seen from above, without the goal.
    #[must_use]
    pub fn path(&self) -> Option<Vec<DVec2>> {
        let mut node = Some(self.best()?.0);
        let mut path_m = Vec::new();
        while let Some(here) = node {
            path_m.push(self.nodes[here].place.ground_m.truncate());
            node = self.nodes[here].parent;
        }
        path_m.reverse();
        Some(path_m)
    }

    fn add(&mut self, node: Node) -> usize {
        let new = self.nodes.len();
        self.index.insert(GeomWithData::new(node.place.centre_m.truncate().to_array(), new));
        self.nodes.push(node);
        new
    }

    fn rewire(&mut self, node: usize, parent: usize, price: f64) {
        if let Some(old) = self.nodes[node].parent.replace(parent) {
            self.nodes[old].children.retain(|&child| child != node);
        }
        self.nodes[parent].children.push(node);
        let saved = self.nodes[node].price - price;
        let mut below = vec![node];
        while let Some(here) = below.pop() {
            self.nodes[here].price -= saved;
            below.extend_from_slice(&self.nodes[here].children);
        }
    }

    fn best(&self) -> Option<(usize, f64)> {
        let price = |&(node, step): &(usize, f64)| (node, self.nodes[node].price + step);
        self.last.iter().map(price).min_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn better(&mut self) {
        let Some((node, price)) = self.best() else { return };
        if price < self.best_price {
            self.best_price = price;
            let (mut here, mut length_m) =
                (node, self.nodes[node].place.centre_m.distance(self.goal.centre_m));
            while let Some(parent) = self.nodes[here].parent {
                length_m += self.nodes[here].place.centre_m.distance(self.nodes[parent].place.centre_m);
                here = parent;
            }
            self.length_m = Some(length_m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::field;

    fn place(x: f64, y: f64, traversability: f64) -> Place {
        let ground_m = DVec3::new(x, y, 0.0);
        Place { centre_m: ground_m + DVec3::Z * 0.7, ground_m, normal: DVec3::Z, traversability }
    }

    #[test]
    fn the_price_by_hand() {
        // 2 · (1 + 0.1 · (1 / 1.0001 + 1 / 0.5001)).
        let price = place(0.0, 0.0, 0.0).price_to(&place(2.0, 0.0, 0.5));
        assert!((price - 2.0 * (1.0 + 0.1 * (1.0 / 1.0001 + 1.0 / 0.5001))).abs() < 1e-12);
        assert!(place(0.0, 0.0, 1.0).price_to(&place(1.0, 0.0, 0.0)) > 1000.0);
    }

    #[test]
    fn ground_in_the_way_and_steep_steps_part_places() {
        let cloud = Cloud::new(&field(6.0, |place| if place.y > 3.0 { 0.6 } else { 0.0 })).unwrap();
        let joined = |a: Place, b: Place| a.is_joined_to(&b, &cloud, 1.0);
        assert!(joined(place(1.0, 1.0, 0.0), place(1.9, 1.0, 0.0)));
        assert!(!joined(place(1.0, 2.6, 0.0), place(1.0, 3.5, 0.0)), "into the step");
        let above = |y| {
            let mut above = place(1.0, y, 0.0);
            above.ground_m.z += 0.6;
            above.centre_m.z += 0.6;
            above
        };
        assert!(!joined(place(1.0, 2.9, 0.0), above(3.3)), "up steeper than 45°");
        assert!(joined(above(4.0), above(4.5)));
        assert!(!joined(place(1.0, 0.1, 0.0), place(1.5, 0.1, 0.0)), "partly off the map");
    }

    #[test]
    fn the_tree_takes_the_cheaper_parent_and_rewires() {
        let mut tree = Tree::new(place(0.0, 0.0, 0.0), place(4.0, 0.0, 0.0), 1.0);
        let free = |_: &Place, _: &Place| true;
        // A detour first, whose far end is then joined straight.
        tree.grow(place(0.0, 0.9, 0.0), 1.0, free);
        tree.grow(place(0.6, 0.7, 0.0), 1.0, free);
        tree.grow(place(1.2, 0.3, 0.0), 1.0, free);
        let before = tree.nodes[3].price;
        tree.grow(place(0.7, 0.1, 0.0), 1.0, free);
        assert_eq!(tree.nodes[3].parent, Some(4));
        assert!(tree.nodes[3].price < before);
        let expected = tree.nodes[4].price + tree.nodes[4].place.price_to(&tree.nodes[3].place);
        assert!((tree.nodes[3].price - expected).abs() < 1e-12);
        // Too far from everything, and refused.
        tree.grow(place(9.0, 9.0, 0.0), 1.0, free);
        tree.grow(place(1.0, 0.0, 0.0), 1.0, |_, _| false);
        assert_eq!(tree.nodes.len(), 5);
        assert_eq!((tree.path(), tree.length_m()), (None, None));
        tree.grow(place(2.1, 0.2, 0.0), 1.0, free);
        tree.grow(place(3.05, 0.2, 0.0), 1.0, free);
        let path = tree.path().unwrap();
        assert_eq!((path[0], path[path.len() - 1]), (DVec2::ZERO, DVec2::new(3.05, 0.2)));
        assert!((tree.length_m().unwrap() - 4.1).abs() < 0.3);
    }

    #[test]
    fn prices_below_a_rewired_node_follow() {
        let mut tree = Tree::new(place(0.0, 0.0, 0.0), place(9.0, 0.0, 0.0), 1.0);
        let free = |_: &Place, _: &Place| true;
        for (x, y) in [(0.0, 0.9), (0.8, 0.9), (1.2, 0.4), (2.0, 0.4), (2.8, 0.4), (0.7, 0.2)] {
            tree.grow(place(x, y, 0.0), 1.0, free);
        }
        for node in &tree.nodes {
            let Some(parent) = node.parent else { continue };
            let parent = &tree.nodes[parent];
            assert!((node.price - parent.price - parent.place.price_to(&node.place)).abs() < 1e-12);
        }
    }
}
