//! The node that takes a sensor's packets over UDP.

use std::net::{Ipv4Addr, UdpSocket};
use std::time::{Duration, Instant};

use crate::robot::Robot;
use crate::sockets::bound;
use crate::velodyne::{SENSOR, Velodyne};
use crate::{DISCOVERY, Process, SLACK, client, drive, peer, until};

/// Ports of TCP and UDP at which a process listens, without those of the DDS domain and of senders.
fn listens_at(process: u32, domain_id: u16) -> Vec<String> {
    let dds = 7400 + 250 * domain_id;
    let ephemeral = std::fs::read_to_string("/proc/sys/net/ipv4/ip_local_port_range").unwrap();
    let ephemeral: u16 = ephemeral.split_whitespace().next().unwrap().parse().unwrap();
    let mut found = Vec::new();
    for table in ["tcp", "tcp6", "udp", "udp6"] {
        for (address, port) in bound(process, table) {
            let is_dds = table == "udp" && (dds..dds + 250).contains(&port);
            let is_sender = table == "udp" && port >= ephemeral;
            if !is_dds && !is_sender {
                found.push(format!("{table} {address}"));
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
    // A loaded machine may have missed some, and answers none twice.
    assert!((0.8 * turns..turns + 3.0).contains(&answered), "{answered} answers to {turns} turns");
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
