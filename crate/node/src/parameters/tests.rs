use std::path::Path;

use super::*;
use crate::config::Distro;

fn parameters() -> Parameters {
    let distro = Distro::BUILT.word();
    let text = format!("/**:\n  ros__parameters:\n    distro: {distro}\n    robot_preset: husky\n");
    Parameters::of(&NodeConfig::parse(Path::new("f"), &text).unwrap())
}

fn change(name: &str, value: Value) -> raw::Parameter {
    raw::Parameter { name: name.to_owned(), value: raw_value(value) }
}

fn refusal(name: &str, value: Value) -> String {
    parameters().set(&[change(name, value)], false).unwrap_err()
}

#[test]
fn every_parameter_is_listed_once_and_has_value_and_description() {
    let parameters = parameters();
    let names = parameters.list(&[], 0).names;
    assert!(names.len() > 90, "{}", names.len());
    for name in &names {
        assert_eq!(names.iter().filter(|other| *other == name).count(), 1, "{name}");
        let told = parameters.describe(name);
        assert_ne!(parameters.get(name).ptype, ParameterType::NOT_SET, "{name}");
        assert!(told.r#type == parameters.get(name).ptype && !told.description.is_empty(), "{name}");
    }
    let told = parameters.describe("planner.perception.variance_threshold");
    assert!(!told.read_only && told.additional_constraints.contains("a share between 0 and 1"));
    assert!(parameters.describe("sensor.rings").read_only);
    let ranges = parameters.describe("navigation.timeout_s").floating_point_range;
    assert!(ranges[0].from_value < 1.1 && ranges[0].to_value > 86_399.0);
    assert_eq!(parameters.describe("no.such").r#type, ParameterType::NOT_SET);
}

#[test]
fn lists_have_prefixes_and_depths_as_rclcpp_counts_them() {
    let parameters = parameters();
    let list = |prefixes: &[&str], depth| {
        let prefixes: Vec<String> = prefixes.iter().map(|prefix| (*prefix).to_owned()).collect();
        parameters.list(&prefixes, depth)
    };
    let navigation = list(&["navigation"], 0);
    assert_eq!(navigation.names.len(), NavigationConfig::PARAMETERS.len());
    assert_eq!(navigation.prefixes, ["navigation"]);
    // The dot after the prefix counts, too.
    assert_eq!(list(&["planner"], 2).names, ["planner.goal_tolerance_m"]);
    assert!(list(&[], 1).names.is_empty() && list(&["plan"], 0).names.is_empty());
}

#[test]
fn a_value_is_set_and_its_neighbours_stay() {
    let mut parameters = parameters();
    let changes = [
        change("planner.perception.variance_threshold", Value::Number(0.25)),
        change("planner.goal_tolerance_m", Value::Whole(1)),
        change("supervisor.max_speed_m_s", Value::Number(0.3)),
    ];
    parameters.set(&changes, false).unwrap();
    let mut expected = PlannerConfig::default();
    (expected.perception.variance_threshold, expected.goal_tolerance_m) = (0.25, 1.0);
    assert_eq!(parameters.planner, expected);
    assert!((parameters.supervisor.max_speed_m_s - 0.3).abs() < 1e-12);
}

#[test]
fn each_refusal_has_its_reason_and_changes_nothing() {
    for (name, value, reason) in [
        ("planner.speed", Value::Number(1.0), "planner.speed: there is no such parameter"),
        (
            "planner.perception.variance_threshold",
            Value::Number(1.5),
            "planner.perception.variance_threshold = 1.5: expected a share between 0 and 1",
        ),
        ("supervisor.max_roll_rad", Value::Number(0.6), "supervisor.max_roll_rad = 0.6: expected at most"),
        ("supervisor.scan_s", Value::Number(1.0), "supervisor.scan_s: it cannot change while the node runs"),
        ("sensor.rings", Value::Whole(8), "sensor.rings: it cannot change while the node runs"),
        ("navigation.timeout_s", Value::Word("long"), "navigation.timeout_s: a value of another type"),
        (
            "navigation.timeout_s",
            Value::Number(f64::NAN),
            "navigation.timeout_s = NaN: expected a finite number",
        ),
        ("planner.decision.cost_model", Value::Word("best"), "unknown variant `best`"),
        ("planner.perception.max_inducing_inputs", Value::Number(1.5), "planner.perception.max_inducing_"),
    ] {
        let refused = refusal(name, value);
        assert!(refused.starts_with(reason), "{refused}\nexpected: {reason}");
    }
    let mut parameters = parameters();
    let before = parameters.navigation;
    let changes = [
        change("navigation.timeout_s", Value::Number(60.0)),
        change("navigation.feedback_hz", Value::Number(-1.0)),
    ];
    parameters.set(&changes, false).unwrap_err();
    assert_eq!(parameters.navigation, before, "all or none");
}

#[test]
fn with_a_goal_the_planner_stays_as_it_is_and_limits_change() {
    let mut parameters = parameters();
    let planner = change("planner.goal_tolerance_m", Value::Number(1.0));
    assert!(parameters.set(std::slice::from_ref(&planner), true).unwrap_err().contains("a goal is pursued"));
    parameters.set(&[change("supervisor.max_speed_m_s", Value::Number(0.2))], true).unwrap();
    parameters.set(&[planner], false).unwrap();
}
