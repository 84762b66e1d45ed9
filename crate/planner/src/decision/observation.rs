//! A scan taken up by the elevation window.

use core::time::Duration;

use glam::DVec3;

use crate::config::PlannerConfig;
use crate::pose::Pose;
use crate::skyline::scan_filter::ScanFilter;
use crate::terrain::elevation_window::ElevationWindow;

/// Under the robot the ground is taken for known at places no farther apart than this.
const WHEEL_GROUND_M: f64 = 0.35;

/// Forgets remembered ground that the scan sees through, and adds the near part of the scan and the ground
/// under the wheels. Where ground was forgotten, [`ElevationWindow::refuted_m`] says.
pub(crate) fn take_up(
    window: &mut ElevationWindow,
    config: &PlannerConfig,
    scan: &ScanFilter,
    pose: &Pose,
    elapsed: Duration,
) {
    window.advance(elapsed);
    let world_from_robot = pose.world_from_robot();
    let sensor = pose.position_m + world_from_robot * config.sensor.offset_m();
    let mount = config.sensor.robot_from_sensor();
    let world_from_sensor = mount.map_or(world_from_robot, |mount| world_from_robot * mount);
    window.looked_from(sensor, world_from_sensor);
    let robot_from_world = world_from_robot.transpose();
    window.forget_where(|place_m: DVec3| scan.refutes(robot_from_world * (place_m - sensor)));
    let radius_squared = config.elevation_window.radius_m * config.elevation_window.radius_m;
    for point in scan.surface_m() {
        let point = point.as_dvec3();
        if point.length_squared() <= radius_squared {
            window.add_return(sensor + world_from_sensor * point);
        }
    }
    window.see_through(sensor, |line| {
        scan.each_sight_line(|end_m, free_share| line(sensor + world_from_robot * end_m, free_share));
    });
    for &face_m in scan.faces_m() {
        window.add_face((sensor + world_from_robot * face_m).truncate());
    }
    let half_width = 0.5 * config.robot.width_m;
    let parts = (half_width / WHEEL_GROUND_M).ceil() as i32;
    let place = |part: i32| half_width * (f64::from(part) / f64::from(parts));
    for x in -parts..=parts {
        for y in -parts..=parts {
            window.add(pose.position_m + world_from_robot * DVec3::new(place(x), place(y), 0.0));
        }
    }
}
