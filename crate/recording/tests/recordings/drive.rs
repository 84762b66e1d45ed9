//! A drive over hills by the parts of the node, in the order in which its threads would call them.

use core::time::Duration;
use std::borrow::Cow;
use std::io::{Seek, Write};

use mapless::glam::{DQuat, DVec2, DVec3};
use mapless::{Command, PlannerConfig, Pose, RobotModel, SensorModel, Status};
use mapless_recording::{
    AnswerMessage, Content, Entry, Faults, GoalMessage, Head, Role, SpoiltMessage, TickMessage, Writer,
};
use mapless_robot::drive_config::DriveConfig;
use mapless_robot::messages::{
    Bool, Header, Imu, Odometry, Point, PointCloud2, PointField, PoseStamped, Quaternion, Time, Vector3,
};
use mapless_robot::navigation::{Navigation, goal_of};
use mapless_robot::pilot::Pilot;
use mapless_robot::senses::{Arrival, Heard, Scan, Senses};
use mapless_robot::supervisor::{Decision, Inputs, Proposal, Supervisor, SupervisorConfig};
use mapless_world::{Attitude, Caster, HeightField, Lidar, RobotConfig, Scene, SensorConfig, attitude_on};

/// The robot's clock when the recording begins, nanoseconds.
const BEGAN_NS: u64 = 1_700_000_000_000_000_000;
const BASE_M: f64 = 0.165;
const GOAL_M: DVec2 = DVec2::new(37.0, 28.0);

/// What is driven.
#[derive(Clone, Copy)]
pub(crate) struct Plan {
    /// Rings and azimuths of the sensor.
    pub(crate) rings: usize,
    pub(crate) columns: usize,
    pub(crate) seconds: f64,
    /// When the emergency stop is pressed, for 0.2 s.
    pub(crate) pressed_s: f64,
    /// When the limits are lowered, the planner is set otherwise and a scan is spoilt.
    pub(crate) changed_s: f64,
}

pub(crate) struct Drive {
    plan: Plan,
    caster: Caster,
    lidar: Lidar,
    pose: Pose,
    senses: Senses,
    pilot: Pilot,
    supervisor: Supervisor,
    pub(crate) navigation: Navigation<()>,
    pub(crate) inputs: Inputs,
    poses: Option<[Pose; 2]>,
    /// The planner is to forget the ground: the localisation jumped.
    has_jumped: bool,
    scan: Option<Scan>,
    proposal: Option<Proposal>,
    /// The supervisor's last one.
    pub(crate) decision: Option<Decision>,
    status: Option<Status>,
    /// What goes wrong.
    pub(crate) faults: Faults,
    /// The next goal, in the odometry's frame.
    pub(crate) goal_m: DVec2,
    pub(crate) config: DriveConfig,
    /// What took effect, until somebody takes it.
    pub(crate) entries: Vec<Entry>,
}

fn hills() -> Caster {
    let height = |index: u32| {
        let (x, y) = (0.25 * f64::from(index % 241), 0.25 * f64::from(index / 241));
        (0.35 * libm::sin(0.6 * x) * libm::cos(0.45 * y) + 0.002 * (x - 30.0) * (x - 30.0)) as f32
    };
    Caster::new(HeightField::new(241, 241, 0.25, (0..241 * 241).map(height).collect()).unwrap())
}

fn config(plan: Plan) -> DriveConfig {
    let mut sensor = SensorModel::vlp16();
    (sensor.rings, sensor.columns) = (plan.rings, plan.columns);
    let planner = PlannerConfig::for_robot(sensor, RobotModel::husky());
    let mut config = DriveConfig { planner, ..DriveConfig::default() };
    config.supervisor.clear_after_s = 0.3;
    config
}

/// The head and the entries of a drive.
pub(crate) fn drive(plan: Plan) -> (Head, Vec<Entry>) {
    let mut drive = Drive::new(plan);
    for tick in 0..(100.0 * plan.seconds) as u64 {
        drive.step(tick);
    }
    let topic = |role: Role| (role, format!("/a200_0000/{}", role.name()));
    let topics = Role::INPUTS.into_iter().map(topic).collect();
    (Head { began_ns: BEGAN_NS, config: drive.config, topics }, drive.entries)
}

/// Writes the recording of a drive.
pub(crate) fn write<W: Write + Seek>(out: W, (head, entries): &(Head, Vec<Entry>)) -> W {
    let mut writer = Writer::new(out, head).unwrap();
    for (index, entry) in entries.iter().enumerate() {
        writer.write(entry).unwrap();
        if index % 100 == 99 {
            writer.flush().unwrap();
        }
    }
    writer.finish().unwrap()
}

