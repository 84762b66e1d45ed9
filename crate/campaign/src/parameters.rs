//! Parameters of the planner by their dotted path, and how their values combine into variations.

use mapless::PlannerConfig;
use toml::{Table, Value};

/// The parameter `path` and its values, each in the form of the planner's own type.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Parameter {
    pub(crate) path: String,
    pub(crate) values: Vec<Value>,
}

/// Values of some parameters; none in the base variation.
pub(crate) type Variation = Vec<(String, Value)>;

/// The variation as rows name it: `path=value`, separated by spaces; empty for the base. A value has no
/// spaces: an array is written as JSON does.
pub(crate) fn name(variation: &Variation) -> String {
    let word = |(path, value): &(String, Value)| format!("{path}={}", value.to_string().replace(", ", ","));
    let words: Vec<String> = variation.iter().map(word).collect();
    words.join(" ")
}

/// The base and, one at a time, every value of every parameter.
pub(crate) fn one_at_a_time(parameters: &[Parameter]) -> Vec<Variation> {
    let alone = |parameter: &Parameter| -> Vec<Variation> {
        parameter.values.iter().map(|value| vec![(parameter.path.clone(), value.clone())]).collect()
    };
    std::iter::once(Vec::new()).chain(parameters.iter().flat_map(alone)).collect()
}

/// Every value of every parameter with every value of all others; the last parameter changes fastest.
pub(crate) fn grid(parameters: &[Parameter]) -> Vec<Variation> {
    parameters.iter().fold(vec![Vec::new()], |variations, parameter| {
        let with = |variation: &Variation| -> Vec<Variation> {
            let add = |value: &Value| {
                let mut longer = variation.clone();
                longer.push((parameter.path.clone(), value.clone()));
                longer
            };
            parameter.values.iter().map(add).collect()
        };
        variations.iter().flat_map(with).collect()
    })
}

/// `config` with the variation's values. They are not checked against their ranges.
pub(crate) fn apply(config: &PlannerConfig, variation: &Variation) -> Result<PlannerConfig, String> {
    let mut table = Table::try_from(config).map_err(|error| error.to_string())?;
    for (path, value) in variation {
        *slot(&mut table, path)? = value.clone();
    }
    table.try_into().map_err(|error: toml::de::Error| error.message().to_owned())
}

/// The value in the form of the planner's own type, so that 1 and 1.0 are one value of a length.
pub(crate) fn normalised(path: &str, value: &Value) -> Result<Value, String> {
    let config = apply(&PlannerConfig::default(), &vec![(path.to_owned(), value.clone())])?;
    let mut table = Table::try_from(&config).map_err(|error| error.to_string())?;
    slot(&mut table, path).cloned()
}

/// The entry of the parameter `path` in a planner's configuration.
fn slot<'a>(table: &'a mut Table, path: &str) -> Result<&'a mut Value, String> {
    let unknown = || {
        format!("\"{path}\": expected a parameter of the planner, as \"planner.decision.steepness_weight\"")
    };
    let (section, name) = path.rsplit_once('.').ok_or_else(unknown)?;
    let mut words = section.split('.');
    if words.next() != Some("planner") {
        return Err(unknown());
    }
    let section =
        words.try_fold(table, |table, word| table.get_mut(word)?.as_table_mut()).ok_or_else(unknown)?;
    section.get_mut(name).ok_or_else(unknown)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(path: &str, values: &[f64]) -> Parameter {
        Parameter { path: path.to_owned(), values: values.iter().map(|&value| Value::Float(value)).collect() }
    }

    #[test]
    fn one_at_a_time_is_the_base_and_each_value_alone() {
        let parameters = [parameter("planner.a", &[1.0, 2.0]), parameter("planner.b", &[3.0])];
        let names: Vec<String> = one_at_a_time(&parameters).iter().map(name).collect();
        assert_eq!(names, ["", "planner.a=1.0", "planner.a=2.0", "planner.b=3.0"]);
    }

    #[test]
    fn an_array_is_one_value() {
        let scales = Value::Array(vec![Value::Float(0.15), Value::Float(0.04)]);
        let variation = vec![("planner.perception.kernel.length_scales_rad".to_owned(), scales)];
        assert_eq!(name(&variation), "planner.perception.kernel.length_scales_rad=[0.15,0.04]");
    }

    #[test]
    fn a_grid_is_every_combination() {
        let parameters = [parameter("planner.a", &[1.0, 2.0]), parameter("planner.b", &[3.0, 4.0, 5.0])];
        let names: Vec<String> = grid(&parameters).iter().map(name).collect();
        assert_eq!(names.len(), 6);
        assert_eq!(names[1], "planner.a=1.0 planner.b=4.0");
        assert_eq!(names[5], "planner.a=2.0 planner.b=5.0");
        assert_eq!(grid(&[]), [Vec::new()]);
    }

    #[test]
    fn values_reach_the_configuration() {
        let base = PlannerConfig::paper();
        let path = "planner.decision.steepness_weight".to_owned();
        let config = apply(&base, &vec![(path.clone(), Value::Float(0.25))]).unwrap();
        assert_eq!(config.decision.steepness_weight.to_bits(), 0.25_f64.to_bits());
        assert_eq!(
            apply(&config, &vec![(path, Value::Float(base.decision.steepness_weight))]).unwrap(),
            base
        );
        assert_eq!(
            normalised("planner.decision.steepness_weight", &Value::Integer(1)).unwrap(),
            Value::Float(1.0)
        );
    }

    #[test]
    fn what_is_no_parameter_is_refused() {
        for path in [
            "planner",
            "planner.none",
            "decision.steepness_weight",
            "planner.decision.none.x",
            "planner..x",
            "",
        ] {
            let error = normalised(path, &Value::Float(1.0)).unwrap_err();
            assert!(error.contains("expected a parameter of the planner"), "{path}: {error}");
        }
        let error =
            normalised("planner.decision.steepness_weight", &Value::String("much".to_owned())).unwrap_err();
        assert!(error.contains("expected") && error.contains("much"), "{error}");
    }
}
