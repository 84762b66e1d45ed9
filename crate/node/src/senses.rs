//! Messages of sensors as estimator, planner and supervisor take them.

use std::hash::{DefaultHasher, Hasher};
use std::time::Duration;

use mapless::glam::{DVec3, Vec3};
use mapless_robot::estimator::{self, Estimator, ReadingError};
use mapless_robot::supervisor::Message;

use crate::config::Frames;
use crate::hub::{Hub, Scan};
use crate::messages::{Header, Imu, Odometry, PointCloud2, Vector3};

/// Why a message was not used.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Unusable {
    #[error("frame {found:?}: expected {expected:?}")]
    Frame { found: String, expected: String },
    #[error(transparent)]
    Reading(#[from] ReadingError),
    #[error("cloud: {0}")]
    Cloud(String),
}

/// Follows the robot's pose, and tells supervisor and planner of every message.
pub(crate) struct Senses {
    estimator: Estimator,
    frames: Frames,
}

fn vector(vector: Vector3) -> DVec3 {
    DVec3::new(vector.x, vector.y, vector.z)
}

impl Senses {
    pub(crate) fn new(estimator: Estimator, frames: Frames) -> Self {
        Self { estimator, frames }
    }

    /// Takes a scan: to the planner, if it can be used and the pose is known.
    pub(crate) fn take_scan(&mut self, hub: &Hub, cloud: &PointCloud2) {
        let arrived = hub.now();
        let points = in_frame(&cloud.header.frame_id, &self.frames.scan).and_then(|()| points_m(cloud));
        let mut content = DefaultHasher::new();
        content.write(&cloud.data);
        let message = message(hub, arrived, &cloud.header, content, &points, "scan");
        hub.tell(|inputs| inputs.scan = Some(message));
        if let (Ok(points_m), Some(pose)) = (points, self.estimator.pose()) {
            hub.scan.put(Scan { arrived, stamp: cloud.header.stamp, points_m, pose });
        }
    }

    /// Takes odometry.
    pub(crate) fn take_odometry(&mut self, hub: &Hub, odometry: &Odometry) {
        let arrived = hub.now();
        let (pose, twist) = (&odometry.pose, &odometry.twist.twist);
        let reading = estimator::Odometry {
            at: arrived,
            position_m: vector(pose.pose.position),
            orientation: pose.pose.orientation.to_glam(),
            variances: std::array::from_fn(|axis| pose.covariance[axis][axis]),
            linear_m_s: vector(twist.linear),
            angular_rad_s: vector(twist.angular),
        };
        let taken = in_frame(&odometry.header.frame_id, &self.frames.odom)
            .and_then(|()| in_frame(&odometry.child_frame_id, &self.frames.base))
            .and_then(|()| Ok(self.estimator.take_odometry(&reading)?));
        let mut content = DefaultHasher::new();
        hash(&mut content, &reading.position_m.to_array());
        hash(&mut content, &reading.orientation.to_array());
        hash(&mut content, &[twist.linear.x, twist.angular.z]);
        let message = message(hub, arrived, &odometry.header, content, &taken, "odometry");
        if let Ok(Some(jump)) = taken {
            log::warn!("the odometry jumped from {} to {}", jump.before.position_m, jump.after.position_m);
            hub.jump();
        }
        let wheels_disagree = self.estimator.wheels_disagree();
        hub.tell(|inputs| {
            inputs.odometry = Some(message);
            inputs.wheels_disagree = wheels_disagree;
        });
        if let Some(pose) = self.estimator.pose() {
            hub.set_pose(pose);
        }
    }