impl Drive {
    /// A robot that stands in the hills and has heard nothing.
    pub(crate) fn new(plan: Plan) -> Self {
        let config = config(plan);
        let sensor = SensorConfig {
            rings: plan.rings,
            columns: plan.columns,
            max_range_m: 30.0,
            ..SensorConfig::default()
        };
        Self {
            plan,
            caster: hills(),
            lidar: Lidar::new(sensor).unwrap(),
            pose: Pose::from_roll_pitch_yaw(DVec3::new(25.0, 25.0, 0.0), 0.0, 0.0, 0.3),
            senses: config.senses().unwrap(),
            pilot: Pilot::new(config.planner.clone()).unwrap(),
            supervisor: Supervisor::new(config.supervisor).unwrap(),
            navigation: Navigation::new(Duration::from_secs(60)),
            inputs: Inputs::default(),
            poses: None,
            has_jumped: false,
            scan: None,
            proposal: None,
            decision: None,
            status: None,
            faults: Faults::default(),
            goal_m: GOAL_M,
            config,
            entries: Vec::new(),
        }
    }

    /// Ten milliseconds.
    pub(crate) fn step(&mut self, tick: u64) {
        let arrival = |micros: u64| {
            let at = Duration::from_nanos(10_000_000 * tick + 1000 * micros + 7 * (tick % 13));
            Arrival { at, clock_ns: BEGAN_NS as i64 + at.as_nanos() as i64 }
        };
        let at_s = 0.01 * tick as f64;
        let plan = self.plan;
        self.move_on();
        if tick.is_multiple_of(5) {
            self.take(arrival(0), Content::Imu(Box::new(self.imu(arrival(0), tick))));
        }
        if tick % 10 == 1 {
            self.take(arrival(10), Content::Odometry(Box::new(self.odometry(arrival(10)))));
        }
        if tick % 20 == 2 {
            let data = (plan.pressed_s..plan.pressed_s + 0.2).contains(&at_s);
            self.take(arrival(20), Content::EmergencyStop(Bool { data }));
        }
        // The first sweep needs poses from before it.
        if tick > 20 && tick % 10 == 3 {
            self.take(arrival(30), Content::Scan(self.cloud(arrival(30), tick)));
        }
        if tick % 10 == 4
            && let (Some(scan), Some(task)) = (self.scan.take(), self.navigation.task())
        {
            let has_jumped = std::mem::take(&mut self.has_jumped);
            let answer = self.pilot.answer(&scan, task, has_jumped);
            self.put(arrival(40), Content::Answer(AnswerMessage::new(&answer, has_jumped)));
            (self.proposal, self.status) = (Some(answer.proposal), answer.status);
        }
        if tick == (100.0 * plan.changed_s) as u64 {
            self.change(arrival(45));
        }
        if tick.is_multiple_of(2) || self.proposal.is_some() {
            self.tick(arrival(50));
        }
        if tick % 10 == 6 && self.navigation.task().is_none() && at_s < plan.pressed_s {
            self.ask(arrival(60));
        }
    }

    /// What comes of a message that is sent.
    fn take(&mut self, arrival: Arrival, content: Content) {
        let sent = Entry { arrival, content };
        let Some(came) = self.faults.message(&sent).map(Cow::into_owned) else { return };
        let heard = match &came.content {
            Content::Imu(imu) => Some(self.senses.take_imu(arrival, imu)),
            Content::Odometry(odometry) => Some(self.senses.take_odometry(arrival, odometry)),
            Content::Scan(cloud) => Some(self.senses.take_scan(arrival, cloud)),
            Content::EmergencyStop(pressed) => {
                self.inputs.hear_emergency_stop(pressed.data);
                None
            }
            _ => None,
        };
        if let Some(heard) = heard {
            self.hear(heard);
        }
        self.entries.push(came);
    }

    /// Parameters that are set while it drives, and a packet that is lost.
    fn change(&mut self, arrival: Arrival) {
        let limits = SupervisorConfig { max_speed_m_s: 0.2, ..self.config.supervisor };
        self.put(arrival, Content::Limits(Box::new(limits)));
        self.supervisor.limit(&limits).unwrap();
        let planner = PlannerConfig { goal_tolerance_m: 1.5, ..self.config.planner.clone() };
        self.put(arrival, Content::Planner(Box::new(planner.clone())));
        self.pilot.configure(planner).unwrap();
        self.put(arrival, Content::Spoilt(SpoiltMessage { why: "a packet was lost".to_owned() }));
        self.inputs.hear_spoilt_scan(arrival.at, arrival.clock_ns);
    }

    fn put(&mut self, arrival: Arrival, content: Content) {
        self.entries.push(Entry { arrival, content });
    }

    fn hear(&mut self, heard: Heard) {
        assert!(heard.complaints.is_empty() || !self.faults.0.is_empty(), "{:?}", heard.complaints);
        heard.tell(&mut self.inputs);
        self.has_jumped |= heard.jump.is_some();
        self.poses = heard.poses.or(self.poses);
        self.scan = heard.scan.or(self.scan.take());
    }

    fn tick(&mut self, arrival: Arrival) {
        self.inputs.has_peer = true;
        self.inputs.other_publishers = 0;
        let mut proposal = self.proposal.take();
        if !self.faults.tick(arrival.at, &mut self.inputs, &mut proposal) {
            return;
        }
        let inputs = self.inputs.take();
        let decision = self.supervisor.tick(arrival.at, &inputs, proposal.as_ref());
        self.put(arrival, Content::Tick(TickMessage::new(&inputs, proposal.as_ref(), &decision)));
        self.decision = Some(decision);
        if self.navigation.check(&decision, self.status, arrival.at).is_some() {
            self.serve(arrival);
        }
    }

