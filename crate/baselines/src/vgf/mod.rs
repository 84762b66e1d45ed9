//! The paper's baseline: the global planner of Wang et al., "Towards Efficient Trajectory Generation for
//! Ground Robots beyond 2D Environment" (ICRA 2023), called VGF there after its *valid ground filter*.
//!
//! 1. [`filter`]: the map's points from which the ground rises too steeply are dropped.
//! 2. [`voxels`]: free voxels over occupied ones are the search space.
//! 3. [`travel`]: a travel cost from the second differences of the surface, spread in the plane.
//! 4. [`mod@search`]: A* over 26 neighbours.
//!
//! [`VgfConfig::published`] has the values of the authors' release. docs/design/baselines.md has the
//! decisions beyond them.

pub mod filter;
pub mod search;
pub mod travel;
pub mod voxels;

use glam::DVec2;
use mapless::Pose;
use mapless_world::HeightField;

use crate::cloud::{Cloud, MapError};
use crate::route::RoutePlanner;
use search::{Prices, search};
use travel::TravelCost;
use voxels::VoxelMap;

/// Every parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VgfConfig {
    /// Side of a voxel, metres.
    pub voxel_m: f64,
    /// Radius of the filter's neighbourhood, metres.
    pub filter_radius_m: f64,
    /// A point is dropped when a neighbour stands above it at more than this.
    pub filter_slope_rad: f64,
    /// The travel cost of a voxel.
    pub travel: TravelCost,
    /// Weight of the travel cost in a voxel's place in the queue.
    pub travel_priority: f64,
    /// Weight of the height in a voxel's place in the queue, per metre.
    pub height_priority: f64,
    /// Cost of a path per unit of travel cost, as a share of its length.
    pub travel_price: f64,
    /// Cost of a path per squared gradient, as a share of its length.
    pub slope_price: f64,
    /// Length of the path over which its points are averaged, metres.
    pub smoothing_m: f64,
}

impl VgfConfig {
    /// The values of the authors' release: the travel cost only orders the queue, slopes cost nothing, the
    /// path is not smoothed.
    #[must_use]
    pub fn published() -> Self {
        Self {
            voxel_m: 0.3,
            filter_radius_m: 0.3,
            filter_slope_rad: 0.4,
            travel: TravelCost { gain_per_m: 40.0, least: 100.0, most: 400.0, spread_m: 2.5, refused: 0.0 },
            travel_priority: 1e4,
            height_priority: 1e5,
            travel_price: 0.0,
            slope_price: 0.0,
            smoothing_m: 0.0,
        }
    }

    /// The same map with the best search found for it: the travel cost is part of the path's cost, slopes
    /// count, ground that the filter refused is kept away from, and the path is smoothed.
    #[must_use]
    pub fn tuned() -> Self {
        let published = Self::published();
        Self {
            travel: TravelCost { refused: 400.0, ..published.travel },
            travel_priority: 0.0,
            height_priority: 0.0,
            travel_price: 0.005,
            slope_price: 20.0,
            smoothing_m: 3.0,
            ..published
        }
    }
}

/// A map of one terrain, ready for searches.
#[derive(Clone, Debug)]
pub struct Vgf {
    voxels: VoxelMap,
    prices: Prices,
    smoothing_m: f64,
}

/// Start and goal are moved to the nearest voxel of the search space within this distance.
const NEAR_M: f64 = 1.0;

impl Vgf {
    /// Maps a terrain.
    ///
    /// # Errors
    /// [`MapError`] for a terrain that is too large.
    pub fn new(field: &HeightField, config: &VgfConfig) -> Result<Self, MapError> {
        let cloud = Cloud::new(field)?;
        let valid = filter::valid_ground(&cloud, config.filter_radius_m, config.filter_slope_rad);
        let voxels = VoxelMap::new(&cloud, &valid, config.voxel_m);
        let travel = config.travel.of_nodes(&voxels);
        let priority = |node: usize| {
            config.travel_priority * travel[node] + config.height_priority * voxels.centre_m(node).z
        };
        let price = |node: usize| {
            let gradient = voxels.gradient(node).length_squared();
            1.0 + config.travel_price * travel[node] + config.slope_price * gradient
        };
        let nodes = 0..voxels.nodes().len();
        let prices =
            Prices { priority: nodes.clone().map(priority).collect(), price: nodes.map(price).collect() };
        Ok(Self { voxels, prices, smoothing_m: config.smoothing_m })
    }
}

