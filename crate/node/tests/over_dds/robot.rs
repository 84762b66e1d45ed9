//! A robot on level ground.

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use crate::velodyne::Velodyne;
use mapless_node::messages::{
    Bool, Clock, DiagnosticArray, Header, Imu, Odometry, PointCloud2, PointField, Quaternion, Time, Twist,
    TwistStamped, now,
};
use ros2_client::{Node, Publisher, Subscription};
use serde::Serialize;
use serde::de::DeserializeOwned;

const RINGS: usize = 16;
const COLUMNS: usize = 900;
const SENSOR_HEIGHT_M: f32 = 0.8;
const PERIOD: Duration = Duration::from_millis(10);

#[derive(Default)]
struct State {
    position_m: [f64; 2],
    yaw_rad: f64,
    command: Twist,
    roll_rad: f64,
    is_blind: bool,
    loses_packets: bool,
    decisions: usize,
    diagnosis: String,
    resets: bool,
    is_ending: bool,
    /// Its time.
    stamp: Time,
}

/// The robot: obeys `cmd_vel` and publishes what it senses, on a thread of its own.
pub(crate) struct Robot {
    state: Arc<Mutex<State>>,
    thread: Option<std::thread::JoinHandle<()>>,
}

struct Sensors {
    _node: Node,
    scan: Scans,
    odometry: Publisher<Odometry>,
    imu: Publisher<Imu>,
    stop: Publisher<Bool>,
    reset: Publisher<Bool>,
    /// The rate of its time over the system's, if it is simulated, and who hears of it.
    clock: Option<(f64, Publisher<Clock>)>,
    commands: Subscription<TwistStamped>,
    decisions: Subscription<TwistStamped>,
    diagnostics: Subscription<DiagnosticArray>,
}

/// How scans are sent.
enum Scans {
    Clouds(Box<Publisher<PointCloud2>>),
    Packets(Velodyne),
}

/// As the robot's drivers do, it keeps the newest alone.
const DEPTH: usize = 1;

fn subscription<M: DeserializeOwned + 'static>(
    node: &mut Node,
    topic: &str,
    message: &str,
) -> Subscription<M> {
    mapless_peer::subscription(node, topic, message, DEPTH).unwrap()
}

fn publisher<M: Serialize>(node: &mut Node, topic: &str, message: &str) -> Publisher<M> {
    mapless_peer::publisher(node, topic, message, DEPTH).unwrap()
}

impl Robot {
    /// Its scans are clouds.
    pub(crate) fn start(mut node: Node) -> Self {
        let scan = publisher(&mut node, "sensors/lidar3d_0/points", "sensor_msgs/PointCloud2");
        Self::start_with(node, Scans::Clouds(Box::new(scan)), None)
    }

    /// Its time passes at another rate than the system's.
    pub(crate) fn start_simulated(mut node: Node, rate: f64) -> Self {
        let scan = publisher(&mut node, "sensors/lidar3d_0/points", "sensor_msgs/PointCloud2");
        let clock = publisher(&mut node, "/clock", "rosgraph_msgs/Clock");
        Self::start_with(node, Scans::Clouds(Box::new(scan)), Some((rate, clock)))
    }

    /// Its scans are packets.
    pub(crate) fn start_with_packets(node: Node, velodyne: Velodyne) -> Self {
        Self::start_with(node, Scans::Packets(velodyne), None)
    }

    fn start_with(mut node: Node, scan: Scans, clock: Option<(f64, Publisher<Clock>)>) -> Self {
        let sensors = Sensors {
            clock,
            commands: subscription(&mut node, "cmd_vel", "geometry_msgs/TwistStamped"),
            decisions: subscription(&mut node, "mapless/decision", "geometry_msgs/TwistStamped"),
            diagnostics: subscription(&mut node, "diagnostics", "diagnostic_msgs/DiagnosticArray"),
            scan,
            odometry: publisher(&mut node, "platform/odom/filtered", "nav_msgs/Odometry"),
            imu: publisher(&mut node, "sensors/imu_0/data", "sensor_msgs/Imu"),
            stop: publisher(&mut node, "platform/emergency_stop", "std_msgs/Bool"),
            reset: publisher(&mut node, "mapless/reset", "std_msgs/Bool"),
            _node: node,
        };
        let state = Arc::new(Mutex::new(State::default()));
        let shared = Arc::clone(&state);
        let thread = std::thread::spawn(move || go(&shared, sensors));
        Self { state, thread: Some(thread) }
    }

    fn set(&self, change: impl FnOnce(&mut State)) {
        change(&mut self.state.lock().unwrap());
    }

    pub(crate) fn position_m(&self) -> [f64; 2] {
        self.state.lock().unwrap().position_m
    }

    /// Its time.
    pub(crate) fn stamp(&self) -> Time {
        self.state.lock().unwrap().stamp
    }

    /// Whether the last command moves it.
    pub(crate) fn is_driven(&self) -> bool {
        self.state.lock().unwrap().command != Twist::default()
    }

    /// The speed that was last commanded.
    pub(crate) fn speed_m_s(&self) -> f64 {
        self.state.lock().unwrap().command.linear.x
    }

    /// Decisions that came, one for each scan.
    pub(crate) fn decisions(&self) -> usize {
        self.state.lock().unwrap().decisions
    }

    /// The last status, and the complaints in it.
    pub(crate) fn diagnosis(&self) -> String {
        self.state.lock().unwrap().diagnosis.clone()
    }

