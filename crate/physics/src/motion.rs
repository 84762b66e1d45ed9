//! The robot's motion by the physics engine, as a trial takes it.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use mapless_trials::Moved;
use mapless_world::{Attitude, RobotState, world_from_body};

use crate::engine::State;

/// A robot is judged by its tilt below this frequency: the shaking of tyres does not turn it over.
const JUDGED_BELOW_HZ: f64 = 5.0;

/// Follows the states of the engine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    last: State,
    judged: Attitude,
}

impl Motion {
    /// Of a robot at rest.
    pub(crate) fn new(rest: State) -> Self {
        Self { last: rest, judged: attitude(&rest) }
    }

    /// The robot has come to `state` in `dt_s` seconds. Speed and turn rate are means over that time.
    pub(crate) fn moved(&mut self, state: State, dt_s: f64) -> Moved {
        let now = attitude(&state);
        let share = 1.0 - libm::exp(-2.0 * PI * JUDGED_BELOW_HZ * dt_s);
        let toward = |from: f64, to: f64| from + (to - from) * share;
        self.judged = Attitude {
            height_m: now.height_m,
            roll_rad: toward(self.judged.roll_rad, now.roll_rad),
            pitch_rad: toward(self.judged.pitch_rad, now.pitch_rad),
        };
        let way_m: DVec3 = state.position_m - self.last.position_m;
        let forward = world_from_body(state.yaw_rad, &now).x_axis;
        let turned_rad = state.yaw_rad - self.last.yaw_rad;
        self.last = state;
        Moved {
            state: RobotState {
                position: DVec2::new(state.position_m.x, state.position_m.y),
                yaw_rad: state.yaw_rad,
                speed_m_s: way_m.dot(forward) / dt_s,
                turn_rate_rad_s: turned_rad / dt_s,
                attitude: now,
            },
            wheels: state.wheels,
            judged: self.judged,
        }
    }
}

fn attitude(state: &State) -> Attitude {
    Attitude { height_m: state.position_m.z, roll_rad: state.roll_rad, pitch_rad: state.pitch_rad }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless_world::DriveCommand;

    fn at(x_m: f64, pitch_rad: f64, yaw_rad: f64) -> State {
        State {
            position_m: DVec3::new(x_m, 2.0, 3.0),
            roll_rad: -0.1,
            pitch_rad,
            yaw_rad,
            wheels: DriveCommand { speed_m_s: 0.7, turn_rate_rad_s: 0.2 },
            body_touches: false,
        }
    }

    #[test]
    fn speeds_are_those_of_the_poses_and_the_pose_is_the_engines() {
        let mut motion = Motion::new(at(1.0, 0.0, 6.0));
        let moved = motion.moved(at(1.01, 0.0, 6.02), 0.01);
        let state = moved.state;
        assert_eq!((state.position, state.yaw_rad), (DVec2::new(1.01, 2.0), 6.02));
        assert!((state.speed_m_s - libm::cos(6.02)).abs() < 1e-9, "{}", state.speed_m_s);
        assert!((state.turn_rate_rad_s - 2.0).abs() < 1e-9);
        assert_eq!((state.attitude.height_m, state.attitude.roll_rad), (3.0, -0.1));
        assert!((moved.wheels.speed_m_s - 0.7).abs() < 1e-12);
    }

    #[test]
    fn the_judged_tilt_follows_in_a_fifth_of_a_second_and_ignores_an_instant() {
        let mut motion = Motion::new(at(0.0, 0.0, 0.0));
        assert!(motion.moved(at(0.0, 0.3, 0.0), 0.01).judged.pitch_rad < 0.09);
        let settled = (0..20).map(|_| motion.moved(at(0.0, 0.3, 0.0), 0.01).judged.pitch_rad).last();
        assert!((settled.unwrap() - 0.3).abs() < 1e-3);
    }
}
