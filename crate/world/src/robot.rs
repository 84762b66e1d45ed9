//! A kinematic differential-drive robot: unicycle motion with limited speeds and accelerations, resting on
//! four wheels.

use crate::attitude::{Attitude, attitude_on, world_from_body};
use crate::ground::Ground;
use crate::motion_config::MotionConfig;
use crate::robot_config::RobotConfig;
use crate::slip::{BodyMotion, body_motion};
use glam::{DVec2, DVec3};
use thiserror::Error;

impl RobotConfig {
    /// World positions of the wheel centres in metres, front left, front right, rear left, rear right, of a
    /// robot at `position` with heading `yaw_rad`.
    #[must_use]
    pub fn wheel_centres(&self, position: DVec2, yaw_rad: f64, attitude: &Attitude) -> [DVec3; 4] {
        let rotation = world_from_body(yaw_rad, attitude);
        [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(ahead, aside)| {
            let body =
                DVec3::new(ahead * self.wheelbase_m / 2.0, aside * self.track_m / 2.0, self.wheel_radius_m);
            position.extend(attitude.height_m) + rotation * body
        })
    }
}

/// The command until the next one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveCommand {
    /// Speed in m/s, positive forward.
    pub speed_m_s: f64,
    /// Turn rate in rad/s, positive to the left.
    pub turn_rate_rad_s: f64,
}

/// The robot's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotState {
    /// Position of the middle of the wheelbase in the world's plan view, in metres.
    pub position: DVec2,
    /// Heading, counter-clockwise from east, in radians; not wrapped, so that turns can be counted.
    pub yaw_rad: f64,
    /// Speed along the body's forward axis, in m/s.
    pub speed_m_s: f64,
    /// Rate of the heading, in rad/s.
    pub turn_rate_rad_s: f64,
    /// Height and tilt.
    pub attitude: Attitude,
}

/// Why the robot could not move. Its state is unchanged.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum DriveError {
    /// A wheel would leave the terrain.
    #[error("a wheel is off the terrain with the robot at ({:.3}, {:.3}) m", position.x, position.y)]
    LeftTerrain {
        /// Where the robot would stand.
        position: DVec2,
    },
    /// A command or time step that is not finite, or a negative time step.
    #[error(
        "speed {speed_m_s} m/s, turn rate {turn_rate_rad_s} rad/s over {dt_s} s: expected finite numbers and time forward"
    )]
    NotFinite {
        /// Speed asked for, in m/s.
        speed_m_s: f64,
        /// Turn rate asked for, in rad/s.
        turn_rate_rad_s: f64,
        /// Time step, in seconds.
        dt_s: f64,
    },
}

/// The robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    config: RobotConfig,
    motion: MotionConfig,
    state: RobotState,
    /// What the wheels do, as the motion of a body that does not slip.
    wheels: DriveCommand,
    /// Speed of the body to its left, in m/s.
    aside_m_s: f64,
}

impl Robot {
    /// Puts a robot at rest on the ground. The configuration must have been validated.
    ///
    /// # Errors
    /// [`DriveError::LeftTerrain`] when a wheel is off the terrain.
    pub fn new(
        config: RobotConfig,
        footing: &impl Ground,
        position: DVec2,
        yaw_rad: f64,
    ) -> Result<Self, DriveError> {
        let attitude =
            attitude_on(footing, position, yaw_rad, &config).ok_or(DriveError::LeftTerrain { position })?;
        let state = RobotState { position, yaw_rad, speed_m_s: 0.0, turn_rate_rad_s: 0.0, attitude };
        let motion = MotionConfig::default();
        Ok(Self { config, motion, state, wheels: DriveCommand::default(), aside_m_s: 0.0 })
    }

    /// The same robot with a drive and a ground that are not ideal. The configuration must have been
    /// validated.
    #[must_use]
    pub fn with_motion(self, motion: MotionConfig) -> Self {
        Self { motion, ..self }
    }

    /// What drive and ground do to a commanded motion.
    #[must_use]
    pub fn motion(&self) -> &MotionConfig {
        &self.motion
    }

    /// What the wheels do, as the motion of a body that does not slip: what wheel odometry measures.
    #[must_use]
    pub fn wheels(&self) -> DriveCommand {
        self.wheels
    }

    /// The robot's dimensions and limits.
    #[must_use]
    pub fn config(&self) -> &RobotConfig {
        &self.config
    }

    /// The present state.
    #[must_use]
    pub fn state(&self) -> &RobotState {
        &self.state
    }

