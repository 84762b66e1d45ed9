//! `[reality]` in the closed loop.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use core::time::Duration;

use glam::{DVec2, DVec3, Vec3};
use mapless::{Command, Goal, Pose};
use mapless_trials::{Activity, Decision, Navigator, Outcome, Preset, RealityPreset, Scenario, Trial};
use mapless_world::HeightField;

const SCENARIO: &str = "terrain = \"it\"\nstart = [20.0, 20.0, 0.0]\ngoal = [38.0, 20.0]\nseed = 7\n";

/// Obeys no goal: gives one command, and keeps what it is given.
#[derive(Clone, Debug, Default)]
struct Steady {
    command: Command,
    poses: Vec<Pose>,
    points: Vec<Vec<Vec3>>,
    elapsed: Vec<Duration>,
    corrections: Vec<(Pose, Pose)>,
}

impl Navigator for Steady {
    fn navigate(&mut self, points_m: &[Vec3], pose: &Pose, _: &Goal, elapsed: Duration) -> Decision {
        self.poses.push(*pose);
        self.points.push(points_m.to_vec());
        self.elapsed.push(elapsed);
        Decision { activity: Activity::Driving, command: self.command }
    }

    fn max_speed_m_s(&self) -> f64 {
        1.0
    }

    fn reset(&mut self) {}

    fn relocalise(&mut self, before: &Pose, after: &Pose) {
        self.corrections.push((*before, *after));
    }
}

fn command(linear_m_s: f64, angular_rad_s: f64) -> Command {
    Command { linear_m_s, angular_rad_s }
}

/// Ground of 60 m by 60 m.
fn ground(height_m: impl Fn(f64, f64) -> f64) -> HeightField {
    let heights = (0..241 * 241)
        .map(|i| height_m(0.25 * f64::from(i % 241), 0.25 * f64::from(i / 241)) as f32)
        .collect();
    HeightField::new(241, 241, 0.25, heights).unwrap()
}

fn hilly() -> HeightField {
    ground(|x, y| 0.6 * libm::sin(0.5 * x) * libm::cos(0.4 * y))
}

fn scenario(reality: &str) -> Scenario {
    Scenario::parse("it", &format!("{SCENARIO}[sensor]\nrange_noise_m = 0.0\n{reality}")).unwrap()
}

/// A trial of so many ticks under one command.
fn steady(reality: &str, field: HeightField, command: Command, ticks: usize) -> Trial<Steady> {
    let navigator = Steady { command, ..Steady::default() };
    let mut trial = Trial::with_navigator(field, &scenario(reality), navigator, 7).unwrap();
    for _ in 0..ticks {
        assert_eq!(trial.tick(), None);
    }
    trial
}

/// Largest height over the ground of the returns of a trial's scan, at the true pose of the sensor.
fn worst_m(trial: &Trial<Steady>, within_m: f32) -> f64 {
    let robot = trial.robot();
    let sensor = trial.sensor().config().pose_on(robot.position, robot.yaw_rad, &robot.attitude);
    let near = trial.scan().points.iter().filter(|point| point.length() < within_m);
    near.map(|point| {
        let world = sensor.position + sensor.world_from_sensor * point.as_dvec3();
        (world.z - trial.field().height_m(world.truncate()).unwrap_or(world.z)).abs()
    })
    .fold(0.0, f64::max)
}

fn digests(reality: &str) -> Vec<String> {
    let text = format!("{SCENARIO}{reality}");
    let scenario = Scenario::parse("it", &text).unwrap();
    let mut trial = Trial::new(hilly(), &scenario, Preset::Default, 3).unwrap();
    let mut digests = Vec::new();
    for _ in 0..60 {
        trial.tick();
        digests.push(trial.digest());
    }
    digests
}

#[test]
fn ideal_is_no_section_at_all_and_field_is_another_world() {
    let without = digests("");
    assert_eq!(without, digests("[reality]\npreset = \"ideal\"\n"));
    assert_eq!(without, digests("[reality.pose]\nscale_drift = 0.0\n[reality.motion]\nfriction = 2.0\n"));
    let field = digests("[reality]\npreset = \"field\"\n");
    assert_ne!(without[59], field[59]);
    assert_eq!(field, digests("[reality]\npreset = \"field\"\n"), "what is random is drawn by the seed");
}

