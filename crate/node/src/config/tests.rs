use super::*;

fn parse(more: &str) -> Result<NodeConfig, ConfigFileError> {
    let distro = Distro::BUILT.word();
    let least = format!("/**:\n  ros__parameters:\n    distro: {distro}\n    robot_preset: husky\n");
    NodeConfig::parse(Path::new("robot.yaml"), &format!("{least}{more}"))
}

fn refusal(more: &str) -> String {
    parse(more).unwrap_err().to_string()
}

#[test]
fn the_shortest_file_is_a_husky_with_clearpath_s_names() {
    let config = parse("").unwrap();
    assert_eq!(config.planner, PlannerConfig::default());
    let stamped = Distro::BUILT == Distro::Jazzy;
    assert_eq!(config.command_type == CommandType::TwistStamped, stamped);
    assert_eq!(config.topics.scan, "sensors/lidar3d_0/points");
    assert_eq!(config.namespace, "/");
}

#[test]
fn sections_start_from_their_presets() {
    let config =
        parse("    sensor:\n      rings: 32\n      height_m: 1.7\n    planner:\n      goal_tolerance_m: 2\n");
    let config = match config {
        Ok(config) => config,
        Err(error) => panic!("{error}"),
    };
    let mut sensor = SensorModel::vlp16();
    (sensor.rings, sensor.height_m) = (32, 1.7);
    let mut expected = PlannerConfig::for_robot(sensor, RobotModel::husky());
    assert_ne!(expected.perception, PlannerConfig::default().perception, "it is fitted to the sensor");
    expected.goal_tolerance_m = 2.0;
    assert_eq!(config.planner, expected);
}

#[test]
fn every_fault_is_told_with_its_line() {
    for (more, expected) in [
        ("    speed: 3\n", "robot.yaml:5: unknown field `speed`"),
        ("    planner:\n      perception:\n        radius: 3\n", "robot.yaml:7: unknown field `radius`"),
        (
            "    planner:\n      perception:\n        surface_radius_m: -1\n",
            "robot.yaml:7: planner.perception.surface_radius_m = -1: expected a positive number",
        ),
        ("    sensor:\n      rings: many\n", "robot.yaml:6: invalid u64 in \"rings: many\""),
        ("    sensor:\n      rings: 1\n", "robot.yaml:6: sensor.rings = 1: expected at least 2"),
        ("    sensor:\n      max_range_m: .inf\n", "robot.yaml:6: "),
        (
            "    robot:\n      length_m: 0.4\n",
            "robot.yaml:5: robot.wheelbase_m = 0.512: expected at most length_m",
        ),
        ("    namespace: a200\n", "robot.yaml:5: namespace = \"a200\": "),
        ("    topics:\n      scan: a//b\n", "robot.yaml:6: topics.scan: \"a//b\" is no name of a topic: "),
        ("    domain_id: 233\n", "robot.yaml:5: domain_id = 233: expected 0 to 232"),
        (
            "    planner:\n      sensor:\n        rings: 3\n",
            "robot.yaml:6: planner.sensor: expected as a section",
        ),
        ("    distro: jazzy\n", "robot.yaml:5: duplicate mapping key: distro"),
        ("    estimator: {base_height_m: -1}\n", "robot.yaml:5: estimator.base_height_m = -1: expected zero"),
        ("    supervisor:\n      scan_s: 0\n", "robot.yaml:6: supervisor.scan_s = 0: expected a number from"),
        (
            "    supervisor:\n      max_roll_rad: 0.6\n",
            "robot.yaml:6: supervisor.max_roll_rad = 0.6: expected at most",
        ),
        ("    supervisor:\n      has_clock: true\n", "robot.yaml:6: supervisor.has_clock: "),
        (
            "    recording: {folder: drives}\n",
            "robot.yaml:5: recording.folder = drives: expected an absolute path",
        ),
        (
            "    recording:\n      folder: /d\n      max_size_mb: 0\n",
            "robot.yaml:7: recording.max_size_mb = 0: ",
        ),
        ("    recording:\n      max_size_mb: 9\n", "robot.yaml:"),
        ("    command_type: joy\n", "robot.yaml:5: "),
    ] {
        let refusal = refusal(more);
        assert!(refusal.starts_with(expected), "{refusal}\nexpected: {expected}");
    }
}

#[test]
fn the_sample_file_of_the_distribution_is_in_order() {
    let name = format!("{}/config/husky-{}.yaml", env!("CARGO_MANIFEST_DIR"), Distro::BUILT.word());
    let config = NodeConfig::open(Path::new(&name)).unwrap();
    assert_eq!(config.namespace, "/a200_0000");
}

#[test]
fn a_file_for_another_distribution_or_form_is_refused() {
    let other = if cfg!(feature = "humble") { "jazzy" } else { "humble" };
    let text = format!("/**:\n  ros__parameters:\n    distro: {other}\n    robot_preset: husky\n");
    let error = NodeConfig::parse(Path::new("f"), &text).unwrap_err().to_string();
    assert!(error.starts_with(&format!("f:3: distro = {other}: this program is built for ")), "{error}");
    for text in ["", "mapless:\n  a: 1\n", "/**:\n  ros__parameters:\n    distro: rolling\n", "a: [1\n"] {
        assert!(NodeConfig::parse(Path::new("f"), text).is_err(), "{text}");
    }
    assert!(
        NodeConfig::open(Path::new("no-such-file")).unwrap_err().to_string().starts_with("no-such-file: ")
    );
}
