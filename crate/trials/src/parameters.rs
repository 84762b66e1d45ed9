//! Every parameter that a scenario file may set, with description, unit, sensible range, the paper's value
//! and its present value. The descriptions come from the configurations themselves; here they are ordered.

use mapless::PlannerConfig;
pub use mapless_parameters::{Kind, Parameter, Value};
use mapless_world::{MotionConfig, RobotConfig, SensingConfig, SensorConfig};

use crate::reality::{PoseConfig, RealityConfig, RealityPreset};
use crate::scenario::{Preset, Scenario, ScenarioFault};

/// Parameters of one table, with their values.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The table of the scenario file, such as `planner.state_lattice`.
    pub table: &'static str,
    /// The title for people.
    pub title: &'static str,
    /// Its parameters.
    pub parameters: Vec<Valued>,
}

/// A parameter and its present value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Valued {
    /// Its description.
    pub parameter: &'static Parameter,
    /// Its value.
    pub value: Value,
}

/// One group: its table, its title, and the configuration that its parameters are in.
macro_rules! groups {
    ($($table:literal $title:literal $type:ty = $config:expr;)*) => {
        vec![$(group($table, $title, <$type>::PARAMETERS, &$config.values())),*]
    };
}

/// All groups, in the order of the method, with the values of these configurations.
pub fn groups(
    planner: &PlannerConfig,
    sensor: &SensorConfig,
    robot: &RobotConfig,
    reality: &RealityConfig,
) -> Vec<Group> {
    use mapless::config::{
        ControllerConfig, DecisionConfig, ElevationWindowConfig, PerceptionConfig, PidGains, SegmentConfig,
        StateLatticeConfig, TrajectoryConfig,
    };
    use mapless::gp::kernel::RationalQuadratic;
    use mapless::gp::learning::{HyperparameterBounds, LearningConfig};
    use mapless::{RobotModel, SensorModel};

    let learning = &planner.perception.learning;
    let controller = &planner.controller;
    let mut groups = groups! {
        "planner" "Planner" PlannerConfig = planner;
        "planner.perception" "Perception" PerceptionConfig = planner.perception;
        "planner.perception.kernel" "Kernel" RationalQuadratic = planner.perception.kernel;
        "planner.perception.learning" "Learning" LearningConfig = learning;
        "planner.perception.learning.bounds" "Bounds of learning" HyperparameterBounds = learning.bounds;
        "planner.segments" "Segments and subgoals" SegmentConfig = planner.segments;
        "planner.decision" "Cost of a subgoal" DecisionConfig = planner.decision;
        "planner.state_lattice" "State lattice" StateLatticeConfig = planner.state_lattice;
        "planner.elevation_window" "Elevation window" ElevationWindowConfig = planner.elevation_window;
        "planner.controller" "Controller" ControllerConfig = controller;
        "planner.controller.distance" "Distance loop: metres to metres a second" PidGains = controller.distance;
        "planner.controller.yaw" "Heading loop: radians to radians a second" PidGains = controller.yaw;
        "planner.controller.trajectory" "Optimised trajectory" TrajectoryConfig = controller.trajectory;
        "planner.robot" "Robot as the planner knows it; follows the robot unless set" RobotModel = planner.robot;
        "planner.sensor" "Sensor as the planner knows it; follows the sensor unless set" SensorModel = planner.sensor;
        "sensor" "Sensor" SensorConfig = sensor;
        "robot" "Robot" RobotConfig = robot;
    };
    groups.extend(reality_groups(reality));
    groups
}

/// The groups of `[reality]` with the values of every preset, in the order of [`RealityPreset::ALL`].
pub fn reality_presets() -> Vec<(&'static str, Vec<Group>)> {
    let of = |preset: &RealityPreset| (preset.word(), reality_groups(&preset.config()));
    RealityPreset::ALL.iter().map(of).collect()
}

