//! What the planner perceived, for RViz, Foxglove and Lichtblick: the skyline, and the variance surface that
//! it is read off. Published where asked for, as the surface costs a prediction of its own; the remembered
//! ground goes with them.

use mapless::glam::DVec3;
use mapless::skyline::columns::{COLUMNS, column_azimuth_rad, column_of};
use mapless::skyline::profile::Column;
use mapless::skyline::segments::{Segment, Verdict};
use mapless::{Planner, Pose, SensorModel};
use mapless_robot::frames::FrameChange;
use ros2_client::Publisher;

use crate::config::NodeConfig;
use crate::elevation::Elevation;
use crate::messages::{
    ColorRgba, Header, Marker, MarkerArray, Point, PointCloud2, Time, Vector3, cloud_of_floats,
};
use crate::ros::{Entities, RosError, published_qos, streamed_qos};

const OPEN: ColorRgba = ColorRgba { r: 0.1, g: 0.8, b: 0.2, a: 1.0 };
const CLOSED: ColorRgba = ColorRgba { r: 0.9, g: 0.5, b: 0.1, a: 1.0 };
const LINE_M: f64 = 0.04;
const FIELDS: [&str; 5] = ["x", "y", "z", "variance", "range"];

/// The publishers of skyline, variance and remembered ground.
pub(crate) struct Surfaces {
    skyline: Publisher<MarkerArray>,
    variance: Publisher<PointCloud2>,
    elevation: Elevation,
    frame_id: String,
}

impl Surfaces {
    pub(crate) fn new(config: &NodeConfig, entities: &mut Entities) -> Result<Self, RosError> {
        let (topics, qos) = (&config.topics, published_qos());
        Ok(Self {
            skyline: entities.publisher(&topics.skyline, "visualization_msgs/MarkerArray", qos)?,
            variance: entities.publisher(&topics.variance, "sensor_msgs/PointCloud2", streamed_qos())?,
            elevation: Elevation::new(config, entities)?,
            frame_id: config.drive.frames.odom.clone(),
        })
    }

    /// Publishes what the last step perceived and knows, in the odometry's frame. `pose` is the robot's for
    /// the scan; the two others are the robot's in the estimator's frame and in the odometry's.
    pub(crate) fn publish(
        &mut self,
        planner: &mut Planner,
        pose: &Pose,
        [believed, told]: [Pose; 2],
        stamp: Time,
    ) {
        let view = View {
            pose: *pose,
            sensor: planner.config().sensor,
            change: FrameChange::new(believed, told),
            radius_m: planner.config().perception.surface_radius_m,
        };
        let header = Header { stamp, frame_id: self.frame_id.clone() };
        self.elevation.publish(planner, &view.change, header.clone());
        let step = planner.last_step();
        let marker = skyline(&view, step.profile, step.segments, header.clone());
        if let Err(error) = self.skyline.publish(MarkerArray { markers: vec![marker] }) {
            log::warn!("the skyline could not be published: {error}");
        }
        let grid = step.observed.grid();
        let elevations_rad: Vec<f64> = (0..grid.rows()).map(|row| grid.row_elevation_rad(row)).collect();
        // Without a posterior there is no surface; the step says so.
        let Ok(surface) = planner.predicted_surface() else { return };
        let cloud = variance(&view, &elevations_rad, &surface.relative_variance, &surface.mean_m, header);
        if let Err(error) = self.variance.publish(cloud) {
            log::warn!("the variance could not be published: {error}");
        }
    }
}

/// From where the sensor looks, and where that lies in the odometry's frame.
struct View {
    pose: Pose,
    sensor: SensorModel,
    change: FrameChange,
    radius_m: f64,
}

impl View {
    /// The point in a direction from the sensor over the robot's x-y plane, on the sphere of the surfaces.
    fn point_m(&self, azimuth_rad: f64, elevation_rad: f64) -> DVec3 {
        let (sin_a, cos_a) = libm::sincos(azimuth_rad);
        let (sin_e, cos_e) = libm::sincos(elevation_rad);
        let from_sensor = self.radius_m * DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
        let from_robot = self.sensor.offset_m() + from_sensor;
        self.change.point_m(self.pose.position_m + self.pose.world_from_robot() * from_robot)
    }
}

/// Lines between neighbouring columns with ground.
fn skyline(view: &View, profile: &[Column], segments: &[Segment], header: Header) -> Marker {
    let mut is_open = [false; COLUMNS];
    for segment in segments.iter().filter(|segment| segment.verdict == Verdict::Valid) {
        let columns = (segment.extent_rad.to_degrees() * COLUMNS as f64 / 360.0).round() as usize;
        let first = column_of(segment.begin_rad);
        (first..first + columns).for_each(|column| is_open[column % COLUMNS] = true);
    }
    let point = |column: usize| match profile.get(column) {
        Some(Column::Ground { elevation_rad }) => {
            Some(view.point_m(column_azimuth_rad(column), *elevation_rad))
        }
        _ => None,
    };
    let (mut points, mut colors) = (Vec::<Point>::new(), Vec::new());
    for column in 0..COLUMNS {
        let next = (column + 1) % COLUMNS;
        if let (Some(from_m), Some(to_m)) = (point(column), point(next)) {
            points.extend([Point::from(from_m), to_m.into()]);
            colors.extend([column, next].map(|end| if is_open[end] { OPEN } else { CLOSED }));
        }
    }
    Marker {
        header,
        ns: "skyline".to_owned(),
        r#type: Marker::LINE_LIST,
        scale: Vector3 { x: LINE_M, ..Vector3::default() },
        color: OPEN,
        points,
        colors,
        ..Marker::default()
    }
}

