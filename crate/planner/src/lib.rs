//! Autonomous mapless navigation on uneven terrain: a planner that takes a LiDAR scan and a pose and gives a
//! subgoal and a velocity command.
//!
//! It implements Jardali, Ali and Liu, "Autonomous Mapless Navigation on Uneven Terrains" (ICRA 2024), called
//! *the paper* throughout. There is no global map: the planner keeps a local elevation window.
//!
//! # Use
//!
//! ```
//! use core::time::Duration;
//! use mapless::glam::{DQuat, DVec2, DVec3, Vec3};
//! use mapless::{Goal, Planner, PlannerConfig, Pose, RobotModel, SensorModel, Status};
//!
//! // Once: what sensor, what robot, where to.
//! let config = PlannerConfig::for_robot(SensorModel::vlp16(), RobotModel::husky());
//! let mut planner = Planner::new(config)?;
//! planner.set_goal(Goal::at(DVec2::new(50.0, 0.0)).within(0.5));
//!
//! // With each scan: here level ground as a sensor 0.8 m up sees it.
//! let points_m: Vec<Vec3> = (0..360)
//!     .flat_map(|degree| [3.0_f32, 3.5, 4.1, 5.0, 6.5].map(|range_m| (degree as f32, range_m)))
//!     .map(|(degree, range_m)| {
//!         let (sin, cos) = degree.to_radians().sin_cos();
//!         Vec3::new(range_m * cos, range_m * sin, -0.8)
//!     })
//!     .collect();
//! let pose = Pose::from_quaternion(DVec3::ZERO, DQuat::IDENTITY);
//! let step = planner.step(&points_m, &pose, Duration::from_millis(100));
//!
//! match step.status {
//!     Status::Driving | Status::Backtracking | Status::Searching => {
//!         assert!(step.command.linear_m_s > 0.0); // send it to the robot
//!     }
//!     Status::Arrived => {}
//!     Status::Stopped(reason) => panic!("{reason}"),
//! }
//! # Ok::<(), mapless::ConfigError>(())
//! ```
//!
//! Another sensor or robot starts from one that is known, and its fields are set. A struct expression does
//! not compile outside this crate, because later versions may add fields.
//!
//! ```
//! # use mapless::{Planner, PlannerConfig, RobotModel, SensorModel};
//! let mut sensor = SensorModel::vlp16();
//! sensor.rings = 32;
//! sensor.lowest_elevation_rad = -25_f64.to_radians();
//! sensor.highest_elevation_rad = 15_f64.to_radians();
//! sensor.height_m = 1.1;
//! sensor.pitch_rad = -5_f64.to_radians(); // mounted nose-down
//! let planner = Planner::new(PlannerConfig::for_robot(sensor, RobotModel::husky()))?;
//! # Ok::<(), mapless::ConfigError>(())
//! ```
//!
//! # What it takes
//!
//! | | type | unit and frame |
//! |---|---|---|
//! | scan | `&[glam::Vec3]` | metres, sensor frame; any order; points that are not finite are skipped |
//! | pose | [`Pose`] | of the robot frame in the world frame, at the time of the scan |
//! | time | [`Duration`](core::time::Duration) | since the step before |
//! | goal | [`Goal`] | metres, world frame; tolerance and final heading if wanted |
//! | sensor | [`SensorModel`] | rings, field of view, range and mount |
//! | robot | [`RobotModel`] | dimensions and tilt limits |
//!
//! - **Frames.** World: x east, y north, z up. Robot: x forward, y left, z up, its origin **on the ground
//!   midway between the wheels**, not at `base_link` ([`Pose::moved`] shifts a pose). Sensor:
//!   [`SensorModel`].
//! - **Pitch is nose-up positive**, unlike in ROS. [`Pose::from_quaternion`] and [`Pose::from_ros_rpy`]
//!   convert.
//! - **Roll and pitch must be measured.** A filter in two-dimensional mode leaves them out: take them from an
//!   IMU.
//! - **Which instant.** All points of a scan are placed with the one pose: the pose of the instant to which
//!   the scan was corrected for motion or, without correction, of the middle of the sweep. Correction is
//!   better and was not needed at 0.8 m/s. Some 0.2 s from scan to command were borne in a physics engine.
//! - **Time** is what passed, never a count of steps: add the time of scans that were lost.
//! - **Cropping.** Returns beyond [`Planner::sight_m`] change nothing and may be left out, as long as one
//!   return is left: a scan without any stops the planner, because the sensor may be blind.
//! - **A jump of the localisation** is told by [`Planner::relocalise`]; without it the remembered ground
//!   tears.
//! - **Returns on the robot itself** are told by its outline ([`RobotModel`]), and stray returns of rain and
//!   dust by what stands around them; [`Step::return_kinds`] says what each point was taken for.
//!
//! # What it gives, and what the base must do
//!
//! [`Step`] holds the [`Status`], the [`Command`] (forward speed and turn rate) and everything that was seen
//! and decided. The base must follow the commanded turn rate in closed loop (a skid-steered base turns up to
//! half too fast or too slow on side slopes), ramp its speeds, keep traction, hold on a slope at zero
//! command, and stop when commands cease. The planner gives up where it gets nowhere, but not where it
//! searches far and wide: set a time limit of your own.
//!
//! # How it works
//!
//! 1. [`skyline::scan_filter`]: the robot's own body, stray returns and things overhead are sorted out.
//! 2. [`skyline::occupancy`]: the returns within r_oc = 7 m become an occupancy surface over azimuth and
//!    elevation.
//! 3. [`skyline::perception`]: a sparse Gaussian process ([`gp::sparse`]) over it gives a mean and a variance
//!    surface.
//! 4. [`skyline::profile`]: the edge of the variance surface is the skyline of the terrain.
//! 5. [`skyline::segments`]: the level stretches of the skyline, each with a verdict.
//! 6. [`decision::subgoals`]: subgoals on the segments, in the world frame.
//! 7. [`route::forecast`]: the tilt to expect on the best path there, over the ground seen so far.
//! 8. [`decision::cost`]: the cheapest subgoal is chosen.
//! 9. The best trajectory of the next two seconds along the path is driven; with the paper's configuration,
//!    [`control::controller`], a PID controller.
//!
//! Every parameter is in [`config`]. A step costs time O(cells + m³) in the m inducing inputs of a sector of
//! the Gaussian process; after the first steps it allocates nothing.
//!
//! # Guarantees
//!
//! The crate does no input or output, reads no clock, starts no thread and draws no random number. Results
//! have the same bits on every target. It never panics on input: its answer to what it does not understand is
//! [`Status::Stopped`] with a [`StopReason`].
//!
//! # Features
//!
//! - `serde`: configurations can be read and written.

pub mod config;
pub mod control;
pub mod decision;
mod for_robot;
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
pub use decision::step::{Status, Step, StopReason};
pub use glam;
pub use goal::Goal;
pub use mapless_parameters::ConfigError;
pub use planner::Planner;
pub use pose::Pose;
pub use robot_model::RobotModel;
pub use sensor_model::SensorModel;