    /// World position of the middle of the contact plane, in metres.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.state.position.extend(self.state.attitude.height_m)
    }

    /// Rests the robot anew on ground that has changed under it.
    ///
    /// # Errors
    /// [`DriveError::LeftTerrain`] when a wheel is off the terrain.
    pub fn settle(&mut self, footing: &impl Ground) -> Result<(), DriveError> {
        self.step(DriveCommand::default(), 0.0, footing)
    }

    /// Takes the state to which something else has moved the robot, and what its wheels do there.
    ///
    /// # Errors
    /// [`DriveError::LeftTerrain`] when a wheel is off the terrain; the robot then stays as it was.
    pub fn move_to(
        &mut self,
        state: RobotState,
        wheels: DriveCommand,
        footing: &impl Ground,
    ) -> Result<(), DriveError> {
        let position = state.position;
        attitude_on(footing, position, state.yaw_rad, &self.config)
            .ok_or(DriveError::LeftTerrain { position })?;
        (self.state, self.wheels, self.aside_m_s) = (state, wheels, 0.0);
        Ok(())
    }

    /// Moves on by `dt_s` seconds: the unicycle of the paper (x' = v cos θ, y' = v sin θ, θ' = ω) along an
    /// exact arc.
    ///
    /// Speed and turn rate approach the command within the limits of speed and acceleration, as the robot's
    /// own drive does with a command beyond them. The speed runs along the body, so a pitched robot covers `v
    /// cos(pitch)` in the plan view; on level ground this is the paper's motion.
    ///
    /// # Errors
    /// [`DriveError`]; the robot then stays as it was.
    pub fn step(
        &mut self,
        command: DriveCommand,
        dt_s: f64,
        footing: &impl Ground,
    ) -> Result<(), DriveError> {
        let DriveCommand { speed_m_s, turn_rate_rad_s } = command;
        if !(speed_m_s.is_finite() && turn_rate_rad_s.is_finite() && dt_s.is_finite() && dt_s >= 0.0) {
            return Err(DriveError::NotFinite { speed_m_s, turn_rate_rad_s, dt_s });
        }
        let (config, state) = (&self.config, &self.state);
        let load = 1.0 + self.motion.payload;
        let wheels = DriveCommand {
            speed_m_s: approach(
                self.wheels.speed_m_s,
                speed_m_s.clamp(-config.max_speed_m_s, config.max_speed_m_s),
                config.max_acceleration_m_s2 / load * dt_s,
            ),
            turn_rate_rad_s: approach(
                self.wheels.turn_rate_rad_s,
                turn_rate_rad_s.clamp(-config.max_turn_rate_rad_s, config.max_turn_rate_rad_s),
                config.max_turn_acceleration_rad_s2 / load * dt_s,
            ),
        };
        let before = BodyMotion {
            velocity_m_s: DVec2::new(state.speed_m_s, self.aside_m_s),
            turn_rate_rad_s: state.turn_rate_rad_s,
        };
        let unslipped = BodyMotion {
            velocity_m_s: DVec2::new(wheels.speed_m_s, 0.0),
            turn_rate_rad_s: wheels.turn_rate_rad_s,
        };
        let after = body_motion(&self.motion, unslipped, &state.attitude, before, dt_s);
        let half_turn = (before.turn_rate_rad_s + after.turn_rate_rad_s) / 4.0 * dt_s;
        let mean_m_s = (before.velocity_m_s + after.velocity_m_s) / 2.0;
        let way = mean_m_s.x * dt_s * libm::cos(state.attitude.pitch_rad);
        let aside = mean_m_s.y * dt_s * libm::cos(state.attitude.roll_rad);
        let (sin, cos) = libm::sincos(state.yaw_rad + half_turn);
        let chord = chord_ratio(half_turn);
        let position =
            state.position + DVec2::new(cos, sin) * (way * chord) + DVec2::new(-sin, cos) * (aside * chord);
        let yaw_rad = state.yaw_rad + 2.0 * half_turn;
        let attitude =
            attitude_on(footing, position, yaw_rad, config).ok_or(DriveError::LeftTerrain { position })?;
        let (speed_m_s, turn_rate_rad_s) = (after.velocity_m_s.x, after.turn_rate_rad_s);
        self.state = RobotState { position, yaw_rad, speed_m_s, turn_rate_rad_s, attitude };
        (self.wheels, self.aside_m_s) = (wheels, after.velocity_m_s.y);
        Ok(())
    }
}

fn approach(value: f64, target: f64, most: f64) -> f64 {
    value + (target - value).clamp(-most, most)
}

