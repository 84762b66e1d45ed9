//! Scenario files: a terrain, a start, a goal and what differs from the defaults.
//!
//! ```toml
//! terrain = "../cht.toml"       # a recipe, .png, .asc or .tif, relative to this file
//! start = [5.0, 5.0, 0.8]       # x, y in metres, heading in radians
//! goal = [60.0, 60.0]           # x, y in metres; a third number is the heading to end with
//! seed = 1
//! waypoints = [[30.0, 20.0]]    # optional: driven to one after the other, before the goal
//!
//! [planner.decision]            # any value of the planner, sensor or robot
//! steepness_weight = 0.8
//!
//! [[objects]]                   # what stands or walks on the ground, in place of the terrain's own; see
//!                               # [`mapless_world::Object`]
//! kind = "post"
//! at = [20.0, 22.0]
//! radius_m = 0.1
//! height_m = 1.5
//!
//! [reality]                     # what goes wrong; by default nothing
//! preset = "field"              # "ideal", "field" or "harsh" sets every value of it
//!
//! [reality.motion]              # and single ones are set beside: sensing, pose or motion
//! friction = 0.5
//! ```

pub(crate) mod renamed_keys;

use glam::DVec2;
use mapless::{PlannerConfig, RobotModel, SensorModel};
use mapless_terrain::TerrainError;
use mapless_world::{Object, RobotConfig, SensorConfig};

use crate::places::{self, StartPose};
use crate::reality::{RealityConfig, RealityPreset};
use renamed_keys::RENAMED_KEYS;

/// The planner configuration from which a scenario's `[planner]` section starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// The best mapless choice known here.
    #[default]
    Default,
    /// The paper read literally.
    Paper,
    /// The paper without its steepness cost, as the same authors drove on flat ground.
    Flat,
}

impl Preset {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Default, Self::Paper, Self::Flat];

    /// The name as on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Paper => "paper",
            Self::Flat => "flat",
        }
    }

    /// The configuration without the scenario's values.
    pub fn planner_config(self) -> PlannerConfig {
        match self {
            Self::Default => PlannerConfig::default(),
            Self::Paper => PlannerConfig::paper(),
            Self::Flat => {
                let mut config = PlannerConfig::paper();
                config.decision.steepness_weight = 0.0;
                config
            }
        }
    }
}

impl std::str::FromStr for Preset {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let preset = Self::ALL.into_iter().find(|preset| preset.name() == name);
        preset.ok_or_else(|| format!("preset \"{name}\": expected default, paper or flat"))
    }
}

/// A scenario, checked except for its terrain.
#[derive(Clone, Debug)]
pub struct Scenario {
    /// Path of the terrain, relative to the scenario file.
    pub terrain: String,
    /// The robot's start.
    pub start: StartPose,
    /// Waypoints before the goal, in order, seen from above, metres.
    pub waypoints_m: Vec<DVec2>,
    /// The goal, seen from above, metres.
    pub goal_m: DVec2,
    /// The final heading, anticlockwise from east, radians; any when absent.
    pub goal_heading_rad: Option<f64>,
    /// Seed of the sensor's noise.
    pub seed: u64,
    /// The sensor.
    pub sensor: SensorConfig,
    /// The robot.
    pub robot: RobotConfig,
    /// What stands and walks on the ground. What the scenario does not say is that of its terrain:
    /// [`Scenario::on_terrain`].
    pub objects: Option<Vec<Object>>,
    /// What goes wrong.
    pub reality: RealityConfig,
    /// The values of the `[planner]` section.
    pub(crate) planner: toml::Table,
}

/// Why a scenario cannot be run: the file and what is wrong with it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}: {fault}")]
pub struct ScenarioError {
    /// The scenario file.
    pub file: String,
    /// What is wrong.
    pub fault: ScenarioFault,
}

