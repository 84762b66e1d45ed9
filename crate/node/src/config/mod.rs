//! The node's configuration: one file in the form of ROS 2's parameter files.

mod merge;
mod recording;
mod sections;
mod topics;
mod yaml;

#[cfg(test)]
mod tests;

use std::path::Path;

use mapless::{PlannerConfig, RobotModel, SensorModel};
use mapless_parameters::ConfigError;
use mapless_robot::cloud::check_sensor;
use mapless_robot::drive_config::DriveConfig;
use mapless_robot::estimator::EstimatorConfig;
use mapless_robot::supervisor::SupervisorConfig;
use ros2_client::NodeName;
use serde::Deserialize;
use serde_json::Value;

pub(crate) use merge::merged;
pub use recording::RecordingConfig;
pub use sections::{
    Frames, ImuMount, Mount, MountSource, NavigationConfig, PlannerPreset, RobotPreset, SensorMount, Velodyne,
};
pub use topics::{CommandType, Distro, Reliability, Topics};
pub use yaml::ConfigFileError;
use yaml::YamlFile;

/// The key that parameters of every node stand under.
const EVERY_NODE: &str = "/**";
const PARAMETERS: &str = "ros__parameters";
/// ROS 2 has this many domains on Linux.
const LAST_DOMAIN: u16 = 232;

/// Everything that the node is told.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeConfig {
    /// Such as `/a200_0000`.
    pub namespace: String,
    /// The node's name within it.
    pub node_name: String,
    /// The DDS domain.
    pub domain_id: u16,
    /// Whether time is read from `/clock`.
    pub use_sim_time: bool,
    /// Names of topics.
    pub topics: Topics,
    /// Whether skyline and variance are published with each answer, and the remembered ground each second.
    pub visualise: bool,
    /// What is asked of the publishers of scan, odometry and IMU.
    pub sensor_reliability: Reliability,
    /// The sensor whose packets are taken by UDP; `None`: scans come by topic.
    pub velodyne: Option<Velodyne>,
    /// The type of the command.
    pub command_type: CommandType,
    /// What the drive depends on besides messages.
    pub drive: DriveConfig,
    /// Where drives are recorded, if they are.
    pub recording: Option<RecordingConfig>,
    /// Where the sensor's mount is told; if by tf, that of `drive.planner.sensor` means nothing yet.
    pub sensor_mount: SensorMount,
    /// How the planner's configuration follows from sensor and robot.
    fit: Fit,
}

/// A preset of the planner, and what a file sets of it.
#[derive(Clone, Debug, PartialEq)]
struct Fit {
    preset: PlannerPreset,
    section: Value,
}

impl Fit {
    fn planner(&self, sensor: SensorModel, robot: RobotModel) -> Result<PlannerConfig, serde_json::Error> {
        let preset = match self.preset {
            PlannerPreset::Default => PlannerConfig::default(),
            PlannerPreset::Paper => PlannerConfig::paper(),
        };
        merged(&preset.fitted_to(sensor, robot), &self.section)
    }
}

/// A parameter file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(rename = "/**")]
    every_node: Section,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    #[serde(rename = "ros__parameters")]
    parameters: Parameters,
}

/// The keys of a file. Sections that start from a preset are read again with it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    distro: Distro,
    #[serde(default = "root")]
    namespace: String,
    #[serde(default = "mapless")]
    node_name: String,
    #[serde(default)]
    domain_id: u16,
    #[serde(default)]
    use_sim_time: bool,
    #[serde(default)]
    visualise: bool,
    #[serde(default)]
    topics: Topics,
    #[serde(default = "best_effort")]
    sensor_reliability: Reliability,
    velodyne: Option<Velodyne>,
    command_type: Option<CommandType>,
    robot_preset: RobotPreset,
    #[serde(default = "default_planner")]
    planner_preset: PlannerPreset,
    #[serde(default)]
    frames: Frames,
    #[serde(default)]
    imu: ImuMount,
    #[serde(default)]
    estimator: EstimatorConfig,
    #[serde(default)]
    navigation: NavigationConfig,
    #[serde(default)]
    supervisor: SupervisorConfig,
    #[serde(default)]
    sensor_mount: SensorMount,
    recording: Option<RecordingConfig>,
    #[serde(default, rename = "robot")]
    _robot: RobotModel,
    #[serde(default, rename = "sensor")]
    _sensor: SensorModel,
    #[serde(default, rename = "planner")]
    _planner: PlannerConfig,
}

