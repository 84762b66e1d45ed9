//! Contacts of a Husky where drawings of it say so.

use super::*;
use crate::ground::Footing;
use crate::objects::{Object, Objects};
use crate::robot::{DriveCommand, Robot};

const CELL_M: f64 = 0.05;

/// Ground whose height depends on x alone, 20 m by 20 m.
fn profile(height_m: impl Fn(f64) -> f64) -> HeightField {
    let heights = (0..401 * 401).map(|i| height_m(f64::from(i % 401) * CELL_M) as f32).collect();
    HeightField::new(401, 401, CELL_M, heights).unwrap()
}

fn level() -> HeightField {
    profile(|_| 1.0)
}

/// Drives east from (5, 10) until something is touched, for 10 m.
fn drive(field: &HeightField, objects: Vec<Object>) -> Option<(Contact, f64)> {
    let config = RobotConfig::default();
    let body = Body::new(&config, DVec3::new(0.0, 0.0, 0.8));
    let objects = Objects::new(objects, field);
    let footing = Footing { field, solids: objects.solids() };
    let mut husky = Robot::new(config, &footing, DVec2::new(5.0, 10.0), 0.0).unwrap();
    let command = DriveCommand { speed_m_s: 0.8, turn_rate_rad_s: 0.0 };
    for _ in 0..1250 {
        husky.step(command, 0.01, &footing).unwrap();
        let state = body.on_wheels(husky.state(), &footing);
        let contact = body.contact_with(objects.solids(), &state);
        if let Some(contact) = contact.or_else(|| body.contact_with_ground(field, &footing, &state)) {
            return Some((contact, husky.state().position.x));
        }
    }
    None
}

fn kind(found: Option<(Contact, f64)>) -> Option<ContactKind> {
    found.map(|(contact, _)| contact.kind)
}

#[test]
fn a_post_is_run_into_with_the_bumper() {
    let (contact, x_m) = drive(&level(), vec![post([9.0, 10.1], 0.1, 1.5)]).unwrap();
    assert_eq!((contact.kind, contact.object), (ContactKind::Collision, Some(0)));
    // Half the body's length before the post's side.
    assert!((x_m - (9.0 - 0.1 - 0.495)).abs() < 0.01, "{x_m}");
    assert!(contact.place_m.distance(DVec3::new(8.9, 10.1, contact.place_m.z)) < 0.03, "{contact:?}");
}

fn post(at: [f64; 2], radius_m: f64, height_m: f64) -> Object {
    Object::Post { at, radius_m, height_m, walk: None }
}

fn cuboid(at: [f64; 2], size_m: [f64; 3], raised_m: f64) -> Object {
    Object::Box { at, size_m, yaw_rad: 0.0, raised_m, walk: None }
}

#[test]
fn what_stands_beside_the_way_is_passed() {
    assert_eq!(drive(&level(), vec![post([9.0, 10.46], 0.1, 1.5), post([9.0, 9.54], 0.1, 1.5)]), None);
    assert_eq!(kind(drive(&level(), vec![post([9.0, 10.43], 0.1, 1.5)])), Some(ContactKind::Collision));
}

#[test]
fn a_roof_is_driven_under_if_the_mast_fits() {
    let roof = |height_m| Object::Roof { at: [9.0, 10.0], size_m: [2.0, 3.0, 0.1], yaw_rad: 0.0, height_m };
    assert_eq!(drive(&level(), vec![roof(0.9)]), None);
    let (contact, x_m) = drive(&level(), vec![roof(0.8)]).unwrap();
    assert_eq!(contact.kind, ContactKind::Collision);
    assert!((x_m - (8.0 - 0.05)).abs() < 0.02, "the mast, not the body: {x_m}");
}

#[test]
fn a_stone_between_the_wheels_is_passed_over_or_sat_upon() {
    let stone = |height_m| vec![cuboid([9.0, 10.0], [0.1, 0.2, height_m], 0.0)];
    assert_eq!(drive(&level(), stone(0.12)), None);
    let (contact, x_m) = drive(&level(), stone(0.15)).unwrap();
    assert_eq!((contact.kind, contact.object), (ContactKind::HighCentred, Some(0)));
    assert!((x_m - (9.0 - 0.05 - 0.256)).abs() < 0.02, "under the front axle: {x_m}");
    assert_eq!(kind(drive(&level(), stone(0.3))), Some(ContactKind::Collision), "the bumper meets it first");
}

