//! What a drive shows of the robot's motion, measured alike in every world.

use glam::DVec3;
use mapless::Command;
use mapless_trials::Trial;
use mapless_world::{Footing, RobotConfig, attitude_on, world_from_body};

/// Sums and samples over the periods of a trial.
#[derive(Clone, Debug, Default)]
pub(crate) struct Measures {
    commanded_rad: f64,
    turned_rad: f64,
    /// To the robot's side, in either direction, metres.
    aside_m: f64,
    /// Roll and pitch less those of the plane of four contacts, unsigned, radians.
    off_plane_rad: [Vec<f64>; 2],
}

/// Where a robot is at the beginning of a period.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Before {
    position_m: DVec3,
    yaw_rad: f64,
}

impl Before {
    /// Of a trial.
    pub(crate) fn of(trial: &Trial) -> Self {
        let pose = trial.pose();
        Self { position_m: pose.position_m, yaw_rad: pose.yaw_rad }
    }
}

impl Measures {
    /// A period has passed under `command`.
    pub(crate) fn add(&mut self, before: Before, command: Command, trial: &Trial, robot: &RobotConfig) {
        let state = trial.robot();
        let turned_rad = state.yaw_rad - before.yaw_rad;
        self.commanded_rad += command.angular_rad_s.abs() * trial.period_s();
        self.turned_rad += turned_rad.abs();
        let half_way = world_from_body(before.yaw_rad + turned_rad / 2.0, &state.attitude);
        self.aside_m += (trial.pose().position_m - before.position_m).dot(half_way.y_axis).abs();
        let footing = Footing { field: trial.field(), solids: trial.objects().solids() };
        if let Some(plane) = attitude_on(&footing, state.position, state.yaw_rad, robot) {
            let off_rad =
                [state.attitude.roll_rad - plane.roll_rad, state.attitude.pitch_rad - plane.pitch_rad];
            for (all, off_rad) in self.off_plane_rad.iter_mut().zip(off_rad) {
                all.push(off_rad.abs());
            }
        }
    }

    /// The turn in all over the commanded one; 1 if none was commanded.
    pub(crate) fn turn_ratio(&self) -> f64 {
        if self.commanded_rad > 0.0 { self.turned_rad / self.commanded_rad } else { 1.0 }
    }

    /// How far the robot slid to its sides, in all, metres.
    pub(crate) fn aside_m(&self) -> f64 {
        self.aside_m
    }

    /// Roll and pitch less those of the plane of four contacts: what 99 % of the periods do not exceed,
    /// radians.
    pub(crate) fn off_plane_rad(&self) -> [f64; 2] {
        self.off_plane_rad.clone().map(|mut all| {
            all.sort_unstable_by(f64::total_cmp);
            all.get((all.len() * 99 / 100).min(all.len().saturating_sub(1))).copied().unwrap_or_default()
        })
    }
}
