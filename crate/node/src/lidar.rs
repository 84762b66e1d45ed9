//! The thread of a LiDAR that sends packets: takes them by UDP and puts revolutions together.

use std::io::ErrorKind;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::time::Duration;

use mapless_recording::{Content, SpoiltMessage};
use mapless_scans::PacketReceiver;
use rustdds::mio1::Waker;

use crate::config::Velodyne;
use crate::hub::{Hub, Revolution};
use crate::messages::{Header, PointCloud2, PointField, Time};

/// The longest wait for a packet, so that the end of the node is noticed.
const WAIT: Duration = Duration::from_millis(100);
/// More than a packet has: what is longer is cut, and then has no packet's length.
const LONGEST_BYTES: usize = 2048;
/// The sensor's clock begins again with each hour.
const HOUR_US: f64 = 3.6e9;

const FLOAT32: u8 = 7;
const FLOAT64: u8 = 8;
/// What a point of the cloud holds: name, offset and type.
const FIELDS: [(&str, u32, u8); 4] =
    [("x", 0, FLOAT32), ("y", 4, FLOAT32), ("z", 8, FLOAT32), ("time", 12, FLOAT64)];
const POINT_BYTES: u32 = 20;

/// The node cannot listen for packets.
#[derive(Debug, thiserror::Error)]
#[error("velodyne: listening at {address}: {error}")]
pub struct LidarError {
    address: SocketAddr,
    error: std::io::Error,
}

/// The socket of a sensor.
pub(crate) struct Lidar {
    socket: UdpSocket,
    from: IpAddr,
    waker: Waker,
    receiver: PacketReceiver,
    clock: SensorClock,
    frame_id: String,
}

impl Lidar {
    /// Listens. `waker` has the middleware's thread look for revolutions; `frame_id` is the sensor's frame.
    pub(crate) fn listen(config: &Velodyne, waker: Waker, frame_id: &str) -> Result<Self, LidarError> {
        let address = SocketAddr::new(config.address, config.port.get());
        let listen = || {
            let socket = UdpSocket::bind(address)?;
            socket.set_read_timeout(Some(WAIT))?;
            Ok(socket)
        };
        let socket = listen().map_err(|error| LidarError { address, error })?;
        log::info!("packets of {} are taken at {address}", config.from);
        let (receiver, clock) = (PacketReceiver::new(), SensorClock::default());
        Ok(Self { socket, from: config.from, waker, receiver, clock, frame_id: frame_id.to_owned() })
    }

    /// Takes packets until the node ends.
    pub(crate) fn run(mut self, hub: &Hub) {
        let mut payload = [0; LONGEST_BYTES];
        while !hub.is_ending() {
            match self.socket.recv_from(&mut payload) {
                Ok((_, sender)) if sender.ip() != self.from => {
                    let from = self.from;
                    hub.complain("packets", &format!("from {}: expected from {from}", sender.ip()));
                }
                Ok((bytes, _)) => self.take(hub, &payload[..bytes]),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                Err(error) => {
                    hub.complain("packets", &error);
                    std::thread::sleep(WAIT);
                }
            }
        }
    }

    fn take(&mut self, hub: &Hub, payload: &[u8]) {
        let whole = self.receiver.take(payload).unwrap_or_else(|fault| {
            spoilt(hub, &fault.to_string());
            None
        });
        if let Some(gap) = self.receiver.take_gap() {
            spoilt(hub, &gap);
        }
        let Some(revolution) = whole else { return };
        let arrival = hub.arrival();
        let stamp = Time::from_nanoseconds(self.clock.take(revolution.end_us, arrival.clock_ns));
        let cloud = cloud(&revolution, Header { stamp, frame_id: self.frame_id.clone() });
        hub.revolution.put(Revolution { arrival, cloud });
        if let Err(error) = self.waker.wake() {
            hub.complain("packets", &error);
        }
    }
}

/// A revolution is left out; a good one that the supervisor does not know yet stays.
fn spoilt(hub: &Hub, why: &str) {
    hub.complain("packets", &why);
    let (arrival, told) = (hub.arrival(), || Content::Spoilt(SpoiltMessage { why: why.to_owned() }));
    hub.tell_of(arrival, told, |inputs| inputs.hear_spoilt_scan(arrival.at, arrival.clock_ns));
}

/// A revolution as a driver would publish it, with the times of its points in seconds since its stamp.
fn cloud(revolution: &mapless_scans::Revolution, header: Header) -> PointCloud2 {
    let width = revolution.points_m.len() as u32;
    let mut data = Vec::with_capacity((width * POINT_BYTES) as usize);
    for (point_m, time_s) in revolution.points_m.iter().zip(&revolution.since_end_s) {
        point_m.to_array().iter().for_each(|axis_m| data.extend(axis_m.to_le_bytes()));
        data.extend(time_s.to_le_bytes());
    }
    let field = |(name, offset, datatype): (&str, u32, u8)| PointField {
        name: name.to_owned(),
        offset,
        datatype,
        count: 1,
    };
    PointCloud2 {
        header,
        height: 1,
        width,
        fields: FIELDS.map(field).to_vec(),
        is_bigendian: false,
        point_step: POINT_BYTES,
        row_step: POINT_BYTES * width,
        data: data.into(),
        is_dense: true,
    }
}

/// The sensor's clock, counted on past the hour.
#[derive(Debug, Default)]
struct SensorClock {
    last: Option<(f64, i64)>,
}

impl SensorClock {
    /// The time of a revolution, nanoseconds: the first one's is `begin_ns`. A step is taken the shorter way
    /// round the hour.
    fn take(&mut self, end_us: f64, begin_ns: i64) -> i64 {
        let time_ns = self.last.map_or(begin_ns, |(before_us, before_ns)| {
            let passed_us = (end_us - before_us + 0.5 * HOUR_US).rem_euclid(HOUR_US) - 0.5 * HOUR_US;
            before_ns.saturating_add((1e3 * passed_us) as i64)
        });
        self.last = Some((end_us, time_ns));
        time_ns
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless_robot::supervisor::Message;

    fn taken(hub: &Hub) -> Option<Message> {
        let mut scan = None;
        hub.tell(|inputs| scan = inputs.take().scan);
        scan
    }

    #[test]
    fn the_sensor_s_clock_goes_on_past_the_hour_and_back_if_it_was_set() {
        let mut clock = SensorClock::default();
        assert_eq!(clock.take(3_599_950_000.0, 5_000), 5_000);
        assert_eq!(clock.take(50_000.0, 0), 100_005_000);
        assert_eq!(clock.take(0.0, 0), 50_005_000);
    }

    #[test]
    fn a_spoilt_revolution_is_told_unless_a_good_one_waits() {
        let hub = Hub::new(false);
        spoilt(&hub, "a packet was lost");
        let told = taken(&hub);
        assert!(told.is_some_and(|message| !message.is_well_formed));
        assert_eq!(hub.complaints(), [("packets", "a packet was lost".to_owned())]);
        let good = Message { is_well_formed: true, ..told.unwrap() };
        hub.tell(|inputs| inputs.scan = Some(good));
        spoilt(&hub, "another one");
        assert_eq!(taken(&hub), Some(good));
    }
}
