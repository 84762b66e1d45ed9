//! Motion compensation: the points of a sweep as a sensor sees them that stands still at one instant.

use core::time::Duration;

use glam::{DMat3, DVec3, Vec3};
use mapless::{Pose, SensorModel};

use crate::estimator::Trajectory;

/// The motion is sampled this often, and is even in between.
const STEP_S: f64 = 0.002;
/// Points that were measured farther from the instant belong to no sweep.
const LONGEST_S: f64 = 1.0;

/// Why points could not be corrected.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DeskewError {
    /// As many times as points are needed.
    #[error("{times} times: expected one for each of {points} points")]
    Times {
        /// Number of points.
        points: usize,
        /// Number of times.
        times: usize,
    },
    /// The trajectory does not reach over the sweep.
    #[error("no pose is known {at_s:.3} s from the instant of the scan: expected odometry and IMU then")]
    Trajectory {
        /// The time without a pose, seconds from the instant.
        at_s: f64,
    },
    /// A point's time is too far away, or not a number.
    #[error("a point was measured {at_s:.3} s from the instant of the scan: expected a sweep within 1 s")]
    Sweep {
        /// The time, seconds from the instant.
        at_s: f64,
    },
}

/// Moves points in the sensor's frame, each measured at its time in seconds from `instant`, to where the
/// sensor would have them at `instant`; the robot's pose at that time, for [`mapless::Planner::step`].
///
/// `instant` is usually the end of the sweep. On an error no point is moved.
///
/// # Errors
/// [`DeskewError`] for a time without a pose, or one that belongs to no sweep.
pub fn deskew(
    points_m: &mut [Vec3],
    times_s: &[f64],
    instant: Duration,
    trajectory: &Trajectory,
    sensor: &SensorModel,
) -> Result<Pose, DeskewError> {
    if points_m.len() != times_s.len() {
        return Err(DeskewError::Times { points: points_m.len(), times: times_s.len() });
    }
    if let Some(&at_s) = times_s.iter().find(|time_s| time_s.is_nan() || time_s.abs() > LONGEST_S) {
        return Err(DeskewError::Sweep { at_s });
    }
    let place = |at_s: f64| {
        let pose = pose_at(trajectory, instant, at_s).ok_or(DeskewError::Trajectory { at_s })?;
        Ok((pose, SensorPlace::of(&pose, sensor)))
    };
    let (pose, now) = place(0.0)?;
    let first_s = times_s.iter().copied().fold(0.0, f64::min);
    let last_s = times_s.iter().copied().fold(0.0, f64::max);
    let steps = ((last_s - first_s) / STEP_S).ceil();
    let step_s = (last_s - first_s) / steps.max(1.0);
    let motions: Vec<Motion> = (0..=steps as usize)
        .map(|step| Ok(Motion::between(&place((first_s + step as f64 * step_s).min(last_s))?.1, &now)))
        .collect::<Result<_, _>>()?;
    for (point_m, time_s) in points_m.iter_mut().zip(times_s) {
        let step = if step_s > 0.0 { (time_s - first_s) / step_s } else { 0.0 };
        let index = (step as usize).min(motions.len().saturating_sub(2));
        let next = &motions[(index + 1).min(motions.len() - 1)];
        let (from, to) = (motions[index].moved(*point_m), next.moved(*point_m));
        *point_m = (from + (step - index as f64) * (to - from)).as_vec3();
    }
    Ok(pose)
}

fn pose_at(trajectory: &Trajectory, instant: Duration, at_s: f64) -> Option<Pose> {
    let offset = Duration::from_secs_f64(at_s.abs());
    trajectory.pose_at(if at_s < 0.0 { instant.checked_sub(offset)? } else { instant.checked_add(offset)? })
}

/// Where the sensor is in the world.
struct SensorPlace {
    position_m: DVec3,
    world_from_sensor: DMat3,
}

impl SensorPlace {
    fn of(pose: &Pose, sensor: &SensorModel) -> Self {
        let world_from_robot = pose.world_from_robot();
        Self {
            position_m: pose.position_m + world_from_robot * sensor.offset_m(),
            world_from_sensor: world_from_robot * sensor.robot_from_sensor().unwrap_or(DMat3::IDENTITY),
        }
    }
}

/// Takes points from the sensor's frame at one time to that at another.
struct Motion {
    turn: DMat3,
    shift_m: DVec3,
}

impl Motion {
    fn between(from: &SensorPlace, to: &SensorPlace) -> Self {
        let to_from_world = to.world_from_sensor.transpose();
        Self {
            turn: to_from_world * from.world_from_sensor,
            shift_m: to_from_world * (from.position_m - to.position_m),
        }
    }

    fn moved(&self, point_m: Vec3) -> DVec3 {
        self.turn * point_m.as_dvec3() + self.shift_m
    }
}
