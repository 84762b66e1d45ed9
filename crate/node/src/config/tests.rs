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
    assert_eq!(config.drive.planner, PlannerConfig::default());
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
    assert_eq!(config.drive.planner, expected);
}

#[test]
fn packets_are_taken_from_the_sensor_that_is_named() {
    assert_eq!(parse("").unwrap().velodyne, None);
    let velodyne = parse("    velodyne: {from: 192.168.1.201}\n").unwrap().velodyne.unwrap();
    assert_eq!(velodyne.from.to_string(), "192.168.1.201");
    assert_eq!((velodyne.address.to_string().as_str(), velodyne.port.get()), ("0.0.0.0", 2368));
}

#[test]
fn a_mount_by_tf_fits_the_planner_as_one_in_the_file_does() {
    let planner = "    planner: {goal_tolerance_m: 2}\n";
    let by_tf = parse(&format!("    sensor_mount: {{source: tf}}\n{planner}")).unwrap();
    let in_file =
        parse(&format!("    sensor: {{height_m: 1.5, forward_m: 0.2, pitch_rad: -0.1}}\n{planner}"));
    let in_file = in_file.unwrap().drive.planner;
    let SensorModel { forward_m, left_m, height_m, roll_rad, pitch_rad, yaw_rad, .. } = in_file.sensor;
    let mount = Mount { forward_m, left_m, height_m, roll_rad, pitch_rad, yaw_rad };
    assert_ne!(by_tf.drive.planner, in_file);
    assert_eq!(by_tf.mounted(&mount).unwrap().drive.planner, in_file);
    let up = by_tf.mounted(&Mount { pitch_rad: 0.5, ..mount }).unwrap_err();
    assert!(up.starts_with("a sensor whose lowest beam ahead is at"), "{up}");
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
        (
            "    sensor_mount: {source: tf}\n    sensor:\n      height_m: 0.6\n",
            "robot.yaml:7: sensor.height_m: the mount comes by tf",
        ),
        ("    sensor_mount: {source: map}\n", "robot.yaml:5: "),
        (
            "    sensor_mount: {timeout_s: 0}\n",
            "robot.yaml:5: sensor_mount.timeout_s = 0: expected a number from 1",
        ),
        ("    velodyne: {}\n", "robot.yaml:5: missing field `from`"),
        ("    velodyne:\n      from: lidar\n", "robot.yaml:6: "),
        ("    velodyne:\n      from: 10.0.0.2\n      port: 0\n", "robot.yaml:7: "),
        (
            "    velodyne:\n      from: fe80::1\n",
            "robot.yaml:6: velodyne.from = fe80::1: expected an address of the kind of 0.0.0.0",
        ),
        (
            "    velodyne: {from: 10.0.0.2}\n    use_sim_time: true\n",
            "robot.yaml:5: velodyne: a sensor on the network has no simulated clock",
        ),
    ] {
        let refusal = refusal(more);
        assert!(refusal.starts_with(expected), "{refusal}\nexpected: {expected}");
    }
}

/// A sample file, for the distribution that this is built for.
fn sample(robot: &str, distro: &str) -> NodeConfig {
    let name = format!("{}/config/{robot}-{distro}.yaml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&name).unwrap();
    let built = text.replace(&format!("distro: {distro}"), &format!("distro: {}", Distro::BUILT.word()));
    NodeConfig::parse(Path::new(&name), &built).unwrap()
}

#[test]
fn the_sample_files_are_in_order() {
    for distro in ["humble", "jazzy"] {
        assert_eq!(sample("husky", distro).namespace, "/a200_0000");
    }
    let jackal = sample("jackal-os1-32", "jazzy");
    assert_eq!((jackal.drive.planner.sensor.rings, jackal.drive.planner.robot), (32, RobotModel::jackal()));
    assert_eq!(
        jackal.drive.planner,
        PlannerConfig::for_robot(jackal.drive.planner.sensor, RobotModel::jackal())
    );
}

#[test]
fn the_foxglove_layout_shows_the_topics_of_the_sample_file() {
    let layout = include_str!("../../foxglove/mapless.json");
    serde_json::from_str::<Value>(layout).unwrap();
    let topics = sample("husky", "jazzy").topics;
    let Topics { scan, path, subgoals, skyline, variance, elevation, .. } = topics;
    let Topics { decision, cmd_vel, diagnostics, goal_pose, .. } = topics;
    let pictures = [scan, path, subgoals, skyline, variance, elevation];
    for topic in pictures.into_iter().chain([decision, cmd_vel, diagnostics, goal_pose]) {
        assert!(layout.contains(&format!("\"/a200_0000/{topic}")), "{topic}");
    }
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