/// What is wrong with a scenario.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ScenarioFault {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Read(String),
    /// Not TOML, a wrong key or a value of the wrong kind; says where.
    #[error("{0}")]
    Syntax(String),
    /// A value outside its range.
    #[error("{0}")]
    Value(String),
    /// The terrain cannot be loaded.
    #[error("terrain: {0}")]
    Terrain(#[from] TerrainError),
}

/// The file as written. `planner` and `reality` are read a second time as tables: here they only report wrong
/// keys with their line.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    terrain: String,
    #[serde(deserialize_with = "places::start")]
    start: StartPose,
    #[serde(deserialize_with = "places::goal")]
    goal: (DVec2, Option<f64>),
    #[serde(default, deserialize_with = "places::waypoints")]
    waypoints: Vec<DVec2>,
    seed: u64,
    #[serde(default)]
    planner: PlannerConfig,
    #[serde(default)]
    sensor: SensorConfig,
    #[serde(default)]
    robot: RobotConfig,
    objects: Option<Vec<Object>>,
    #[serde(default)]
    reality: RealityConfig,
}

/// The sections of a scenario file that set parameters.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
struct Sections {
    planner: toml::Table,
    sensor: toml::Table,
    robot: toml::Table,
    reality: toml::Table,
}

impl Scenario {
    /// Reads the text of the scenario file `file`.
    ///
    /// # Errors
    /// [`ScenarioError`] names the file, the place, the value and what was expected.
    pub fn parse(file: &str, text: &str) -> Result<Self, ScenarioError> {
        let fail = |fault| ScenarioError { file: file.to_owned(), fault };
        let syntax = |error: mapless_toml::Error| fail(ScenarioFault::Syntax(error.to_string()));
        let parsed: File = mapless_toml::from_str_renamed(text, RENAMED_KEYS).map_err(syntax)?;
        let mut table: toml::Table = mapless_toml::from_str_renamed(text, RENAMED_KEYS).map_err(syntax)?;
        let mut section = |name: &str| match table.remove(name) {
            Some(toml::Value::Table(section)) => section,
            _ => toml::Table::new(),
        };
        let planner = section("planner");
        let value = |reason: String| fail(ScenarioFault::Value(reason));
        parsed.planner.validate("planner").map_err(|e| value(e.to_string()))?;
        parsed.sensor.validate("sensor").map_err(|e| value(e.to_string()))?;
        parsed.robot.validate("robot").map_err(|e| value(e.to_string()))?;
        for (index, object) in parsed.objects.iter().flatten().enumerate() {
            object.validate(&format!("objects[{}]", index + 1)).map_err(|e| value(e.to_string()))?;
        }
        parsed.reality.validate("reality").map_err(|e| value(e.to_string()))?;
        let reality = RealityConfig::default().with_section(&section("reality")).map_err(fail)?;
        Ok(Self {
            terrain: parsed.terrain,
            start: parsed.start,
            waypoints_m: parsed.waypoints,
            goal_m: parsed.goal.0,
            goal_heading_rad: parsed.goal.1,
            seed: parsed.seed,
            sensor: parsed.sensor,
            robot: parsed.robot,
            objects: parsed.objects,
            reality,
            planner,
        })
    }

    /// This scenario with other values of parameters: `sections` is TOML with nothing but `[planner]`,
    /// `[sensor]`, `[robot]` and `[reality]`, named `file` in errors. A `preset` of `[reality]` replaces all
    /// of the file's own `[reality]`. What the planner's section sets is checked by
    /// [`Scenario::planner_config`].
    ///
    /// # Errors
    /// [`ScenarioError`] names the place, the value and what was expected.
    pub fn with_parameters(&self, file: &str, sections: &str) -> Result<Self, ScenarioError> {
        let fail = |fault| ScenarioError { file: file.to_owned(), fault };
        let sections = Sections::parse(sections).map_err(fail)?;
        let mut scenario = self.clone();
        merge(&mut scenario.planner, &sections.planner);
        (scenario.sensor, scenario.robot) = sections.applied_to(&self.sensor, &self.robot).map_err(fail)?;
        scenario.reality = self.reality.with_section(&sections.reality).map_err(fail)?;
        Ok(scenario)
    }

