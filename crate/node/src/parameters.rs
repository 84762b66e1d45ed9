//! What the parameter services tell and change: the sections of the file with a description for each value.
//! Free of the middleware, but for its messages.

use mapless::PlannerConfig;
use mapless_parameters::{Check, Kind, Parameter, Value};
use mapless_robot::drive_config::DriveConfig;
use mapless_robot::supervisor::SupervisorConfig;
use ros2_client::parameters::raw::{
    self, FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterType, ParameterValue,
};
use ros2_client::rcl_interfaces::ListParametersResult;
use serde_json::{Map, Number, json};

use crate::config::{NavigationConfig, NodeConfig, check_tilt, merged};

/// The sections with their present values.
#[derive(Clone, Debug)]
pub(crate) struct Parameters {
    pub(crate) planner: PlannerConfig,
    pub(crate) supervisor: SupervisorConfig,
    pub(crate) navigation: NavigationConfig,
}

/// A parameter under its name in the file.
struct Entry {
    name: String,
    parameter: &'static Parameter,
    value: Value,
}

impl Parameters {
    /// Those of a file.
    pub(crate) fn of(config: &NodeConfig) -> Self {
        let DriveConfig { planner, supervisor, navigation, .. } = config.drive.clone();
        Self { planner, supervisor, navigation }
    }

    fn entries(&self) -> Vec<Entry> {
        let mut entries = Vec::new();
        let mut see = |place: &str, parameter: &'static Parameter, value| {
            // The file has sensor and robot as sections of their own.
            let own = ["planner.sensor", "planner.robot"].into_iter().find(|own| *own == place);
            let place = own.and_then(|own| own.strip_prefix("planner.")).unwrap_or(place);
            entries.push(Entry { name: format!("{place}.{}", parameter.name), parameter, value });
        };
        self.planner.visit("planner", &mut see);
        self.supervisor.visit("supervisor", &mut see);
        self.navigation.visit("navigation", &mut see);
        entries
    }

    fn find(&self, name: &str) -> Option<Entry> {
        self.entries().into_iter().find(|entry| entry.name == name)
    }

    /// Names under prefixes, as rclcpp lists them: `depth` levels of them, or all of them for 0.
    pub(crate) fn list(&self, prefixes: &[String], depth: u64) -> ListParametersResult {
        let is_near = |rest: &str| depth == 0 || (rest.matches('.').count() as u64) < depth;
        let is_listed = |name: &String| {
            let is_under = |prefix: &String| {
                let rest = name.strip_prefix(prefix.as_str());
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.') && is_near(rest))
            };
            prefixes.is_empty() && is_near(name) || prefixes.iter().any(is_under)
        };
        let names: Vec<String> =
            self.entries().into_iter().map(|entry| entry.name).filter(is_listed).collect();
        let mut prefixes: Vec<String> =
            names.iter().filter_map(|name| Some(name.rsplit_once('.')?.0.to_owned())).collect();
        prefixes.dedup();
        ListParametersResult { names, prefixes }
    }

    /// The value of a parameter; that of an unknown one is not set.
    pub(crate) fn get(&self, name: &str) -> ParameterValue {
        self.find(name).map_or_else(not_set, |entry| raw_value(entry.value))
    }

    /// The description of a parameter, as the file's documentation has it.
    pub(crate) fn describe(&self, name: &str) -> ParameterDescriptor {
        let mut told = ParameterDescriptor {
            name: name.to_owned(),
            r#type: self.get(name).ptype,
            description: String::new(),
            additional_constraints: String::new(),
            read_only: true,
            dynamic_typing: false,
            floating_point_range: Vec::new(),
            integer_range: Vec::new(),
        };
        let Some(Entry { parameter, .. }) = self.find(name) else { return told };
        told.description = match parameter.unit {
            "" => parameter.text.to_owned(),
            unit => format!("{} Unit: {unit}.", parameter.text),
        };
        told.additional_constraints = constraints(parameter);
        told.read_only = !is_settable(name);
        if let Check::Within(from_value, to_value) = parameter.check {
            let (from, to) = (from_value as i64, to_value as i64);
            match parameter.kind {
                Kind::Whole(..) => {
                    told.integer_range = vec![IntegerRange { from_value: from, to_value: to, step: 0 }];
                }
                _ => {
                    told.floating_point_range = vec![FloatingPointRange { from_value, to_value, step: 0.0 }];
                }
            }
        }
        told
    }

    /// Sets all of these or none.
    ///
    /// # Errors
    /// Why not, for people.
    pub(crate) fn set(&mut self, changes: &[raw::Parameter], is_pursuing: bool) -> Result<(), String> {
        let mut sections = Map::new();
        for raw::Parameter { name, value } in changes {
            let entry = self.find(name).ok_or_else(|| format!("{name}: there is no such parameter"))?;
            if !is_settable(name) {
                return Err(format!("{name}: it cannot change while the node runs: set it in the file"));
            }
            if is_pursuing && name.starts_with("planner.") {
                return Err(format!(
                    "{name}: the planner forgets the ground with it, and a goal is pursued: cancel the goal first"
                ));
            }
            let value = json_value(value, &entry)?;
            let mut keys = name.split('.').peekable();
            let mut table = &mut sections;
            while let Some(key) = keys.next() {
                if keys.peek().is_none() {
                    table.insert(key.to_owned(), value);
                    break;
                }
                let inner = table.entry(key).or_insert_with(|| json!({}));
                table = inner.as_object_mut().ok_or_else(|| format!("{name}: {key} is no table"))?;
            }
        }
        let section = |key: &str| sections.get(key).cloned().unwrap_or_default();
        let unread = |error: serde_json::Error| error.to_string();
        let changed = Self {
            planner: merged(&self.planner, &section("planner")).map_err(unread)?,
            supervisor: merged(&self.supervisor, &section("supervisor")).map_err(unread)?,
            navigation: merged(&self.navigation, &section("navigation")).map_err(unread)?,
        };
        changed.validate().map_err(|error| error.to_string())?;
        *self = changed;
        Ok(())
    }

    fn validate(&self) -> Result<(), mapless_parameters::ConfigError> {
        self.planner.validate("planner")?;
        self.supervisor.validate("supervisor")?;
        check_tilt(&self.supervisor, &self.planner.robot)?;
        self.navigation.validate("navigation")
    }
}

