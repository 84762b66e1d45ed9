//! The oracle: the shortest safe path for a planner that knows the whole ground.
//!
//! It is A* on a lattice of positions and headings: places of a square grid with sixteen headings each. A
//! motion goes straight along a heading, bends into one of the next two to either side, or turns on the spot
//! to the next. Along every motion the robot's attitude on the true ground is checked every 0.125 m and 0.1
//! rad: roll and pitch must stay a margin inside the limits, and the body clear of what stands there. The
//! grid's first axis runs from start to goal, so that both are places of it and the straight line is one of
//! its paths.
//!
//! The cost is the length seen from above, plus 0.1 m for each heading turned on the spot, which avoids
//! needless turns. Between its headings the lattice path zigzags: up to 2.8 % longer than a path over all
//! headings.

mod lattice;
mod motions;
mod planner;
mod safe_poses;
#[cfg(test)]
mod tests;

use lattice::{Lattice, Node};
pub use planner::Oracle;
pub(crate) use safe_poses::SafePoses;

use crate::known_world::KnownWorld;
use glam::DVec2;
use mapless_world::ConfigError;
use pathfinding::directed::astar::astar;

/// Parameters of the oracle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OracleConfig {
    /// Spacing of the places, metres; adjusted by a few per cent so that the goal is one of them.
    pub cell_m: f64,
    /// Roll and pitch stay this much inside the robot's limits, radians.
    pub margin_rad: f64,
    /// Everything keeps this far from what stands on the ground, metres: poses are checked at steps, and no
    /// controller keeps exactly to a path.
    pub clearance_m: f64,
    /// Belly and bumpers keep this far from the ground, metres.
    pub ground_clearance_m: f64,
}

impl Default for OracleConfig {
    fn default() -> Self {
        Self { cell_m: 0.5, margin_rad: 0.08, clearance_m: 0.1, ground_clearance_m: 0.03 }
    }
}

/// A pose seen from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanPose {
    /// Position of the middle of the wheelbase in the world frame, metres.
    pub position_m: DVec2,
    /// Heading, anticlockwise from east, radians.
    pub yaw_rad: f64,
}

/// A path on which every pose is safe.
#[derive(Clone, Debug, PartialEq)]
pub struct OraclePath {
    /// From the start to the goal, at most 0.125 m and 0.1 rad apart.
    pub poses: Vec<PlanPose>,
    /// Length seen from above, metres.
    pub length_m: f64,
}

impl OraclePath {
    /// The positions, each once where the robot turns on the spot.
    pub fn points_m(&self) -> impl Iterator<Item = DVec2> {
        let mut last = None;
        self.poses.iter().map(|pose| pose.position_m).filter(move |&point| last.replace(point) != Some(point))
    }
}

/// Why there is no path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OracleError {
    /// A configuration value is outside its range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Start or goal is off the terrain; the start needs all wheels on it.
    #[error("{what} = ({:.3}, {:.3}) m: expected a place on the terrain, which spans (0, 0) to ({:.3}, {:.3}) m", place_m.x, place_m.y, extent_m.x, extent_m.y)]
    OffTerrain {
        /// `start` or `goal`.
        what: &'static str,
        /// The place.
        place_m: DVec2,
        /// North-east corner of the terrain.
        extent_m: DVec2,
    },
    /// The tilt exceeds what is allowed at the start, or with every heading at the goal.
    #[error("{what} = ({:.3}, {:.3}) m is too steep: expected at most {roll_rad:.3} rad of roll and {pitch_rad:.3} rad of pitch", place_m.x, place_m.y)]
    NotStandable {
        /// `start` or `goal`.
        what: &'static str,
        /// The place.
        place_m: DVec2,
        /// The most roll allowed.
        roll_rad: f64,
        /// The most pitch allowed.
        pitch_rad: f64,
    },
    /// The terrain has more places than the search can hold.
    #[error("{places} places on the terrain at {cell_m} m: expected at most {most}")]
    TooLarge {
        /// Places of the grid.
        places: f64,
        /// Their spacing.
        cell_m: f64,
        /// The most allowed.
        most: usize,
    },
    /// Every path leads over ground that is too steep or off the terrain.
    #[error("no safe path from ({:.3}, {:.3}) to ({:.3}, {:.3}) m", start_m.x, start_m.y, goal_m.x, goal_m.y)]
    NoPath {
        /// The start.
        start_m: DVec2,
        /// The goal.
        goal_m: DVec2,
    },
}

/// The shortest safe path in `world` from a pose to a place. A goal nearer than half a cell counts as
/// reached.
///
/// # Errors
/// [`OracleError`]: no path, start or goal off the terrain or too steep, or a bad configuration.
pub fn shortest_path(
    world: &KnownWorld,
    start: PlanPose,
    goal_m: DVec2,
    config: &OracleConfig,
) -> Result<OraclePath, OracleError> {
    let safe_poses = SafePoses::new(world, config)?;
    safe_poses.search(start, goal_m, config.cell_m)
}

impl SafePoses<'_> {
    /// As [`shortest_path`], on ground that may be searched again.
    pub(crate) fn search(
        &self,
        start: PlanPose,
        goal_m: DVec2,
        cell_m: f64,
    ) -> Result<OraclePath, OracleError> {
        self.check_start(start)?;
        self.check_goal(goal_m)?;
        if start.position_m.distance(goal_m) < cell_m / 2.0 {
            return Ok(OraclePath { poses: vec![start], length_m: 0.0 });
        }
        let mut lattice = Lattice::new(self, start, goal_m, cell_m)?;
        let goal = lattice.goal();
        let found = astar(
            &Node::START,
            |&node| lattice.successors(node),
            |&node| goal.estimate(node),
            |&node| goal.is_at(node),
        );
        let (nodes, _) = found.ok_or(OracleError::NoPath { start_m: start.position_m, goal_m })?;
        let poses = lattice.poses(&nodes);
        let length_m = poses.windows(2).map(|pair| pair[0].position_m.distance(pair[1].position_m)).sum();
        Ok(OraclePath { poses, length_m })
    }
}