    /// With the objects of its terrain, unless the scenario has its own.
    #[must_use]
    pub fn on_terrain(mut self, objects: &[Object]) -> Self {
        self.objects.get_or_insert_with(|| objects.to_vec());
        self
    }

    /// The planner's configuration: the preset, with the geometry of this sensor and robot, with what the
    /// scenario sets. It keeps the robot's underside clear where that can touch the ground.
    ///
    /// # Errors
    /// The value that does not fit the preset.
    pub fn planner_config(&self, preset: Preset) -> Result<PlannerConfig, ScenarioFault> {
        let mut known =
            preset.planner_config().fitted_to(sensor_model(&self.sensor), robot_model(&self.robot));
        known.state_lattice.keeps_underside_clear = self.reality.motion.touches_ground;
        planner_config(&known, &self.planner)
    }
}

impl Sections {
    fn parse(text: &str) -> Result<Self, ScenarioFault> {
        mapless_toml::from_str_renamed(text, RENAMED_KEYS)
            .map_err(|error| ScenarioFault::Syntax(error.to_string()))
    }

    /// Sensor and robot with what these sections set.
    fn applied_to(
        &self,
        sensor: &SensorConfig,
        robot: &RobotConfig,
    ) -> Result<(SensorConfig, RobotConfig), ScenarioFault> {
        let sensor: SensorConfig = overridden(sensor, &self.sensor, "sensor")?;
        let robot: RobotConfig = overridden(robot, &self.robot, "robot")?;
        sensor.validate("sensor").map_err(|e| ScenarioFault::Value(e.to_string()))?;
        robot.validate("robot").map_err(|e| ScenarioFault::Value(e.to_string()))?;
        Ok((sensor, robot))
    }
}

/// The planner's configuration without a scenario: the preset for the sensor and the robot that `sections`
/// sets, TOML with nothing but `[planner]`, `[sensor]` and `[robot]`, named `file` in errors.
///
/// # Errors
/// [`ScenarioError`] names the place, the value and what was expected.
pub fn planner_config_for(
    file: &str,
    sections: &str,
    preset: Preset,
) -> Result<PlannerConfig, ScenarioError> {
    let fail = |fault| ScenarioError { file: file.to_owned(), fault };
    let sections = Sections::parse(sections).map_err(fail)?;
    let (sensor, robot) =
        sections.applied_to(&SensorConfig::default(), &RobotConfig::default()).map_err(fail)?;
    let known = preset.planner_config().fitted_to(sensor_model(&sensor), robot_model(&robot));
    planner_config(&known, &sections.planner).map_err(fail)
}

/// A planner's configuration for what is known of the robot, with what `[planner]` sets.
fn planner_config(known: &PlannerConfig, planner: &toml::Table) -> Result<PlannerConfig, ScenarioFault> {
    let config: PlannerConfig = overridden(known, planner, "planner")?;
    config.validate("planner").map_err(|e| ScenarioFault::Value(e.to_string()))?;
    Ok(config)
}

/// The planner's model of a sensor.
fn sensor_model(sensor: &SensorConfig) -> SensorModel {
    let mut model = SensorModel::default();
    model.rings = sensor.rings;
    model.lowest_elevation_rad = sensor.lowest_elevation_rad;
    model.highest_elevation_rad = sensor.highest_elevation_rad;
    model.columns = sensor.columns;
    model.horizontal_fov_rad = sensor.horizontal_fov_rad;
    model.min_range_m = sensor.min_range_m;
    model.max_range_m = sensor.max_range_m;
    model.forward_m = sensor.forward_m;
    model.left_m = sensor.left_m;
    model.height_m = sensor.height_m;
    model.roll_rad = sensor.roll_rad;
    model.pitch_rad = sensor.pitch_rad;
    model.yaw_rad = sensor.yaw_rad;
    model
}