#[test]
fn a_low_kerb_is_climbed_and_a_high_one_is_a_step() {
    let kerb = |height_m| vec![cuboid([10.0, 10.0], [2.0, 6.0, height_m], 0.0)];
    assert_eq!(drive(&level(), kerb(0.1)), None);
    let (contact, x_m) = drive(&level(), kerb(0.17)).unwrap();
    assert_eq!(contact.kind, ContactKind::Step, "{contact:?}");
    assert!((x_m - (9.0 - 0.256 - 0.165)).abs() < 0.03, "{x_m}");
}

#[test]
fn the_belly_touches_a_crest_where_the_cross_section_says_so() {
    // A roof-shaped ridge: half-way over it the belly is wheelbase / 2 × slope nearer to the crest.
    let ridge = |slope: f64| profile(move |x| 1.0 + (1.5 - (x - 9.0).abs()).max(0.0) * slope);
    let touching = 0.13 / 0.256;
    assert_eq!(drive(&ridge(touching * 0.9), Vec::new()), None);
    let (contact, _) = drive(&ridge(touching * 1.1), Vec::new()).unwrap();
    assert_eq!((contact.kind, contact.object), (ContactKind::HighCentred, None));
    assert!((contact.place_m.x - 9.0).abs() < 0.1, "{contact:?}");
}

#[test]
fn a_ditch_swallows_the_front_wheels_and_a_narrow_one_does_not() {
    let ditch = |width_m: f64| profile(move |x| if (x - 9.0).abs() < width_m / 2.0 { 0.4 } else { 1.0 });
    let (contact, x_m) = drive(&ditch(0.7), Vec::new()).unwrap();
    assert_eq!(contact.kind, ContactKind::HighCentred);
    assert!((x_m + 0.256 - 8.65).abs() < 0.15, "its front wheels are at the edge: {x_m}");
    let rut = profile(|x| if (x - 9.0).abs() < 0.15 { 0.95 } else { 1.0 });
    assert_eq!(drive(&rut, Vec::new()), None);
}

#[test]
fn a_vertical_step_is_climbed_up_to_what_wheels_climb_and_driven_down() {
    let step = |height_m: f64| profile(move |x| 1.0 + if x > 9.0 { height_m } else { 0.0 });
    assert_eq!(drive(&step(0.1), Vec::new()), None);
    let (contact, _) = drive(&step(0.35), Vec::new()).unwrap();
    assert_ne!(contact.kind, ContactKind::Collision);
    assert!((contact.place_m.x - 9.0).abs() < 0.1, "{contact:?}");
    assert_eq!(drive(&step(-0.1), Vec::new()), None);
}

#[test]
fn slopes_within_the_tilt_limits_touch_nothing() {
    for slope in [0.2, 0.5, 0.7] {
        assert_eq!(drive(&profile(|x| x * slope), Vec::new()), None, "{slope}");
        assert_eq!(drive(&profile(|x| 20.0 - x * slope), Vec::new()), None, "{slope}");
    }
}

/// A robot at (5, 10), facing east, with blocks of this height under its front left and rear right wheels and
/// one of that height between all four.
fn on_two_blocks(under_wheels_m: f64, between_m: f64) -> Option<Contact> {
    let config = RobotConfig::default();
    let body = Body::new(&config, DVec3::new(0.0, 0.0, 0.8));
    let place_m = DVec2::new(5.0, 10.0);
    let wheel_m = DVec2::new(config.wheelbase_m, config.track_m) / 2.0;
    let block_m = |place: DVec2| {
        let is_on = |at: DVec2| (place - at).abs().max_element() < 0.1;
        let under_wheel = is_on(place_m + wheel_m) || is_on(place_m - wheel_m);
        if under_wheel { under_wheels_m } else { f64::from(u8::from(is_on(place_m))) * between_m }
    };
    let heights = (0..401 * 401)
        .map(|i| (1.0 + block_m(DVec2::new(f64::from(i % 401), f64::from(i / 401)) * CELL_M)) as f32)
        .collect();
    let field = HeightField::new(401, 401, CELL_M, heights).unwrap();
    let footing = Footing { field: &field, solids: &[] };
    let husky = Robot::new(config, &footing, place_m, 0.0).unwrap();
    body.contact_with_ground(&field, &footing, &body.on_wheels(husky.state(), &footing))
}

#[test]
fn a_rigid_body_on_warped_ground_stands_on_its_highest_wheels() {
    // On two blocks of 0.1 m at opposite corners the belly is 0.23 m up; a plane through the middle of the
    // four contacts would have it at 0.18 m.
    assert_eq!(on_two_blocks(0.1, 0.2), None);
    let contact = on_two_blocks(0.1, 0.24).unwrap();
    assert_eq!((contact.kind, contact.object), (ContactKind::HighCentred, None));
    assert_eq!(on_two_blocks(0.0, 0.12), None);
    assert!(on_two_blocks(0.0, 0.14).is_some());
}
