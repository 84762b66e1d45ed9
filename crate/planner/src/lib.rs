//! Autonomous mapless navigation on uneven terrain: a planner that takes a LiDAR scan, a pose and a goal and gives a
//! subgoal and a velocity command.
//!
//! It implements Jardali, Ali and Liu, "Autonomous Mapless Navigation on Uneven Terrains" (ICRA 2024), called *the paper*
//! throughout. One [`Planner::step`] runs the whole method:
//!
//! 1. [`skyline::occupancy`]: the returns within r_oc = 7 m become an occupancy surface over azimuth and elevation.
//! 2. [`skyline::perception`]: a sparse Gaussian process ([`gp::sparse`]) over it gives a mean and a variance surface.
//! 3. [`skyline::profile`]: the edge of the variance surface is the skyline of the terrain.
//! 4. [`skyline::segments`]: its stretches of one elevation, each with a verdict.
//! 5. [`decision::subgoals`]: places on the segments, in the world frame.
//! 6. [`route::forecast`]: what the best way there, over the ground seen so far, promises.
//! 7. [`decision::cost`]: the cheapest one is chosen.
//! 8. [`control::controller`]: a PID drives to it.
//!
//! The crate does no input or output, reads no clock, starts no thread and draws no random number, and its results have
//! the same bits on every target.
//!
//! ```
//! use glam::{DVec2, DVec3, Vec3};
//! use mapless::{Planner, PlannerConfig, Status, pose::Pose};
//!
//! let mut planner = Planner::new(PlannerConfig::default())?;
//! // Level ground as the sensor sees it, 0.8 m above.
//! let scan: Vec<Vec3> = (0..360)
//!     .flat_map(|degree| [3.0_f32, 3.5, 4.1, 5.0, 6.5].map(|range| (degree as f32, range)))
//!     .map(|(degree, range)| {
//!         let (sin, cos) = degree.to_radians().sin_cos();
//!         Vec3::new(range * cos, range * sin, -0.8)
//!     })
//!     .collect();
//! let pose = Pose { position_m: DVec3::ZERO, roll_rad: 0.0, pitch_rad: 0.0, yaw_rad: 0.0 };
//! let step = planner.step(&scan, &pose, DVec2::new(50.0, 0.0));
//! assert_eq!(step.status, Status::Driving);
//! assert!(step.command.linear_m_s > 0.5);
//! # Ok::<(), mapless::ConfigError>(())
//! ```

pub mod config;
pub mod control;
pub mod decision;
mod goal;
pub mod gp;
pub mod math;
mod planner;
mod pose;
mod robot_model;
pub mod route;
mod sensor_model;
pub mod skyline;
pub mod terrain;
#[cfg(test)]
mod testing;

pub use config::PlannerConfig;
pub use control::controller::Command;
pub use decision::step::{PerceptionOverride, Status, Step, StopReason, TerrainOverride};
pub use goal::Goal;
pub use mapless_parameters::ConfigError;
pub use planner::Planner;
pub use pose::Pose;
pub use robot_model::RobotModel;
pub use route::state_lattice::PathPoint;
pub use sensor_model::SensorModel;