/// The planner's model of a robot.
fn robot_model(robot: &RobotConfig) -> RobotModel {
    let mut model = RobotModel::default();
    model.length_m = robot.length_m;
    model.width_m = robot.width_m;
    model.wheelbase_m = robot.wheelbase_m;
    model.track_m = robot.track_m;
    model.ground_clearance_m = robot.ground_clearance_m;
    model.overhang_clearance_m = robot.overhang_clearance_m;
    model.deck_height_m = robot.height_m;
    model.height_m = robot.height_m;
    model.max_step_m = robot.max_step_m;
    model.roll_limit_rad = robot.roll_limit_rad;
    model.pitch_limit_rad = robot.pitch_limit_rad;
    model
}

impl RealityConfig {
    /// This with what a section `[reality]` sets: all values of its preset, if it names one, then single
    /// ones.
    ///
    /// # Errors
    /// [`ScenarioFault::Value`] names the key and value that `[reality]` does not have, and what was
    /// expected.
    pub fn with_section(&self, section: &toml::Table) -> Result<Self, ScenarioFault> {
        let word = section.get("preset").and_then(toml::Value::as_str);
        let preset = RealityPreset::ALL.iter().find(|preset| Some(preset.word()) == word);
        let config = preset.map_or_else(|| self.clone(), |preset| preset.config());
        let config: Self = overridden(&config, section, "reality")?;
        config.validate("reality").map_err(|e| ScenarioFault::Value(e.to_string()))?;
        Ok(config)
    }
}

/// `config` with the values of `over`; `section` names the place in errors.
fn overridden<C: serde::Serialize + serde::de::DeserializeOwned>(
    config: &C,
    over: &toml::Table,
    section: &str,
) -> Result<C, ScenarioFault> {
    let fault = |place: &str, reason: &dyn std::fmt::Display| {
        ScenarioFault::Value(format!("{place}: {}", reason.to_string().trim_end()))
    };
    let mut table = toml::Table::try_from(config).map_err(|e| fault(section, &e))?;
    merge(&mut table, over);
    // By way of text: one reader is enough.
    let text = toml::to_string(&table).map_err(|e| fault(section, &e))?;
    mapless_toml::from_str(&text).map_err(|e| fault(&path(section, &text, e.line()), &e.message()))
}

/// The key and value in a line of a section's text, after the tables that they are in.
fn path(section: &str, text: &str, line: Option<usize>) -> String {
    let lines: Vec<&str> = text.lines().take(line.unwrap_or(0)).collect();
    let table = lines.iter().rev().find_map(|line| line.strip_prefix('[')?.strip_suffix(']'));
    let value = lines.last().copied().filter(|line| !line.starts_with('['));
    [Some(section), table, value].into_iter().flatten().collect::<Vec<_>>().join(".")
}

fn merge(base: &mut toml::Table, over: &toml::Table) {
    for (key, value) in over {
        match (base.get_mut(key), value) {
            (Some(toml::Value::Table(base)), toml::Value::Table(over)) => merge(base, over),
            _ => {
                base.insert(key.clone(), value.clone());
            }
        }
    }
}

/// A scenario with its terrain, from disk.
#[cfg(not(target_arch = "wasm32"))]
#[derive(Clone, Debug)]
pub struct LoadedScenario {
    /// The scenario.
    pub scenario: Scenario,
    /// Its terrain.
    pub terrain: mapless_terrain::Terrain,
}

