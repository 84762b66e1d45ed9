//! The session as the page uses it, in a real browser.
#![cfg(target_arch = "wasm32")]
// Clippy does not know these functions as tests.
#![allow(clippy::panic, clippy::unwrap_used, clippy::float_cmp)]

use glam::DVec3;
use js_sys::{Float32Array, Uint8Array};
use mapless_wasm::{Session, generated_recipe, level_places, read_scenario, terrain_preview};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};

wasm_bindgen_test_configure!(run_in_browser);

const RECIPE: &str = r#"
name = "hill"
description = "One hill beside the way."
size_m = [40.0, 30.0]
cell_m = 0.25
seed = 1

[[hill]]
centre = [20.0, 18.0]
height_m = 3.0
radius_m = 4.0
"#;
const SCENARIO: &str = "terrain = \"hill.toml\"\nstart = [5.0, 8.0, 0.0]\ngoal = [34.0, 8.0]\nseed = 7\n";
const RAISE: &str = "kind = \"raise\"\nradius_m = 2.0\nstrength_m = 1.5\npoints = [[15.0, 8.0]]\n";
const COLUMNS: usize = 161;

fn session(preset: &str, seed: Option<u64>) -> Session {
    open(SCENARIO, preset, seed).unwrap_or_else(|_| panic!("the session does not open"))
}

fn open(scenario: &str, preset: &str, seed: Option<u64>) -> Result<Session, wasm_bindgen::JsError> {
    Session::new("scenario.toml", scenario, "hill.toml", RECIPE.as_bytes(), &[], preset, None, seed)
}

fn message(error: wasm_bindgen::JsError) -> String {
    js_sys::Error::from(wasm_bindgen::JsValue::from(error)).message().into()
}

fn tick(session: &mut Session, times: usize) {
    for _ in 0..times {
        session.look();
        session.plan();
        session.act();
    }
}

#[wasm_bindgen_test]
fn a_scenario_is_read_as_plain_data() {
    let read =
        read_scenario("scenario.toml", &format!("{SCENARIO}[planner.decision]\nsteepness_weight = 0.5\n"));
    let text = read.map(|object| String::from(js_sys::JSON::stringify(&object).unwrap())).unwrap_or_default();
    assert_eq!(
        text,
        r#"{"terrain":"hill.toml","start":[5,8,0],"waypoints":[],"goal":[34,8],"seed":7,"planner":{"decision":{"steepness_weight":0.5}}}"#
    );
}

#[wasm_bindgen_test]
fn the_seed_is_the_scenarios_unless_given() {
    assert_eq!(session("default", None).seed(), 7);
    assert_eq!(session("default", Some(u64::MAX)).seed(), u64::MAX);
}

#[wasm_bindgen_test]
fn faults_reach_the_page_as_sentences() {
    let unknown = message(open(SCENARIO, "best", None).unwrap_err());
    assert!(unknown.contains("best") && unknown.contains("expected default, paper or flat"), "{unknown}");
    let off = message(open(&SCENARIO.replace("34.0", "99.0"), "default", None).unwrap_err());
    assert!(off.contains("goal = (99.000, 8.000)"), "{off}");
    let key = message(open(&format!("{SCENARIO}colour = 1\n"), "default", None).unwrap_err());
    assert!(key.contains("scenario.toml") && key.contains("colour"), "{key}");
}

#[wasm_bindgen_test]
fn a_restart_repeats_the_trajectory_bit_by_bit() {
    let mut session = session("default", None);
    tick(&mut session, 12);
    let first = session.digest();
    assert!(session.restart().is_ok());
    assert_ne!(session.digest(), first);
    tick(&mut session, 12);
    assert_eq!(session.digest(), first);
}

