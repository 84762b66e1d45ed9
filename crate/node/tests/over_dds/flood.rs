//! Malformed and forged RTPS, with what systemd would do about it.

use std::net::{Ipv4Addr, UdpSocket};
use std::os::unix::net::UnixDatagram;
use std::os::unix::process::ExitStatusExt as _;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use mapless_node::messages::{Imu, Twist, TwistStamped};
use ros2_client::{Node, Publisher, Subscription};

use crate::robot::Robot;
use crate::rtps::{Datagrams, fragment};
use crate::sockets::bound;
use crate::{DISCOVERY, Process, client, drive, peer, until};

/// `WatchdogSec` and `RestartSec` of the unit.
const WATCHDOG: Duration = Duration::from_secs(1);
const RESTART: Duration = Duration::from_millis(500);
/// A process that never was ready is started anew after this; systemd waits for half a minute.
const READY: Duration = Duration::from_secs(5);
/// No process goes on for longer without a command that arrives: a watchdog, and a busy machine.
const SILENCE: Duration = Duration::from_secs(3);
/// SIGABRT.
const ABORTED: i32 = 6;
/// What the process may take, kB, and what is not counted by its own limit.
const MOST_KB: u64 = (512 + 64) * 1024;

/// How long the flood lasts; `cargo xtask fuzz` asks for more.
fn flood() -> Duration {
    let seconds = std::env::var("MAPLESS_FLOOD_S").map_or(5.0, |text| text.parse().expect(&text));
    Duration::from_secs_f64(seconds)
}

/// Ports of UDP at which the process alone receives; those of multicast are shared with its peers (9.6.1).
fn ports(process: u32, domain_id: u16) -> Vec<u16> {
    let multicast = 7400 + 250 * domain_id;
    let all = bound(process, "udp").into_iter().map(|(_, port)| port);
    all.filter(|port| !(multicast..multicast + 10).contains(port)).collect()
}

/// Memory of a process that is not swapped out; `None` once it has ended.
fn resident_kb(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let row = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    row.trim().trim_end_matches(" kB").parse().ok()
}

/// One whose name the forged messages bear.
fn imu_publisher(node: &mut Node) -> Publisher<Imu> {
    mapless_peer::publisher(node, "sensors/imu_0/data", "sensor_msgs/Imu", 1).unwrap()
}

/// What systemd does for a service: restarts it when it has ended, or when its watchdog is not fed.
struct Systemd {
    process: Process,
    begun: Instant,
    /// When the watchdog was fed last.
    fed: Arc<Mutex<Option<Instant>>>,
    restarts: Vec<Instant>,
    fired: u32,
}

impl Systemd {
    fn start(domain_id: u16, folder: &Path) -> Self {
        let path = folder.join("notify");
        let socket = UnixDatagram::bind(&path).unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
        let fed = Arc::new(Mutex::new(None));
        let heard = Arc::downgrade(&fed);
        std::thread::spawn(move || {
            let mut bytes = [0; 256];
            while let Some(fed) = heard.upgrade() {
                if socket.recv(&mut bytes).is_ok_and(|length| bytes[..length].starts_with(b"WATCHDOG=1")) {
                    *fed.lock().unwrap() = Some(Instant::now());
                }
            }
        });
        let process = Process::start_as(domain_id, "", &[("NOTIFY_SOCKET", &path)]);
        Self { process, begun: Instant::now(), fed, restarts: Vec::new(), fired: 0 }
    }

    /// Whether the service goes on as it was.
    fn tend(&mut self) -> bool {
        let fed = self.fed.lock().unwrap().filter(|fed| *fed > self.begun);
        let is_silent = fed.map_or(self.begun.elapsed() > READY, |fed| fed.elapsed() > WATCHDOG);
        match self.process.child.try_wait().unwrap() {
            None if !is_silent => return true,
            None => {
                self.fired += 1;
                self.process.child.kill().unwrap();
                self.process.child.wait().unwrap();
            }
            Some(status) => {
                let log = self.process.log();
                // Of memory, or of a panic in the middleware, whose thread then ends.
                let is_foreseen = status.signal() == Some(ABORTED)
                    || status.code() == Some(1) && log.contains("a thread of the middleware ended");
                assert!(is_foreseen, "{status}: {log}");
            }
        }
        self.restarts.push(Instant::now());
        std::thread::sleep(RESTART);
        self.process.restart();
        self.begun = Instant::now();
        false
    }
}

