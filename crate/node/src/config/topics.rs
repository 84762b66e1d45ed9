//! Names and types of topics, by distribution.

use mapless_parameters::choices;
use ros2_client::Name;
use serde::Deserialize;

choices! {
    /// A ROS 2 distribution whose message layouts are known.
    pub enum Distro {
        /// Humble Hawksbill.
        Humble = "humble",
        /// Jazzy Jalisco.
        Jazzy = "jazzy",
    }
}

impl Distro {
    /// The one that this program is built for.
    pub const BUILT: Self = if cfg!(feature = "humble") { Self::Humble } else { Self::Jazzy };
}

choices! {
    /// The type of the velocity command.
    pub enum CommandType {
        /// `geometry_msgs/Twist`, as Clearpath's Humble takes it.
        Twist = "twist",
        /// `geometry_msgs/TwistStamped`, as Clearpath's Jazzy takes it.
        TwistStamped = "twist_stamped",
    }
}

choices! {
    /// What a subscriber asks of a publisher.
    pub enum Reliability {
        /// Takes what arrives, from either kind of publisher.
        BestEffort = "best_effort",
        /// Asks for what was lost; hears nothing from a best-effort publisher.
        Reliable = "reliable",
    }
}

/// The topics, each absolute (`/a/b`) or within the namespace (`a/b`). Defaults are Clearpath's.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Topics {
    /// `sensor_msgs/PointCloud2`, read.
    pub scan: String,
    /// `nav_msgs/Odometry`, read.
    pub odometry: String,
    /// `sensor_msgs/Imu`, read.
    pub imu: String,
    /// `std_msgs/Bool`, read: true while the emergency stop is pressed.
    pub emergency_stop: String,
    /// `geometry_msgs/PoseStamped`, read.
    pub goal_pose: String,
    /// The command, written.
    pub cmd_vel: String,
    /// `geometry_msgs/TwistStamped`, written: the planner's answer to each scan, with its stamp.
    pub decision: String,
    /// `nav_msgs/Path`, written: the way that the planner means to go.
    pub path: String,
    /// `visualization_msgs/MarkerArray`, written: the subgoals; the chosen one green, refused ones red.
    pub subgoals: String,
    /// `visualization_msgs/MarkerArray`, written with `visualise`: the skyline; what can be driven to green.
    pub skyline: String,
    /// `sensor_msgs/PointCloud2`, written with `visualise`: the variance surface, and the predicted range.
    pub variance: String,
    /// `sensor_msgs/PointCloud2`, written with `visualise`: the ground that the planner remembers.
    pub elevation: String,
    /// `builtin_interfaces/Time`, written and read by the node itself: whether messages leave.
    pub heartbeat: String,
    /// `std_msgs/Bool`, read: true resets a latched stop.
    pub reset: String,
    /// `diagnostic_msgs/DiagnosticArray`, written.
    pub diagnostics: String,
    /// `nav2_msgs/NavigateToPose`, served.
    pub navigate_to_pose: String,
    /// `tf2_msgs/TFMessage`, read where `sensor_mount` asks for it: transforms that change.
    pub tf: String,
    /// `tf2_msgs/TFMessage`, likewise: transforms that hold for good.
    pub tf_static: String,
    /// `rosgraph_msgs/Clock`, read with `use_sim_time`.
    pub clock: String,
}

impl Default for Topics {
    fn default() -> Self {
        Self {
            scan: "sensors/lidar3d_0/points".to_owned(),
            odometry: "platform/odom/filtered".to_owned(),
            imu: "sensors/imu_0/data".to_owned(),
            emergency_stop: "platform/emergency_stop".to_owned(),
            goal_pose: "goal_pose".to_owned(),
            cmd_vel: "cmd_vel".to_owned(),
            decision: "mapless/decision".to_owned(),
            path: "mapless/path".to_owned(),
            subgoals: "mapless/subgoals".to_owned(),
            skyline: "mapless/skyline".to_owned(),
            variance: "mapless/variance".to_owned(),
            elevation: "mapless/elevation".to_owned(),
            heartbeat: "mapless/heartbeat".to_owned(),
            reset: "mapless/reset".to_owned(),
            diagnostics: "diagnostics".to_owned(),
            navigate_to_pose: "navigate_to_pose".to_owned(),
            tf: "tf".to_owned(),
            tf_static: "tf_static".to_owned(),
            clock: "/clock".to_owned(),
        }
    }
}

impl Topics {
    /// Every name with its key.
    pub(super) fn entries(&self) -> [(&'static str, &str); 19] {
        [
            ("scan", &self.scan),
            ("odometry", &self.odometry),
            ("imu", &self.imu),
            ("emergency_stop", &self.emergency_stop),
            ("goal_pose", &self.goal_pose),
            ("cmd_vel", &self.cmd_vel),
            ("decision", &self.decision),
            ("path", &self.path),
            ("subgoals", &self.subgoals),
            ("skyline", &self.skyline),
            ("variance", &self.variance),
            ("elevation", &self.elevation),
            ("heartbeat", &self.heartbeat),
            ("reset", &self.reset),
            ("diagnostics", &self.diagnostics),
            ("navigate_to_pose", &self.navigate_to_pose),
            ("tf", &self.tf),
            ("tf_static", &self.tf_static),
            ("clock", &self.clock),
        ]
    }
}

/// Why a text is no name of a topic.
pub(super) fn check_topic(name: &str) -> Result<(), String> {
    Name::parse(name).map(drop).map_err(|error| format!("{name:?} is no name of a topic: {error}"))
}
