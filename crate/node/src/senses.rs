//! Messages of sensors on their way to estimator, planner and supervisor.

use mapless_robot::senses::{Heard, Senses as Meanings};

use crate::hub::Hub;
use crate::messages::{Imu, Odometry, PointCloud2};

/// Follows the robot's pose, and tells supervisor and planner of every message.
pub(crate) struct Senses {
    meanings: Meanings,
}

impl Senses {
    pub(crate) fn new(meanings: Meanings) -> Self {
        Self { meanings }
    }

    /// Takes a scan: to the planner, if it can be used and the pose is known.
    pub(crate) fn take_scan(&mut self, hub: &Hub, cloud: &PointCloud2) {
        let heard = self.meanings.take_scan(hub.arrival(), cloud);
        hear(hub, heard);
    }

    /// Takes odometry.
    pub(crate) fn take_odometry(&mut self, hub: &Hub, odometry: &Odometry) {
        let heard = self.meanings.take_odometry(hub.arrival(), odometry);
        hear(hub, heard);
    }

    /// Takes a message of the IMU.
    pub(crate) fn take_imu(&mut self, hub: &Hub, imu: &Imu) {
        let heard = self.meanings.take_imu(hub.arrival(), imu);
        hear(hub, heard);
    }
}

fn hear(hub: &Hub, heard: Heard) {
    for (what, complaint) in &heard.complaints {
        hub.complain(what, complaint);
    }
    if let Some(jump) = heard.jump {
        log::warn!("the odometry jumped from {} to {}", jump.before.position_m, jump.after.position_m);
        hub.jump();
    }
    hub.tell(|inputs| heard.tell(inputs));
    if let Some([believed, told]) = heard.poses {
        hub.set_poses(believed, told);
    }
    if let Some(scan) = heard.scan {
        hub.scan.put(scan);
    }
}
