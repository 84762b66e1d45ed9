//! Messages of scan, odometry and IMU as estimator, planner and supervisor take them.
//!
//! The same code runs in the node, as messages arrive, and in a replay: what a message means depends on the
//! messages before it and on [`Arrival`] alone.

use core::time::Duration;
use std::fmt::Display;
use std::hash::{DefaultHasher, Hasher};

use glam::{DVec3, Vec3};
use mapless::{Pose, SensorModel};
use serde::{Deserialize, Serialize};

use crate::cloud::{self, CloudError, Field, PointCloud, Returns, ViewError, check_view};
use crate::deskew::deskew;
use crate::estimator::{self, Estimator, Jump, ReadingError};
use crate::messages::{Header, Imu, Odometry, PointCloud2, Time};
use crate::supervisor::{Inputs, Message};

/// Half a turn of a sensor that turns at 10 Hz.
const HALF_SWEEP: Duration = Duration::from_millis(50);

/// Names of frames. A message in another frame is malformed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Frames {
    /// The frame of the odometry's pose, and of goals.
    pub odom: String,
    /// The odometry's child frame.
    pub base: String,
    /// The frame of the scans.
    pub scan: String,
    /// The frame of the IMU.
    pub imu: String,
}

impl Default for Frames {
    fn default() -> Self {
        Self {
            odom: "odom".to_owned(),
            base: "base_link".to_owned(),
            scan: "lidar3d_0_laser".to_owned(),
            imu: "imu_0_link".to_owned(),
        }
    }
}

