//! Sensors that cannot serve, and scans that are not of the sensor that is configured.

use core::f64::consts::PI;

use mapless::glam::Vec3;
use mapless::{RobotModel, SensorModel};
use mapless_robot::cloud::{check_sensor, check_view};

fn sensor(rings: usize, lowest_deg: f64, highest_deg: f64) -> SensorModel {
    let mut sensor = SensorModel::vlp16();
    sensor.rings = rings;
    sensor.lowest_elevation_rad = lowest_deg.to_radians();
    sensor.highest_elevation_rad = highest_deg.to_radians();
    sensor
}

fn refusal(sensor: &SensorModel) -> String {
    check_sensor(sensor, &RobotModel::husky()).map_or_else(|error| error.to_string(), |()| String::new())
}

#[test]
fn known_sensors_serve() {
    for (rings, lowest_deg, highest_deg) in [
        (8, -15.0, 15.0),
        (16, -15.0, 15.0),
        (32, -25.0, 15.0),
        (32, -45.0, 45.0),
        (40, -16.0, 7.0),
        (64, -24.9, 2.0),
        (128, -22.5, 22.5),
        (128, -45.0, 45.0),
    ] {
        assert_eq!(refusal(&sensor(rings, lowest_deg, highest_deg)), "", "{rings}");
    }
    let mut upside_down = sensor(32, -15.0, 25.0);
    upside_down.roll_rad = PI;
    assert_eq!(refusal(&upside_down), "");
}

#[test]
fn a_sensor_that_cannot_serve_is_refused_with_a_sentence() {
    assert_eq!(refusal(&sensor(1, 0.0, 0.1)), "a sensor with 1 rings cannot serve: expected 8 to 128");
    assert_eq!(refusal(&sensor(4, -10.0, 10.0)), "a sensor with 4 rings cannot serve: expected 8 to 128");
    assert_eq!(refusal(&sensor(256, -10.0, 10.0)), "a sensor with 256 rings cannot serve: expected 8 to 128");
    assert_eq!(
        refusal(&sensor(8, -45.0, 45.0)),
        "a sensor whose rings are 12.9° apart cannot serve: expected at most 6.5°"
    );
    assert_eq!(
        refusal(&sensor(16, -2.0, 20.0)),
        "a sensor whose lowest beam ahead is at -2.0° and 0.8 m up cannot serve: it meets level ground beyond 7.5 m, \
         where the planner looks for it"
    );
    let mut nose_up = SensorModel::vlp16();
    nose_up.pitch_rad = 0.5;
    assert!(refusal(&nose_up).contains("lowest beam ahead is at 5.4°"), "{}", refusal(&nose_up));
    let mut backwards = SensorModel::vlp16();
    (backwards.horizontal_fov_rad, backwards.yaw_rad) = (2.0, PI);
    assert_eq!(
        refusal(&backwards),
        "a sensor that is mounted so that nothing ahead of the robot is in its view cannot serve"
    );
}

/// Returns all around at 5 m, at -5°, from one azimuth to another.
fn ring(from_deg: i32, to_deg: i32) -> Vec<Vec3> {
    let point = |degree: i32| {
        let (sin, cos) = (degree as f32).to_radians().sin_cos();
        5.0 * Vec3::new(cos, sin, -0.09)
    };
    (from_deg..to_deg).map(point).collect()
}

#[test]
fn half_a_scan_or_a_scan_of_another_sensor_is_told() {
    let vlp16 = SensorModel::vlp16();
    let told = |points: &[Vec3], sensor: &SensorModel| {
        check_view(points, sensor).map_or_else(|error| error.to_string(), |()| String::new())
    };
    assert_eq!(told(&ring(-180, 180), &vlp16), "");
    assert_eq!(told(&[], &vlp16), "", "an empty scan is for the planner to judge");
    // The robot's own mast may hide a quarter.
    assert_eq!(told(&ring(-130, 130), &vlp16), "");
    assert_eq!(
        told(&ring(-90, 90), &vlp16),
        "returns in 19 of 36 sectors of the view: half a scan, or a blocked lens"
    );
    // A sensor that looks ahead alone has no more.
    let mut ahead = vlp16;
    ahead.horizontal_fov_rad = PI;
    assert_eq!(told(&ring(-90, 90), &ahead), "");
    // In a frame with z ahead, the ground is straight down the x axis.
    let turned: Vec<Vec3> =
        ring(-180, 180).iter().map(|point| Vec3::new(-point.z, -point.y, point.x)).collect();
    let message = told(&turned, &vlp16);
    assert!(message.contains("% of the returns are outside elevations of -15.0° to 15.0°"), "{message}");
}