fn root() -> String {
    "/".to_owned()
}

fn mapless() -> String {
    "mapless".to_owned()
}

fn best_effort() -> Reliability {
    Reliability::BestEffort
}

fn default_planner() -> PlannerPreset {
    PlannerPreset::Default
}

impl NodeConfig {
    /// Reads a file.
    ///
    /// # Errors
    /// [`ConfigFileError`] with file, line and what was expected: a file that cannot be read, no YAML, an
    /// unknown or missing key, a value of another type or out of its range, a distribution that this program
    /// is not built for.
    pub fn open(file: &Path) -> Result<Self, ConfigFileError> {
        let text = std::fs::read_to_string(file).map_err(|error| ConfigFileError {
            file: file.display().to_string(),
            line: None,
            message: error.to_string(),
        })?;
        Self::parse(file, &text)
    }

    /// Reads `text`, which stands in `file`.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn parse(file: &Path, text: &str) -> Result<Self, ConfigFileError> {
        let yaml = YamlFile::parse(file, text)?;
        let given = yaml.read::<File>()?.every_node.parameters;
        let fail = |keys: &[&str], message: String| Err(yaml.error(&inside(keys), message));

        if given.distro != Distro::BUILT {
            let (distro, built) = (given.distro.word(), Distro::BUILT.word());
            return fail(
                &["distro"],
                format!(
                    "distro = {distro}: this program is built for {built}, whose messages have another layout"
                ),
            );
        }
        if let Err(error) = NodeName::new(&given.namespace, "name") {
            return fail(&["namespace"], format!("namespace = {:?}: {error}", given.namespace));
        }
        if let Err(error) = NodeName::new("/", &given.node_name) {
            return fail(&["node_name"], format!("node_name = {:?}: {error}", given.node_name));
        }
        if given.domain_id > LAST_DOMAIN {
            let message = format!("domain_id = {}: expected 0 to {LAST_DOMAIN}", given.domain_id);
            return fail(&["domain_id"], message);
        }
        for (key, name) in given.topics.entries() {
            if let Err(message) = topics::check_topic(name) {
                return fail(&["topics", key], format!("topics.{key}: {message}"));
            }
        }
        if let Some(velodyne) = given.velodyne {
            if velodyne.address.is_ipv4() != velodyne.from.is_ipv4() {
                let Velodyne { address, from, .. } = velodyne;
                let message = format!("velodyne.from = {from}: expected an address of the kind of {address}");
                return fail(&["velodyne", "from"], message);
            }
            if given.use_sim_time {
                let message =
                    "velodyne: a sensor on the network has no simulated clock: expected use_sim_time: false";
                return fail(&["velodyne"], message.to_owned());
            }
        }
        checked(&yaml, given.imu.validate("imu"))?;
        checked(&yaml, given.estimator.validate("estimator"))?;
        checked(&yaml, given.navigation.validate("navigation"))?;
        checked(&yaml, given.sensor_mount.validate("sensor_mount"))?;
        if let Some(recording) = &given.recording {
            checked(&yaml, recording.validate())?;
        }
        let (planner, fit) = planner_config(&yaml, &given)?;
        let supervisor = supervisor_config(&yaml, &given, &planner.robot)?;
        let by_distro = match given.distro {
            Distro::Humble => CommandType::Twist,
            Distro::Jazzy => CommandType::TwistStamped,
        };
        Ok(Self {
            namespace: given.namespace,
            node_name: given.node_name,
            domain_id: given.domain_id,
            use_sim_time: given.use_sim_time,
            topics: given.topics,
            visualise: given.visualise,
            sensor_reliability: given.sensor_reliability,
            velodyne: given.velodyne,
            command_type: given.command_type.unwrap_or(by_distro),
            drive: DriveConfig {
                frames: given.frames,
                imu: given.imu,
                estimator: given.estimator,
                navigation: given.navigation,
                planner,
                supervisor,
            },
            recording: given.recording,
            sensor_mount: given.sensor_mount,
            fit,
        })
    }

    /// The same with this mount of the sensor, and the planner fitted to it.
    ///
    /// # Errors
    /// Why the sensor cannot serve there, for people.
    pub fn mounted(&self, mount: &Mount) -> Result<Self, String> {
        let told = serde_json::to_value(mount).map_err(|error| error.to_string())?;
        let sensor: SensorModel =
            merged(&self.drive.planner.sensor, &told).map_err(|error| error.to_string())?;
        let robot = self.drive.planner.robot;
        sensor.validate("sensor").map_err(|error| error.to_string())?;
        check_sensor(&sensor, &robot).map_err(|error| error.to_string())?;
        let planner = self.fit.planner(sensor, robot).map_err(|error| error.to_string())?;
        planner.validate("planner").map_err(|error| error.to_string())?;
        Ok(Self { drive: DriveConfig { planner, ..self.drive.clone() }, ..self.clone() })
    }
}