/// Why a message was not used.
#[derive(Debug, thiserror::Error)]
enum Unusable {
    #[error("frame {found:?}: expected {expected:?}")]
    Frame { found: String, expected: String },
    #[error(transparent)]
    Reading(#[from] ReadingError),
    #[error(transparent)]
    Cloud(#[from] CloudError),
    #[error(transparent)]
    View(#[from] ViewError),
}

/// When a message arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// On the monotonic clock of the supervisor's ticks.
    pub at: Duration,
    /// On the robot's clock (in ROS: the node's, simulated or not), nanoseconds.
    pub clock_ns: i64,
}

/// A scan for the planner.
#[derive(Clone, Debug)]
pub struct Scan {
    /// When it arrived.
    pub arrived: Duration,
    /// Its stamp.
    pub stamp: Time,
    /// Its returns in the sensor frame, metres.
    pub points_m: Vec<Vec3>,
    /// The robot's pose for it.
    pub pose: Pose,
}

/// What a message of a sensor says to the others.
#[derive(Debug)]
pub struct Heard {
    told: Told,
    /// The scan for the planner, if this is a usable one and the pose is known.
    pub scan: Option<Scan>,
    /// A jump of the odometry: what the planner remembers of the ground lies elsewhere now.
    pub jump: Option<Jump>,
    /// Where the robot is, in the estimator's frame and in the odometry's, if this is usable odometry.
    pub poses: Option<[Pose; 2]>,
    /// What is wrong with it: about what, and what.
    pub complaints: Vec<(&'static str, String)>,
}

#[derive(Debug)]
enum Told {
    Scan(Message),
    Odometry { message: Message, has_jumped: bool, wheels_disagree: bool },
    Imu { message: Message, attitude_rad: Option<[f64; 2]> },
}

impl Heard {
    fn new(told: Told) -> Self {
        Self { told, scan: None, jump: None, poses: None, complaints: Vec::new() }
    }

    /// Tells the supervisor.
    pub fn tell(&self, inputs: &mut Inputs) {
        match self.told {
            Told::Scan(message) => inputs.scan = Some(message),
            Told::Odometry { message, has_jumped, wheels_disagree } => {
                inputs.odometry = Some(message);
                inputs.has_jumped |= has_jumped;
                inputs.wheels_disagree = wheels_disagree;
            }
            Told::Imu { message, attitude_rad } => {
                (inputs.imu, inputs.attitude_rad) = (Some(message), attitude_rad);
            }
        }
    }

    fn complain(&mut self, what: &'static str, error: &impl Display) {
        self.complaints.push((what, error.to_string()));
    }
}

/// Follows the robot's pose, and says what every message means.
#[derive(Clone, Debug)]
pub struct Senses {
    estimator: Estimator,
    frames: Frames,
    sensor: SensorModel,
}

impl Senses {
    /// Messages in other frames than these are malformed; scans must look like those of `sensor`.
    #[must_use]
    pub fn new(estimator: Estimator, frames: Frames, sensor: SensorModel) -> Self {
        Self { estimator, frames, sensor }
    }

    /// Takes a scan.
    pub fn take_scan(&mut self, arrival: Arrival, cloud: &PointCloud2) -> Heard {
        let returns =
            in_frame(&cloud.header.frame_id, &self.frames.scan).and_then(|()| returns(cloud, &self.sensor));
        let mut content = DefaultHasher::new();
        match &returns {
            // Times and the like change even if the sensor sends the same returns again.
            Ok(Returns { points_m, .. }) => {
                let axes_m = points_m.iter().flat_map(|point_m| point_m.to_array());
                axes_m.for_each(|axis_m| content.write_u32(axis_m.to_bits()));
            }
            Err(_) => content.write(&cloud.data),
        }
        let message = message(arrival, &cloud.header, &content, returns.is_ok());
        let mut heard = Heard::new(Told::Scan(message));
        match returns {
            Ok(mut returns) => {
                returns.warnings.iter().for_each(|warning| heard.complain("scan", warning));
                if let Some(pose) = self.placed(&mut heard, &mut returns, arrival.at) {
                    let (arrived, stamp) = (arrival.at, cloud.header.stamp);
                    heard.scan = Some(Scan { arrived, stamp, points_m: returns.points_m, pose });
                }
            }
            Err(error) => heard.complain("scan", &error),
        }
        heard
    }

    /// The pose for a scan that arrived now: of the end of the sweep, once its points are corrected for
    /// motion since; of its middle, if they have no times. Sensors' clocks lie, so a sweep ends when it
    /// arrives.
    fn placed(&self, heard: &mut Heard, returns: &mut Returns, arrived: Duration) -> Option<Pose> {
        let trajectory = self.estimator.trajectory();
        if let Some(times_s) = &returns.since_stamp_s {
            let end_s = times_s.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let until_end_s: Vec<f64> = times_s.iter().map(|time_s| time_s - end_s).collect();
            match deskew(&mut returns.points_m, &until_end_s, arrived, trajectory, &self.sensor) {
                Ok(pose) => return Some(pose),
                Err(error) => heard.complain("motion compensation", &error),
            }
        }
        arrived.checked_sub(HALF_SWEEP).and_then(|at| trajectory.pose_at(at)).or(self.estimator.pose())
    }

    /// Takes odometry.
    pub fn take_odometry(&mut self, arrival: Arrival, odometry: &Odometry) -> Heard {
        let (pose, twist) = (&odometry.pose, &odometry.twist.twist);
        let reading = estimator::Odometry {
            at: arrival.at,
            position_m: pose.pose.position.into(),
            orientation: pose.pose.orientation.to_glam(),
            variances: core::array::from_fn(|axis| pose.covariance[axis][axis]),
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
        let mut heard = Heard::new(Told::Odometry {
            message: message(arrival, &odometry.header, &content, taken.is_ok()),
            has_jumped: matches!(taken, Ok(Some(_))),
            wheels_disagree: self.estimator.wheels_disagree(),
        });
        match taken {
            Ok(jump) => {
                heard.jump = jump;
                let told = Pose::from_quaternion(reading.position_m, reading.orientation);
                heard.poses = self.estimator.pose().map(|believed| [believed, told]);
            }
            Err(error) => heard.complain("odometry", &error),
        }
        heard
    }

    /// Takes a message of the IMU.
    pub fn take_imu(&mut self, arrival: Arrival, imu: &Imu) -> Heard {
        let reading = estimator::Imu {
            at: arrival.at,
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
        let mut heard = Heard::new(Told::Imu {
            message: message(arrival, &imu.header, &content, taken.is_ok()),
            attitude_rad: self.estimator.attitude_rad(),
        });
        if let Err(error) = taken {
            heard.complain("IMU", &error);
        }
        heard
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
fn message(arrival: Arrival, header: &Header, content: &DefaultHasher, is_well_formed: bool) -> Message {
    Message {
        arrived: arrival.at,
        clock_ns: arrival.clock_ns,
        stamp_ns: header.stamp.nanoseconds(),
        fingerprint: content.finish(),
        is_well_formed,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive_config::DriveConfig;
    use crate::messages::{Header, PointField};

    #[test]
    fn a_cloud_whose_times_tell_nothing_is_told_of() {
        let config = DriveConfig::default();
        let mut senses = config.senses().unwrap();
        let field =
            |(name, offset): (&str, u32)| PointField { name: name.to_owned(), offset, datatype: 7, count: 1 };
        // A ring of returns 3 m away, all at the same time.
        let point = |k: usize| {
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * k as f64 / 360.0);
            [3.0 * cos, 3.0 * sin, -0.4, 0.0].map(|value| (value as f32).to_le_bytes()).concat()
        };
        let data: Vec<u8> = (0..360).flat_map(point).collect();
        let cloud = PointCloud2 {
            header: Header { frame_id: config.frames.scan.clone(), ..Header::default() },
            height: 1,
            width: 360,
            fields: [("x", 0), ("y", 4), ("z", 8), ("time", 12)].map(field).to_vec(),
            is_bigendian: false,
            point_step: 16,
            row_step: 16 * 360,
            data: data.into(),
            is_dense: true,
        };
        let heard = senses.take_scan(Arrival { at: Duration::from_secs(1), clock_ns: 0 }, &cloud);
        let [(what, complaint)] = heard.complaints.as_slice() else { panic!("{:?}", heard.complaints) };
        assert!(*what == "scan" && complaint.starts_with("field time spreads over 0"), "{complaint}");
    }
}