#[wasm_bindgen_test]
fn returns_lie_on_the_ground() {
    let mut session = session("default", None);
    tick(&mut session, 3);
    let out = Float32Array::new_with_length(3 * 28_800);
    let count = session.points(&out);
    assert!(count > 5_000, "{count} returns");
    let points = out.subarray(0, 3 * count as u32).to_vec();
    // South of y = 2 the hill is 16 m or four sigma away: the ground is level at 0, and the range noise is 2 cm.
    let level: Vec<_> = points.chunks_exact(3).filter(|p| p[1] < 2.0).collect();
    assert!(level.len() > 50 && level.iter().all(|p| p[2].abs() < 0.1));
    let short = Float32Array::new_with_length(30);
    assert_eq!(session.points(&short), 10);
    // Each return leaves the sensor along one of its rings: whole even degrees, but for a little noise of the range.
    let pose = session.world_from_sensor();
    let (sensor, up) = (DVec3::from_slice(&pose), DVec3::from_slice(&pose[9..]));
    for point in points.chunks_exact(3) {
        let ray = DVec3::new(point[0].into(), point[1].into(), point[2].into()) - sensor;
        let elevation_deg = 90.0 - ray.angle_between(up).to_degrees();
        assert!(((elevation_deg + 15.0) % 2.0 - 1.0).abs() > 0.99, "{elevation_deg}");
    }
}

#[wasm_bindgen_test]
fn the_image_has_the_size_that_the_scene_says() {
    let mut session = session("paper", None);
    tick(&mut session, 1);
    let scene = session.scene();
    let (columns, rows, rings) = (scene[9] as u32, scene[10] as u32, scene[11] as u32);
    let surface = || Float32Array::new_with_length(columns * rows);
    let (occupancy, variance) = (surface(), surface());
    session.surfaces(&occupancy, &variance);
    assert!(variance.to_vec().iter().all(|v| (0.0..=1.0 + 1e-6).contains(v) && *v > 0.0));
    let observed = Float32Array::new_with_length(columns * rings);
    session.observed(&observed);
    let (occupancy, variance, observed) = (occupancy.to_vec(), variance.to_vec(), observed.to_vec());
    let (mut seen, mut error_m) = (0, 0.0);
    for (index, observed_m) in observed.iter().enumerate().filter(|(_, v)| !v.is_nan()) {
        assert!((0.0..=7.0).contains(observed_m));
        // The image has a row for each ring and one between two.
        let at = index / rings as usize * rows as usize + 2 * (index % rings as usize);
        assert!(variance[at] < 0.7, "{}", variance[at]);
        error_m += f64::from((occupancy[at] - observed_m).abs());
        seen += 1;
    }
    assert!(seen > 1_000 && error_m / f64::from(seen) < 0.3, "{seen} cells, {error_m} m");
    let (profile, kinds) = (Float32Array::new_with_length(columns), Uint8Array::new_with_length(columns));
    session.profile(&profile);
    session.kinds(&kinds);
    for (elevation_rad, kind) in profile.to_vec().into_iter().zip(kinds.to_vec()) {
        assert_eq!(elevation_rad.is_nan(), kind != 0);
    }
    assert_eq!(session.segments().len() % 6, 0);
    let subgoals = session.subgoals();
    let chosen = subgoals.chunks_exact(18).filter(|one| one[5] > 0.5).count();
    assert_eq!((subgoals.len() % 18, chosen), (0, 1));
    let segments = session.segments().len() as f64 / 6.0;
    assert!(subgoals.chunks_exact(18).all(|one| (-1.0..segments).contains(&one[7]) && one[8].is_nan()));
}

#[wasm_bindgen_test]
fn sculpting_changes_the_samples_it_names_and_no_other() {
    let mut session = session("default", None);
    let whole = |s: &Session| s.heights(0, 0, s.columns(), s.rows()).unwrap_or_default();
    let before = whole(&session);
    let Ok(Some(changed)) = session.sculpt(RAISE) else { panic!("no change") };
    let after = whole(&session);
    let [column, row, columns, rows] = [0, 1, 2, 3].map(|i| changed[i] as usize);
    assert_eq!(session.columns(), COLUMNS);
    let mut risen = 0;
    for (index, (a, b)) in before.iter().zip(&after).enumerate() {
        let (c, r) = (index % COLUMNS, index / COLUMNS);
        let inside = (column..column + columns).contains(&c) && (row..row + rows).contains(&r);
        assert!(inside || a == b, "({c}, {r}) changed outside the rectangle");
        risen += usize::from(b > a);
    }
    assert!(risen > 100);
    let patch = session.heights(column, row, columns, rows).unwrap_or_default();
    assert_eq!(patch[0], after[row * COLUMNS + column]);
    assert!(session.sculpt(&RAISE.replace("15.0", "-50.0")).is_ok_and(|changed| changed.is_none()));
    assert!(session.sculpt(&RAISE.replace("2.0", "nan")).is_err());
    assert!(session.sculpt(&RAISE.replace("raise", "polish")).is_err());
}

