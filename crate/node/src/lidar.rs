//! The thread of a LiDAR that sends packets: takes them by UDP and puts revolutions together.

use std::io::ErrorKind;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::time::Duration;

use mapless_robot::supervisor::Message;
use mapless_scans::PacketReceiver;
use rustdds::mio1::Waker;

use crate::config::Velodyne;
use crate::hub::{Arrived, Hub};

/// The longest wait for a packet, so that the end of the node is noticed.
const WAIT: Duration = Duration::from_millis(100);
/// More than a packet has: what is longer is cut, and then has no packet's length.
const LONGEST_BYTES: usize = 2048;
/// The sensor's clock begins again with each hour.
const HOUR_US: f64 = 3.6e9;

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
}

impl Lidar {
    /// Listens. `waker` has the middleware's thread look for revolutions.
    pub(crate) fn listen(config: &Velodyne, waker: Waker) -> Result<Self, LidarError> {
        let address = SocketAddr::new(config.address, config.port.get());
        let listen = || {
            let socket = UdpSocket::bind(address)?;
            socket.set_read_timeout(Some(WAIT))?;
            Ok(socket)
        };
        let socket = listen().map_err(|error| LidarError { address, error })?;
        log::info!("packets of {} are taken at {address}", config.from);
        let (receiver, clock) = (PacketReceiver::new(), SensorClock::default());
        Ok(Self { socket, from: config.from, waker, receiver, clock })
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
        let (at, stamp) = (hub.now(), hub.stamp());
        let sensor_ns = self.clock.take(revolution.end_us, stamp.nanoseconds());
        hub.revolution.put(Arrived { at, stamp, sensor_ns, revolution });
        if let Err(error) = self.waker.wake() {
            hub.complain("packets", &error);
        }
    }
}

/// A revolution is left out; a good one that the supervisor does not know yet stays.
fn spoilt(hub: &Hub, why: &str) {
    hub.complain("packets", &why);
    let clock_ns = hub.stamp().nanoseconds();
    let message =
        Message { arrived: hub.now(), clock_ns, stamp_ns: 0, fingerprint: 0, is_well_formed: false };
    hub.tell(|inputs| {
        inputs.scan.get_or_insert(message);
    });
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
        let told = hub.take_inputs().scan;
        assert!(told.is_some_and(|message| !message.is_well_formed));
        assert_eq!(hub.complaints(), [("packets", "a packet was lost".to_owned())]);
        let good = Message { is_well_formed: true, ..told.unwrap() };
        hub.tell(|inputs| inputs.scan = Some(good));
        spoilt(&hub, "another one");
        assert_eq!(hub.take_inputs().scan, Some(good));
    }
}
