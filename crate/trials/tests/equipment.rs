//! A trial that goes on with other equipment: what stays, what changes, and what is refused.
#![allow(clippy::unwrap_used, clippy::float_cmp, missing_docs)]

use glam::DVec2;
use mapless_trials::{Preset, Scenario, Trial};
use mapless_world::{Brush, BrushKind, ContactKind, HeightField};

const SCENARIO: &str = "terrain = \"a.toml\"\nstart = [4.0, 4.0, 0.2]\ngoal = [15.0, 14.0]\nseed = 3\n";

fn trial(scenario: &str, preset: Preset) -> Trial {
    let field = HeightField::new(81, 81, 0.25, vec![0.0; 81 * 81]).unwrap();
    Trial::new(field, &Scenario::parse("it", scenario).unwrap(), preset, 3).unwrap()
}

fn driven(ticks: u64) -> Trial {
    let mut trial = trial(SCENARIO, Preset::Default);
    while trial.ticks() < ticks {
        trial.tick();
    }
    trial
}

#[test]
fn another_planner_goes_on_where_the_trial_is() {
    let mut trial = driven(20);
    let before = (trial.motion(), trial.ticks(), trial.digest(), trial.metrics());
    trial.equip(self::trial(SCENARIO, Preset::Paper)).unwrap();
    assert_eq!((trial.motion(), trial.ticks(), trial.digest(), trial.metrics()), before);
    assert_eq!(trial.planner_config().perception.variance_threshold, 0.7);
    assert_eq!(trial.tick(), None);
    assert!(trial.metrics().distance_m > before.3.distance_m);
}

#[test]
fn the_same_equipment_changes_nothing_but_what_the_planner_remembers() {
    let (mut equipped, mut plain) = (driven(20), driven(20));
    let other = plain.clone();
    equipped.equip(other).unwrap();
    for _ in 0..10 {
        equipped.tick();
        plain.tick();
    }
    assert_eq!(equipped.digest(), plain.digest());
}

#[test]
fn another_robot_keeps_pose_and_speed() {
    let mut trial = driven(20);
    let (pose, speed_m_s) = (trial.pose(), trial.robot().speed_m_s);
    let wider = format!("{SCENARIO}[robot]\nwidth_m = 0.9\n");
    trial.equip(self::trial(&wider, Preset::Default)).unwrap();
    assert_eq!((trial.pose(), trial.robot().speed_m_s), (pose, speed_m_s));
    assert_eq!(trial.planner_config().robot.width_m, 0.9);
}

#[test]
fn another_period_is_refused() {
    let mut trial = driven(5);
    let slower = self::trial(&format!("{SCENARIO}[sensor]\nperiod_s = 0.2\n"), Preset::Default);
    let error = trial.equip(slower).unwrap_err().to_string();
    assert!(error.starts_with("sensor.period_s = 0.2: expected 0.1 under way"), "{error}");
    assert_eq!(trial.period_s(), 0.1);
}

#[test]
fn a_stance_tells_tilt_and_contact_of_a_place_and_none_off_the_terrain() {
    let mut trial = driven(1);
    let level = trial.stance_at(DVec2::new(10.0, 10.0), 1.0).unwrap();
    assert!(!level.is_too_steep && level.contact.is_none() && level.attitude.pitch_rad.abs() < 1e-9);
    assert!(trial.stance_at(DVec2::new(0.1, 10.0), 0.0).is_none());
    let kind = BrushKind::Raise;
    trial.sculpt(&Brush { centre: DVec2::new(10.0, 10.0), radius_m: 3.0, strength_m: 4.0, kind }).unwrap();
    let steep = trial.stance_at(DVec2::new(11.5, 10.0), 0.0).unwrap();
    assert!(steep.is_too_steep && steep.attitude.pitch_rad < -0.5, "{steep:?}");
}

#[test]
fn a_stance_rests_on_the_highest_wheels_as_the_trial_does() {
    // A saddle, on which the plane of the four contacts lies below two of them: under a body on that plane
    // the front left corner of a bumper would be in the ground.
    let contact_on = |warp_per_m: f64| {
        let along = |index: u32| (f64::from(index) * 0.25 - 10.0).clamp(-1.0, 1.0);
        let heights = (0..81 * 81).map(|i| (warp_per_m * along(i % 81) * along(i / 81)) as f32).collect();
        let field = HeightField::new(81, 81, 0.25, heights).unwrap();
        let trial = Trial::new(field, &Scenario::parse("it", SCENARIO).unwrap(), Preset::Default, 3).unwrap();
        trial.stance_at(DVec2::new(10.0, 10.0), 0.0).unwrap().contact.map(|contact| contact.kind)
    };
    assert_eq!(contact_on(1.5), None);
    assert_eq!(contact_on(2.3), Some(ContactKind::HighCentred));
}