/// The planner's preset, fitted to sensor and robot, with what the file sets.
fn planner_config(yaml: &YamlFile<'_>, given: &Parameters) -> Result<(PlannerConfig, Fit), ConfigFileError> {
    let section = |key: &str| yaml.value(&inside(&[key])).unwrap_or(&Value::Null);
    for key in ["sensor", "robot"] {
        if section("planner").get(key).is_some() {
            let message = format!("planner.{key}: expected as a section of its own, {key}");
            return Err(yaml.error(&inside(&["planner", key]), message));
        }
    }
    let fail = |key: &str, error: serde_json::Error| yaml.error(&inside(&[key]), format!("{key}: {error}"));
    let sensor: SensorModel =
        merged(&SensorModel::default(), section("sensor")).map_err(|error| fail("sensor", error))?;
    let robot: RobotModel =
        merged(&given.robot_preset.model(), section("robot")).map_err(|error| fail("robot", error))?;
    checked(yaml, sensor.validate("sensor"))?;
    checked(yaml, robot.validate("robot"))?;
    match given.sensor_mount.source {
        MountSource::File => {
            check_sensor(&sensor, &robot).map_err(|error| yaml.error(&inside(&["sensor"]), error))?;
        }
        MountSource::Tf => {
            if let Some(key) = Mount::KEYS.into_iter().find(|key| section("sensor").get(key).is_some()) {
                let message = format!("sensor.{key}: the mount comes by tf: expected to be left out");
                return Err(yaml.error(&inside(&["sensor", key]), message));
            }
        }
    }
    let fit = Fit { preset: given.planner_preset, section: section("planner").clone() };
    let planner = fit.planner(sensor, robot).map_err(|error| fail("planner", error))?;
    checked(yaml, planner.validate("planner"))?;
    Ok((planner, fit))
}

/// The limits of the supervisor, within the robot's.
fn supervisor_config(
    yaml: &YamlFile<'_>,
    given: &Parameters,
    robot: &RobotModel,
) -> Result<SupervisorConfig, ConfigFileError> {
    let own_clock = inside(&["supervisor", "has_clock"]);
    if yaml.value(&own_clock).is_some() {
        return Err(yaml.error(&own_clock, "supervisor.has_clock: expected use_sim_time in its place"));
    }
    let supervisor = SupervisorConfig { has_clock: given.use_sim_time, ..given.supervisor };
    checked(yaml, supervisor.validate("supervisor"))?;
    checked(yaml, check_tilt(&supervisor, robot))?;
    Ok(supervisor)
}

/// The robot is stopped before it leans beyond what it can.
pub(crate) fn check_tilt(supervisor: &SupervisorConfig, robot: &RobotModel) -> Result<(), ConfigError> {
    for (name, limit_rad, most_rad) in [
        ("max_roll_rad", supervisor.max_roll_rad, robot.roll_limit_rad),
        ("max_pitch_rad", supervisor.max_pitch_rad, robot.pitch_limit_rad),
    ] {
        let expected = format!("at most the robot's limit, {most_rad}");
        ConfigError::require(limit_rad <= most_rad, "supervisor", name, limit_rad, &expected)?;
    }
    Ok(())
}

/// A value out of its range, with its line.
fn checked(yaml: &YamlFile<'_>, check: Result<(), ConfigError>) -> Result<(), ConfigFileError> {
    check.map_err(|error| {
        let keys: Vec<&str> = error.place.split('.').chain([error.name]).collect();
        yaml.error(&inside(&keys), &error)
    })
}

/// The path of a parameter from the top of the file.
fn inside<'a>(keys: &[&'a str]) -> Vec<&'a str> {
    [EVERY_NODE, PARAMETERS].iter().chain(keys).copied().collect()
}
