//! PUTN's global planner: plane-fitting RRT* (Jian et al., "PUTN: A Plane-fitting based Uneven Terrain
//! Navigation Framework", IROS 2022).
//!
//! A node of the tree is a place with the plane through the ground around it ([`plane`]); the cost of a path
//! between two nodes is its length plus a term for planes that are hard to traverse ([`tree`]).
//! [`PutnConfig::default`] has the values of the authors' release; docs/design/baselines.md has the decisions
//! beyond them.

pub mod plane;
pub mod tree;

use glam::DVec2;
use mapless::Pose;
use mapless::RobotModel;
use mapless_world::HeightField;
use mapless_world::random::{key, uniform};

use crate::cloud::{Cloud, MapError};
use crate::route::RoutePlanner;
use plane::{PlaneConfig, fit_plane};
use tree::{Place, Tree};

/// Every parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PutnConfig {
    /// How planes are fitted and rated.
    pub plane: PlaneConfig,
    /// Largest distance by which the tree grows, metres.
    pub step_m: f64,
    /// Nodes are joined to others within this distance, metres.
    pub neighbour_radius_m: f64,
    /// A node this near to the goal may end the path, metres.
    pub goal_radius_m: f64,
    /// Share of the samples that are the goal itself, until there is a path.
    pub goal_bias: f64,
    /// Samples drawn per square metre of the map.
    pub samples_per_m2: f64,
    /// Bounds on the number of samples.
    pub samples: [f64; 2],
}

impl Default for PutnConfig {
    fn default() -> Self {
        Self {
            plane: PlaneConfig::default(),
            step_m: 0.4,
            neighbour_radius_m: 1.0,
            goal_radius_m: 1.0,
            goal_bias: 0.15,
            samples_per_m2: 5.0,
            samples: [5e3, 5e4],
        }
    }
}

/// A map of one terrain, on which trees grow.
#[derive(Clone, Debug)]
pub struct Putn {
    cloud: Cloud,
    config: PutnConfig,
    limits: RobotModel,
    seed: u64,
}

impl Putn {
    /// Maps a terrain for a robot with these limits. The same `seed` gives the same routes.
    ///
    /// # Errors
    /// [`MapError`] for a terrain that is too large.
    pub fn new(
        field: &HeightField,
        config: PutnConfig,
        limits: RobotModel,
        seed: u64,
    ) -> Result<Self, MapError> {
        Ok(Self { cloud: Cloud::new(field)?, config, limits, seed })
    }

    /// The node at a place; `None` off the map and if the plane exceeds the roll limit.
    fn place(&self, plan_m: DVec2) -> Option<Place> {
        let plane = fit_plane(&self.cloud, plan_m, &self.config.plane)?;
        (plane.slope_rad <= self.limits.roll_limit_rad).then(|| Place::on(&plane, &self.config.plane))
    }

    /// The `iteration`-th sample: anywhere, or the goal; once there is a path, within the ellipse of shorter
    /// paths from start to goal.
    fn sample(&self, iteration: u64, from_m: DVec2, to_m: DVec2, length_m: Option<f64>) -> DVec2 {
        let draw = |number: u64| uniform(key(key(self.seed, iteration), number));
        let Some(length_m) = length_m else {
            let anywhere = self.cloud.extent_m() * DVec2::new(draw(1), draw(2));
            return if draw(0) <= self.config.goal_bias { to_m } else { anywhere };
        };
        let along = (to_m - from_m) / 2.0;
        // The release, too, makes the ellipse a metre longer than the path.
        let half_long_m = (length_m + 1.0) / 2.0;
        let half_short_m = (half_long_m * half_long_m - along.length_squared()).max(0.0).sqrt();
        let (sin, cos) = libm::sincos(core::f64::consts::TAU * draw(1));
        let radius = draw(2).sqrt();
        let axis = along.normalize_or(DVec2::X);
        (from_m + to_m) / 2.0
            + axis * (half_long_m * radius * cos)
            + axis.perp() * (half_short_m * radius * sin)
    }
}

impl RoutePlanner for Putn {
    fn route(&self, from: &Pose, to_m: DVec2) -> Option<Vec<DVec2>> {
        let from_m = from.plan_m();
        let config = &self.config;
        let steepest = libm::tan(self.limits.pitch_limit_rad);
        let mut tree = Tree::new(self.place(from_m)?, self.place(to_m)?, config.goal_radius_m);
        let extent_m = self.cloud.extent_m();
        let [fewest, most] = config.samples;
        let samples = (config.samples_per_m2 * extent_m.x * extent_m.y).clamp(fewest, most);
        for iteration in 0..samples as u64 {
            let sample_m = self.sample(iteration, from_m, to_m, tree.length_m());
            let step_m = sample_m - tree.nearest_m(sample_m);
            let new_m = sample_m - step_m + step_m.clamp_length_max(config.step_m);
            if let Some(place) = self.place(new_m) {
                tree.grow(place, config.neighbour_radius_m, |a, b| a.is_joined_to(b, &self.cloud, steepest));
            }
        }
        let mut route_m = tree.path()?;
        route_m[0] = from_m;
        route_m.push(to_m);
        Some(route_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{at, field, undulating, walled};

    const FROM_M: DVec2 = DVec2::new(3.0, 10.0);
    const TO_M: DVec2 = DVec2::new(17.0, 11.0);

    fn putn(height_m: impl Fn(DVec2) -> f64, seed: u64) -> Putn {
        Putn::new(&field(20.0, height_m), PutnConfig::default(), RobotModel::default(), seed).unwrap()
    }

    #[test]
    fn a_route_over_gentle_ground_goes_from_start_to_goal_without_gaps() {
        let route_m = putn(undulating, 1).route(&at(FROM_M), TO_M).unwrap();
        assert_eq!((route_m[0], route_m[route_m.len() - 1]), (FROM_M, TO_M));
        assert!(route_m.windows(2).all(|pair| pair[0].distance(pair[1]) <= 1.5), "{route_m:?}");
    }

    #[test]
    fn the_seed_decides_to_the_last_bit() {
        let route = |seed| putn(undulating, seed).route(&at(FROM_M), TO_M).unwrap();
        assert_eq!(route(3), route(3));
        assert_ne!(route(3), route(4));
    }

    #[test]
    fn a_wall_has_no_route() {
        assert_eq!(putn(walled, 1).route(&at(FROM_M), TO_M), None);
    }

    #[test]
    fn flat_ground_is_preferred_to_a_hill() {
        // A hill of 15° to 20° on the straight line, level ground beside it.
        let hill = |place: DVec2| {
            let off = place - DVec2::new(10.0, 10.5);
            1.2 * libm::exp(-off.length_squared() / 12.0)
        };
        let ground = field(20.0, hill);
        let route_m = putn(hill, 1).route(&at(FROM_M), TO_M).unwrap();
        let highest = route_m.iter().filter_map(|&place| ground.height_m(place)).fold(0.0, f64::max);
        assert!(highest < 0.7, "{highest}");
    }
}
