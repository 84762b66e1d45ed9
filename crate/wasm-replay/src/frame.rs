//! What the page shows of a moment.

use core::time::Duration;

use glam::{DMat3, DVec3};
use mapless::{Pose as RobotPose, Status};
use mapless_recording::{Difference, Moment};
use serde::Serialize;
use tsify::Tsify;

use crate::decision::{self, Activity, PathPoint, Segment, Subgoal, Velocity};
use crate::pose::Pose;
use crate::returns::SetAside;
use crate::sight::{FrameBuffers, SensorPose};
use crate::surroundings::{Surroundings, around};

/// Everything that a moment saw, decided and did.
#[derive(Debug, Serialize, Tsify)]
pub struct RecordedFrame {
    time_s: f64,
    /// Nothing until odometry and IMU came.
    pose: Option<Pose>,
    /// The supervisor's state: `Standby`, `Driving`, `Paused`, `Aborted` or `Latched`.
    state: String,
    /// Why the robot was stopped, if it was.
    reason: Option<String>,
    /// What is wrong now, if anything is.
    cause: Option<String>,
    /// What the robot was told to do.
    command: Velocity,
    /// What the planner does; nothing while it has no goal.
    activity: Option<Activity>,
    /// Why the planner stopped, if it did.
    stop_reason: Option<String>,
    goal: Option<RecordedGoal>,
    /// How old the scan in view is; nothing before the first.
    scan_age_s: Option<f64>,
    returns: usize,
    set_aside: SetAside,
    sensor: SensorPose,
    threshold: f64,
    segments: Vec<Segment>,
    subgoals: Vec<Subgoal>,
    path: Vec<PathPoint>,
    /// Whether the surfaces in the buffers are predicted ones.
    surfaces: bool,
    surroundings: Surroundings,
    /// What was decided otherwise than recorded since the frame before: name, recorded value, value now.
    differences: Vec<String>,
}

/// Where the robot was to go.
#[derive(Debug, Serialize, Tsify)]
pub struct RecordedGoal {
    x: f64,
    y: f64,
    /// Any heading without it.
    heading_rad: Option<f64>,
}

/// Fills `buffers` with the moment's scan and skyline.
pub(crate) fn frame(
    at: Duration,
    moment: &Moment<'_>,
    differences: &[&Difference],
    buffers: &FrameBuffers,
) -> RecordedFrame {
    let mut scratch = Vec::new();
    let step = moment.seen.and_then(|seen| seen.step);
    let scanned = moment.seen.map(|seen| seen.scan.pose).or(moment.pose);
    let scanned = scanned.unwrap_or_else(|| RobotPose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0));
    let sensor = &moment.config.sensor;
    let axes = scanned.world_from_robot();
    let sensor_m = scanned.position_m + axes * sensor.offset_m();
    let world_from_sensor = axes * sensor.robot_from_sensor().unwrap_or(DMat3::IDENTITY);
    let points_m = moment.seen.map_or(&[][..], |seen| &seen.scan.points_m);
    let kinds = step.map_or(&[][..], |step| step.return_kinds);
    let returns = buffers.fill_points(points_m, sensor_m, world_from_sensor, &mut scratch);
    buffers.fill_return_kinds(kinds);
    buffers.forget_surfaces();
    for unknown in [&buffers.former, &buffers.truth] {
        unknown.fill(f32::NAN, 0, unknown.length());
    }
    match step {
        Some(step) => {
            buffers.fill_profile(step.profile, &mut scratch);
            buffers.fill_observed(step.observed, &mut scratch);
        }
        None => buffers.forget_profile(),
    }
    let pose = moment.pose.unwrap_or(scanned);
    let decision = moment.decision;
    let stop_reason = step.and_then(|step| match step.status {
        Status::Stopped(reason) => Some(reason.to_string()),
        _ => None,
    });
    RecordedFrame {
        time_s: at.as_secs_f64(),
        pose: moment.pose.map(Pose::from),
        state: decision.map_or_else(String::new, |decision| format!("{:?}", decision.state)),
        reason: decision.and_then(|decision| decision.reason).map(|reason| reason.to_string()),
        cause: decision.and_then(|decision| decision.cause).map(|cause| cause.to_string()),
        command: decision.map_or(mapless::Command::STOP, |decision| decision.command).into(),
        activity: step.map(|step| step.status.into()),
        stop_reason,
        goal: moment.task.map(|task| RecordedGoal {
            x: task.goal.position_m.x,
            y: task.goal.position_m.y,
            heading_rad: task.goal.heading_rad,
        }),
        scan_age_s: moment.seen.map(|seen| at.saturating_sub(seen.scan.arrived).as_secs_f64()),
        returns,
        set_aside: SetAside::of(kinds),
        sensor: SensorPose::new(sensor_m, axes),
        threshold: moment.config.perception.variance_threshold,
        segments: step.map(|step| decision::segments(&step)).unwrap_or_default(),
        subgoals: step.map(|step| decision::subgoals(&step)).unwrap_or_default(),
        path: step.map(|step| decision::path(&step)).unwrap_or_default(),
        surfaces: false,
        surroundings: around(pose.position_m, points_m, kinds, sensor_m, world_from_sensor),
        differences: differences.iter().map(|difference| words(difference)).collect(),
    }
}

impl RecordedFrame {
    pub(crate) fn with_surfaces(self) -> Self {
        Self { surfaces: true, ..self }
    }
}

fn words(difference: &Difference) -> String {
    let fields = difference.fields.iter().map(|(name, then, now)| format!("{name} {then}, now {now}"));
    format!("{}: {}", difference.whose, fields.collect::<Vec<_>>().join("; "))
}