#[test]
fn a_forged_fragment_takes_no_memory_of_the_computer() {
    let domain_id = 151 + (std::process::id() % 25) as u16;
    let mut process = Process::start(domain_id, "");
    let robot = Robot::start(peer(domain_id, "robot"));
    let mut node = peer(domain_id, "client");
    let client = client(&mut node);
    let mut stranger = peer(domain_id, "stranger");
    let known = imu_publisher(&mut stranger);
    drive(&client, &robot);

    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let forged = fragment(known.gid().to_bytes16(), u32::MAX);
    let ports = ports(process.child.id(), domain_id);
    let ended = until(DISCOVERY, || {
        for port in &ports {
            socket.send_to(&forged, (Ipv4Addr::LOCALHOST, *port)).unwrap();
        }
        std::thread::sleep(Duration::from_millis(20));
        process.child.try_wait().unwrap()
    });
    assert_eq!(ended.expect("it took all that memory").signal(), Some(ABORTED), "{}", process.log());
    assert!(process.log().contains("memory allocation of 4294967295 bytes failed"), "{}", process.log());

    process.restart();
    drive(&client, &robot);
}

#[test]
fn a_flood_moves_no_robot_and_does_not_hide_that_nothing_is_published() {
    let domain_id = 176 + (std::process::id() % 25) as u16;
    let folder = tempfile::tempdir().unwrap();
    let mut service = Systemd::start(domain_id, folder.path());
    let robot = Robot::start(peer(domain_id, "robot"));
    let mut node = peer(domain_id, "client");
    let client = client(&mut node);
    let commands: Subscription<TwistStamped> =
        mapless_peer::subscription(&mut node, "cmd_vel", "geometry_msgs/TwistStamped", 1).unwrap();
    let mut stranger = peer(domain_id, "stranger");
    let known = imu_publisher(&mut stranger);
    drive(&client, &robot);

    let mut datagrams = Datagrams::new(known.gid().as_bytes()[..12].try_into().unwrap());
    let (mut sent, mut most_kb, ends) = (0_u64, 0, AtomicBool::new(false));
    let begun = Instant::now();
    let heard: Vec<(Instant, Twist)> = std::thread::scope(|scope| {
        let heard = scope.spawn(|| {
            let mut heard = Vec::new();
            while !ends.load(Ordering::Relaxed) {
                while let Some((command, _)) = commands.take().unwrap() {
                    heard.push((Instant::now(), command.twist));
                }
                std::thread::sleep(Duration::from_millis(2));
            }
            heard
        });
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let mut ports = ports(service.process.child.id(), domain_id);
        while begun.elapsed() < flood() {
            for port in ports.iter().cycle().take(200) {
                // What finds no room in the node's buffer is lost, as on a network.
                let _ = socket.send_to(datagrams.next(), (Ipv4Addr::LOCALHOST, *port));
                sent += 1;
            }
            most_kb = most_kb.max(resident_kb(service.process.child.id()).unwrap_or(0));
            if !service.tend() {
                std::thread::sleep(RESTART);
                ports = self::ports(service.process.child.id(), domain_id);
            }
        }
        // It recovers by itself, or is started anew.
        let quiet = Instant::now();
        while quiet.elapsed() < 2 * READY {
            service.tend();
            std::thread::sleep(Duration::from_millis(10));
        }
        ends.store(true, Ordering::Relaxed);
        heard.join().unwrap()
    });
    let log = service.process.log();
    println!(
        "{sent} datagrams; {} restarts, {} of them by the watchdog; at most {most_kb} kB",
        service.restarts.len(),
        service.fired
    );
    let panics = log.lines().filter(|line| line.contains("panicked at") && !line.contains("/rustdds-"));
    assert_eq!(panics.count(), 0, "{log}");
    assert!(most_kb < MOST_KB, "{most_kb} kB");
    // While one process goes on, commands arrive.
    let times = heard.iter().map(|(at, _)| *at);
    let marks: Vec<Instant> = [begun].into_iter().chain(times).chain([Instant::now()]).collect();
    for pair in marks.windows(2) {
        let is_restarted = service.restarts.iter().any(|at| (pair[0]..pair[0] + SILENCE).contains(at));
        assert!(is_restarted || pair[1] - pair[0] < SILENCE, "no command for {:?}", pair[1] - pair[0]);
    }
    // A process that was started anew moves nothing before a new goal.
    if let Some(restarted) = service.restarts.first() {
        let later = heard.iter().filter(|(at, _)| *at > *restarted + RESTART);
        assert!(later.clone().all(|(_, twist)| *twist == Twist::default()));
    }
    drive(&client, &robot);
}
