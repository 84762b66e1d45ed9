//! A VLP-16 on level ground that sends its packets over UDP, and the node that takes them.

use std::net::{IpAddr, Ipv4Addr, UdpSocket};
use std::time::{Duration, Instant};

use crate::robot::Robot;
use crate::{DISCOVERY, Process, SLACK, client, drive, peer, until};

const LASERS: usize = 16;
const BLOCKS: usize = 12;
/// Two firing sequences.
const BLOCK_US: f64 = 110.592;
const TURN_US: f64 = 1e5;
const SENSOR_HEIGHT_M: f64 = 0.8;
/// Just before the sensor's clock begins again.
const BEGIN_US: f64 = 3.595e9;
const SENSOR: IpAddr = IpAddr::V4(Ipv4Addr::new(127, 0, 0, 2));

/// The sensor: ten turns a second.
pub(crate) struct Velodyne {
    socket: UdpSocket,
    port: u16,
    is_dual: bool,
    sent: u32,
}

impl Velodyne {
    fn new(port: u16, is_dual: bool) -> Self {
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

/// Ports of TCP and UDP at which a process listens, without those of the DDS domain and of senders.
fn listens_at(process: u32, domain_id: u16) -> Vec<String> {
    let links = std::fs::read_dir(format!("/proc/{process}/fd")).unwrap();
    let links = links.filter_map(|link| std::fs::read_link(link.ok()?.path()).ok());
    let sockets: Vec<String> = links.map(|link| link.display().to_string()).collect();
    let dds = 7400 + 250 * domain_id;
    let ephemeral = std::fs::read_to_string("/proc/sys/net/ipv4/ip_local_port_range").unwrap();
    let ephemeral: u16 = ephemeral.split_whitespace().next().unwrap().parse().unwrap();
    let mut found = Vec::new();
    for table in ["tcp", "tcp6", "udp", "udp6"] {
        let rows = std::fs::read_to_string(format!("/proc/{process}/net/{table}")).unwrap();
        for row in rows.lines().skip(1).map(|row| row.split_whitespace().collect::<Vec<_>>()) {
            let port = u16::from_str_radix(row[1].rsplit_once(':').unwrap().1, 16).unwrap();
            let is_dds = table == "udp" && (dds..dds + 250).contains(&port);
            let is_sender = table == "udp" && port >= ephemeral;
            if sockets.contains(&format!("socket:[{}]", row[9])) && !is_dds && !is_sender {
                found.push(format!("{table} {}", row[1]));
            }
        }
    }
    found
}

/// A port that nobody has, below those that the system gives to senders.
fn free_port(lowest: u16) -> u16 {
    (lowest..lowest + 5000).find(|port| UdpSocket::bind((Ipv4Addr::LOCALHOST, *port)).is_ok()).unwrap()
}

#[test]
fn a_robot_is_driven_by_packets_of_two_returns() {
    is_driven_by_packets(51 + (std::process::id() % 25) as u16, true, 20_000);
}

#[test]
fn a_robot_is_driven_by_packets_of_one_return() {
    is_driven_by_packets(101 + (std::process::id() % 25) as u16, false, 25_000);
}

/// And is stopped when they are lost.
fn is_driven_by_packets(domain_id: u16, is_dual: bool, lowest_port: u16) {
    let port = free_port(lowest_port);
    let more = format!("    velodyne: {{from: {SENSOR}, address: 127.0.0.1, port: {port}}}\n");
    let mut process = Process::start(domain_id, &more);
    let robot = Robot::start_with_packets(peer(domain_id, "robot"), Velodyne::new(port, is_dual));
    let mut node = peer(domain_id, "client");
    let client = client(&mut node);

    // Every turn is answered, also across the hour of the sensor's clock, and a stranger changes nothing.
    drive(&client, &robot);
    let stranger = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let (begun, before) = (Instant::now(), robot.decisions());
    while begun.elapsed() < Duration::from_secs(6) {
        stranger.send_to(&[0; 1206], (Ipv4Addr::LOCALHOST, port)).unwrap();
        std::thread::sleep(Duration::from_millis(10));
    }
    let turns = begun.elapsed().as_secs_f64() / 0.1;
    let answered = (robot.decisions() - before) as f64;
    assert!((answered - turns).abs() < 3.0, "{answered} answers to {turns} turns");
    let named = "packets: from 127.0.0.1: expected from 127.0.0.2";
    assert!(robot.diagnosis().contains(named), "{}", robot.diagnosis());
    assert_eq!(listens_at(process.child.id(), domain_id), [format!("udp 0100007F:{port:04X}")]);

    // A loaded machine may have paused the drive.
    until(Duration::from_secs(10), || robot.is_driven().then_some(())).expect("it does not drive");

    // A packet of each turn gets lost: no turn is whole, and the reason is named.
    let begun = Instant::now();
    robot.lose_packets();
    let stopped = until(Duration::from_secs(3), || (!robot.is_driven()).then(|| begun.elapsed())).unwrap();
    assert!(stopped < Duration::from_millis(450) + SLACK, "stopped {stopped:?} after the last whole turn");
    let named = "scan: Malformed";
    until(DISCOVERY, || robot.diagnosis().contains(named).then_some(())).expect(named);
    assert!(robot.diagnosis().contains("are missing by the sensor's time stamps"), "{}", robot.diagnosis());

    let recorded = process.end();
    assert!(recorded.contains("are missing by the sensor's time stamps"), "{recorded}");
}

#[test]
fn without_a_sensor_on_the_network_nothing_but_dds_listens() {
    let domain_id = 76 + (std::process::id() % 25) as u16;
    let process = Process::start(domain_id, "");
    let robot = Robot::start(peer(domain_id, "robot"));
    until(DISCOVERY, || (!robot.diagnosis().is_empty()).then_some(())).expect("no diagnostics came");
    assert_eq!(listens_at(process.child.id(), domain_id), Vec::<String>::new());
}
