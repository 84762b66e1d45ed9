//! Messages of sensors as estimator, planner and supervisor take them.

use std::hash::{DefaultHasher, Hasher};
use std::time::Duration;

use mapless::glam::DVec3;
use mapless::{Pose, SensorModel};
use mapless_robot::cloud::{self, CloudError, Field, PointCloud, Returns, ViewError, check_view};
use mapless_robot::deskew::deskew;
use mapless_robot::estimator::{self, Estimator, ReadingError};
use mapless_robot::supervisor::Message;

use crate::config::Frames;
use crate::hub::{Arrived, Hub, Scan};
use crate::messages::{Imu, Odometry, PointCloud2, Time};

/// Half a turn of a sensor that turns at 10 Hz.
const HALF_SWEEP: Duration = Duration::from_millis(50);

/// Why a message was not used.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Unusable {
    #[error("frame {found:?}: expected {expected:?}")]
    Frame { found: String, expected: String },
    #[error(transparent)]
    Reading(#[from] ReadingError),
    #[error(transparent)]
    Cloud(#[from] CloudError),
    #[error(transparent)]
    View(#[from] ViewError),
}

/// Follows the robot's pose, and tells supervisor and planner of every message.
pub(crate) struct Senses {
    estimator: Estimator,
    frames: Frames,
    sensor: SensorModel,
}

impl Senses {
    pub(crate) fn new(estimator: Estimator, frames: Frames, sensor: SensorModel) -> Self {
        Self { estimator, frames, sensor }
    }

    /// Takes a scan: to the planner, if it can be used and the pose is known.
    pub(crate) fn take_scan(&mut self, hub: &Hub, cloud: &PointCloud2) {
        let arrived = hub.now();
        let stamp = cloud.header.stamp;
        let returns =
            in_frame(&cloud.header.frame_id, &self.frames.scan).and_then(|()| returns(cloud, &self.sensor));
        let mut content = DefaultHasher::new();
        content.write(&cloud.data);
        let message = message(hub, arrived, stamp.nanoseconds(), content, &returns, "scan");
        hub.tell(|inputs| inputs.scan = Some(message));
        self.plan(hub, arrived, stamp, returns);
    }

    /// Takes a revolution of a sensor that sends packets, likewise.
    pub(crate) fn take_revolution(&mut self, hub: &Hub, arrived: Arrived) {
        let Arrived { at, stamp, sensor_ns, revolution } = arrived;
        let mut content = DefaultHasher::new();
        for point_m in &revolution.points_m {
            point_m.to_array().iter().for_each(|axis_m| content.write_u32(axis_m.to_bits()));
        }
        let returns =
            check_view(&revolution.points_m, &self.sensor).map_err(Unusable::from).map(|()| Returns {
                points_m: revolution.points_m,
                since_stamp_s: Some(revolution.since_end_s),
                warnings: Vec::new(),
            });
        let message = message(hub, at, sensor_ns, content, &returns, "scan");
        hub.tell(|inputs| inputs.scan = Some(message));
        self.plan(hub, at, stamp, returns);
    }

    fn plan(&self, hub: &Hub, arrived: Duration, stamp: Time, returns: Result<Returns, Unusable>) {
        if let Ok(mut returns) = returns
            && let Some(pose) = self.placed(hub, &mut returns, arrived)
        {
            hub.scan.put(Scan { arrived, stamp, points_m: returns.points_m, pose });
        }
    }

    /// The pose for a scan that arrived now: of the end of the sweep, once its points are corrected for
    /// motion since; of its middle, if they have no times. Sensors' clocks lie, so a sweep ends when it
    /// arrives.
    fn placed(&self, hub: &Hub, returns: &mut Returns, arrived: Duration) -> Option<Pose> {
        let trajectory = self.estimator.trajectory();
        if let Some(times_s) = &returns.since_stamp_s {
            let end_s = times_s.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let until_end_s: Vec<f64> = times_s.iter().map(|time_s| time_s - end_s).collect();
            match deskew(&mut returns.points_m, &until_end_s, arrived, trajectory, &self.sensor) {
                Ok(pose) => return Some(pose),
                Err(error) => hub.complain("motion compensation", &error),
            }
        }
        arrived.checked_sub(HALF_SWEEP).and_then(|at| trajectory.pose_at(at)).or(self.estimator.pose())
    }

    /// Takes odometry.
    pub(crate) fn take_odometry(&mut self, hub: &Hub, odometry: &Odometry) {
        let arrived = hub.now();
        let (pose, twist) = (&odometry.pose, &odometry.twist.twist);
        let reading = estimator::Odometry {
            at: arrived,
            position_m: pose.pose.position.into(),
            orientation: pose.pose.orientation.to_glam(),
            variances: std::array::from_fn(|axis| pose.covariance[axis][axis]),
            linear_m_s: twist.linear.into(),
            angular_rad_s: twist.angular.into(),
        };
        let taken = in_frame(&odometry.header.frame_id, &self.frames.odom)
            .and_then(|()| in_frame(&odometry.child_frame_id, &self.frames.base))
            .and_then(|()| Ok(self.estimator.take_odometry(&reading)?));
        let mut content = DefaultHasher::new();
        hash(&mut content, &reading.position_m.to_array());
        hash(&mut content, &reading.orientation.to_array());
        hash(&mut content, &[twist.linear.x, twist.angular.z]);
        let message = message(hub, arrived, odometry.header.stamp.nanoseconds(), content, &taken, "odometry");
        if let Ok(Some(jump)) = taken {
            log::warn!("the odometry jumped from {} to {}", jump.before.position_m, jump.after.position_m);
            hub.jump();
        }
        let wheels_disagree = self.estimator.wheels_disagree();
        hub.tell(|inputs| {
            inputs.odometry = Some(message);
            inputs.wheels_disagree = wheels_disagree;
        });
        if let (true, Some(believed)) = (message.is_well_formed, self.estimator.pose()) {
            let told = Pose::from_quaternion(reading.position_m, reading.orientation);
            hub.set_poses(believed, told);
        }
    }

    /// Takes a message of the IMU.
    pub(crate) fn take_imu(&mut self, hub: &Hub, imu: &Imu) {
        let arrived = hub.now();
        let reading = estimator::Imu {
            at: arrived,
            orientation: imu.orientation.to_glam(),
            orientation_variance: imu.orientation_covariance[0],
            angular_rad_s: imu.angular_velocity.into(),
        };
        let taken = in_frame(&imu.header.frame_id, &self.frames.imu)
            .and_then(|()| Ok(self.estimator.take_imu(&reading)?));
        let mut content = DefaultHasher::new();
        hash(&mut content, &reading.orientation.to_array());
        hash(&mut content, &reading.angular_rad_s.to_array());
        hash(&mut content, &DVec3::from(imu.linear_acceleration).to_array());
        let message = message(hub, arrived, imu.header.stamp.nanoseconds(), content, &taken, "IMU");
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
    stamp_ns: i64,
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
        stamp_ns,
        fingerprint: content.finish(),
        is_well_formed: taken.is_ok(),
    }
}

/// The returns of a cloud, if it looks like one of the sensor.
fn returns(cloud: &PointCloud2, sensor: &SensorModel) -> Result<Returns, Unusable> {
    let fields: Vec<Field> = cloud
        .fields
        .iter()
        .map(|field| Field { name: field.name.clone(), offset: field.offset, datatype: field.datatype })
        .collect();
    let returns = cloud::read(&PointCloud {
        height: cloud.height,
        width: cloud.width,
        fields: &fields,
        is_big_endian: cloud.is_bigendian,
        point_step: cloud.point_step,
        row_step: cloud.row_step,
        data: &cloud.data,
        stamp_ns: cloud.header.stamp.nanoseconds(),
    })?;
    check_view(&returns.points_m, sensor)?;
    Ok(returns)
}
