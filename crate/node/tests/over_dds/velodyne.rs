//! A VLP-16 on level ground that sends its packets over UDP.

use std::net::{IpAddr, Ipv4Addr, UdpSocket};
use std::time::Duration;

const LASERS: usize = 16;
const BLOCKS: usize = 12;
/// Two firing sequences.
const BLOCK_US: f64 = 110.592;
const TURN_US: f64 = 1e5;
const SENSOR_HEIGHT_M: f64 = 0.8;
/// Just before the sensor's clock begins again.
const BEGIN_US: f64 = 3.595e9;
/// The sensor's address.
pub(crate) const SENSOR: IpAddr = IpAddr::V4(Ipv4Addr::new(127, 0, 0, 2));

/// The sensor: ten turns a second.
pub(crate) struct Velodyne {
    socket: UdpSocket,
    port: u16,
    is_dual: bool,
    sent: u32,
}

impl Velodyne {
    /// A sensor that sends to a port of this machine, with one return a beam or two.
    pub(crate) fn new(port: u16, is_dual: bool) -> Self {
        Self { socket: UdpSocket::bind((SENSOR, 0)).unwrap(), port, is_dual, sent: 0 }
    }

    /// Sends what is due; `loses`: but for one packet of each turn.
    pub(crate) fn send_until(&mut self, time: Duration, loses: bool) {
        loop {
            let begin_us = f64::from(self.sent) * self.packet_us();
            if begin_us > 1e6 * time.as_secs_f64() {
                return;
            }
            let is_lost = loses && begin_us.rem_euclid(TURN_US) < self.packet_us();
            if !is_lost {
                let packet = packet(begin_us, self.is_dual);
                self.socket.send_to(&packet, (Ipv4Addr::LOCALHOST, self.port)).unwrap();
            }
            self.sent += 1;
        }
    }

    fn packet_us(&self) -> f64 {
        BLOCK_US * (BLOCKS / if self.is_dual { 2 } else { 1 }) as f64
    }
}

/// The packet that begins at a time: the ground, and a wall 30 m away with something thin 10 m before it.
fn packet(begin_us: f64, is_dual: bool) -> Vec<u8> {
    let mut packet = Vec::with_capacity(1206);
    for block in 0..BLOCKS {
        let (group, is_strongest) = if is_dual { (block / 2, block % 2 == 1) } else { (block, false) };
        let time_us = begin_us + BLOCK_US * group as f64;
        let azimuth = (36_000.0 * (time_us / TURN_US).fract()) as u16;
        packet.extend([0xff, 0xee]);
        packet.extend(azimuth.to_le_bytes());
        for laser in (0..LASERS).chain(0..LASERS) {
            let odd = laser % 2 == 1;
            let elevation_deg = if odd { laser as f64 } else { laser as f64 - 15.0 };
            let (sin, cos) = libm::sincos(elevation_deg.to_radians());
            let wall_m = if is_strongest && azimuth % 500 < 100 { 20.0 } else { 30.0 };
            let ground_m = if sin < 0.0 { -SENSOR_HEIGHT_M / sin } else { f64::INFINITY };
            // What is measured is never the same twice.
            let noise_m = 0.002 * (time_us as u64 % 3) as f64;
            let range_m = ground_m.min(wall_m / cos) + noise_m;
            packet.extend(((range_m / 0.002) as u16).to_le_bytes());
            packet.push(100);
        }
    }
    let stamp_us = (BEGIN_US + begin_us).rem_euclid(3.6e9) as u32;
    packet.extend(stamp_us.to_le_bytes());
    packet.extend([if is_dual { 0x39 } else { 0x37 }, 0x22]);
    packet
}