    /// Takes a message of the IMU.
    pub(crate) fn take_imu(&mut self, hub: &Hub, imu: &Imu) {
        let arrived = hub.now();
        let reading = estimator::Imu {
            at: arrived,
            orientation: imu.orientation.to_glam(),
            orientation_variance: imu.orientation_covariance[0],
            angular_rad_s: vector(imu.angular_velocity),
        };
        let taken = in_frame(&imu.header.frame_id, &self.frames.imu)
            .and_then(|()| Ok(self.estimator.take_imu(&reading)?));
        let mut content = DefaultHasher::new();
        hash(&mut content, &reading.orientation.to_array());
        hash(&mut content, &reading.angular_rad_s.to_array());
        hash(&mut content, &vector(imu.linear_acceleration).to_array());
        let message = message(hub, arrived, &imu.header, content, &taken, "IMU");
        let attitude_rad = self.estimator.attitude_rad();
        hub.tell(|inputs| {
            inputs.imu = Some(message);
            inputs.attitude_rad = attitude_rad;
        });
    }
}

fn in_frame(found: &str, expected: &str) -> Result<(), Unusable> {
    if found == expected {
        return Ok(());
    }
    Err(Unusable::Frame { found: found.to_owned(), expected: expected.to_owned() })
}

fn hash(content: &mut DefaultHasher, numbers: &[f64]) {
    numbers.iter().for_each(|number| content.write_u64(number.to_bits()));
}

/// What the supervisor is told of a message.
fn message<T>(
    hub: &Hub,
    arrived: Duration,
    header: &Header,
    content: DefaultHasher,
    taken: &Result<T, Unusable>,
    what: &'static str,
) -> Message {
    if let Err(error) = taken {
        hub.complain(what, error);
    }
    Message {
        arrived,
        clock_ns: hub.stamp().nanoseconds(),
        stamp_ns: header.stamp.nanoseconds(),
        fingerprint: content.finish(),
        is_well_formed: taken.is_ok(),
    }
}

/// The points of a cloud in the sensor frame, metres.
fn points_m(cloud: &PointCloud2) -> Result<Vec<Vec3>, Unusable> {
    let coordinate = |name: &str| {
        let field = cloud.fields.iter().find(|field| field.name == name);
        let field = field.ok_or_else(|| Unusable::Cloud(format!("no field {name}: expected x, y and z")))?;
        let size = match field.datatype {
            FLOAT32 => 4,
            FLOAT64 => 8,
            other => {
                return Err(Unusable::Cloud(format!("field {name} has datatype {other}: expected 7 or 8")));
            }
        };
        let begin = field.offset as usize;
        if begin + size > cloud.point_step as usize {
            let step = cloud.point_step;
            return Err(Unusable::Cloud(format!("field {name} ends beyond the point's {step} bytes")));
        }
        Ok((begin, size))
    };
    let places = [coordinate("x")?, coordinate("y")?, coordinate("z")?];
    let (width, height) = (cloud.width as usize, cloud.height as usize);
    let (step, row) = (cloud.point_step as usize, cloud.row_step as usize);
    let needed = height.checked_sub(1).map_or(0, |rows| rows * row + width * step);
    if width * step > row || needed > cloud.data.len() {
        let length = cloud.data.len();
        return Err(Unusable::Cloud(format!(
            "{height} rows of {width} points of {step} bytes, a row each {row} bytes, in {length} bytes"
        )));
    }
    let number = |point: &[u8], (begin, size): (usize, usize)| -> f32 {
        let mut bytes = [0; 8];
        bytes[..size].copy_from_slice(&point[begin..begin + size]);
        if cloud.is_bigendian {
            bytes[..size].reverse();
        }
        match size {
            4 => f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
            _ => f64::from_le_bytes(bytes) as f32,
        }
    };
    let points = (0..height).flat_map(|line| {
        let begin = line * row;
        cloud.data[begin..begin + width * step].chunks_exact(step)
    });
    Ok(points.map(|point| Vec3::from_array(places.map(|place| number(point, place)))).collect())
}

/// Datatypes of `sensor_msgs/PointField`.
const FLOAT32: u8 = 7;
const FLOAT64: u8 = 8;