/// Chord over arc of a circle for half the turned angle: `sin(x) / x`.
fn chord_ratio(half_turn: f64) -> f64 {
    if half_turn.abs() < 1e-4 { 1.0 - half_turn * half_turn / 6.0 } else { libm::sin(half_turn) / half_turn }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::height_field::HeightField;
    use proptest::prelude::*;

    fn flat() -> HeightField {
        HeightField::new(101, 101, 0.5, vec![0.0; 101 * 101]).unwrap()
    }

    fn drive(husky: &mut Robot, field: &HeightField, speed_m_s: f64, turn_rate_rad_s: f64, seconds: f64) {
        let command = DriveCommand { speed_m_s, turn_rate_rad_s };
        for _ in 0..(seconds / 0.02).round() as usize {
            husky.step(command, 0.02, field).unwrap();
        }
    }

    #[test]
    fn drives_a_circle_of_the_commanded_radius() {
        let field = flat();
        let mut husky = Robot::new(RobotConfig::default(), &field, DVec2::splat(25.0), 0.3).unwrap();
        drive(&mut husky, &field, 0.8, 0.4, 2.0);
        let begin = *husky.state();
        let (sin, cos) = libm::sincos(begin.yaw_rad);
        let centre = begin.position + DVec2::new(-sin, cos) * 2.0;
        for _ in 0..200 {
            drive(&mut husky, &field, 0.8, 0.4, 0.1);
            assert!((husky.state().position.distance(centre) - 2.0).abs() < 1e-9);
        }
    }

    #[test]
    fn accelerates_within_its_limits() {
        let field = flat();
        let mut husky = Robot::new(RobotConfig::default(), &field, DVec2::splat(25.0), 0.0).unwrap();
        let command = DriveCommand { speed_m_s: 9.0, turn_rate_rad_s: -9.0 };
        husky.step(command, 0.1, &field).unwrap();
        assert!((husky.state().speed_m_s - 0.1).abs() < 1e-12);
        assert!((husky.state().turn_rate_rad_s + 0.2).abs() < 1e-12);
        assert!(husky.state().yaw_rad < 0.0, "a negative rate turns right");
        drive(&mut husky, &field, 9.0, -9.0, 2.0);
        assert_eq!((husky.state().speed_m_s, husky.state().turn_rate_rad_s), (1.0, -1.0));
    }

    #[test]
    fn climbs_at_the_speed_of_its_wheels() {
        let heights = (0..101 * 101).map(|i| (i % 101) as f32 * 0.25).collect();
        let field = HeightField::new(101, 101, 0.5, heights).unwrap();
        let mut husky = Robot::new(RobotConfig::default(), &field, DVec2::splat(10.0), 0.0).unwrap();
        drive(&mut husky, &field, 0.5, 0.0, 1.0);
        let before = husky.position();
        drive(&mut husky, &field, 0.5, 0.0, 4.0);
        assert!((husky.position().distance(before) - 2.0).abs() < 1e-6);
        assert!((husky.position().z - before.z) > 0.8);
    }

    #[test]
    fn an_error_leaves_the_robot_as_it_was() {
        let field = flat();
        let mut husky = Robot::new(RobotConfig::default(), &field, DVec2::new(49.5, 25.0), 0.0).unwrap();
        let command = DriveCommand { speed_m_s: 1.0, turn_rate_rad_s: 0.0 };
        let (error, last) = loop {
            let before = husky.clone();
            if let Err(error) = husky.step(command, 0.1, &field) {
                break (error, before);
            }
        };
        assert!(matches!(error, DriveError::LeftTerrain { position } if position.x > 49.7), "{error}");
        assert_eq!(husky, last);
        let nan = DriveCommand { speed_m_s: f64::NAN, turn_rate_rad_s: 0.0 };
        assert!(matches!(husky.step(nan, 0.1, &field), Err(DriveError::NotFinite { .. })));
        assert!(husky.step(command, -0.1, &field).is_err());
        assert!(Robot::new(RobotConfig::default(), &field, DVec2::new(-1.0, 0.0), 0.0).is_err());
    }

    #[test]
    fn wheels_stand_one_radius_above_the_ground() {
        let field = flat();
        let husky = Robot::new(RobotConfig::default(), &field, DVec2::splat(25.0), 1.0).unwrap();
        let state = husky.state();
        let wheels = husky.config().wheel_centres(state.position, state.yaw_rad, &state.attitude);
        assert!(wheels.iter().all(|wheel| (wheel.z - 0.165).abs() < 1e-12));
        assert!((wheels[0].distance(wheels[1]) - 0.571).abs() < 1e-12, "front axle");
        assert!((wheels[0].distance(wheels[2]) - 0.512).abs() < 1e-12, "left side");
    }

    proptest! {
        #[test]
        fn one_long_step_is_many_short_ones(speed_m_s in -1.0..1.0f64, turn_rate_rad_s in -1.0..1.0f64) {
            let field = flat();
            let mut short = Robot::new(RobotConfig::default(), &field, DVec2::splat(25.0), 0.0).unwrap();
            drive(&mut short, &field, speed_m_s, turn_rate_rad_s, 2.0);
            let mut long = short.clone();
            drive(&mut short, &field, speed_m_s, turn_rate_rad_s, 4.0);
            long.step(DriveCommand { speed_m_s, turn_rate_rad_s }, 4.0, &field).unwrap();
            prop_assert!(long.state().position.distance(short.state().position) < 1e-9);
        }
    }
}
