//! Every parameter that a scenario file may set, described for people: what it does, its unit, a sensible range and what the
//! paper says. One table, [`GROUPS`]; tests hold it against the configurations themselves.

mod planner;
mod world;

use std::fmt::Write as _;

use toml::{Table, Value};

use crate::scenario::{Preset, Scenario, ScenarioFault};

/// Parameters that belong together.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// The table of the scenario file they stand in, such as `planner.forecast`.
    pub table: &'static str,
    /// What people call it.
    pub title: &'static str,
    /// Its parameters.
    pub parameters: &'static [Parameter],
}

/// One parameter.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// The name in its table.
    pub name: &'static str,
    /// The unit; empty for shares, counts and choices.
    pub unit: &'static str,
    /// What it may be.
    pub kind: Kind,
    /// What it does.
    pub text: &'static str,
    /// The value that the paper gives, as TOML; nothing where it gives none.
    pub paper: Option<&'static str>,
}

/// What a parameter may be. The ranges are sensible ones: the configuration itself says what makes no sense at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number, from lowest to highest.
    Number(f64, f64),
    /// A whole number, from lowest to highest.
    Whole(u32, u32),
    /// Two numbers.
    Pair(f64, f64),
    /// `true` or `false`.
    Switch,
    /// One of these words.
    Choice(&'static [&'static str]),
}

/// All groups, in the order of the method.
pub const GROUPS: [&[Group]; 2] = [planner::GROUPS, world::GROUPS];

/// A parameter the paper says nothing about.
const fn open(name: &'static str, unit: &'static str, kind: Kind, text: &'static str) -> Parameter {
    Parameter { name, unit, kind, text, paper: None }
}

/// A parameter whose value the paper gives.
const fn given(
    name: &'static str,
    unit: &'static str,
    kind: Kind,
    paper: &'static str,
    text: &'static str,
) -> Parameter {
    Parameter { name, unit, kind, text, paper: Some(paper) }
}

/// The values that hold where nobody changed any: those of the scenario `file` under `preset`, as tables with the file's names
/// `planner`, `sensor` and `robot`. What the planner takes from sensor and robot follows those of `running`, the scenario with
/// its changes.
///
/// # Errors
/// The value that does not fit the preset.
pub fn values(file: &Scenario, running: &Scenario, preset: Preset) -> Result<Table, ScenarioFault> {
    let fault = |error: toml::ser::Error| ScenarioFault::Value(error.to_string());
    let planner = Scenario { planner: file.planner.clone(), ..running.clone() }.planner_config(preset)?;
    Ok(Table::from_iter([
        ("planner".to_owned(), Value::try_from(&planner).map_err(fault)?),
        ("sensor".to_owned(), Value::try_from(&file.sensor).map_err(fault)?),
        ("robot".to_owned(), Value::try_from(&file.robot).map_err(fault)?),
    ]))
}

/// The table as JSON, with the `values` of one configuration: a list of groups with `table`, `title` and `parameters`, each
/// with `name`, `unit`, `kind`, `range` or `choices`, `text`, `value`, and `paper` where the paper gives one.
pub fn json(values: &Table) -> String {
    let mut text = String::from("[");
    for group in GROUPS.into_iter().flatten() {
        separate(&mut text);
        text += "{\"table\":";
        string(&mut text, group.table);
        text += ",\"title\":";
        string(&mut text, group.title);
        text += ",\"parameters\":[";
        for parameter in group.parameters {
            separate(&mut text);
            describe(&mut text, parameter, table_of(values, group.table).and_then(|t| t.get(parameter.name)));
        }
        text += "]}";
    }
    text + "]"
}

