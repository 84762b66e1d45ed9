use super::*;
use crate::file::{Benchmark, Campaign};
use glam::{DVec2, DVec3};
use mapless_trials::{LoadedScenario, Preset, Trial};
use tempfile::TempDir;

/// A folder with the small benchmark of the tests, and where it is imported to.
fn folder() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    testing::write(folder.path());
    let out = folder.path().join("out");
    (folder, out)
}

fn scale(text: &str) -> Scale {
    text.parse().unwrap()
}

/// The error of an import with `from` in `tasks.json` replaced by `to`.
fn refused(from: &str, to: &str) -> String {
    let (folder, out) = folder();
    assert!(testing::TASKS.contains(from), "{from}");
    fs::write(folder.path().join("tasks.json"), testing::TASKS.replacen(from, to, 1)).unwrap();
    import(folder.path(), scale("1/5"), &out).unwrap_err().to_string()
}

#[test]
fn a_world_becomes_a_fifth_of_its_size_in_all_directions() {
    let (folder, out) = folder();
    let imported = import(folder.path(), scale("1/5"), &out).unwrap();
    assert_eq!((imported.worlds, imported.tasks), (1, 2));
    let LoadedScenario { scenario, terrain } =
        LoadedScenario::read(&out.join("tasks/mid-003-01.toml")).unwrap();
    let field = &terrain.field;
    assert_eq!(field.extent_m(), DVec2::splat(40.0 * 0.2));
    // A level is 10.2 m / 255 = 4 cm there, and the ground rises by one a row northwards.
    let height_m = |row: usize| field.height_m(DVec2::new(1.0, row as f64 * 0.2)).unwrap();
    for row in [0, 7, 40] {
        assert!((height_m(row) - 0.2 * 0.04 * (60 + row) as f64).abs() < 1e-6, "{row}");
    }
    assert_eq!(scenario.start.position_m, DVec2::new(1.0, 5.0));
    assert_eq!(scenario.goal_m, DVec2::new(7.0, 2.0));
    assert!((scenario.start.heading_rad - libm::atan2(-3.0, 6.0)).abs() < 1e-4);
    let config = scenario.planner_config(Preset::Default).unwrap();
    assert!((config.goal_tolerance_m - 1.6).abs() < 1e-12);
    let campaign = Campaign::read(&imported.campaign).unwrap();
    assert_eq!((campaign.routes.len(), campaign.benchmark), (2, Some(Benchmark::VertiBench)));
    assert_eq!(campaign.planners, ["default", "oracle", "vgf_tuned", "putn"]);
}

#[test]
fn the_first_scan_hits_a_rock_where_it_stands() {
    let (folder, out) = folder();
    import(folder.path(), scale("1/5"), &out).unwrap();
    let LoadedScenario { scenario, terrain } =
        LoadedScenario::read(&out.join("tasks/mid-003-01.toml")).unwrap();
    let mut trial = Trial::new(terrain.field, &scenario, Preset::Default, 1).unwrap();
    trial.look_far();
    // Half of 4.4 m and of 3.8 m, a fifth in size, in front of (10, 5) from the middle of 20 m.
    let (rock_m, half_m, height_m) = (DVec2::new(6.0, 5.0), 0.5 * 4.4 / 5.0 / 2.0, 0.5 * 3.8 / 5.0);
    let ground_m = 0.2 * 0.04 * 85.0;
    let state = trial.robot();
    let sensor = trial.sensor().config().pose_on(state.position, state.yaw_rad, &state.attitude);
    let points = trial.scan().points.iter();
    let hits: Vec<DVec3> =
        points.map(|point| sensor.position + sensor.world_from_sensor * point.as_dvec3()).collect();
    let on_face = |hit: &&DVec3| {
        (hit.x - (rock_m.x - half_m)).abs() < 0.1
            && (hit.y - rock_m.y).abs() < half_m
            && (ground_m + 0.1..ground_m + height_m + 0.1).contains(&hit.z)
    };
    assert!(hits.iter().filter(on_face).count() >= 3, "{hits:?}");
}

#[test]
fn ground_that_gives_is_left_out_and_bad_places_are_told() {
    let (folder, out) = folder();
    let warnings = import(folder.path(), scale("1/5"), &out).unwrap().warnings;
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("left out"), "{warnings:?}");
    // The start is put into the rock and its goal over the border; the second pair stays as it is.
    let tasks = testing::TASKS.replace("[-15.0,5.0],[15.0,-10.0]", "[10.0,5.5],[20.0,0.0]");
    fs::write(folder.path().join("tasks.json"), tasks).unwrap();
    let again = folder.path().join("again");
    let warnings = import(folder.path(), scale("1/5"), &again).unwrap().warnings;
    let [_, start, goal] = warnings.as_slice() else { panic!("{warnings:?}") };
    let begins = |what: &str| format!("{}: {what} at ", again.join("tasks/mid-003-01.toml").display());
    assert!(start.starts_with(&begins("start")) && start.ends_with("touches the box there"), "{start}");
    assert!(goal.starts_with(&begins("goal")) && goal.contains("a wheel is off the map"), "{goal}");
    assert!(again.join("tasks/mid-003-01.toml").is_file());
    // Four times as high, the ground rises by 45 % northwards.
    fs::write(folder.path().join("tasks.json"), testing::TASKS.replace("10.2", "300")).unwrap();
    let warnings = import(folder.path(), scale("1/5"), &folder.path().join("steep")).unwrap().warnings;
    let tilted = warnings.iter().filter(|warning| warning.contains("rad there: the limit is")).count();
    assert_eq!(tilted, 4, "{warnings:?}");
}