fn reality_groups(reality: &RealityConfig) -> Vec<Group> {
    groups! {
        "reality" "Reality" RealityConfig = reality;
        "reality.sensing" "What spoils the scans" SensingConfig = reality.sensing;
        "reality.pose" "What is wrong with the believed pose" PoseConfig = reality.pose;
        "reality.motion" "What drive and ground do to a motion" MotionConfig = reality.motion;
    }
}

fn group(
    table: &'static str,
    title: &'static str,
    parameters: &'static [Parameter],
    values: &[Value],
) -> Group {
    let valued = parameters.iter().zip(values).map(|(parameter, &value)| Valued { parameter, value });
    Group { table, title, parameters: valued.collect() }
}

/// The values that hold where nobody changed any: those of the scenario `file` under `preset`. What the
/// planner takes from sensor and robot follows those of `running`, the scenario with its changes, and so does
/// `[reality]` if they name another preset.
///
/// # Errors
/// The value that does not fit the preset.
pub fn values(file: &Scenario, running: &Scenario, preset: Preset) -> Result<Vec<Group>, ScenarioFault> {
    let planner = Scenario { planner: file.planner.clone(), ..running.clone() }.planner_config(preset)?;
    let preset = running.reality.preset;
    let is_changed = preset != file.reality.preset;
    let reality = if is_changed { preset.config() } else { file.reality.clone() };
    Ok(groups(&planner, &file.sensor, &file.robot, &reality))
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless::gp::learning::LearningConfig;
    use mapless_parameters::Check;
    use toml::Table;

    const SCENARIO: &str = "terrain = \"a.toml\"\nstart = [1, 2, 0]\ngoal = [3, 4]\nseed = 7\n";

    fn scenario() -> Scenario {
        Scenario::parse("a.toml", SCENARIO).unwrap()
    }

    fn of_preset(preset: Preset) -> Vec<Group> {
        values(&scenario(), &scenario(), preset).unwrap()
    }

    fn all(groups: &[Group]) -> impl Iterator<Item = (&'static str, Valued)> {
        groups.iter().flat_map(|group| group.parameters.iter().map(|&one| (group.table, one)))
    }

    fn value(groups: &[Group], table: &str, name: &str) -> Value {
        let found = all(groups).find(|(of, one)| *of == table && one.parameter.name == name);
        found.unwrap_or_else(|| panic!("{table}.{name}")).1.value
    }

    fn paths(table: &Table, prefix: &str, found: &mut Vec<String>) {
        for (name, value) in table {
            let path = format!("{prefix}.{name}");
            match value {
                toml::Value::Table(table) => paths(table, &path, found),
                _ => found.push(path),
            }
        }
    }

    fn set(table: &str, name: &str, value: &str) -> Result<(), String> {
        let sections = format!("[{table}]\n{name} = {value}\n");
        // Learning one length-scale for both axes needs bounds that overlap.
        let bounds = "[planner.perception.learning.bounds]\nelevation_length_scale_rad = [0.03, 0.2]\n";
        let base = Scenario::parse("a.toml", &format!("{SCENARIO}{bounds}")).unwrap();
        let scenario = base.with_parameters("it", &sections).map_err(|error| error.to_string())?;
        scenario.planner_config(Preset::Default).map(|_| ()).map_err(|error| error.to_string())
    }

    #[test]
    fn the_groups_have_every_parameter_and_no_other() {
        let mut expected = Vec::new();
        paths(&Table::try_from(PlannerConfig::default()).unwrap(), "planner", &mut expected);
        paths(&Table::try_from(SensorConfig::default()).unwrap(), "sensor", &mut expected);
        paths(&Table::try_from(RobotConfig::default()).unwrap(), "robot", &mut expected);
        paths(&Table::try_from(RealityConfig::default()).unwrap(), "reality", &mut expected);
        let groups = of_preset(Preset::Default);
        let mut found: Vec<String> =
            all(&groups).map(|(table, one)| format!("{table}.{}", one.parameter.name)).collect();
        expected.sort();
        found.sort();
        assert_eq!(found, expected);
    }

    #[test]
    fn a_number_has_a_check_and_every_text_is_a_sentence() {
        for (table, Valued { parameter, value }) in all(&of_preset(Preset::Default)) {
            let is_number = matches!(value, Value::Number(_) | Value::Pair(_));
            assert!(!is_number || parameter.check != Check::ByType, "{table}.{}", parameter.name);
            let text = parameter.text;
            assert!(text.starts_with(char::is_uppercase) && text.ends_with('.'), "{text}");
            assert!(!text.contains(['\n', '[', '`']), "{text}");
        }
    }

    #[test]
    fn ranges_hold_the_values_of_every_preset() {
        for preset in Preset::ALL {
            for (table, Valued { parameter, value }) in all(&of_preset(preset)) {
                let inside = match (parameter.kind, value) {
                    (Kind::Number(low, high), Value::Number(number)) => (low..=high).contains(&number),
                    (Kind::Whole(low, high), Value::Whole(number)) => {
                        (u64::from(low)..=u64::from(high)).contains(&number)
                    }
                    (Kind::Pair(low, high), Value::Pair(two)) => two.iter().all(|n| (low..=high).contains(n)),
                    (Kind::Switch, Value::Switch(_)) => true,
                    (Kind::Choice(names), Value::Word(name)) => names.contains(&name),
                    _ => false,
                };
                assert!(inside, "{table}.{} = {value}: {:?}", parameter.name, parameter.kind);
            }
        }
    }

    #[test]
    fn the_core_takes_both_ends_of_every_range_and_every_choice() {
        for (table, Valued { parameter, .. }) in all(&of_preset(Preset::Default)) {
            let tried: Vec<String> = match parameter.kind {
                Kind::Number(low, high) => vec![format!("{low:?}"), format!("{high:?}")],
                Kind::Whole(low, high) => vec![low.to_string(), high.to_string()],
                Kind::Pair(low, high) => vec![format!("[{low:?}, {high:?}]")],
                Kind::Switch => vec!["true".to_owned(), "false".to_owned()],
                Kind::Choice(names) => names.iter().map(|name| format!("\"{name}\"")).collect(),
            };
            for value in tried {
                assert_eq!(
                    set(table, parameter.name, &value),
                    Ok(()),
                    "{table}.{} = {value}",
                    parameter.name
                );
            }
            let fault = set(table, parameter.name, "\"none of these\"").unwrap_err();
            assert!(fault.contains(parameter.name) || fault.contains("none of these"), "{fault}");
        }
    }

    #[test]
    fn the_papers_values_are_those_of_the_paper_preset() {
        let mut paper = PlannerConfig::paper();
        paper.perception.learning = LearningConfig::paper();
        let groups =
            groups(&paper, &SensorConfig::default(), &RobotConfig::default(), &RealityConfig::default());
        let mut given = 0;
        for (table, Valued { parameter, value }) in all(&groups) {
            let Some(paper) = parameter.paper else { continue };
            assert_eq!(paper, value, "{table}.{}", parameter.name);
            given += 1;
        }
        assert!(given > 10);
    }

    #[test]
    fn the_planner_follows_a_changed_robot() {
        let (file, sections) = (scenario(), "[robot]\nwidth_m = 0.9\n[planner.decision]\nclimb_weight = 2\n");
        let running = file.with_parameters("it", sections).unwrap();
        let values = values(&file, &running, Preset::Default).unwrap();
        assert_eq!(value(&values, "planner.robot", "width_m"), Value::Number(0.9));
        assert_eq!(value(&values, "planner.decision", "climb_weight"), Value::Number(1.0));
        assert_eq!(value(&values, "robot", "width_m"), Value::Number(0.685));
    }
}