/// What may change while the node runs. How old an input may get is for the file alone, as are sensor and
/// robot.
fn is_settable(name: &str) -> bool {
    ["planner.", "navigation.", "supervisor.max_"].iter().any(|prefix| name.starts_with(prefix))
}

fn constraints(parameter: &Parameter) -> String {
    match parameter.kind {
        Kind::Number(low, high) => format!("{}; usually {low} to {high}", parameter.check),
        Kind::Whole(low, high) => format!("{}; usually {low} to {high}", parameter.check),
        Kind::Pair(low, high) => format!("two of {}; usually {low} to {high}", parameter.check),
        Kind::Switch => String::new(),
        Kind::Choice(words) => format!("one of {}", words.join(", ")),
    }
}

fn not_set() -> ParameterValue {
    ParameterValue {
        ptype: ParameterType::NOT_SET,
        boolean_value: false,
        int_value: 0,
        double_value: 0.0,
        string_value: String::new(),
        byte_array: Vec::new(),
        bool_array: Vec::new(),
        int_array: Vec::new(),
        double_array: Vec::new(),
        string_array: Vec::new(),
    }
}

fn raw_value(value: Value) -> ParameterValue {
    let rest = not_set();
    match value {
        Value::Number(number) => {
            ParameterValue { ptype: ParameterType::DOUBLE, double_value: number, ..rest }
        }
        Value::Whole(number) => ParameterValue {
            ptype: ParameterType::INTEGER,
            int_value: i64::try_from(number).unwrap_or(i64::MAX),
            ..rest
        },
        Value::Pair(pair) => {
            ParameterValue { ptype: ParameterType::DOUBLE_ARRAY, double_array: pair.to_vec(), ..rest }
        }
        Value::Switch(on) => ParameterValue { ptype: ParameterType::BOOL, boolean_value: on, ..rest },
        Value::Word(word) => {
            ParameterValue { ptype: ParameterType::STRING, string_value: word.to_owned(), ..rest }
        }
    }
}

/// A value of the parameter's type. A whole number will do for a number, as `ros2 param set` sends it.
fn json_value(value: &ParameterValue, entry: &Entry) -> Result<serde_json::Value, String> {
    let name = &entry.name;
    let number = |number: f64| {
        let number =
            Number::from_f64(number).ok_or_else(|| format!("{name} = {number}: expected a finite number"));
        number.map(serde_json::Value::Number)
    };
    match (entry.value, value.ptype) {
        (Value::Number(_), ParameterType::DOUBLE) => number(value.double_value),
        (Value::Number(_) | Value::Whole(_), ParameterType::INTEGER) => Ok(json!(value.int_value)),
        (Value::Switch(_), ParameterType::BOOL) => Ok(json!(value.boolean_value)),
        (Value::Word(_), ParameterType::STRING) => Ok(json!(value.string_value)),
        (Value::Pair(_), ParameterType::DOUBLE_ARRAY) => {
            let pair: Result<Vec<_>, _> = value.double_array.iter().copied().map(number).collect();
            Ok(json!(pair?))
        }
        (expected, _) => {
            let kind = match expected {
                Value::Number(_) => "a number",
                Value::Whole(_) => "a whole number",
                Value::Pair(_) => "a list of two numbers",
                Value::Switch(_) => "true or false",
                Value::Word(_) => "a word",
            };
            Err(format!("{name}: a value of another type: expected {kind}"))
        }
    }
}

#[cfg(test)]
mod tests;