#[test]
fn a_second_import_changes_nothing_and_another_scale_is_refused() {
    let (folder, out) = folder();
    let first = import(folder.path(), scale("1/5"), &out).unwrap();
    assert_eq!(import(folder.path(), scale("0.2"), &out).unwrap(), first);
    let error = import(folder.path(), scale("1"), &out).unwrap_err().to_string();
    assert!(error.contains("003.toml: cannot be written: it has other contents"), "{error}");
}

#[test]
fn errors_name_file_place_value_and_expectation() {
    for (from, to, parts) in [
        ("\"mid\"", "\"hard\"", ["tasks.json: ", "unknown variant `hard`, expected one of `low`", "line 2"]),
        ("10.2", "0", ["tasks.json: world 3, ", "max_height_m = 0: ", "expected a positive number"]),
        ("5.0,0.5]", "5.0,-1]", ["tasks.json: world 3, ", "scale of rocks[1] = -1: ", "positive number"]),
        ("[10.0,5.0", "[10.0,25.0", ["tasks.json: world 3, rocks[1] at ", "[10.0, 25.0]", "on the map"]),
        ("5.0,0.5]", "5.0,900]", ["objects", "size_m", "0.001 to 100"]),
        ("\"3\"", "\"4\"", ["worlds/4.bmp: ", "cannot be read", "No such file"]),
        ("\"3\"", "\"x\"", ["tasks.json: ", "line 2", "expected"]),
    ] {
        let error = refused(from, to);
        for part in parts {
            assert!(error.contains(part), "{part} is not in: {error}");
        }
    }
    let (folder, out) = folder();
    fs::write(folder.path().join("worlds/3.bmp"), b"GIF").unwrap();
    let error = import(folder.path(), scale("1/5"), &out).unwrap_err().to_string();
    assert!(error.contains("3.bmp: it begins with") && error.contains("expected \"BM\""), "{error}");
    let error = import(&out, scale("1/5"), &out).unwrap_err().to_string();
    assert!(error.contains("expected tasks.json with worlds/"), "{error}");
}

#[test]
fn a_checkout_gives_the_same_as_the_list() {
    let (folder, out) = folder();
    import(folder.path(), scale("1/5"), &out).unwrap();
    let maps = folder.path().join("checkout/envs/data/BenchMaps/sampled_maps");
    for part in ["Worlds", "Configs/Final"] {
        fs::create_dir_all(maps.join(part)).unwrap();
    }
    fs::copy(folder.path().join("worlds/3.bmp"), maps.join("Worlds/3.bmp")).unwrap();
    fs::write(maps.join("Configs/Final/obs3_mid.bmp"), b"").unwrap();
    let config = "\
obstacle_density: medium
obstacles:
  rocks:
  - position: {x: 10.0, y: 5.00001, z: 3.7}
    scale: 0.5
  trees:
  - position: {x: -15.0, y: -15.0, z: 3.1}
obstacles_flag: true
positions:
- goal: [15.0, -10.0, 1.0]
  start: [-15.0, 5.0, 1.0]
- goal: [-15.0, 14.5, 1.0]
  start: [-15.0, -5.0, 1.0]
terrain: {difficulty: mid, is_flat: false, length: 20.5, max_height: 10.2, min_height: 0.0,
  width: 20.5}
terrain_type: rigid
textures: []
";
    fs::write(maps.join("Configs/Final/config3_mid.yaml"), config).unwrap();
    let again = folder.path().join("again");
    let imported = import(&folder.path().join("checkout"), scale("1/5"), &again).unwrap();
    assert_eq!((imported.tasks, imported.warnings.len()), (2, 0));
    for file in ["worlds/003.png", "worlds/003.toml", "tasks/mid-003-01.toml", "tasks/mid-003-02.toml"] {
        assert_eq!(fs::read(out.join(file)).unwrap(), fs::read(again.join(file)).unwrap(), "{file}");
    }
    fs::write(maps.join("Configs/Final/config3_mid.yaml"), config.replace("[15.0, ", "[east, ")).unwrap();
    let error = import(&folder.path().join("checkout"), scale("1/5"), &again).unwrap_err().to_string();
    assert!(error.contains("config3_mid.yaml: ") && error.contains("line 10"), "{error}");
}