fn describe(text: &mut String, parameter: &Parameter, value: Option<&Value>) {
    text.push('{');
    for (key, words) in [("name", parameter.name), ("unit", parameter.unit), ("text", parameter.text)] {
        string(text, key);
        text.push(':');
        string(text, words);
        text.push(',');
    }
    // Writing to a string cannot fail.
    let _ = match parameter.kind {
        Kind::Number(low, high) => write!(text, "\"kind\":\"number\",\"range\":[{low},{high}]"),
        Kind::Whole(low, high) => write!(text, "\"kind\":\"whole\",\"range\":[{low},{high}]"),
        Kind::Pair(low, high) => write!(text, "\"kind\":\"pair\",\"range\":[{low},{high}]"),
        Kind::Switch => write!(text, "\"kind\":\"switch\""),
        Kind::Choice(names) => {
            text.push_str("\"kind\":\"choice\",\"choices\":[");
            for name in names {
                separate(text);
                string(text, name);
            }
            write!(text, "]")
        }
    };
    if let Some(value) = value {
        text.push_str(",\"value\":");
        scalar(text, value);
    }
    if let Some(paper) = parameter.paper {
        text.push_str(",\"paper\":");
        text.push_str(paper);
    }
    text.push('}');
}

fn table_of<'a>(values: &'a Table, path: &str) -> Option<&'a Table> {
    path.split('.').try_fold(values, |table, name| table.get(name)?.as_table())
}

fn separate(text: &mut String) {
    if !text.ends_with(['[', '{']) {
        text.push(',');
    }
}

fn string(text: &mut String, words: &str) {
    text.push('"');
    for letter in words.chars() {
        if matches!(letter, '"' | '\\') {
            text.push('\\');
        }
        text.push(letter);
    }
    text.push('"');
}