    fn ask(&mut self, arrival: Arrival) {
        let mut pose = PoseStamped { header: self.header("odom", arrival), ..PoseStamped::default() };
        pose.pose.position = Point { x: self.goal_m.x, y: self.goal_m.y, z: 0.0 };
        self.put(arrival, Content::GoalPose(pose.clone()));
        if let Ok(goal) = goal_of(&pose, "odom", self.decision.as_ref(), self.poses, false) {
            self.navigation.accept(goal, None, arrival.at);
            self.status = None;
            self.serve(arrival);
        }
    }

    fn serve(&mut self, arrival: Arrival) {
        let task = self.navigation.task();
        self.inputs.goal = task.map(|task| task.number);
        self.put(arrival, Content::Goal(GoalMessage::new(task.as_ref())));
    }

    /// What the robot does: the last command.
    fn command(&self) -> [f64; 2] {
        let Command { linear_m_s, angular_rad_s } =
            self.decision.map_or(Command::STOP, |decision| decision.command);
        [linear_m_s, angular_rad_s]
    }

    fn attitude(&self) -> Attitude {
        attitude_on(self.caster.field(), self.pose.plan_m(), self.pose.yaw_rad, &RobotConfig::default())
            .unwrap()
    }

    fn move_on(&mut self) {
        let [linear_m_s, angular_rad_s] = self.command();
        let (sin, cos) = libm::sincos(self.pose.yaw_rad);
        let plan_m = self.pose.plan_m() + 0.01 * linear_m_s * DVec2::new(cos, sin);
        self.pose =
            Pose::from_roll_pitch_yaw(plan_m.extend(0.0), 0.0, 0.0, self.pose.yaw_rad + 0.01 * angular_rad_s);
        let Attitude { height_m, roll_rad, pitch_rad } = self.attitude();
        self.pose =
            Pose::from_roll_pitch_yaw(plan_m.extend(height_m), roll_rad, pitch_rad, self.pose.yaw_rad);
    }

    fn header(&self, frame_id: &str, arrival: Arrival) -> Header {
        let stamp = Time::from_nanoseconds(arrival.clock_ns - 2_000_000);
        Header { stamp, frame_id: frame_id.to_owned() }
    }

    fn imu(&self, arrival: Arrival, tick: u64) -> Imu {
        let DQuat { x, y, z, w } = DQuat::from_mat3(&self.pose.world_from_robot());
        // What is measured is never the same twice.
        let noise = 1e-6 * (tick % 997) as f64;
        Imu {
            header: self.header("imu_0_link", arrival),
            orientation: Quaternion { x, y, z, w },
            angular_velocity: Vector3 { x: 0.0, y: 0.0, z: self.command()[1] + noise },
            ..Imu::default()
        }
    }

    fn odometry(&self, arrival: Arrival) -> Odometry {
        let base_m = self.pose.moved(DVec3::Z * BASE_M).position_m;
        let [linear_m_s, angular_rad_s] = self.command();
        let mut odometry = Odometry { header: self.header("odom", arrival), ..Odometry::default() };
        odometry.child_frame_id = "base_link".to_owned();
        odometry.pose.pose.position = Point { x: base_m.x, y: base_m.y, z: 0.0 };
        odometry.pose.pose.orientation = Quaternion::from_yaw(self.pose.yaw_rad);
        odometry.twist.twist.linear.x = linear_m_s;
        odometry.twist.twist.angular.z = angular_rad_s;
        odometry
    }

    /// The sensor's returns, each with its time in milliseconds.
    fn cloud(&self, arrival: Arrival, tick: u64) -> PointCloud2 {
        const STEP: u32 = 14;
        let sensor = self.lidar.config().pose_on(self.pose.plan_m(), self.pose.yaw_rad, &self.attitude());
        let mut scan = mapless_world::Scan::default();
        self.lidar.scan_along(30.0, &Scene::bare(&self.caster), |_| sensor, 1, tick, &mut scan);
        let rings = self.lidar.config().rings;
        let beams = scan.ranges_m.iter().enumerate().filter(|(_, range_m)| !range_m.is_nan());
        let mut data = Vec::new();
        for ((beam, _), point_m) in beams.zip(&scan.points) {
            point_m.to_array().iter().for_each(|axis| data.extend(axis.to_le_bytes()));
            let share = (beam / rings) as f64 / self.lidar.config().columns as f64;
            data.extend(((100.0 * share) as u16).to_le_bytes());
        }
        let field =
            |name: &str, offset, datatype| PointField { name: name.to_owned(), offset, datatype, count: 1 };
        let width = data.len() as u32 / STEP;
        PointCloud2 {
            header: self.header("lidar3d_0_laser", arrival),
            height: 1,
            width,
            fields: vec![field("x", 0, 7), field("y", 4, 7), field("z", 8, 7), field("time", 12, 4)],
            is_bigendian: false,
            point_step: STEP,
            row_step: STEP * width,
            data: data.into(),
            is_dense: true,
        }
    }
}
