//! Messages of sensors on their way to estimator, planner and supervisor.

use mapless_recording::Content;
use mapless_robot::senses::{Arrival, Heard, Senses as Meanings};

use crate::hub::{Hub, Revolution};
use crate::messages::{Imu, Odometry, PointCloud2, Time};

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
        let arrival = hub.arrival();
        let heard = self.meanings.take_scan(arrival, cloud);
        hear(hub, arrival, heard, || Content::Scan(cloud.clone()));
    }

    /// Takes a revolution of a sensor that sends packets, likewise. The sensor's clock is for the supervisor:
    /// what is published of the scan has the time of the node's.
    pub(crate) fn take_revolution(&mut self, hub: &Hub, revolution: Revolution) {
        let Revolution { arrival, cloud } = revolution;
        let mut heard = self.meanings.take_scan(arrival, &cloud);
        if let Some(scan) = &mut heard.scan {
            scan.stamp = Time::from_nanoseconds(arrival.clock_ns);
        }
        hear(hub, arrival, heard, || Content::Scan(cloud));
    }

    /// Takes odometry.
    pub(crate) fn take_odometry(&mut self, hub: &Hub, odometry: &Odometry) {
        let arrival = hub.arrival();
        let heard = self.meanings.take_odometry(arrival, odometry);
        hear(hub, arrival, heard, || Content::Odometry(Box::new(odometry.clone())));
    }

    /// Takes a message of the IMU.
    pub(crate) fn take_imu(&mut self, hub: &Hub, imu: &Imu) {
        let arrival = hub.arrival();
        let heard = self.meanings.take_imu(arrival, imu);
        hear(hub, arrival, heard, || Content::Imu(Box::new(imu.clone())));
    }
}

fn hear(hub: &Hub, arrival: Arrival, heard: Heard, content: impl FnOnce() -> Content) {
    for (what, complaint) in &heard.complaints {
        hub.complain(what, complaint);
    }
    if let Some(jump) = heard.jump {
        log::warn!("the odometry jumped from {} to {}", jump.before.position_m, jump.after.position_m);
        hub.jump();
    }
    hub.tell_of(arrival, content, |inputs| heard.tell(inputs));
    if let Some([believed, told]) = heard.poses {
        hub.set_poses(believed, told);
    }
    if let Some(scan) = heard.scan {
        hub.scan.put(scan);
    }
}