/// A parameter's value; there are no others than these, and none is infinite.
fn scalar(text: &mut String, value: &Value) {
    let _ = match value {
        Value::Float(number) => write!(text, "{number}"),
        Value::Integer(number) => write!(text, "{number}"),
        Value::Boolean(on) => write!(text, "{on}"),
        Value::Array(items) => {
            text.push('[');
            for item in items {
                separate(text);
                scalar(text, item);
            }
            write!(text, "]")
        }
        other => {
            string(text, other.as_str().unwrap_or_default());
            Ok(())
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless::PlannerConfig;
    use mapless::gp::learning::LearningConfig;

    const SCENARIO: &str = "terrain = \"a.toml\"\nstart = [1, 2, 0]\ngoal = [3, 4]\nseed = 7\n";

    fn scenario() -> Scenario {
        Scenario::parse("a.toml", SCENARIO).unwrap()
    }

    fn all() -> impl Iterator<Item = (&'static Group, &'static Parameter)> {
        GROUPS.into_iter().flatten().flat_map(|group| group.parameters.iter().map(move |one| (group, one)))
    }

    fn paths(table: &Table, prefix: &str, found: &mut Vec<String>) {
        for (name, value) in table {
            let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
            match value {
                Value::Table(table) => paths(table, &path, found),
                _ => found.push(path),
            }
        }
    }

    /// The parsed text of a single value.
    fn value(text: &str) -> Value {
        format!("it = {text}").parse::<Table>().unwrap().remove("it").unwrap()
    }

    fn set(group: &Group, parameter: &Parameter, value: &str) -> Result<(), String> {
        let sections = format!("[{}]\n{} = {value}\n", group.table, parameter.name);
        // Learning one length-scale for both axes needs bounds that overlap.
        let bounds = "[planner.perception.learning.bounds]\nelevation_length_scale_rad = [0.03, 0.2]\n";
        let base = Scenario::parse("a.toml", &format!("{SCENARIO}{bounds}")).unwrap();
        let scenario = base.with_parameters("it", &sections).map_err(|error| error.to_string())?;
        scenario.planner_config(Preset::Default).map(|_| ()).map_err(|error| error.to_string())
    }

    #[test]
    fn the_table_has_every_parameter_and_no_other() {
        let mut expected = Vec::new();
        paths(&values(&scenario(), &scenario(), Preset::Default).unwrap(), "", &mut expected);
        let mut found: Vec<String> =
            all().map(|(group, one)| format!("{}.{}", group.table, one.name)).collect();
        expected.sort();
        found.sort();
        assert_eq!(found, expected);
    }

    #[test]
    fn kinds_are_those_of_the_values_and_ranges_hold_both_presets() {
        for preset in Preset::ALL {
            let values = values(&scenario(), &scenario(), preset).unwrap();
            for (group, one) in all() {
                let value = &table_of(&values, group.table).unwrap()[one.name];
                let inside = match (one.kind, value) {
                    (Kind::Number(low, high), Value::Float(number)) => (low..=high).contains(number),
                    (Kind::Whole(low, high), Value::Integer(number)) => {
                        (i64::from(low)..=i64::from(high)).contains(number)
                    }
                    (Kind::Pair(low, high), Value::Array(two)) => {
                        two.len() == 2 && two.iter().all(|n| (low..=high).contains(&n.as_float().unwrap()))
                    }
                    (Kind::Switch, Value::Boolean(_)) => true,
                    (Kind::Choice(names), Value::String(name)) => names.contains(&name.as_str()),
                    _ => false,
                };
                assert!(inside, "{}.{} = {value}: {:?}", group.table, one.name, one.kind);
            }
        }
    }

    #[test]
    fn the_core_takes_both_ends_of_every_range_and_every_choice() {
        for (group, one) in all() {
            let tried: Vec<String> = match one.kind {
                Kind::Number(low, high) => vec![format!("{low:?}"), format!("{high:?}")],
                Kind::Whole(low, high) => vec![low.to_string(), high.to_string()],
                Kind::Pair(low, high) => vec![format!("[{low:?}, {high:?}]")],
                Kind::Switch => vec!["true".to_owned(), "false".to_owned()],
                Kind::Choice(names) => names.iter().map(|name| format!("\"{name}\"")).collect(),
            };
            for value in tried {
                assert_eq!(set(group, one, &value), Ok(()), "{}.{} = {value}", group.table, one.name);
            }
            let fault = set(group, one, "\"none of these\"").unwrap_err();
            assert!(fault.contains(one.name) || fault.contains("none of these"), "{fault}");
        }
    }

    #[test]
    fn the_papers_values_are_those_of_the_paper_preset() {
        let mut paper = PlannerConfig::paper();
        paper.perception.learning = LearningConfig::paper();
        let mut values = values(&scenario(), &scenario(), Preset::Paper).unwrap();
        values.insert("planner".to_owned(), Value::try_from(&paper).unwrap());
        let mut given = 0;
        for (group, one) in all() {
            let Some(paper) = one.paper else { continue };
            assert_eq!(value(paper), table_of(&values, group.table).unwrap()[one.name], "{}", one.name);
            given += 1;
        }
        assert!(given > 10);
    }

    #[test]
    fn the_planner_follows_a_changed_robot() {
        let (file, sections) = (scenario(), "[robot]\nwidth_m = 0.9\n[planner.decision]\nlook_ticks = 9\n");
        let running = file.with_parameters("it", sections).unwrap();
        let values = values(&file, &running, Preset::Default).unwrap();
        assert_eq!(values["planner"]["robot_width_m"].as_float(), Some(0.9));
        assert_eq!(values["planner"]["decision"]["look_ticks"].as_integer(), Some(150));
        assert_eq!(values["robot"]["width_m"].as_float(), Some(0.685));
    }

    #[test]
    fn the_json_holds_every_value() {
        let json = json(&values(&scenario(), &scenario(), Preset::Default).unwrap());
        assert!(json.starts_with("[{\"table\":\"planner\",\"title\":"), "{json}");
        assert_eq!(json.matches("\"value\":").count(), all().count());
        assert!(json.contains("\"name\":\"range_noise_m\",\"unit\":\"m\""));
        assert!(json.contains("\"value\":[0.15,0.04]"));
        assert!(json.contains("\"kind\":\"choice\",\"choices\":[\"lattice\",\"farthest_points\"]"));
        assert!(json.contains("\"paper\":\"every_scan\""));
        assert!(!json.contains(['\n', '\t']));
    }
}
