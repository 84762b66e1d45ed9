//! The ground that the planner remembers and judges paths on, for RViz, Foxglove and Lichtblick.

use std::time::{Duration, Instant};

use mapless::Planner;
use mapless::terrain::remembered_ground::RememberedGround;
use mapless_robot::frames::FrameChange;
use ros2_client::Publisher;

use crate::config::NodeConfig;
use crate::messages::{Header, PointCloud2, cloud_of_floats};
use crate::ros::{Entities, RosError, streamed_qos};

/// A full window is as large as the variance surface, up to 221 kB. At 10 Hz both would fill a robot's radio
/// link, and in a second a robot at 0.8 m/s comes upon four new rows of cells.
const PERIOD: Duration = Duration::from_secs(1);
const FIELDS: [&str; 6] = ["x", "y", "z", "returns", "age", "upright"];

/// The publisher of the remembered ground.
pub(crate) struct Elevation {
    publisher: Publisher<PointCloud2>,
    published: Option<Instant>,
}

impl Elevation {
    pub(crate) fn new(config: &NodeConfig, entities: &mut Entities) -> Result<Self, RosError> {
        let publisher =
            entities.publisher(&config.topics.elevation, "sensor_msgs/PointCloud2", streamed_qos())?;
        Ok(Self { publisher, published: None })
    }

    /// Publishes it, unless that was done within the last second. `change` leads to the frame of the header.
    pub(crate) fn publish(&mut self, planner: &Planner, change: &FrameChange, header: Header) {
        let now = Instant::now();
        if self.published.is_some_and(|published| now - published < PERIOD) {
            return;
        }
        self.published = Some(now);
        if let Err(error) = self.publisher.publish(elevation(planner.remembered_ground(), change, header)) {
            log::warn!("the remembered ground could not be published: {error}");
        }
    }
}

/// A point for each cell, at the mean of its returns: how many these are, up to 30, the seconds since the
/// last, and 1 where something upright stands, else 0.
fn elevation(
    ground: impl Iterator<Item = RememberedGround>,
    change: &FrameChange,
    header: Header,
) -> PointCloud2 {
    let points = ground.map(|cell| {
        let place_m = change.point_m(cell.mean_m).as_vec3();
        let upright = f32::from(u8::from(cell.is_upright));
        [place_m.x, place_m.y, place_m.z, cell.returns as f32, cell.age.as_secs_f32(), upright]
    });
    cloud_of_floats(header, FIELDS, 1, &points.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless::glam::{DVec2, DVec3, Vec3};
    use mapless::{Goal, PlannerConfig, Pose};

    const STEP: Duration = Duration::from_millis(100);

    /// Level ground ahead and to the sides of a sensor 0.8 m up, and a wall 4 m ahead that is 2 m wide.
    fn scan() -> Vec<Vec3> {
        let mut points_m = Vec::new();
        for column in 0..1440 {
            let (sin_a, cos_a) = libm::sincos((0.25 * f64::from(column)).to_radians());
            for ring in 0..16 {
                let (sin_e, cos_e) = libm::sincos((2.0 * f64::from(ring) - 15.0).to_radians());
                let ground_m = if sin_e < 0.0 { -0.8 / sin_e } else { f64::INFINITY };
                let wall_m = 4.0 / (cos_e * cos_a);
                let meets_wall = cos_a > 0.0 && (wall_m * cos_e * sin_a).abs() < 1.0;
                let range_m = if meets_wall { ground_m.min(wall_m) } else { ground_m };
                if range_m < 30.0 {
                    points_m.push((range_m * DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e)).as_vec3());
                }
            }
        }
        points_m
    }

    fn numbers(cloud: &PointCloud2) -> Vec<[f32; FIELDS.len()]> {
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
        let point = |bytes: &[u8]| -> [f32; FIELDS.len()] {
            bytes.chunks_exact(4).map(number).collect::<Vec<_>>().try_into().unwrap()
        };
        cloud.data.chunks_exact(cloud.point_step as usize).map(point).collect()
    }

    #[test]
    fn remembered_ground_lies_in_the_odometry_s_frame_with_the_wall_upright() {
        let pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0);
        // The odometry's robot faces north, elsewhere and 2 m higher.
        let told =
            Pose::from_roll_pitch_yaw(DVec3::new(100.0, 0.0, 2.0), 0.0, 0.0, core::f64::consts::FRAC_PI_2);
        let change = FrameChange::new(pose, told);
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        let cloud = elevation(planner.remembered_ground(), &change, Header::default());
        assert_eq!((cloud.width, cloud.row_step, cloud.data.len()), (0, 0, 0), "nothing was seen");

        planner.set_goal(Goal::at(DVec2::new(50.0, 0.0)));
        for _ in 0..5 {
            planner.step(&scan(), &pose, STEP);
        }
        let cloud = elevation(planner.remembered_ground(), &change, Header::default());
        assert_eq!((cloud.height, cloud.point_step), (1, 24));
        assert_eq!(cloud.data.len() as u32, cloud.width * cloud.point_step);
        let points = numbers(&cloud);
        assert!(points.len() > 700, "{}", points.len());
        for &[x, y, z, returns, age, upright] in &points {
            let [ahead_m, left_m] = [y, 100.0 - x];
            assert!(ahead_m.abs() < 9.1 && left_m.abs() < 9.1, "{ahead_m} {left_m}");
            assert!((1.0..=30.0).contains(&returns) && age == 0.0);
            let is_at_wall = (ahead_m - 4.0).abs() < 0.2 && left_m.abs() < 1.2;
            assert!(upright == 0.0 || is_at_wall, "{ahead_m} {left_m} {z}");
            assert!(is_at_wall || (z - 2.0).abs() < 0.05, "{ahead_m} {left_m} {z}");
        }
        let upright = points.iter().filter(|point| point[5] > 0.5).count();
        assert!((5..=11).contains(&upright), "{upright} cells of a wall of 2 m");

        // What is ahead is not seen any more: it ages.
        let behind: Vec<_> = scan().into_iter().filter(|point_m| point_m.x < 0.0).collect();
        planner.step(&behind, &pose, 20 * STEP);
        let cloud = elevation(planner.remembered_ground(), &change, Header::default());
        let ages = |ahead: bool| -> Vec<f32> {
            let there = numbers(&cloud).into_iter().filter(|point| (point[1] > 0.5) == ahead);
            there.map(|[.., age, _]| age).collect()
        };
        assert!(ages(true).len() > 300 && ages(true).iter().all(|age| (age - 2.0).abs() < 1e-6));
        let fresh = ages(false).iter().filter(|age| **age == 0.0).count();
        assert!(2 * fresh > ages(false).len(), "{fresh} of {}", ages(false).len());
    }
}
