//! The session as the page uses it, in a real browser.
#![cfg(target_arch = "wasm32")]
// Clippy does not know these functions as tests.
#![allow(clippy::panic, clippy::unwrap_used, clippy::float_cmp)]

use glam::{DVec2, DVec3};
use js_sys::{Array, Float32Array, Object, Reflect, Uint8Array};
use mapless_wasm::{Session, generated_recipe, import_of, level_places, read_scenario, terrain_preview};
use tsify::{Ts, Tsify};
use wasm_bindgen::{JsCast as _, JsError, JsValue};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};

// As in the page, where the core finds the clock.
wasm_bindgen_test_configure!(run_in_dedicated_worker);

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
const RAISE: &str = r#"{ "kind": "raise", "radius_m": 2, "strength_m": 1.5, "points_cm": [1500, 800] }"#;
const COLUMNS: usize = 161;
const ROWS: usize = 121;

/// A plain object as JavaScript gives one.
fn given<T: Tsify>(json: &str) -> Ts<T> {
    Ts::new_unchecked(js_sys::JSON::parse(json).unwrap())
}

/// What is at a path such as `pose.x`.
fn at(value: &JsValue, path: &str) -> JsValue {
    path.split('.').fold(value.clone(), |value, key| Reflect::get(&value, &key.into()).unwrap())
}

fn number(value: &JsValue, path: &str) -> f64 {
    at(value, path).as_f64().unwrap_or_else(|| panic!("no number at {path}"))
}

fn text(value: &JsValue, path: &str) -> String {
    at(value, path).as_string().unwrap_or_else(|| panic!("no text at {path}"))
}

fn items(value: &JsValue, path: &str) -> Vec<JsValue> {
    at(value, path).unchecked_into::<Array>().to_vec()
}

fn heights(patch: &JsValue) -> Vec<f32> {
    at(patch, "heights_m").unchecked_into::<Float32Array>().to_vec()
}

fn json(value: impl Into<JsValue>) -> String {
    js_sys::JSON::stringify(&value.into()).unwrap().into()
}

/// What a call gave, as JavaScript has it.
fn got<T: Tsify>(result: Result<Ts<T>, JsError>) -> JsValue {
    result.unwrap_or_else(|error| panic!("{}", message(error))).into()
}

fn message(error: JsError) -> String {
    js_sys::Error::from(JsValue::from(error)).message().into()
}

fn terrain<T: Tsify>(recipe: &str) -> Ts<T> {
    let files = Object::new();
    let bytes = Uint8Array::from(recipe.as_bytes());
    Reflect::set(&files, &"name".into(), &"hill.toml".into()).unwrap();
    Reflect::set(&files, &"bytes".into(), &bytes).unwrap();
    Ts::new_unchecked(files.into())
}

/// Opens a session with `options` beside the files.
fn open(scenario: &str, recipe: &str, options: &str) -> Result<Session, JsError> {
    let all = js_sys::JSON::parse(options).unwrap();
    let file = Object::new();
    Reflect::set(&file, &"name".into(), &"scenario.toml".into()).unwrap();
    Reflect::set(&file, &"text".into(), &scenario.into()).unwrap();
    Reflect::set(&all, &"scenario".into(), &file).unwrap();
    let terrain: Ts<mapless_wasm::TerrainFiles> = terrain(recipe);
    Reflect::set(&all, &"terrain".into(), &terrain.into()).unwrap();
    Session::new(Ts::new_unchecked(all))
}

const DEFAULT: &str = r#"{ "preset": "default" }"#;

fn session() -> Session {
    open(SCENARIO, RECIPE, DEFAULT).unwrap_or_else(|error| panic!("{}", message(error)))
}

fn refused(scenario: &str, options: &str) -> String {
    message(open(scenario, RECIPE, options).unwrap_err())
}

fn tick(session: &mut Session, times: usize) -> JsValue {
    (0..times).map(|_| got(session.tick())).last().unwrap()
}

/// Arrays for a frame, with room for `points`.
fn buffers(session: &Session, points: u32) -> JsValue {
    let scene = got(session.scene());
    let [columns, rows, rings] = ["columns", "rows", "rings"].map(|n| number(&at(&scene, "image"), n) as u32);
    let buffers = Object::new();
    for (name, length) in [
        ("points", 3 * points),
        ("observed", columns * rings),
        ("occupancy", columns * rows),
        ("variance", columns * rows),
        ("profile", columns),
        ("former", columns),
        ("truth", columns),
    ] {
        Reflect::set(&buffers, &name.into(), &Float32Array::new_with_length(length)).unwrap();
    }
    for (name, length) in [("kinds", columns), ("return_kinds", points)] {
        Reflect::set(&buffers, &name.into(), &Uint8Array::new_with_length(length)).unwrap();
    }
    buffers.into()
}