#[wasm_bindgen_test]
fn a_stroke_and_its_undoing_and_its_place_in_the_recipe_drive_the_same_way() {
    let drive = |session: &mut Session| {
        assert!(session.restart().is_ok());
        tick(session, 15);
        session.digest()
    };
    let mut by_hand = session("default", None);
    let plain = drive(&mut by_hand);
    // In sight of the start, and well inside the rectangle.
    let old = by_hand.heights(20, 20, 60, 40).unwrap_or_default();
    let stroke = RAISE.replace("15.0", "10.0");
    assert!(by_hand.sculpt(&stroke).is_ok());
    let sculpted = drive(&mut by_hand);
    assert_ne!(sculpted, plain);
    let recipe = format!("{RECIPE}\n[[stroke]]\n{stroke}");
    let loaded =
        Session::new("scenario.toml", SCENARIO, "hill.toml", recipe.as_bytes(), &[], "default", None, None);
    assert_eq!(drive(&mut loaded.unwrap_or_else(|_| panic!("the recipe does not load"))), sculpted);
    assert!(by_hand.replace_ground(20, 20, 60, &old).is_ok());
    assert_eq!(drive(&mut by_hand), plain);
    assert!(by_hand.replace_ground(COLUMNS - 10, 20, 60, &old).is_err());
}

#[wasm_bindgen_test]
fn a_preview_is_a_coarse_grid_of_the_same_ground() {
    let preview = terrain_preview("hill.toml", RECIPE.as_bytes(), &[], 50).unwrap_or_default();
    assert_eq!((preview[0], preview[1], preview[2], preview.len()), (41.0, 31.0, 1.0, 3 + 41 * 31));
    let whole = session("default", None);
    let heights = whole.heights(0, 0, COLUMNS, 121).unwrap_or_default();
    assert_eq!(preview[3 + 18 * 41 + 20], heights[72 * COLUMNS + 80]);
}

#[wasm_bindgen_test]
fn generated_terrains_have_places_to_start_from() {
    let recipe = generated_recipe("hard", 3).unwrap_or_default();
    let places = level_places("hard.toml", recipe.as_bytes(), &[]).unwrap_or_default();
    assert!(places.len() == 4 && places[2] - places[0] > 10.0, "{places:?}");
    assert!(
        message(generated_recipe("gruesome", 3).unwrap_err()).contains("expected easy, moderate or hard")
    );
}

#[wasm_bindgen_test]
fn a_rectangle_beyond_the_field_is_refused() {
    let session = session("default", None);
    for (column, row, columns, rows) in
        [(0, 0, COLUMNS + 1, 1), (COLUMNS, 0, 1, 1), (0, usize::MAX, 1, 2), (1, 0, usize::MAX, 1)]
    {
        assert!(session.heights(column, row, columns, rows).is_err());
    }
}

#[wasm_bindgen_test]
fn a_place_off_the_terrain_changes_nothing() {
    let mut session = session("default", None);
    tick(&mut session, 2);
    let before = (session.scene(), session.digest());
    assert!(session.set_route(&[], -1.0, 8.0).is_err());
    assert!(session.set_start(f64::NAN, 8.0, 0.0).is_err());
    assert_eq!((session.scene(), session.digest()), before);
}

#[wasm_bindgen_test]
fn reaches_a_goal_nearby() {
    let mut session = session("default", None);
    assert!(session.set_route(&[], 9.0, 8.0).is_ok());
    tick(&mut session, 120);
    assert_eq!((session.outcome(), session.activity()), ("reached".into(), "arrived".into()));
}