/// The surface as an organised cloud on its sphere, lowest row first: the relative variance, 1 where nothing
/// was observed, and the predicted range, metres. `variance` and `occupancy_m` are column by column.
fn variance(
    view: &View,
    elevations_rad: &[f64],
    variance: &[f64],
    occupancy_m: &[f64],
    header: Header,
) -> PointCloud2 {
    let rows = elevations_rad.len();
    let mut points = Vec::with_capacity(rows * COLUMNS);
    for (row, elevation_rad) in elevations_rad.iter().enumerate() {
        for column in 0..COLUMNS {
            let place_m = view.point_m(column_azimuth_rad(column), *elevation_rad);
            let at = column * rows + row;
            let range_m = view.radius_m - occupancy_m[at];
            let point = [place_m.x, place_m.y, place_m.z, variance[at], range_m];
            points.push(point.map(|number| number as f32));
        }
    }
    cloud_of_floats(header, FIELDS, rows, &points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::time::Duration;
    use mapless::glam::DVec2;
    use mapless::{Goal, PlannerConfig};

    /// A planner after a scan of level ground that the sensor sees from 0.8 m up, but for the robot's left.
    fn stepped(pose: &Pose) -> Planner {
        let mut planner = Planner::new(PlannerConfig::default()).unwrap();
        planner.set_goal(Goal::at(DVec2::new(50.0, 0.0)));
        let mut points_m = Vec::new();
        for azimuth_deg in (0..360).filter(|azimuth| !(60..120).contains(azimuth)) {
            let (sin, cos) = libm::sincos(f64::from(azimuth_deg).to_radians());
            for elevation_deg in [-15.0_f64, -13.0, -11.0, -9.0, -7.0] {
                let out_m = 0.8 / libm::tan(-elevation_deg.to_radians());
                points_m.push(DVec3::new(out_m * cos, out_m * sin, -0.8).as_vec3());
            }
        }
        planner.step(&points_m, pose, Duration::ZERO);
        planner
    }

    fn view(planner: &Planner, pose: Pose, told: Pose) -> View {
        View {
            pose,
            sensor: planner.config().sensor,
            change: FrameChange::new(pose, told),
            radius_m: planner.config().perception.surface_radius_m,
        }
    }

    #[test]
    fn the_skyline_is_where_the_ground_ends_in_the_odometry_s_frame() {
        let pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0);
        let told = Pose::from_roll_pitch_yaw(DVec3::new(100.0, 0.0, 2.0), 0.0, 0.0, 0.0);
        let planner = stepped(&pose);
        let (view, step) = (view(&planner, pose, told), planner.last_step());
        let marker = skyline(&view, step.profile, step.segments, Header::default());
        assert_eq!((marker.points.len() % 2, marker.points.len()), (0, marker.colors.len()));
        assert!(marker.points.len() > 2 * 250, "{}", marker.points.len());
        for point in &marker.points {
            let place_m = DVec3::from(*point) - told.position_m;
            assert!((place_m - view.sensor.offset_m()).length() < view.radius_m + 1e-9);
            assert!(place_m.z.abs() < 0.7, "the skyline of level ground is near its horizon: {place_m}");
            let azimuth_deg = libm::atan2(place_m.y, place_m.x).to_degrees();
            assert!(!(70.0..110.0).contains(&azimuth_deg), "nothing was seen at {azimuth_deg}°");
        }
    }

    #[test]
    fn the_variance_is_low_where_ground_was_seen_and_one_where_nothing_was() {
        let pose = Pose::from_roll_pitch_yaw(DVec3::ZERO, 0.0, 0.0, 0.0);
        let mut planner = stepped(&pose);
        let view = view(&planner, pose, pose);
        let grid = planner.last_step().observed.grid();
        let elevations_rad: Vec<f64> = (0..grid.rows()).map(|row| grid.row_elevation_rad(row)).collect();
        let surface = planner.predicted_surface().unwrap();
        let cloud =
            variance(&view, &elevations_rad, &surface.relative_variance, &surface.mean_m, Header::default());
        assert_eq!(cloud.data.len() as u32, cloud.height * cloud.row_step);
        let number = |row: u32, column: usize, field: usize| {
            let at = (row * cloud.row_step + column as u32 * cloud.point_step) as usize + 4 * field;
            f32::from_le_bytes(cloud.data[at..at + 4].try_into().unwrap())
        };
        let (ahead, left) = (column_of(0.0), column_of(core::f64::consts::FRAC_PI_2));
        assert!(number(0, ahead, 3) < 0.2 && number(0, left, 3) > 0.9);
        // The lowest beam meets the ground 3.1 m away, that at -7° 6.6 m; the surface smooths.
        let row = (0..cloud.height).find(|row| elevations_rad[*row as usize].to_degrees() > -7.01).unwrap();
        let [lowest_m, higher_m] = [number(0, ahead, 4), number(row, ahead, 4)];
        assert!((lowest_m - 3.1).abs() < 0.8 && higher_m > 5.5, "{lowest_m} {higher_m}");
        assert!(number(0, ahead, 0) > 6.0 && number(0, ahead, 1).abs() < 1e-3);
    }
}
