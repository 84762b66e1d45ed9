//! The paper's PID controller: one loop for the distance to the target, one for the yaw error α_g*.

use crate::config::{ControllerConfig, PidGains};
use core::time::Duration;

use crate::math::angle::wrap_rad;

/// A turn on the spot is never slowed to less than this share.
const LEAST_TURN_SHARE: f64 = 0.4;

/// A velocity command for a differential-drive robot: the paper's u = (v, ω).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Forward speed.
    pub linear_m_s: f64,
    /// Anticlockwise turn rate.
    pub angular_rad_s: f64,
}

impl Command {
    /// Standing still.
    pub const STOP: Self = Self { linear_m_s: 0.0, angular_rad_s: 0.0 };
}

#[derive(Clone, Copy, Debug, Default)]
struct Pid {
    integral: f64,
    last_error: Option<f64>,
}

impl Pid {
    fn update(&mut self, error: f64, gains: &PidGains, elapsed: Duration, most: f64) -> f64 {
        let elapsed_s = elapsed.as_secs_f64();
        let rate = self.last_error.filter(|_| elapsed_s > 0.0).map_or(0.0, |last| (error - last) / elapsed_s);
        self.last_error = Some(error);
        let wanted = gains.proportional * error
            + gains.integral * (self.integral + error * elapsed_s)
            + gains.derivative * rate;
        // The integral is held while the output is saturated (anti-windup).
        if wanted.abs() < most {
            self.integral += error * elapsed_s;
        }
        wanted.clamp(-most, most)
    }
}

/// The two loops. The baselines drive through them too.
#[derive(Clone, Debug)]
pub struct Controller {
    config: ControllerConfig,
    distance: Pid,
    yaw: Pid,
}

impl Controller {
    /// Both loops at rest. The configuration must have been validated.
    pub fn new(config: ControllerConfig) -> Self {
        Self { config, distance: Pid::default(), yaw: Pid::default() }
    }

    /// Forgets the last errors and their integrals, as after a stop.
    pub fn reset(&mut self) {
        self.distance = Pid::default();
        self.yaw = Pid::default();
    }

    /// Drives towards a point at `distance_m` and `bearing_rad` in the robot frame; rotates in place first if
    /// the bearing is large. `elapsed` is the time since the last call.
    pub fn drive(&mut self, distance_m: f64, bearing_rad: f64, elapsed: Duration) -> Command {
        let config = &self.config;
        let bearing = wrap_rad(bearing_rad);
        let turning = self.yaw.update(bearing, &config.yaw, elapsed, config.max_turn_rate_rad_s);
        let forward = self.distance.update(distance_m, &config.distance, elapsed, config.max_speed_m_s);
        let ahead = if bearing.abs() > config.rotate_in_place_rad { 0.0 } else { libm::cos(bearing) };
        Command { linear_m_s: forward.max(0.0) * ahead, angular_rad_s: turning }
    }

    /// Drives a distance along an arc of curvature `turn_rad_m` (anticlockwise turn per metre), in reverse if
    /// `reverse`; no faster than in reverse, as the arc follows a trail.
    pub(crate) fn drive_arc(
        &mut self,
        distance_m: f64,
        turn_rad_m: f64,
        reverse: bool,
        elapsed: Duration,
    ) -> Command {
        let forward = self.drive(distance_m, 0.0, elapsed).linear_m_s;
        let most_m_s = self.config.max_turn_rate_rad_s / turn_rad_m.abs();
        let speed_m_s = forward.min(most_m_s).min(self.config.reverse_m_s());
        let linear_m_s = if reverse { -speed_m_s } else { speed_m_s };
        Command { linear_m_s, angular_rad_s: speed_m_s * turn_rad_m }
    }

    /// The command with its speed regulated by the tilt utilisation `share`. A turn on the spot hardly moves
    /// the wheels' contact points, so it is slowed less.
    pub(crate) fn regulated(&self, command: Command, share: f64) -> Command {
        let kept = self.config.speed_share(share);
        let in_place = command.linear_m_s == 0.0;
        let speed = if in_place { kept.max(LEAST_TURN_SHARE) } else { kept };
        Command { linear_m_s: speed * command.linear_m_s, angular_rad_s: speed * command.angular_rad_s }
    }

    /// Turns on the spot at the configured rate (spin recovery).
    pub fn spin(&mut self) -> Command {
        self.reset();
        Command { linear_m_s: 0.0, angular_rad_s: self.config.spin_turn_rate_rad_s }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_the_limits_a_drive_is_slowed_more_than_a_turn_in_place() {
        let controller = Controller::new(ControllerConfig::default());
        let ControllerConfig { regulate_from_utilisation, min_speed_share, .. } = controller.config;
        let drive = Command { linear_m_s: 0.8, angular_rad_s: 0.5 };
        let turn = Command { linear_m_s: 0.0, angular_rad_s: 1.0 };
        for (command, least_share) in [(drive, min_speed_share), (turn, LEAST_TURN_SHARE)] {
            assert_eq!(controller.regulated(command, regulate_from_utilisation), command);
            let slowest = controller.regulated(command, 1.5);
            assert!((slowest.linear_m_s - least_share * command.linear_m_s).abs() < 1e-12);
            assert!((slowest.angular_rad_s - least_share * command.angular_rad_s).abs() < 1e-12);
        }
    }
}
