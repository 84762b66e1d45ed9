//! Accuracy of the elevation profile against the true skyline of the ground.

use core::f64::consts::TAU;
use core::time::Duration;

use glam::DVec2;
use mapless::skyline::columns::{COLUMNS, column_azimuth_rad};
use mapless::skyline::profile::Column;
use mapless::{Goal, Planner, PlannerConfig, Pose, StopReason};
use mapless_world::random::{key, uniform};
use mapless_world::{
    Caster, Lidar, RobotConfig, Scan, SensorConfig, SensorPose, Skyline, attitude_on, true_skyline,
};

use crate::trial::TrialError;

/// The kind of a column, true or perceived; the index of a row or column of the confusion matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// Ground up to a skyline.
    Ground,
    /// No ground within r_oc.
    Unknown,
    /// Ground up to the highest ring.
    Wall,
}

/// The profile against the truth over many poses.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct ProfileAccuracy {
    /// Poses scanned.
    pub poses: usize,
    /// Mean over all columns that are ground in truth and as perceived, of the absolute difference in
    /// elevation.
    pub mean_abs_error_rad: f64,
    /// Mean of the difference, perceived less true.
    pub bias_rad: f64,
    /// The mean absolute error of the worst pose.
    pub worst_pose_error_rad: f64,
    /// Index of that pose among those drawn, from zero; poses at which the robot is not safe count, too.
    pub worst_pose: u64,
    /// Columns, by truth and then by what was perceived, each in the order of [`ColumnKind`].
    pub confusion: [[usize; 3]; 3],
    /// Ground taken for unknown although both neighbours were seen.
    pub holes: usize,
    /// Poses whose scan gave no posterior.
    pub no_perception: usize,
}

/// Compares profile and truth at `poses` random places and headings where the robot could stand within its
/// limits, at least r_oc from the border.
///
/// # Errors
/// [`TrialError::Config`] names the configuration value that makes no sense.
pub fn profile_accuracy(
    caster: &Caster,
    sensor: &SensorConfig,
    robot: &RobotConfig,
    planner: &PlannerConfig,
    poses: usize,
    seed: u64,
) -> Result<ProfileAccuracy, TrialError> {
    let config = |reason: &dyn std::fmt::Display| TrialError::Config(reason.to_string());
    let lidar = Lidar::new(sensor.clone()).map_err(|e| config(&e))?;
    let mut planner = Planner::new(planner.clone()).map_err(|e| config(&e))?;
    let radius_m = planner.config().perception.surface_radius_m;
    let between_rad = [sensor.lowest_elevation_rad, sensor.highest_elevation_rad];
    let mut scan = Scan::default();
    let mut sums = Sums::default();
    // Bounds the search on ground without a safe pose.
    for attempt in 0..100 * poses as u64 {
        if sums.accuracy.poses == poses {
            break;
        }
        let Some((pose, sensor_pose)) = random_pose(caster, sensor, robot, radius_m, key(seed, attempt))
        else {
            continue;
        };
        lidar.scan(caster, &sensor_pose, seed, attempt, &mut scan);
        let far_goal_m = pose.plan_m() + DVec2::new(100.0, 0.0);
        planner.set_goal(Goal::at(far_goal_m));
        let step = planner.step(&scan.points, &pose, Duration::from_secs_f64(sensor.period_s));
        sums.accuracy.poses += 1;
        if let mapless::Status::Stopped(StopReason::NoPerception(_)) = step.status {
            sums.accuracy.no_perception += 1;
            continue;
        }
        // The profile is seen along the robot's axes, however the sensor is mounted.
        let upright = SensorPose { world_from_sensor: pose.world_from_robot(), ..sensor_pose };
        sums.add_pose(step.profile, attempt, |column| {
            true_skyline(caster, &upright, radius_m, column_azimuth_rad(column), between_rad)
        });
    }
    Ok(sums.finish())
}

fn random_pose(
    caster: &Caster,
    sensor: &SensorConfig,
    robot: &RobotConfig,
    margin_m: f64,
    key_of_pose: u64,
) -> Option<(Pose, SensorPose)> {
    let draw = |number: u64| uniform(key(key_of_pose, number));
    let room = caster.field().extent_m() - DVec2::splat(2.0 * margin_m);
    let place = DVec2::splat(margin_m) + room.max(DVec2::ZERO) * DVec2::new(draw(0), draw(1));
    let yaw_rad = TAU * (draw(2) - 0.5);
    let attitude = attitude_on(caster.field(), place, yaw_rad, robot)?;
    if attitude.roll_rad.abs() > robot.roll_limit_rad || attitude.pitch_rad.abs() > robot.pitch_limit_rad {
        return None;
    }
    let pose = Pose::from_roll_pitch_yaw(
        place.extend(attitude.height_m),
        attitude.roll_rad,
        attitude.pitch_rad,
        yaw_rad,
    );
    Some((pose, sensor.pose_on(place, yaw_rad, &attitude)))
}

#[derive(Default)]
struct Sums {
    accuracy: ProfileAccuracy,
    columns: usize,
}

impl Sums {
    fn add_pose(&mut self, profile: &[Column], pose: u64, truth: impl Fn(usize) -> Skyline) {
        let (mut error, mut count) = (0.0, 0);
        for (column, perceived) in profile.iter().enumerate() {
            let truth = truth(column);
            self.accuracy.confusion[kind_of_skyline(truth) as usize][kind_of_column(perceived) as usize] += 1;
            match (truth, perceived) {
                (Skyline::Ground { elevation_rad: truth }, Column::Ground { elevation_rad }) => {
                    error += (elevation_rad - truth).abs();
                    self.accuracy.bias_rad += elevation_rad - truth;
                    count += 1;
                }
                (Skyline::Ground { .. }, Column::Unknown) => {
                    let seen = |column: usize| profile[column % COLUMNS] != Column::Unknown;
                    if seen(column + 1) && seen(column + COLUMNS - 1) {
                        self.accuracy.holes += 1;
                    }
                }
                _ => {}
            }
        }
        if count > 0 {
            let mean = error / f64::from(count);
            if mean > self.accuracy.worst_pose_error_rad {
                (self.accuracy.worst_pose_error_rad, self.accuracy.worst_pose) = (mean, pose);
            }
        }
        self.accuracy.mean_abs_error_rad += error;
        self.columns += count as usize;
    }

    fn finish(mut self) -> ProfileAccuracy {
        let columns = self.columns.max(1) as f64;
        self.accuracy.mean_abs_error_rad /= columns;
        self.accuracy.bias_rad /= columns;
        self.accuracy
    }
}

fn kind_of_skyline(skyline: Skyline) -> ColumnKind {
    match skyline {
        Skyline::Ground { .. } => ColumnKind::Ground,
        Skyline::Unknown => ColumnKind::Unknown,
        Skyline::Wall => ColumnKind::Wall,
    }
}

fn kind_of_column(column: &Column) -> ColumnKind {
    match column {
        Column::Ground { .. } => ColumnKind::Ground,
        Column::Unknown => ColumnKind::Unknown,
        Column::Wall => ColumnKind::Wall,
    }
}
