//! The smallest program around the planner: a robot on level ground drives to a goal.
//!
//! Replace `scan` by your sensor, `pose` by your localisation and the last lines of the loop by your base.

use core::time::Duration;

use mapless::glam::{DVec2, DVec3, Vec3};
use mapless::{Goal, Planner, PlannerConfig, Pose, RobotModel, SensorModel, Status};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sensor = SensorModel::vlp16();
    let mut planner = Planner::new(PlannerConfig::for_robot(sensor, RobotModel::husky()))?;
    planner.set_goal(Goal::at(DVec2::new(12.0, 5.0)).facing(0.0));

    let period = Duration::from_millis(100);
    let (mut position_m, mut yaw_rad) = (DVec3::ZERO, 0.0);
    for tick in 0..600 {
        let pose = Pose::from_roll_pitch_yaw(position_m, 0.0, 0.0, yaw_rad);
        let step = planner.step(&scan(&sensor), &pose, period);
        let command = step.command;
        match step.status {
            Status::Driving | Status::Backtracking | Status::Searching => {}
            Status::Arrived => {
                println!(
                    "arrived at {position_m:.2} m, {yaw_rad:.2} rad after {:.1} s",
                    f64::from(tick) * 0.1
                );
                return Ok(());
            }
            Status::Stopped(reason) => return Err(format!("stopped: {reason}").into()),
        }
        // A robot that obeys at once.
        yaw_rad += command.angular_rad_s * period.as_secs_f64();
        position_m += DVec2::from_angle(yaw_rad).extend(0.0) * command.linear_m_s * period.as_secs_f64();
    }
    Err("not arrived within a minute".into())
}

/// The returns of level ground in the sensor frame.
fn scan(sensor: &SensorModel) -> Vec<Vec3> {
    let step_rad = (sensor.highest_elevation_rad - sensor.lowest_elevation_rad) / (sensor.rings - 1) as f64;
    let mut points_m = Vec::new();
    for column in 0..720 {
        let azimuth = DVec2::from_angle(f64::from(column) * 0.5_f64.to_radians());
        for ring in 0..sensor.rings {
            let downward_rad = -(sensor.lowest_elevation_rad + step_rad * ring as f64);
            if downward_rad > 0.01 {
                let beam = DVec2::from_angle(downward_rad);
                let far_m = sensor.height_m * beam.x / beam.y;
                points_m.push((azimuth * far_m).extend(-sensor.height_m).as_vec3());
            }
        }
    }
    points_m
}