    /// From now on one packet of each revolution gets lost.
    pub(crate) fn lose_packets(&self) {
        self.set(|state| state.loses_packets = true);
    }

    pub(crate) fn tilt(&self, roll_rad: f64) {
        self.set(|state| state.roll_rad = roll_rad);
    }

    pub(crate) fn reset(&self) {
        self.set(|state| state.resets = true);
    }

    /// No scan comes from now on.
    pub(crate) fn blind(&self) {
        self.set(|state| state.is_blind = true);
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        self.set(|state| state.is_ending = true);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn go(state: &Mutex<State>, mut sensors: Sensors) {
    let begun = Instant::now();
    for tick in 0_u32.. {
        let mut state = state.lock().unwrap();
        if state.is_ending {
            return;
        }
        while let Some((command, _)) = sensors.commands.take().unwrap() {
            state.command = command.twist;
        }
        while sensors.decisions.take().unwrap().is_some() {
            state.decisions += 1;
        }
        while let Some((mut diagnostics, _)) = sensors.diagnostics.take().unwrap() {
            let status = diagnostics.status.remove(0);
            let values = status.values.iter().map(|value| format!("; {}: {}", value.key, value.value));
            state.diagnosis = status.message + &values.collect::<String>();
        }
        let period_s = match &sensors.clock {
            None => {
                state.stamp = now();
                PERIOD.as_secs_f64()
            }
            Some((rate, clock)) => {
                let period = PERIOD.mul_f64(*rate);
                state.stamp = Time::from_nanoseconds((period * tick).as_nanos() as i64);
                clock.publish(Clock { clock: state.stamp }).unwrap();
                period.as_secs_f64()
            }
        };
        let (speed_m_s, turn_rad_s) = (state.command.linear.x, state.command.angular.z);
        let (sin, cos) = libm::sincos(state.yaw_rad);
        let way_m = speed_m_s * period_s;
        state.position_m = [state.position_m[0] + way_m * cos, state.position_m[1] + way_m * sin];
        state.yaw_rad += turn_rad_s * period_s;
        // What is measured is never the same twice.
        let noise = 1e-6 * f64::from(tick % 997);
        sensors.imu.publish(imu(&state, noise)).unwrap();
        if tick % 2 == 0 {
            sensors.odometry.publish(odometry(&state)).unwrap();
        }
        if tick % 10 == 0 {
            sensors.stop.publish(Bool { data: false }).unwrap();
            if std::mem::take(&mut state.resets) {
                sensors.reset.publish(Bool { data: true }).unwrap();
            }
            if let (Scans::Clouds(publisher), false) = (&sensors.scan, state.is_blind) {
                publisher.publish(scan(&state, noise as f32)).unwrap();
            }
        }
        if let (Scans::Packets(velodyne), false) = (&mut sensors.scan, state.is_blind) {
            velodyne.send_until(begun.elapsed(), state.loses_packets);
        }
        drop(state);
        std::thread::sleep((begun + PERIOD * tick).saturating_duration_since(Instant::now()));
    }
}

fn header(state: &State, frame_id: &str) -> Header {
    Header { stamp: state.stamp, frame_id: frame_id.to_owned() }
}

fn imu(state: &State, noise: f64) -> Imu {
    let (sin, cos) = libm::sincos(0.5 * state.roll_rad);
    let mut imu = Imu { header: header(state, "imu_0_link"), ..Imu::default() };
    imu.orientation = Quaternion { x: sin, y: 0.0, z: 0.0, w: cos };
    imu.angular_velocity.z = state.command.angular.z + noise;
    imu.linear_acceleration.z = 9.81 + noise;
    imu
}

fn odometry(state: &State) -> Odometry {
    let mut odometry = Odometry {
        header: header(state, "odom"),
        child_frame_id: "base_link".to_owned(),
        ..Odometry::default()
    };
    [odometry.pose.pose.position.x, odometry.pose.pose.position.y] = state.position_m;
    odometry.pose.pose.orientation = Quaternion::from_yaw(state.yaw_rad);
    odometry.twist.twist = state.command;
    odometry
}

/// Level ground as a VLP-16 sees it; what looks up meets a wall 30 m away.
fn scan(state: &State, noise: f32) -> PointCloud2 {
    let mut data = Vec::with_capacity(12 * RINGS * COLUMNS);
    for column in 0..COLUMNS {
        let (sin_a, cos_a) = libm::sincosf((360.0 / COLUMNS as f32 * column as f32).to_radians());
        for ring in 0..RINGS {
            let (sin_e, cos_e) = libm::sincosf((2.0 * ring as f32 - 15.0).to_radians());
            let ground_m = if sin_e < 0.0 { -SENSOR_HEIGHT_M / sin_e } else { f32::INFINITY };
            let range_m = ground_m.min(30.0 / cos_e) + noise;
            for axis in [cos_e * cos_a, cos_e * sin_a, sin_e] {
                data.extend((range_m * axis).to_le_bytes());
            }
        }
    }
    let field = |name: &str, offset| PointField { name: name.to_owned(), offset, datatype: 7, count: 1 };
    PointCloud2 {
        header: header(state, "lidar3d_0_laser"),
        height: 1,
        width: (RINGS * COLUMNS) as u32,
        fields: vec![field("x", 0), field("y", 4), field("z", 8)],
        is_bigendian: false,
        point_step: 12,
        row_step: (12 * RINGS * COLUMNS) as u32,
        data: data.into(),
        is_dense: true,
    }
}