/// A frame, and the numbers that an array was filled with.
fn frame(session: &mut Session) -> (JsValue, impl Fn(&str) -> Vec<f32> + use<>) {
    let buffers = buffers(session, 28_800);
    let frame = got(session.frame(Ts::new_unchecked(buffers.clone()), true, true));
    (frame, move |name: &str| at(&buffers, name).unchecked_into::<Float32Array>().to_vec())
}

#[wasm_bindgen_test]
fn a_scenario_is_read_as_plain_data() {
    let tables = "[planner.decision]\nsteepness_weight = 0.5\n";
    let read = got(read_scenario("scenario.toml", &format!("{SCENARIO}{tables}")));
    assert_eq!(
        json(read),
        r#"{"terrain":"hill.toml","start":{"x":5,"y":8,"heading_rad":0},"waypoints":[],"goal":{"x":34,"y":8},"seed":7,"overrides":{"planner":{"decision":{"steepness_weight":0.5}}}}"#
    );
}

#[wasm_bindgen_test]
fn a_goals_heading_crosses_from_the_file_and_back() {
    let with_heading = SCENARIO.replace("[34.0, 8.0]", "[34.0, 8.0, 1.5]");
    let expected = r#"{"x":34,"y":8,"heading_rad":1.5}"#;
    let read = got(read_scenario("scenario.toml", &with_heading));
    assert_eq!(json(at(&read, "goal")), expected);
    let mut session = open(&with_heading, RECIPE, DEFAULT).unwrap();
    assert_eq!(json(at(&got(session.scene()), "goal")), expected);
    // It stays when the trial begins anew with other parameters, and goes with a route that has none.
    assert!(session.set_parameters(given("{}"), Some(3)).is_ok());
    assert_eq!(json(at(&got(session.scene()), "goal")), expected);
    assert!(session.set_route(given(r#"{ "waypoints": [], "goal": { "x": 30, "y": 8 } }"#)).is_ok());
    assert_eq!(json(at(&got(session.scene()), "goal")), r#"{"x":30,"y":8}"#);
}

#[wasm_bindgen_test]
fn the_seed_is_the_scenarios_unless_given() {
    assert_eq!(number(&got(session().scene()), "seed"), 7.0);
    let other = open(SCENARIO, RECIPE, r#"{ "preset": "default", "seed": 4294967295 }"#);
    assert!(other.is_ok_and(|session| number(&got(session.scene()), "seed") == 4_294_967_295.0));
}

#[wasm_bindgen_test]
fn faults_reach_the_page_as_sentences() {
    let unknown = refused(SCENARIO, r#"{ "preset": "best" }"#);
    assert!(unknown.contains("`best`, expected `default` or `paper`"), "{unknown}");
    let off = refused(&SCENARIO.replace("34.0", "99.0"), DEFAULT);
    assert!(off.contains("goal = (99.000, 8.000)"), "{off}");
    let key = refused(&format!("{SCENARIO}colour = 1\n"), DEFAULT);
    assert!(key.contains("scenario.toml") && key.contains("colour"), "{key}");
}

#[wasm_bindgen_test]
fn overrides_are_tables_of_any_depth_and_faults_in_them_name_their_place() {
    let fault = |overrides: &str| {
        refused(SCENARIO, &format!(r#"{{ "preset": "default", "overrides": {overrides} }}"#))
    };
    assert_eq!(
        fault(r#"{ "sensor": { "range_noise_m": 2 } }"#),
        "settings: sensor.range_noise_m = 2: expected a number from 0 to 1"
    );
    let kernel = fault(r#"{ "planner": { "perception": { "kernel": { "variance": true } } } }"#);
    assert!(kernel.contains("planner.perception.kernel.variance = true"), "{kernel}");
    assert!(fault(r#"{ "colour": 1 }"#).contains("colour"));
}

#[wasm_bindgen_test]
fn overrides_from_the_beginning_and_set_later_drive_the_same_way() {
    let overrides =
        r#"{ "planner": { "decision": { "distance_weight": 2 } }, "sensor": { "range_noise_m": 0.05 } }"#;
    let mut plain = session();
    let mut changed = session();
    let mut begun =
        open(SCENARIO, RECIPE, &format!(r#"{{ "preset": "default", "overrides": {overrides} }}"#)).unwrap();
    assert!(changed.set_parameters(given(overrides), None).is_ok());
    for session in [&mut plain, &mut changed, &mut begun] {
        tick(session, 12);
    }
    assert_eq!(changed.digest(), begun.digest());
    assert_ne!(changed.digest(), plain.digest());
    // Parameters are told with the values of the file.
    let groups: Vec<JsValue> =
        begun.parameters().unwrap_or_default().into_iter().map(JsValue::from).collect();
    let sensor = groups.iter().find(|group| text(group, "table") == "sensor").unwrap();
    let parameters = items(sensor, "parameters");
    let noise = parameters.iter().find(|parameter| text(parameter, "name") == "range_noise_m").unwrap();
    assert_eq!(text(noise, "kind"), "number");
    assert_eq!((number(noise, "range.1"), number(noise, "value")), (0.5, 0.02));
}

#[wasm_bindgen_test]
fn a_tick_is_one_call_that_tells_what_came_of_it() {
    let mut session = session();
    let first = tick(&mut session, 1);
    let second = tick(&mut session, 1);
    assert_eq!((number(&first, "tick"), number(&first, "time_s")), (0.0, 0.0));
    assert_eq!((number(&second, "tick"), number(&first, "after.tick")), (1.0, 1.0));
    // What comes after one tick is what the next one starts from.
    for axis in ["x", "y", "z"] {
        assert_eq!(number(&first, &format!("after.{axis}")), number(&second, &format!("pose.{axis}")));
    }
    assert_eq!(text(&second, "after.outcome"), "running");
    assert_eq!(json(got(session.standing())), json(at(&second, "after")));
    assert_eq!(text(&second, "activity"), "driving");
    assert!(number(&second, "subgoal.x") > 5.0 && number(&second, "command.v_m_s") > 0.0);
    // A planner's step takes longer than the clock's grain, and scanning too.
    assert!(["scan_ms", "planner_ms"].into_iter().all(|name| number(&second, name) > 0.0));
    assert!(number(&second, "motion_ms") >= 0.0);
}

#[wasm_bindgen_test]
fn a_restart_repeats_the_trajectory_bit_by_bit() {
    let mut session = session();
    tick(&mut session, 12);
    let first = session.digest();
    assert!(session.restart().is_ok());
    assert_ne!(session.digest(), first);
    tick(&mut session, 12);
    assert_eq!(session.digest(), first);
}

#[wasm_bindgen_test]
fn a_change_of_route_comes_back_with_its_time() {
    let mut session = session();
    tick(&mut session, 6);
    let route = r#"{ "waypoints": [{ "x": 12, "y": 9 }], "goal": { "x": 30, "y": 8 } }"#;
    assert!(session.set_route(given(route)).is_ok());
    tick(&mut session, 6);
    let (digest, goal) = (session.digest(), number(&got(session.scene()), "goal.x"));
    assert_eq!(session.go_back(3.0), 3.0);
    assert_eq!(number(&got(session.scene()), "goal.x"), 34.0);
    let again: Vec<f64> = (0..12)
        .map_while(|_| (number(&got(session.standing()), "tick") < 12.0).then(|| tick(&mut session, 1)))
        .filter(|tick| at(tick, "rerouted").is_truthy())
        .map(|tick| number(&tick, "after.tick"))
        .collect();
    assert_eq!((again, session.digest()), (vec![6.0], digest));
    assert_eq!(number(&got(session.scene()), "goal.x"), goal);
    let (frame, _) = frame(&mut session);
    assert_eq!(json(at(&frame, "timeline")), r#"{"first":0,"end":12,"changes":[6]}"#);
}

#[wasm_bindgen_test]
fn returns_lie_on_the_ground() {
    let mut session = session();
    tick(&mut session, 3);
    let (shown, array) = frame(&mut session);
    let count = number(&shown, "returns") as usize;
    assert!(count > 5_000, "{count} returns");
    let points = array("points")[..3 * count].to_vec();
    // South of y = 2 the hill is 16 m or four sigma away: the ground is level at 0, and the range noise is 2
    // cm.
    let level: Vec<_> = points.chunks_exact(3).filter(|p| p[1] < 2.0).collect();
    assert!(level.len() > 50 && level.iter().all(|p| p[2].abs() < 0.1));
    let short = session.frame(Ts::new_unchecked(buffers(&session, 10)), false, false);
    assert_eq!(number(&got(short), "returns"), 10.0);
    // Each return leaves the sensor along one of its rings: whole even degrees, but for a little noise of the
    // range.
    let vector = |name: &str| {
        DVec3::from_array(["x", "y", "z"].map(|axis| number(&shown, &format!("sensor.{name}.{axis}"))))
    };
    let (sensor, up) = (vector("position"), vector("z_axis"));
    for point in points.chunks_exact(3) {
        let ray = DVec3::new(point[0].into(), point[1].into(), point[2].into()) - sensor;
        let elevation_deg = 90.0 - ray.angle_between(up).to_degrees();
        assert!(((elevation_deg + 15.0) % 2.0 - 1.0).abs() > 0.99, "{elevation_deg}");
    }
}

#[wasm_bindgen_test]
fn before_the_first_tick_nothing_is_decided() {
    let (shown, array) = frame(&mut session());
    assert!(number(&shown, "returns") > 5_000.0);
    for list in ["segments", "subgoals", "path"] {
        assert!(items(&shown, list).is_empty(), "{list}");
    }
    assert!(array("profile").iter().chain(&array("observed")).all(|value| value.is_nan()));
    assert!(array("variance").iter().all(|&share| share == 1.0));
}

#[wasm_bindgen_test]
fn the_image_has_the_size_that_the_scene_says() {
    let mut session = open(SCENARIO, RECIPE, r#"{ "preset": "paper" }"#).unwrap();
    tick(&mut session, 1);
    let rings = number(&got(session.scene()), "image.rings") as usize;
    let rows = number(&got(session.scene()), "image.rows") as usize;
    let given = buffers(&session, 10);
    let shown = got(session.frame(Ts::new_unchecked(given.clone()), true, false));
    let array = |name: &str| at(&given, name).unchecked_into::<Float32Array>().to_vec();
    let (occupancy, variance, observed) = (array("occupancy"), array("variance"), array("observed"));
    assert!(variance.iter().all(|v| (0.0..=1.0 + 1e-6).contains(v) && *v > 0.0));
    let (mut seen, mut error_m) = (0, 0.0);
    for (index, observed_m) in observed.iter().enumerate().filter(|(_, v)| !v.is_nan()) {
        assert!((0.0..=7.0).contains(observed_m));
        // The image has a row for each ring and one between two.
        let at = index / rings * rows + 2 * (index % rings);
        assert!(variance[at] < 0.7, "{}", variance[at]);
        error_m += f64::from((occupancy[at] - observed_m).abs());
        seen += 1;
    }
    assert!(seen > 1_000 && error_m / f64::from(seen) < 0.3, "{seen} cells, {error_m} m");
    let kinds = at(&given, "kinds").unchecked_into::<Uint8Array>().to_vec();
    for (elevation_rad, kind) in array("profile").into_iter().zip(kinds) {
        assert_eq!(elevation_rad.is_nan(), kind != 0);
    }
    let (segments, subgoals) = (items(&shown, "segments"), items(&shown, "subgoals"));
    assert_eq!(subgoals.iter().filter(|one| at(one, "chosen").is_truthy()).count(), 1);
    // The paper judges by height alone, and only what stands on the skyline.
    for one in &subgoals {
        assert!(number(one, "segment") < segments.len() as f64 && at(one, "forecast").is_undefined());
    }
    assert!(segments.iter().any(|one| text(one, "verdict") == "valid" && number(one, "width_m") > 0.0));
}

#[wasm_bindgen_test]
fn a_subgoal_tells_all_that_its_cost_follows_from() {
    let mut session = session();
    tick(&mut session, 5);
    let (shown, _) = frame(&mut session);
    let subgoals = items(&shown, "subgoals");
    let chosen = subgoals.iter().find(|one| at(one, "chosen").is_truthy()).unwrap();
    let terms = ["direction", "distance", "steepness", "commitment", "correction"];
    let sum: f64 = terms.into_iter().map(|term| number(chosen, &format!("cost.{term}"))).sum();
    assert!((sum - number(chosen, "cost.total")).abs() < 1e-12);
    let (path_m, reach_m) = (number(chosen, "forecast.path_m"), number(chosen, "forecast.reach_m"));
    assert!(path_m >= reach_m && number(chosen, "forecast.climb_m") >= 0.0, "{path_m} m, {reach_m} m");
    // The path as it is drawn is as long.
    let place = |point: &JsValue| glam::DVec2::new(number(point, "x"), number(point, "y"));
    let path: Vec<_> = items(&shown, "path").iter().map(place).collect();
    let drawn_m: f64 = path.windows(2).map(|two| (two[1] - two[0]).length()).sum();
    assert!((drawn_m - path_m).abs() < 0.5, "{drawn_m} m, {path_m} m");
    for one in &subgoals {
        assert_ne!(at(one, "refusal").is_undefined(), at(one, "cost").is_undefined());
    }
}

#[wasm_bindgen_test]
fn sculpting_changes_the_samples_it_names_and_no_other() {
    let mut session = session();
    let before = heights(&got(session.ground()));
    let Ok(Some(changed)) = session.sculpt(given(RAISE)) else { panic!("no change") };
    let (changed, ground) = (JsValue::from(changed), got(session.ground()));
    let after = heights(&ground);
    let [column, row, columns, rows] =
        ["column", "row", "columns", "rows"].map(|name| number(&changed, name) as usize);
    assert_eq!((number(&ground, "columns"), number(&ground, "rows")), (COLUMNS as f64, ROWS as f64));
    let mut risen = 0;
    for (index, (a, b)) in before.iter().zip(&after).enumerate() {
        let (c, r) = (index % COLUMNS, index / COLUMNS);
        let inside = (column..column + columns).contains(&c) && (row..row + rows).contains(&r);
        assert!(inside || a == b, "({c}, {r}) changed outside the rectangle");
        risen += usize::from(b > a);
    }
    assert!(risen > 100);
    let patch = heights(&changed);
    assert_eq!((patch.len(), patch[0]), (columns * rows, after[row * COLUMNS + column]));
    let off = session.sculpt(given(&RAISE.replace("1500", "-5000")));
    assert!(off.is_ok_and(|changed| changed.is_none()));
    let fault = |stroke: &str, session: &mut Session| message(session.sculpt(given(stroke)).unwrap_err());
    let radius = fault(&RAISE.replace(r#""radius_m": 2"#, r#""radius_m": 0"#), &mut session);
    assert!(radius.contains("radius_m = 0"), "{radius}");
    assert!(fault(&RAISE.replace("raise", "polish"), &mut session).contains("`polish`"));
    assert!(fault(&RAISE.replace("raise", "level"), &mut session).contains("height_m = absent"));
    // What is refused leaves the session as it was.
    assert_eq!(heights(&got(session.ground())), after);
}

#[wasm_bindgen_test]
fn a_stroke_and_its_undoing_and_its_place_in_the_recipe_drive_the_same_way() {
    let drive = |session: &mut Session| {
        assert!(session.restart().is_ok());
        tick(session, 15);
        session.digest()
    };
    let mut by_hand = session();
    let plain = drive(&mut by_hand);
    let old = heights(&got(by_hand.ground()));
    // In sight of the start.
    let Ok(Some(changed)) = by_hand.sculpt(given(&RAISE.replace("1500", "1000"))) else {
        panic!("no change")
    };
    let changed = JsValue::from(changed);
    let sculpted = drive(&mut by_hand);
    assert_ne!(sculpted, plain);
    let keys = "kind = \"raise\"\nradius_m = 2\nstrength_m = 1.5\npoints = [[10.0, 8.0]]\n";
    let loaded = open(SCENARIO, &format!("{RECIPE}\n[[stroke]]\n{keys}"), DEFAULT);
    assert_eq!(drive(&mut loaded.unwrap_or_else(|error| panic!("{}", message(error)))), sculpted);
    let [column, row, columns, rows] =
        ["column", "row", "columns", "rows"].map(|name| number(&changed, name) as usize);
    let lines = old.chunks_exact(COLUMNS).skip(row).take(rows);
    let undone: Vec<f32> = lines.flat_map(|line| &line[column..column + columns]).copied().collect();
    let undone = Float32Array::from(undone.as_slice());
    Reflect::set(&changed, &"heights_m".into(), &undone).unwrap();
    assert!(by_hand.replace_ground(Ts::new_unchecked(changed.clone())).is_ok());
    assert_eq!(drive(&mut by_hand), plain);
    Reflect::set(&changed, &"column".into(), &(COLUMNS as u32 - 1).into()).unwrap();
    assert!(by_hand.replace_ground(Ts::new_unchecked(changed)).is_err());
}

#[wasm_bindgen_test]
fn ground_that_changes_before_the_first_tick_is_where_the_trial_begins() {
    let mut early = session();
    assert!(early.sculpt(given(RAISE)).is_ok());
    let _ = frame(&mut early);
    tick(&mut early, 8);
    let mut anew = session();
    assert!(anew.sculpt(given(RAISE)).is_ok() && anew.restart().is_ok());
    tick(&mut anew, 8);
    assert_eq!(early.digest(), anew.digest());
}

const HIGHER: &str =
    r#"{ "preset": "default", "overrides": { "planner": { "perception": { "variance_threshold": 0.7 } } } }"#;

/// The numbers that are not NaN.
fn known(values: &[f32]) -> Vec<f32> {
    values.iter().copied().filter(|value| !value.is_nan()).collect()
}

#[wasm_bindgen_test]
fn what_is_only_tried_is_shown_at_the_pose_and_leaves_the_run_as_it_was() {
    let (mut tried, mut plain) = (session(), session());
    tick(&mut tried, 30);
    tick(&mut plain, 30);
    let (before, _) = frame(&mut tried);
    tried.think_again(Some(given(HIGHER))).unwrap_or_else(|error| panic!("{}", message(error)));
    let (after, filled) = frame(&mut tried);
    assert_eq!((text(&before, "thought"), text(&after, "thought")), ("run".into(), "what_if".into()));
    assert_eq!(json(at(&before, "pose")), json(at(&after, "pose")));
    assert_eq!((number(&before, "tick"), number(&after, "threshold")), (30.0, 0.7));
    // A higher threshold takes more for ground.
    let mean = |values: Vec<f32>| values.iter().sum::<f32>() / values.len() as f32;
    assert!(mean(known(&filled("profile"))) > mean(known(&filled("former"))));
    assert!(known(&filled("truth")).len() > 100);
    tried.forget_thought();
    assert_eq!(text(&frame(&mut tried).0, "thought"), "run");
    tick(&mut tried, 10);
    tick(&mut plain, 10);
    assert_eq!(tried.digest(), plain.digest());
}

#[wasm_bindgen_test]
fn the_true_skyline_is_that_of_the_radius_which_is_tried() {
    let truth = |radius_m: f64, session: &mut Session| {
        let with = format!(
            r#"{{ "preset": "default", "overrides": {{ "planner": {{ "perception": {{ "surface_radius_m": {radius_m} }} }} }} }}"#
        );
        session.think_again(Some(given(&with))).unwrap_or_else(|error| panic!("{}", message(error)));
        known(&frame(session).1("truth"))
    };
    let (mut one, mut other) = (session(), session());
    tick(&mut one, 30);
    tick(&mut other, 30);
    let _ = truth(4.0, &mut one);
    assert_eq!(truth(6.0, &mut one), truth(6.0, &mut other));
}

#[wasm_bindgen_test]
fn going_on_with_what_was_tried_begins_a_timeline_at_the_pose() {
    let mut session = session();
    tick(&mut session, 25);
    session.think_again(Some(given(HIGHER))).unwrap_or_else(|error| panic!("{}", message(error)));
    session.go_on_so();
    tick(&mut session, 1);
    let (frame, _) = frame(&mut session);
    assert_eq!((number(&frame, "tick"), number(&frame, "timeline.first")), (26.0, 25.0));
    assert_eq!((text(&frame, "thought"), number(&frame, "threshold")), ("run".into(), 0.7));
}

#[wasm_bindgen_test]
fn what_cannot_be_tried_under_way_says_why_and_changes_nothing() {
    let mut session = session();
    tick(&mut session, 5);
    let options = r#"{ "preset": "default", "overrides": { "sensor": { "period_s": 0.2 } } }"#;
    let error = message(session.think_again(Some(given(options))).unwrap_err());
    assert!(error.starts_with("sensor.period_s = 0.2: expected 0.1 under way"), "{error}");
    assert_eq!(text(&frame(&mut session).0, "thought"), "run");
}

#[wasm_bindgen_test]
fn a_look_inside_has_the_inducing_inputs_and_less_is_known_without_one() {
    let mut session = session();
    tick(&mut session, 5);
    let look = |json: &str| got(session.look_inside(given(json)));
    let floats = |value: &JsValue, name: &str| at(value, name).unchecked_into::<Float32Array>().to_vec();
    let whole = look(r#"{ "without": [] }"#);
    let less = look(r#"{ "placement": "lattice", "without": [100] }"#);
    let sum = |value: &JsValue| floats(value, "variance").iter().map(|&v| f64::from(v)).sum::<f64>();
    assert!(sum(&less) > sum(&whole) + 0.1, "{} {}", sum(&less), sum(&whole));
    let kernel = session.kernel_from(180, 10).to_vec();
    assert_eq!(kernel.len(), floats(&whole, "variance").len());
    assert_eq!(kernel.iter().copied().fold(0.0, f32::max), 1.0);
    let bounds: Vec<f64> = session
        .climb()
        .unwrap_or_else(|error| panic!("{}", message(error)))
        .into_iter()
        .map(|step| number(&step.into(), "bound"))
        .collect();
    assert!(bounds.len() > 3 && bounds.is_sorted(), "{bounds:?}");
}

#[wasm_bindgen_test]
fn a_preview_is_a_coarse_grid_of_the_same_ground() {
    let preview = got(terrain_preview(terrain(RECIPE), 50));
    assert!(items(&preview, "solids").is_empty());
    let preview = at(&preview, "ground");
    let size = ["columns", "rows", "cell_m"].map(|name| number(&preview, name));
    let coarse = heights(&preview);
    assert_eq!((size, coarse.len()), ([41.0, 31.0, 1.0], 41 * 31));
    assert_eq!(coarse[18 * 41 + 20], heights(&got(session().ground()))[72 * COLUMNS + 80]);
}

#[wasm_bindgen_test]
fn a_preview_has_the_objects_of_its_family_and_its_places_keep_clear_of_them() {
    let recipe = generated_recipe("posts", 3).unwrap_or_default();
    let solids = items(&got(terrain_preview(terrain(&recipe), 50)), "solids");
    assert!(solids.len() > 10);
    let places = got(level_places(terrain(&recipe)));
    for place in ["start", "goal"] {
        for solid in &solids {
            let [x, y] = ["x", "y"].map(|axis| number(&places, &format!("{place}.{axis}")));
            let [east, north] = ["centre_m.0", "centre_m.1"].map(|axis| number(solid, axis));
            let away_m = DVec2::new(east - x, north - y).length();
            assert!(away_m > 0.8, "{place}: {}", json(solid.clone()));
        }
    }
}

#[wasm_bindgen_test]
fn generated_terrains_have_places_to_start_from() {
    let recipe = generated_recipe("hard", 3).unwrap_or_default();
    let places = got(level_places(terrain(&recipe)));
    assert!(number(&places, "goal.x") - number(&places, "start.x") > 10.0, "{}", json(places));
    assert!(
        message(generated_recipe("gruesome", 3).unwrap_err())
            .contains("expected one of easy, moderate, hard, rocks")
    );
}

#[wasm_bindgen_test]
fn a_recipe_that_imports_asks_for_the_file() {
    let recipe = "name = \"a\"\n\n[import]\nfile = \"heights.asc\"\n";
    let fault = message(level_places(terrain(recipe)).unwrap_err());
    assert!(fault.contains("expected the file heights.asc"), "{fault}");
    let grid = js_sys::JSON::parse(r#"{ "columns": 3, "rows": 3, "cell_m": 20 }"#).unwrap();
    let bump = Float32Array::from([0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0].as_slice());
    Reflect::set(&grid, &"heights_m".into(), &bump).unwrap();
    let files = JsValue::from(terrain::<mapless_wasm::TerrainFiles>(recipe));
    Reflect::set(&files, &"imported".into(), &grid).unwrap();
    let preview = terrain_preview(Ts::new_unchecked(files), 50);
    assert_eq!(heights(&at(&got(preview), "ground"))[4], 1.0);
}

#[wasm_bindgen_test]
fn a_recipe_says_what_it_imports() {
    let recipe = "name = \"a\"\n\n[import]\nfile = \"h.png\"\ncell_m = 0.5\nholes = \"crop\"\n";
    let import = got(import_of("a.toml", recipe).map(Option::unwrap));
    assert_eq!((text(&import, "file"), text(&import, "holes")), ("h.png".into(), "crop".into()));
    assert_eq!(number(&import, "cell_m"), 0.5);
    assert!(matches!(import_of("a.toml", RECIPE), Ok(None)));
    let dug = recipe.replace("crop", "dig");
    assert!(
        message(import_of("a.toml", &dug).unwrap_err()).contains("expected \"refuse\", \"fill\" or \"crop\"")
    );
}

#[wasm_bindgen_test]
fn a_place_off_the_terrain_changes_nothing() {
    let mut session = session();
    tick(&mut session, 2);
    let before = (json(got(session.scene())), session.digest());
    assert!(session.set_route(given(r#"{ "waypoints": [], "goal": { "x": -1, "y": 8 } }"#)).is_err());
    assert!(session.set_start(given(r#"{ "x": 99, "y": 8, "heading_rad": 0 }"#)).is_err());
    assert!(session.set_start(given(r#"{ "x": 9, "y": 8 }"#)).is_err());
    assert_eq!((json(got(session.scene())), session.digest()), before);
}

#[wasm_bindgen_test]
fn what_the_robot_believes_is_told_where_that_may_be_wrong() {
    let mut session = session();
    assert_eq!(text(&got(session.scene()), "reality"), "ideal");
    assert!(at(&frame(&mut session).0, "believed").is_undefined());
    for (overrides, name, believed) in [
        (r#"{ "reality": { "preset": "harsh" } }"#, "harsh", true),
        (r#"{ "reality": { "preset": "field", "pose": { "latency_s": 0.2 } } }"#, "own", true),
        (r#"{ "reality": { "motion": { "friction": 0.5 } } }"#, "own", false),
    ] {
        assert!(session.set_parameters(given(overrides), None).is_ok());
        assert_eq!(text(&got(session.scene()), "reality"), name);
        tick(&mut session, 20);
        let frame = frame(&mut session).0;
        assert_eq!(!at(&frame, "believed").is_undefined(), believed, "{overrides}");
        if believed {
            assert!((number(&frame, "pose.x") - number(&frame, "believed.x")).abs() > 1e-4);
        }
    }
    let groups: Vec<JsValue> =
        session.parameters().unwrap_or_default().into_iter().map(JsValue::from).collect();
    let motion = groups.iter().find(|group| text(group, "table") == "reality.motion").unwrap();
    let all = items(motion, "parameters");
    let friction = all.iter().find(|one| text(one, "name") == "friction").unwrap();
    assert_eq!(
        json(at(friction, "presets")),
        r#"[{"preset":"ideal","value":2},{"preset":"field","value":0.9},{"preset":"harsh","value":0.4}]"#
    );
}

/// Drives until the trial ends; gives the last tick.
fn ended(session: &mut Session) -> JsValue {
    let ticks = (0..200).map(|_| got(session.tick()));
    ticks.into_iter().find(|tick| text(tick, "after.outcome") != "running").unwrap()
}

#[wasm_bindgen_test]
fn reaches_a_goal_nearby() {
    let mut session = session();
    assert!(session.set_route(given(r#"{ "waypoints": [], "goal": { "x": 9, "y": 8 } }"#)).is_ok());
    let last = ended(&mut session);
    assert_eq!((text(&last, "after.outcome"), text(&last, "activity")), ("reached".into(), "arrived".into()));
    assert!(number(&last, "pose.yaw").abs() < 0.5, "it came from the west");
}

#[wasm_bindgen_test]
fn ends_with_the_goals_heading() {
    let mut session = session();
    let route = r#"{ "waypoints": [], "goal": { "x": 9, "y": 8, "heading_rad": 2.5 } }"#;
    assert!(session.set_route(given(route)).is_ok());
    let last = ended(&mut session);
    assert_eq!((text(&last, "after.outcome"), text(&last, "activity")), ("reached".into(), "arrived".into()));
    assert!((number(&last, "pose.yaw") - 2.5).abs() < 0.1, "{}", number(&last, "pose.yaw"));
    // Another heading at the goal is turned to there.
    assert!(session.set_route(given(&route.replace("2.5", "1.0"))).is_ok());
    let last = ended(&mut session);
    assert_eq!(text(&last, "after.outcome"), "reached");
    assert!((number(&last, "pose.yaw") - 1.0).abs() < 0.1, "{}", number(&last, "pose.yaw"));
}