#[test]
fn going_back_in_time_repeats_what_went_wrong() {
    for preset in ["ideal", "field", "harsh"] {
        let text = format!("{SCENARIO}[reality]\npreset = \"{preset}\"\n");
        let mut trial =
            Trial::new(hilly(), &Scenario::parse("it", &text).unwrap(), Preset::Default, 3).unwrap();
        for _ in 0..40 {
            trial.tick();
        }
        let mut copy = trial.clone();
        for _ in 0..40 {
            trial.tick();
            copy.look_far();
            copy.tick();
            assert_eq!(trial.digest(), copy.digest());
            assert_eq!(trial.believed_pose(), copy.believed_pose());
        }
        // And so does beginning anew.
        let reality = format!("[reality]\npreset = \"{preset}\"\n");
        let mut again = steady(&reality, hilly(), command(0.5, 0.2), 30);
        again.set_start(again.start()).unwrap();
        for _ in 0..40 {
            again.tick();
        }
        let anew = steady(&reality, hilly(), command(0.5, 0.2), 40);
        assert_eq!(again.digest(), anew.digest(), "{preset}");
        assert_eq!(again.believed_pose(), anew.believed_pose());
    }
}

#[test]
fn a_preset_holds_unless_the_file_sets_a_value() {
    let read = |reality: &str| scenario(reality).reality;
    let field = RealityPreset::Field.config();
    assert_eq!(read("[reality]\npreset = \"field\"\n"), field);
    let mut wet = field.clone();
    wet.motion.friction = 0.4;
    assert_eq!(read("[reality]\npreset = \"field\"\n[reality.motion]\nfriction = 0.4\n"), wet);
    // Parameters from elsewhere: another preset replaces all, single values stand beside those of the file.
    let file = scenario("[reality]\npreset = \"field\"\n[reality.motion]\nfriction = 0.4\n");
    let changed = |sections: &str| file.with_parameters("it", sections).unwrap().reality;
    assert_eq!(changed("[reality]\npreset = \"harsh\"\n"), RealityPreset::Harsh.config());
    wet.pose.scale_drift = 0.05;
    assert_eq!(changed("[reality.pose]\nscale_drift = 0.05\n"), wet);
    for preset in RealityPreset::ALL {
        assert_eq!(preset.config().preset, *preset);
        assert_eq!(preset.config().validate("reality"), Ok(()));
    }
    let fault = |text: &str| Scenario::parse("it", &format!("{SCENARIO}{text}")).unwrap_err().to_string();
    assert!(fault("[reality]\npreset = \"mild\"\n").contains("line 6, column 10"));
    assert!(fault("[reality.motion]\nfriction = 0\n").contains("reality.motion.friction = 0: expected"));
    assert!(fault("[reality.sensing]\nfog = 1\n").contains("unknown field `fog`"));
}

#[test]
fn exact_odometry_mends_a_sweep_and_a_false_one_does_not() {
    let drive = |reality: &str| {
        let mut trial = steady(reality, hilly(), command(0.8, 0.6), 25);
        trial.look();
        worst_m(&trial, 9.0)
    };
    let still = drive("");
    let raw = drive("[reality.sensing]\nsweep = true\n");
    let mended = drive("[reality.sensing]\nsweep = true\nmotion_compensation = \"odometry\"\n");
    // Interpolation between motion steps of 10 ms is not exact on warped ground.
    assert!(still < 1e-3 && mended < 0.01, "{still} {mended}");
    // The robot turned by 0.06 rad and drove 0.08 m during the sweep.
    assert!(raw > 0.1, "{raw}");
    let drifting = "[reality.sensing]\nsweep = true\nmotion_compensation = \"odometry\"\n";
    let drifting = drive(&format!("{drifting}[reality.pose]\nscale_drift = 0.5\nheading_drift_rad = 0.2\n"));
    assert!(drifting > 2.0 * mended, "{drifting} {mended}");
}

#[test]
fn a_latency_delays_a_command_by_so_many_ticks() {
    let moves_at = |latency_s: f64| {
        let reality = format!("[reality.motion]\nlatency_s = {latency_s:?}\n");
        let navigator = Steady { command: command(0.5, 0.0), ..Steady::default() };
        let mut trial = Trial::with_navigator(ground(|_, _| 0.0), &scenario(&reality), navigator, 7).unwrap();
        (1..100).find(|_| {
            trial.tick();
            trial.robot().speed_m_s > 0.0
        })
    };
    assert_eq!([0.0, 0.05, 0.1, 0.3].map(moves_at), [Some(1), Some(1), Some(2), Some(4)]);
    let lagging = steady("[reality.motion]\nlag_s = 0.5\n", ground(|_, _| 0.0), command(0.5, 0.0), 5);
    let expected = 0.5 * (1.0 - libm::exp(-1.0));
    assert!((lagging.robot().speed_m_s - expected).abs() < 0.01, "{}", lagging.robot().speed_m_s);
}