impl RoutePlanner for Vgf {
    fn route(&self, from: &Pose, to_m: DVec2) -> Option<Vec<DVec2>> {
        let from_m = from.plan_m();
        let start = self.voxels.nearest(from_m, NEAR_M)?;
        let goal = self.voxels.nearest(to_m, NEAR_M)?;
        let nodes = search(&self.voxels, &self.prices, start, goal)?;
        let mut route_m: Vec<DVec2> =
            nodes.iter().map(|&node| self.voxels.centre_m(node).truncate()).collect();
        route_m[0] = from_m;
        route_m.push(to_m);
        Some(smooth(&route_m, (self.smoothing_m / self.voxels.voxel_m() / 2.0).round() as usize))
    }
}

/// Averages each point with as many on either side; fewer towards the ends, which stay.
fn smooth(route_m: &[DVec2], neighbours: usize) -> Vec<DVec2> {
    let last = route_m.len() - 1;
    (0..=last)
        .map(|index| {
            let reach = neighbours.min(index).min(last - index);
            let around = &route_m[index - reach..=index + reach];
            around.iter().sum::<DVec2>() / around.len() as f64
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{at, field, undulating, walled};

    const FROM_M: DVec2 = DVec2::new(3.0, 10.0);
    const TO_M: DVec2 = DVec2::new(17.0, 11.0);

    #[test]
    fn a_route_over_gentle_ground_goes_from_start_to_goal_without_gaps() {
        for config in [VgfConfig::published(), VgfConfig::tuned()] {
            let route_m =
                Vgf::new(&field(20.0, undulating), &config).unwrap().route(&at(FROM_M), TO_M).unwrap();
            assert_eq!((route_m[0], route_m[route_m.len() - 1]), (FROM_M, TO_M));
            assert!(route_m.windows(2).all(|pair| pair[0].distance(pair[1]) < 0.7), "{route_m:?}");
        }
    }

    #[test]
    fn a_wall_has_no_route() {
        for config in [VgfConfig::published(), VgfConfig::tuned()] {
            assert_eq!(Vgf::new(&field(20.0, walled), &config).unwrap().route(&at(FROM_M), TO_M), None);
        }
    }

    #[test]
    fn the_published_search_goes_low_and_the_tuned_one_keeps_off_slopes() {
        // A hill on the straight line; the ground falls to the north.
        let hill = |place: DVec2| {
            let off = place - DVec2::new(10.0, 10.0);
            1.2 * libm::exp(-off.length_squared() / 6.0) - 0.02 * place.y
        };
        let ground = field(20.0, hill);
        let highest = |config| {
            let route_m = Vgf::new(&ground, &config).unwrap().route(&at(FROM_M), TO_M).unwrap();
            route_m.iter().filter_map(|&place| ground.height_m(place)).fold(f64::MIN, f64::max)
        };
        assert!(highest(VgfConfig::published()) < 0.3);
        assert!(highest(VgfConfig::tuned()) < 0.5);
        assert!(ground.height_m(DVec2::new(10.0, 10.5)).unwrap() > 0.9);
    }

    #[test]
    fn smoothing_keeps_the_ends_and_averages_between() {
        let points = [0.0, 1.0, 0.0, 1.0, 0.0].map(|y| DVec2::new(0.0, y));
        let smoothed = smooth(&points, 1);
        assert_eq!((smoothed[0], smoothed[4]), (points[0], points[4]));
        assert!((smoothed[2].y - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(smooth(&points, 0), points);
        assert_eq!(smooth(&points, 9)[1], smoothed[1]);
    }

    #[test]
    fn the_same_map_gives_the_same_route() {
        let ground = field(20.0, undulating);
        let route = || Vgf::new(&ground, &VgfConfig::published()).unwrap().route(&at(FROM_M), TO_M).unwrap();
        assert_eq!(route(), route());
    }
}