#[cfg(not(target_arch = "wasm32"))]
impl LoadedScenario {
    /// Reads a scenario file and the terrain it names.
    ///
    /// # Errors
    /// [`ScenarioError`] names the file, the place, the value and what was expected.
    pub fn read(path: &std::path::Path) -> Result<Self, ScenarioError> {
        let file = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|error| ScenarioError {
            file: file.clone(),
            fault: ScenarioFault::Read(error.to_string()),
        })?;
        let scenario = Scenario::parse(&file, &text)?;
        let terrain = mapless_terrain::load_terrain(&path.with_file_name(&scenario.terrain))
            .map_err(|error| ScenarioError { file, fault: ScenarioFault::Terrain(error) })?;
        Ok(Self { scenario: scenario.on_terrain(&terrain.objects), terrain })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENARIO: &str = "terrain = \"a.toml\"\nstart = [1.0, 2.0, 0.5]\ngoal = [3.0, 4.0]\nseed = 7\n";

    fn error(text: &str) -> String {
        Scenario::parse("x.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn places_are_read_in_both_forms() {
        let listed = Scenario::parse("x.toml", SCENARIO).unwrap();
        let named = SCENARIO
            .replace("[1.0, 2.0, 0.5]", "{ y = 2.0, x = 1.0, heading = 0.5 }")
            .replace("[3.0, 4.0]", "{ x = 3, y = 4 }");
        let named = Scenario::parse("x.toml", &named).unwrap();
        assert_eq!((listed.start, listed.goal_m), (named.start, named.goal_m));
        assert_eq!(listed.seed, 7);
    }

    #[test]
    fn a_goal_may_have_a_heading() {
        assert_eq!(Scenario::parse("x.toml", SCENARIO).unwrap().goal_heading_rad, None);
        for goal in ["[3.0, 4.0, 1.5]", "{ heading = 1.5, x = 3, y = 4 }"] {
            let scenario = Scenario::parse("x.toml", &SCENARIO.replace("[3.0, 4.0]", goal)).unwrap();
            assert_eq!((scenario.goal_m, scenario.goal_heading_rad), (DVec2::new(3.0, 4.0), Some(1.5)));
        }
    }

    #[test]
    fn the_planner_section_overrides_either_preset() {
        let text = format!("{SCENARIO}[planner.perception]\nsurface_radius_m = 6\n");
        let scenario = Scenario::parse("x.toml", &text).unwrap();
        let paper = scenario.planner_config(Preset::Paper).unwrap();
        let expected = PlannerConfig::paper();
        assert!((paper.perception.surface_radius_m - 6.0).abs() < 1e-12);
        assert_eq!(paper.perception.kernel, expected.perception.kernel);
        assert_eq!(paper.decision, expected.decision);
    }

    #[test]
    fn the_underside_is_kept_clear_where_it_can_touch_the_ground() {
        let keeps = |sections: &str| {
            let scenario = Scenario::parse("x.toml", &format!("{SCENARIO}{sections}")).unwrap();
            scenario.planner_config(Preset::Default).unwrap().state_lattice.keeps_underside_clear
        };
        assert!(!keeps("") && keeps("[reality]\npreset = \"field\"\n"));
        assert!(keeps("[reality.motion]\ntouches_ground = true\n"));
        assert!(keeps("[planner.state_lattice]\nkeeps_underside_clear = true\n"));
        let on_a_robot = planner_config_for("robot.yaml", "", Preset::Default).unwrap();
        assert!(on_a_robot.state_lattice.keeps_underside_clear);
    }

    #[test]
    fn waypoints_are_read_in_order() {
        let text = format!("{SCENARIO}waypoints = [[9.0, 8.0], {{ x = 7, y = 6 }}]\n");
        let scenario = Scenario::parse("x.toml", &text).unwrap();
        assert_eq!(scenario.waypoints_m, [DVec2::new(9.0, 8.0), DVec2::new(7.0, 6.0)]);
        assert!(Scenario::parse("x.toml", SCENARIO).unwrap().waypoints_m.is_empty());
        assert!(error(&format!("{SCENARIO}waypoints = [[1.0]]\n")).contains("expected 2 numbers: x, y"));
    }

    #[test]
    fn other_parameters_replace_those_of_the_file_and_keep_the_rest() {
        let text = format!("{SCENARIO}[planner.decision]\nspin_recovery_s = 9.0\n[sensor]\nheight_m = 0.9\n");
        let scenario = Scenario::parse("x.toml", &text).unwrap();
        let sections = "[planner.decision]\ndistance_weight = 2\n[sensor]\nrange_noise_m = 0.1\n[robot]\nwidth_m = 0.8\n";
        let changed = scenario.with_parameters("settings", sections).unwrap();
        let config = changed.planner_config(Preset::Default).unwrap();
        assert!((config.decision.spin_recovery_s - 9.0).abs() < 1e-12);
        assert!((config.decision.distance_weight - 2.0).abs() < 1e-12);
        assert!((config.sensor.height_m - 0.9).abs() < 1e-12);
        assert!((config.robot.width_m - 0.8).abs() < 1e-12);
        assert!((changed.sensor.range_noise_m - 0.1).abs() < 1e-12);

        let fault = |sections| scenario.with_parameters("settings", sections).unwrap_err().to_string();
        let noise = "settings: sensor.range_noise_m = 2: expected a number from 0 to 1";
        assert_eq!(fault("[sensor]\nrange_noise_m = 2"), noise);
        let columns = "settings: sensor.columns = 1.5: invalid type: floating point `1.5`, expected usize";
        assert_eq!(fault("[sensor]\ncolumns = 1.5"), columns);
        let planner =
            scenario.with_parameters("settings", "[planner.perception.kernel]\nvariance = true").unwrap();
        let fault_of = planner.planner_config(Preset::Default).unwrap_err().to_string();
        assert!(
            fault_of.starts_with("planner.perception.kernel.variance = true: invalid type"),
            "{fault_of}"
        );
        assert!(fault("seed = 1").contains("unknown field `seed`"));
        let planner = scenario.with_parameters("settings", "[planner]\ngoal_tolerance_m = -1").unwrap();
        let fault = planner.planner_config(Preset::Default).unwrap_err().to_string();
        assert_eq!(fault, "planner.goal_tolerance_m = -1: expected a positive number");
    }

    #[test]
    fn flat_is_the_paper_without_steepness() {
        let mut paper = Preset::Paper.planner_config();
        assert!(paper.decision.steepness_weight > 0.0);
        paper.decision.steepness_weight = 0.0;
        assert_eq!(Preset::Flat.planner_config(), paper);
        for preset in Preset::ALL {
            assert_eq!(preset.name().parse(), Ok(preset));
        }
        assert_eq!(
            "best".parse::<Preset>(),
            Err("preset \"best\": expected default, paper or flat".to_owned())
        );
    }

    #[test]
    fn errors_name_file_place_value_and_expectation() {
        assert!(error("terrain = 3").starts_with("x.toml: TOML parse error at line 1, column 11"));
        assert!(error(&format!("{SCENARIO}colour = 1\n")).contains("line 5, column 1"));
        assert!(
            error(&format!("{SCENARIO}[planner.decision]\nk_dir = 1\n")).contains("unknown field `k_dir`")
        );
        assert!(error(&SCENARIO.replace("2.0", "nan")).contains("y = NaN: expected a finite number"));
        assert!(
            error(&SCENARIO.replace("[3.0, 4.0]", "[3.0]"))
                .contains("expected 2 or 3 numbers: x, y, heading")
        );
        assert!(error(&SCENARIO.replace("[3.0, 4.0]", "{ x = 1 }")).contains("missing field `y`"));
        let text = format!("{SCENARIO}[planner.state_lattice]\nstep_m = -1.0\n");
        assert_eq!(error(&text), "x.toml: planner.state_lattice.step_m = -1: expected at least 0.2");
        assert!(
            error(&format!("{SCENARIO}[sensor]\nrange_noise_m = inf\n")).contains("sensor.range_noise_m")
        );
    }
}