#[test]
fn drift_grows_with_the_way_and_the_truth_is_told_beside() {
    let reality = "[reality.pose]\nscale_drift = 0.1\n";
    let error_m = |ticks| {
        let trial = steady(reality, ground(|_, _| 0.0), command(0.5, 0.0), ticks);
        (trial.believed_pose().position_m.x - trial.pose().position_m.x) / trial.metrics().distance_m
    };
    assert!((error_m(40) - error_m(200)).abs() < 1e-6, "a share of the way");
    assert!(error_m(200).abs() > 0.001);
    // The goal is reached where it is believed to be.
    let text = format!("{SCENARIO}[reality.pose]\nscale_drift = 0.3\n");
    let mut trial =
        Trial::new(ground(|_, _| 0.0), &Scenario::parse("it", &text).unwrap(), Preset::Default, 5).unwrap();
    while trial.tick().is_none() {}
    assert_eq!(trial.outcome(), Some(Outcome::Reached));
    assert!((trial.believed_pose().plan_m() - trial.goal_m()).length() < 0.5);
    assert!(trial.true_distance_to_goal_m() > 0.5, "{}", trial.true_distance_to_goal_m());
    let miss_m = (trial.pose().plan_m() - DVec2::new(38.0, 20.0)).length();
    assert!((trial.true_distance_to_goal_m() - miss_m).abs() < 1e-12);
}

#[test]
fn a_correction_is_told_or_not() {
    let drift = "[reality.pose]\nscale_drift = 0.1\ncorrection_period_s = 1.0\n";
    let trial = steady(drift, ground(|_, _| 0.0), command(0.5, 0.0), 35);
    let corrections = &trial.navigator().corrections;
    assert_eq!(corrections.len(), 3);
    let (before, after) = corrections[2];
    assert!((after.position_m - before.position_m).length() > 1e-4);
    assert!((after.position_m.x - 20.0 - (trial.pose().position_m.x - 20.0 - 0.25)).abs() < 1e-3);
    let silent = steady(&format!("{drift}relocalises = false\n"), ground(|_, _| 0.0), command(0.5, 0.0), 35);
    assert!(silent.navigator().corrections.is_empty());
    assert_eq!(silent.believed_pose(), trial.believed_pose());
}

#[test]
fn a_pose_may_be_older_than_its_scan() {
    let trial = steady("[reality.pose]\nlatency_s = 0.15\n", ground(|_, _| 0.0), command(0.5, 0.0), 20);
    let behind_m = trial.pose().position_m - trial.believed_pose().position_m;
    assert!((behind_m - DVec3::X * 0.075).length() < 1e-9, "{behind_m}");
}

#[test]
fn a_late_scan_comes_with_its_own_pose() {
    let on_time = steady("", hilly(), command(0.5, 0.2), 12);
    let late = steady("[reality.sensing]\nscan_delay_periods = 2\n", hilly(), command(0.5, 0.2), 14);
    let (on_time, late) = (on_time.navigator(), late.navigator());
    // The first scan arrives two periods late, so the robot sets out later, and then all is the same.
    assert_eq!(late.poses.len(), 12);
    assert_eq!(late.points[0], on_time.points[0]);
    assert_eq!(late.poses[3..12], on_time.poses[1..10]);
    assert_eq!(late.elapsed[0], Duration::from_millis(300));
}

#[test]
fn a_lost_scan_leaves_the_last_command_and_is_time_that_passed() {
    let trial = steady("[reality.sensing]\nlost_scan_probability = 0.3\n", hilly(), command(0.5, 0.0), 100);
    let elapsed = &trial.navigator().elapsed;
    assert!((60..80).contains(&elapsed.len()), "{}", elapsed.len());
    let total: Duration = elapsed.iter().sum();
    assert!(total <= Duration::from_secs(10) && total > Duration::from_secs(9), "{total:?}");
    // It drove on all the time but for the start.
    assert!(trial.metrics().distance_m > 4.0, "{}", trial.metrics().distance_m);
}

#[test]
fn on_wet_grass_a_climb_ends_and_the_wheels_spin() {
    // 26.6 degrees, from x = 22 m on.
    let hill = || ground(|x, _| 0.5 * (x - 22.0).max(0.0));
    let climbed_m = |reality: &str| {
        let trial = steady(reality, hill(), command(0.5, 0.0), 160);
        trial.pose().position_m.z
    };
    assert!(climbed_m("") > 2.0);
    assert!(climbed_m("[reality.motion]\nfriction = 0.9\n") > 2.0);
    assert!(climbed_m("[reality.motion]\nfriction = 0.3\n") < 0.5);
}
