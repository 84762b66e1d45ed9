use core::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::config::PlannerConfig;
use crate::route::forecast::ReachEnd;
use crate::terrain::plane::Plane;
use crate::terrain::slopes::Slopes;
use crate::testing::Standing;

const STEP: Duration = Duration::from_millis(100);

fn lattice() -> StateLattice {
    let config = PlannerConfig::default();
    StateLattice::new(config.state_lattice, &config.robot, 7.0)
}

fn pose(roll_rad: f64, pitch_rad: f64) -> Pose {
    Pose { position_m: DVec3::ZERO, roll_rad, pitch_rad, yaw_rad: 0.0 }
}

fn plane(place_m: DVec2, gradient: DVec2) -> Option<Plane> {
    Some(Plane { height_m: gradient.dot(place_m), gradient, gradient_deviation: 0.0 })
}

fn level(place_m: DVec2) -> Option<Plane> {
    plane(place_m, DVec2::ZERO)
}

/// Level ground with a bank across the path, two metres ahead and four metres wide.
fn bank(place_m: DVec2) -> Option<Plane> {
    let on_bank = (1.9..3.1).contains(&place_m.x) && place_m.y.abs() < 2.0;
    plane(place_m, if on_bank { DVec2::new(1.5, 0.0) } else { DVec2::ZERO })
}

/// Keeps the path to a place; returns the point that the robot drives to.
fn set_out(lattice: &mut StateLattice, goal_m: DVec2, path: &mut Vec<PathPoint>) -> PathPoint {
    let reached = lattice.to(goal_m).unwrap();
    lattice.follow(reached, path);
    lattice.keep(reached);
    lattice.lookahead(path)
}

#[test]
fn on_level_ground_the_path_is_straight() {
    let mut lattice = lattice();
    lattice.search(&level, &pose(0.0, 0.0), STEP);
    let mut path = Vec::new();
    for goal_m in [DVec2::new(6.0, 0.0), DVec2::new(0.0, -5.0), DVec2::new(-4.0, 3.0)] {
        let forecast = lattice.follow(lattice.to(goal_m).unwrap(), &mut path);
        assert!((forecast.path_m / goal_m.length() - 1.0).abs() < 0.06, "{goal_m}: {forecast:?}");
        assert!(forecast.mean_risk < 1e-12 && path.iter().all(|point| !point.reverse));
        assert_eq!(lattice.lookahead(&path).position_m, goal_m);
    }
    let (reach_m, end) = lattice.reach_along(DVec2::X, 7.0);
    assert!((reach_m - 7.0).abs() < 1e-12 && end == ReachEnd::Whole);
}

#[test]
fn a_path_leads_around_a_bank_that_is_too_steep() {
    let mut lattice = lattice();
    lattice.search(&bank, &pose(0.0, 0.0), STEP);
    let beyond_m = DVec2::new(5.0, 0.0);
    let mut path = Vec::new();
    let forecast = lattice.follow(lattice.to(beyond_m).unwrap(), &mut path);
    assert!(forecast.path_m > 6.0, "{forecast:?}");
    for point in &path {
        assert!(bank(point.position_m).unwrap().gradient.length() < 1e-12, "{point:?}");
    }
    // The straight line through the bank is refused too.
    assert!(lattice.lookahead(&path).position_m.y.abs() > 1.0);
    assert!(lattice.to(DVec2::new(2.5, 0.0)).is_none());
}

#[test]
fn a_path_leaves_more_room_beside_what_stands_than_it_must() {
    let mut lattice = lattice();
    // 0.25 m of room would do.
    let post = Standing { at_m: DVec2::new(3.0, -0.5), radius_m: 0.25, is_void: false };
    lattice.search(&post, &pose(0.0, 0.0), STEP);
    let mut path = Vec::new();
    lattice.follow(lattice.to(DVec2::new(6.0, 0.0)).unwrap(), &mut path);
    let room_m = path.iter().map(|point| point.position_m.distance(post.at_m) - 0.25).fold(9.0, f64::min);
    assert!(room_m > 0.45, "{room_m}");
}

#[test]
fn a_path_leads_around_a_knoll_that_it_could_cross() {
    // 0.8 m high and two metres around its top; nowhere near the limits.
    let knoll = |place_m: DVec2| {
        let from_top_m = place_m - DVec2::new(3.0, 0.0);
        let reach = from_top_m.length_squared() / 4.0;
        let inside = reach < 1.0;
        let height_m = if inside { 0.8 * (1.0 - reach) * (1.0 - reach) } else { 0.0 };
        let gradient = if inside { from_top_m * (-0.8 * (1.0 - reach)) } else { DVec2::ZERO };
        Some(Plane { height_m, gradient, gradient_deviation: 0.0 })
    };
    let limits = PlannerConfig::default().robot;
    let [over, around, impatient] = [(0.0, 1.0), (4.0, 1.0), (4.0, 0.1)].map(|(climb_price, share)| {
        let config = StateLatticeConfig { tilt_price: 0.0, climb_price, ..StateLatticeConfig::default() };
        let mut lattice = StateLattice::new(config, &limits, 7.0);
        lattice.scale_slope_cost(share);
        lattice.search(&knoll, &pose(0.0, 0.0), STEP);
        let mut path = Vec::new();
        let forecast = lattice.follow(lattice.to(DVec2::new(6.0, 0.0)).unwrap(), &mut path);
        (forecast, lattice.lookahead(&path).position_m)
    });
    assert!((over.0.climb_m - 1.6).abs() < 0.05 && over.1.y.abs() < 0.1, "{over:?}");
    assert!(around.0.climb_m < 0.4 && around.1.y.abs() > 0.4, "{around:?}");
    assert!(impatient.0.climb_m > 1.5, "{impatient:?}");
}

#[test]
fn the_reach_ends_before_what_is_steep_or_unseen_and_says_which() {
    let mut lattice = lattice();
    let wall = |place_m: DVec2| plane(place_m, DVec2::new(if place_m.x > 3.1 { 2.0 } else { 0.0 }, 0.0));
    lattice.search(&wall, &pose(0.0, 0.0), STEP);
    let (reach_m, end) = lattice.reach_along(DVec2::X, 7.0);
    assert_eq!(end, ReachEnd::Tilt);
    assert!((1.5..2.6).contains(&reach_m), "{reach_m}");
    lattice.clear();
    let edge = |place_m: DVec2| level(place_m).filter(|_| place_m.x < 3.1);
    lattice.search(&edge, &pose(0.0, 0.0), STEP);
    assert_eq!(lattice.reach_along(DVec2::X, 7.0).1, ReachEnd::Unseen);
}

#[test]
fn ground_that_no_beam_reaches_is_bridged_unless_its_ends_say_it_is_steep() {
    let ring = |height_m: f64| {
        move |place_m: DVec2| match place_m.length() {
            r if r < 0.6 => level(place_m),
            r if r < 3.0 => None,
            _ => level(place_m).map(|plane| Plane { height_m, ..plane }),
        }
    };
    let mut lattice = lattice();
    lattice.search(&ring(0.2), &pose(0.0, 0.0), STEP);
    let mut path = Vec::new();
    lattice.follow(lattice.to(DVec2::new(5.0, 0.0)).unwrap(), &mut path);
    assert!(
        (lattice.utilisation_ahead(&path, path.last().unwrap()) - 0.75).abs() < 1e-12,
        "what is not seen is driven on with care"
    );
    lattice.clear();
    lattice.search(&level, &pose(0.0, 0.0), STEP);
    lattice.follow(lattice.to(DVec2::new(5.0, 0.0)).unwrap(), &mut path);
    assert!(lattice.utilisation_ahead(&path, path.last().unwrap()) < 1e-12);
    lattice.clear();
    lattice.search(&ring(3.0), &pose(0.0, 0.0), STEP);
    assert!(lattice.to(DVec2::new(5.0, 0.0)).is_none());
}

#[test]
fn on_a_slope_too_steep_to_turn_the_path_back_is_in_reverse() {
    let steep = DVec2::new(libm::tan(0.6), 0.0);
    let mut lattice = lattice();
    lattice.search(&|place_m| plane(place_m, steep), &pose(0.0, 0.6), STEP);
    assert!(!lattice.may_turn_around());
    let mut path = Vec::new();
    lattice.follow(lattice.to(DVec2::new(-4.0, 0.0)).unwrap(), &mut path);
    assert!(path[1..].iter().all(|point| point.reverse));
    let ahead = lattice.lookahead(&path);
    assert!(ahead.reverse && ahead.position_m.x < -2.0);
}

#[test]
fn a_turn_keeps_the_least_margin_in_roll_and_in_pitch() {
    let limits = PlannerConfig::default().robot;
    let least_rad = PlannerConfig::default().state_lattice.recovery_margin_rad;
    let mut lattice = lattice();
    // Half-way between up and down a slope the robot rolls.
    for (excess_rad, may_turn) in [(-0.01, true), (0.01, false)] {
        lattice.search(&level, &pose(0.0, limits.roll_limit_rad - least_rad + excess_rad), STEP);
        assert_eq!(lattice.may_turn_around(), may_turn);
    }
    // Inside both limits, on a slope that is steeper than either: only towards its foot does the pitch grow.
    lattice.search(&level, &pose(0.28, -0.70), STEP);
    let down_m = -lattice.attitude.gradient;
    assert!(down_m.length() > libm::tan(limits.pitch_limit_rad - least_rad));
    assert!(!lattice.may_turn_to(down_m));
    assert!(lattice.may_turn_to(DVec2::from_angle(-0.1 * down_m.y.signum())));
}

#[test]
fn ground_with_the_least_margin_is_crossed_if_no_other_path_exists() {
    let config = PlannerConfig::default();
    let steep = libm::tan(config.robot.pitch_limit_rad - config.state_lattice.recovery_margin_rad - 0.005);
    let slope = |place_m: DVec2, half_width_m: f64| {
        let on_bank = (1.9..3.1).contains(&place_m.x) && place_m.y.abs() < half_width_m;
        plane(place_m, if on_bank { DVec2::new(steep, 0.0) } else { DVec2::ZERO })
    };
    let mut path = Vec::new();
    for (half_width_m, crosses) in [(2.0, false), (20.0, true)] {
        let mut lattice = lattice();
        lattice.search(&|place_m| slope(place_m, half_width_m), &pose(0.0, 0.0), STEP);
        lattice.follow(lattice.to(DVec2::new(5.0, 0.0)).unwrap(), &mut path);
        let steep_places =
            path.iter().filter(|point| slope(point.position_m, half_width_m).unwrap().gradient.x > 0.1);
        assert_eq!(steep_places.count() > 0, crosses, "{half_width_m} m: {path:?}");
    }
}

#[test]
fn the_frontier_borders_on_unseen_ground_away_from_the_robot() {
    let mut lattice = lattice();
    let edge = |place_m: DVec2| level(place_m).filter(|_| place_m.x < 3.1);
    let here_m = DVec3::new(2.0, 0.0, 0.0);
    lattice.search(&edge, &Pose { position_m: here_m, ..pose(0.0, 0.0) }, STEP);
    let frontier: Vec<DVec2> = lattice.frontier().map(|(_, place_m)| place_m).collect();
    assert!(frontier.iter().any(|place_m| place_m.x > 2.9 && place_m.y.abs() < 2.0), "{frontier:?}");
    for place_m in &frontier {
        let away_m = (*place_m - here_m.truncate()).length();
        assert!(place_m.x > 2.9 && away_m > 1.2 || away_m > 5.0, "{place_m}");
    }
}

#[test]
fn the_cost_to_go_leads_out_of_a_pocket_and_grows_towards_its_end() {
    // Walls ahead and on both sides; the goal is behind the wall ahead.
    let pocket = |place_m: DVec2| {
        let wall = (2.4..3.6).contains(&place_m.x) && place_m.y.abs() < 4.1
            || (3.4..4.6).contains(&place_m.y.abs()) && (-2.1..3.6).contains(&place_m.x);
        plane(place_m, if wall { DVec2::new(2.0, 2.0) } else { DVec2::ZERO })
    };
    let goal_m = DVec2::new(20.0, 0.0);
    let mut lattice = lattice();
    lattice.search(&pocket, &pose(0.0, 0.0), STEP);
    let ends: Vec<_> = lattice.frontier().map(|(end, place_m)| (end, (goal_m - place_m).length())).collect();
    let remaining: Vec<(DVec2, f64)> = lattice.backward_search(&ends, 2.0, 1.0).collect();
    let left_m = |place_m: DVec2| remaining.iter().find(|(other_m, _)| *other_m == place_m).unwrap().1;
    // Out, along a side, and on: 2.5 m back, some 4 m aside, and then the straight distance from there.
    let out_m = (DVec2::new(-2.5, 3.5) - goal_m).length() + 2.5 + 3.5;
    assert!(left_m(DVec2::ZERO) > out_m && left_m(DVec2::ZERO) < out_m + 6.0, "{}", left_m(DVec2::ZERO));
    assert!(left_m(DVec2::new(2.0, 0.0)) > left_m(DVec2::ZERO) + 1.5);
    for (end, given_m) in &ends {
        let place_m = lattice.frontier().find(|(other, _)| other == end).unwrap().1;
        assert!(left_m(place_m) <= given_m + 2e-3);
    }
}

#[test]
fn ground_steeper_than_predicted_is_avoided() {
    let mut lattice = lattice();
    let mut path = Vec::new();
    let goal_m = DVec2::new(4.0, 0.0);
    // The window says level, the attitude is 43.5°.
    lattice.search(&level, &pose(0.0, 0.76), STEP);
    assert!(lattice.is_too_steep());
    lattice.inflate_variance_ahead(DVec2::X);
    let back = Pose { position_m: DVec3::new(-1.0, 0.0, 0.0), ..pose(0.0, 0.0) };
    // Twice: the attitude's rate must settle.
    for _ in 0..2 {
        lattice.search(&level, &back, STEP);
    }
    assert!(!lattice.is_too_steep() && lattice.is_calm());
    lattice.follow(lattice.to(goal_m).unwrap(), &mut path);
    let met_m = DVec2::new(0.5, 0.0);
    assert!(path.iter().all(|point| (point.position_m - met_m).length() > 0.55), "{path:?}");
}

#[test]
fn inflated_variance_makes_similar_ground_nearby_dearer_for_a_while() {
    // Ground that keeps its margin with one deviation, and not with two; a path on it costs more where the
    // variance is inflated.
    let rough = |_: DVec2| Some(Plane { height_m: 0.0, gradient: DVec2::ZERO, gradient_deviation: 0.25 });
    let risk = |lattice: &mut StateLattice, y_m: f64| {
        lattice.search(&rough, &Pose { position_m: DVec3::new(0.0, y_m, 0.0), ..pose(0.0, 0.0) }, STEP);
        let reached = lattice.to(DVec2::new(4.0, y_m))?;
        Some(lattice.follow(reached, &mut Vec::new()).mean_risk)
    };
    let is_dearer = |lattice: &mut StateLattice, y_m: f64| risk(lattice, y_m).is_none_or(|risk| risk > 0.1);
    let mut lattice = lattice();
    assert!(!is_dearer(&mut lattice, 0.0));
    for _ in 0..2 {
        lattice.inflate_variance_ahead(DVec2::X);
    }
    assert!(is_dearer(&mut lattice, 0.0));
    assert!(!is_dearer(&mut lattice, 8.0), "far from there no variance is inflated");
    let after_m = (1..).map(|k| 16.0 * f64::from(k)).find(|_| {
        let near = is_dearer(&mut lattice, 0.0);
        is_dearer(&mut lattice, 8.0);
        !near
    });
    assert!((15.0..100.0).contains(&after_m.unwrap()), "{after_m:?} m");
}

#[test]
fn ground_that_gets_steeper_fast_slows_the_robot_before_it_is_steep() {
    let mut lattice = lattice();
    let mut path = Vec::new();
    let mut shares = [0.0; 2];
    for (share, pitches_rad) in shares.iter_mut().zip([[0.10, 0.15], [0.15, 0.15]]) {
        for pitch_rad in pitches_rad {
            lattice.search(&level, &pose(0.0, -pitch_rad), STEP);
        }
        set_out(&mut lattice, DVec2::new(4.0, 0.0), &mut path);
        let ahead = lattice.lookahead(&path);
        *share = lattice.utilisation_ahead(&path, &ahead);
    }
    assert!((shares[1] - libm::tan(0.15)).abs() < 0.01 && shares[0] > shares[1] + 0.2, "{shares:?}");
}

#[test]
fn tilt_utilisation_covers_the_path_and_the_line_to_the_point_driven_to() {
    let mut lattice = lattice();
    let mut path = Vec::new();
    lattice.search(&bank, &Pose { position_m: DVec3::new(1.2, 0.0, 0.0), ..pose(0.0, 0.0) }, STEP);
    set_out(&mut lattice, DVec2::new(-4.0, 0.0), &mut path);
    let ahead = lattice.lookahead(&path);
    assert!(lattice.utilisation_ahead(&path, &ahead) < 0.1, "behind it all is level");
    let on_the_bank = PathPoint { position_m: DVec2::new(2.2, 0.0), ..ahead };
    assert!(lattice.utilisation_ahead(&path, &on_the_bank) > 0.7);
}

#[test]
fn ground_steeper_than_predicted_is_tried_again_if_no_other_path_exists() {
    let corridor =
        |place_m: DVec2| plane(place_m, DVec2::new(0.0, if place_m.y.abs() < 0.6 { 0.0 } else { 1.5 }));
    let mut lattice = lattice();
    let mut path = Vec::new();
    let goal_m = DVec2::new(4.0, 0.0);
    let mut costs_m = Vec::new();
    for _ in 0..3 {
        lattice.search(&corridor, &Pose { position_m: DVec3::new(-1.0, 0.0, 0.0), ..pose(0.0, 0.0) }, STEP);
        set_out(&mut lattice, goal_m, &mut path);
        costs_m.push(path.last().unwrap().cost_m);
        lattice.search(&corridor, &pose(0.0, 0.76), STEP);
        lattice.search_recovery();
        set_out(&mut lattice, DVec2::new(-1.0, 0.0), &mut path);
    }
    let dearer_m = [costs_m[1] - costs_m[0], costs_m[2] - costs_m[1]];
    assert!(dearer_m.iter().all(|&dearer_m| dearer_m > 2.0), "{costs_m:?}");
}

#[test]
fn the_kept_path_keeps_the_side_of_an_obstacle() {
    // Either side of a narrow obstacle costs the same; the second search keeps to the side of the first.
    let post = |place_m: DVec2| {
        plane(
            place_m,
            DVec2::new(if (place_m - DVec2::new(3.0, 0.0)).length() < 0.8 { 2.0 } else { 0.0 }, 0.0),
        )
    };
    let mut lattice = lattice();
    let mut path = Vec::new();
    let mut sides = [0.0; 2];
    for side in &mut sides {
        lattice.search(&post, &pose(0.0, 0.0), STEP);
        let ahead = set_out(&mut lattice, DVec2::new(6.0, 0.0), &mut path);
        *side = ahead.position_m.y.signum();
    }
    assert!(sides[0] * sides[1] > 0.0);
}

#[test]
fn a_path_is_left_only_for_one_that_is_cheaper_by_half_a_metre() {
    // An obstacle ahead, and a slope on one side of it.
    let slope = |left: f64, right: f64| {
        move |place_m: DVec2| {
            let is_obstacle = (place_m - DVec2::new(3.0, 0.0)).length() < 0.8;
            let beside = if place_m.y > 0.0 {
                left
            } else if place_m.y < 0.0 {
                right
            } else {
                0.0
            };
            plane(place_m, DVec2::X * if is_obstacle { 2.0 } else { beside })
        }
    };
    let mut path = Vec::new();
    for (right, keeps, leaves) in [(0.005, true, false), (0.005, false, true), (0.05, true, true)] {
        let mut lattice = lattice();
        lattice.search(&slope(0.005, 0.0), &pose(0.0, 0.0), STEP);
        set_out(&mut lattice, DVec2::new(6.0, 0.0), &mut path);
        let side = |path: &[PathPoint]| {
            let beside = path
                .iter()
                .min_by(|a, b| (a.position_m.x - 3.0).abs().total_cmp(&(b.position_m.x - 3.0).abs()));
            beside.unwrap().position_m.y.signum()
        };
        assert!(side(&path) < 0.0, "{path:?}");
        if !keeps {
            lattice.release();
        }
        lattice.query_again_near(DVec2::ZERO, 8.0);
        lattice.search(&slope(0.0, right), &pose(0.0, 0.0), STEP);
        set_out(&mut lattice, DVec2::new(6.0, 0.0), &mut path);
        assert_eq!(side(&path) > 0.0, leaves, "{right}, {keeps}: {path:?}");
    }
}

#[test]
fn the_next_place_of_the_kept_path_stays_possible_until_it_is_unsafe() {
    let mut path = Vec::new();
    let goal_m = DVec2::new(4.0, 0.0);
    // On the path, but facing 34° aside, and too steep to turn.
    let aside = Pose { position_m: DVec3::new(0.1, 0.1, 0.0), roll_rad: 0.0, pitch_rad: 0.7, yaw_rad: 0.6 };
    let first_step = |lattice: &mut StateLattice, ground: &dyn TerrainQuery, path: &mut Vec<PathPoint>| {
        lattice.query_again_near(DVec2::ZERO, 8.0);
        lattice.search(ground, &aside, STEP);
        lattice.follow(lattice.to(goal_m).or_else(|| lattice.to(-goal_m))?, path);
        Some(path[1].position_m)
    };
    let mut lattice = lattice();
    lattice.search(&level, &pose(0.0, 0.0), STEP);
    set_out(&mut lattice, goal_m, &mut path);
    let next_m = path[1].position_m;
    assert_eq!(first_step(&mut lattice, &level, &mut path), Some(next_m));
    assert!(!lattice.may_turn_to(next_m - aside.plan_m()));
    let drop = |place_m: DVec2| plane(place_m, DVec2::X * if place_m.x > 0.3 { 2.0 } else { 0.0 });
    assert_ne!(first_step(&mut lattice, &drop, &mut path), Some(next_m));
    lattice.release();
    assert_ne!(first_step(&mut lattice, &level, &mut path), Some(next_m));
}

/// Level ground with something upright at a place.
struct Post(DVec2);

impl TerrainQuery for Post {
    fn plane_at(&self, place_m: DVec2) -> Option<Plane> {
        level(place_m)
    }

    fn each_upright(&self, _: DVec2, _: f64, visit: &mut dyn FnMut(DVec2)) {
        visit(self.0);
    }
}

#[test]
fn a_turn_to_the_kept_path_sweeps_into_nothing() {
    let yaw_rad: f64 = -0.45;
    // Beside the robot, where its corner passes as it turns back to the path.
    let beside_m = DVec2::new(0.3, 0.45).rotate(DVec2::from_angle(yaw_rad));
    for (at_m, turns) in [(beside_m, false), (DVec2::new(-3.0, 3.0), true)] {
        let mut lattice = lattice();
        let mut path = Vec::new();
        lattice.search(&level, &pose(0.0, 0.0), STEP);
        set_out(&mut lattice, DVec2::new(4.0, 0.0), &mut path);
        lattice.search(&Post(at_m), &Pose { yaw_rad, ..pose(0.0, 0.0) }, STEP);
        let (next, _) = lattice.kept_state.unwrap();
        let is_begun = lattice.costs_mm[next] != UNREACHED && lattice.came_from[next] == BEGIN;
        assert_eq!(is_begun, turns, "{at_m}");
    }
}

#[test]
fn a_place_too_near_to_drive_to_is_reached_by_staying() {
    let mut lattice = lattice();
    let here_m = DVec2::new(0.1, -0.2);
    lattice.search(&level, &Pose { position_m: here_m.extend(0.0), ..pose(0.0, 0.0) }, STEP);
    let mut path = Vec::new();
    assert!((lattice.cost_m(lattice.to(DVec2::ZERO).unwrap()) - here_m.length()).abs() < 2e-3);
    for goal_m in [DVec2::new(2.0, 0.0), DVec2::new(-1.0, 1.5)] {
        lattice.follow(lattice.to(goal_m).unwrap(), &mut path);
        assert!((path[1].position_m - here_m).length() >= FIRST_STEP_M, "{path:?}");
    }
}

#[test]
fn uncertain_steep_ground_is_bridged_like_unseen_ground() {
    // From a knoll: ground seen from four metres on, and extrapolated up to there.
    let flank = |deviation: f64| {
        move |place_m: DVec2| {
            let guessed = (1.2..4.0).contains(&place_m.length());
            let gradient = DVec2::X * if guessed { 1.1 } else { 0.0 };
            let gradient_deviation = if guessed { deviation } else { 0.0 };
            Some(Plane { height_m: 0.0, gradient, gradient_deviation })
        }
    };
    for (deviation, bridged) in [(0.4, true), (0.14, false)] {
        let mut lattice = lattice();
        lattice.search(&flank(deviation), &pose(0.0, 0.0), STEP);
        assert_eq!(lattice.to(DVec2::new(5.0, 0.0)).is_some(), bridged, "{deviation}");
    }
}

#[test]
fn a_smaller_margin_admits_slightly_steeper_ground() {
    let mut lattice = lattice();
    // Obliquely, at 26.6 degrees, the robot climbs 42.7 degrees and rolls 24.7.
    let bank =
        |place_m: DVec2| plane(place_m, DVec2::X * if (1.9..3.1).contains(&place_m.x) { 1.03 } else { 0.0 });
    let mut reaches = |margin_rad: f64| {
        lattice.keep_margin(margin_rad);
        lattice.search(&bank, &pose(0.0, 0.0), STEP);
        lattice.to(DVec2::new(5.0, 0.0)).is_some()
    };
    assert!(!reaches(0.06) && reaches(0.03) && !reaches(0.06));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// On any ground, no path leads over an unsafe place or along an unsafe heading.
    #[test]
    fn every_path_keeps_its_margin(
        waves in prop::collection::vec((-0.9..0.9_f64, -0.9..0.9_f64, 0.0..6.3_f64), 3),
        bearing in 0.0..6.3_f64,
    ) {
        let gradient = |place_m: DVec2| waves.iter().fold(DVec2::ZERO, |sum, &(kx, ky, phase)| {
            let slope = libm::cos(kx * place_m.x + ky * place_m.y + phase) - libm::cos(phase);
            sum + DVec2::new(kx, ky) * slope
        });
        let ground = |place_m: DVec2| {
            let height_m = waves.iter().fold(0.0, |sum, &(kx, ky, phase)| {
                let along = kx * place_m.x + ky * place_m.y;
                sum + libm::sin(along + phase) - libm::sin(phase) - along * libm::cos(phase)
            });
            Some(Plane { height_m, gradient: gradient(place_m), gradient_deviation: 0.0 })
        };
        let mut lattice = lattice();
        lattice.search(&ground, &pose(0.0, 0.0), STEP);
        let (sin, cos) = libm::sincos(bearing);
        let Some(reached) = lattice.to(DVec2::new(cos, sin) * 6.0) else { return Ok(()) };
        let mut path = Vec::new();
        let forecast = lattice.follow(reached, &mut path);
        let margin_rad = PlannerConfig::default().state_lattice.recovery_margin_rad;
        let limits = PlannerConfig::default().robot;
        prop_assert!(forecast.max_roll_rad <= limits.roll_limit_rad - margin_rad + 1e-6, "{forecast:?}");
        prop_assert!(forecast.max_pitch_rad <= limits.pitch_limit_rad - margin_rad + 1e-6, "{forecast:?}");
        prop_assert!(forecast.max_roll_rad < FRAC_PI_2 && forecast.path_m >= 5.0);
        prop_assert!(path.windows(2).all(|pair| pair[1].cost_m > pair[0].cost_m));
    }

    /// On any slope, a first step leads in no direction in which the robot would tilt beyond the least
    /// margin.
    #[test]
    fn the_first_step_of_every_path_is_safe_at_the_headings_it_is_driven_at(
        across in -0.9..0.9_f64,
        along in -0.9..0.9_f64,
        x_m in -0.25..0.25_f64,
        y_m in -0.25..0.25_f64,
        yaw_rad in -3.1..3.1_f64,
    ) {
        // A plane: the robot's attitude and every place have the same gradient.
        let gradient = DVec2::new(along, across);
        let ahead = DVec2::from_angle(yaw_rad);
        let slope_up = |direction: DVec2| gradient.dot(direction);
        let here_m = DVec2::new(x_m, y_m);
        let normal = (-gradient).extend(1.0).normalize();
        let forward = ahead.extend(slope_up(ahead)).normalize();
        let left = normal.cross(forward);
        let standing = Pose {
            position_m: here_m.extend(gradient.dot(here_m)),
            roll_rad: libm::atan2(left.z, normal.z),
            pitch_rad: libm::asin(forward.z),
            yaw_rad,
        };
        let mut lattice = lattice();
        lattice.search(&|place_m| plane(place_m, gradient), &standing, STEP);
        let least_rad = PlannerConfig::default().state_lattice.recovery_margin_rad;
        let most = Slopes::of_limits(&PlannerConfig::default().robot, least_rad);
        let own = Slopes::facing(gradient, ahead);
        let mut path = Vec::new();
        let reached: Vec<_> = lattice.reached().map(|(reached, _)| reached).collect();
        for reached in reached {
            lattice.follow(reached, &mut path);
            let Some(first) = path.get(1) else { continue };
            let way = (first.position_m - here_m).normalize();
            if first.position_m.distance(here_m) < FIRST_STEP_M {
                continue;
            }
            let slopes = Slopes::facing(gradient, way);
            let allowed = most.max(own);
            prop_assert!(slopes.within(&allowed, -0.005), "{slopes:?} beyond {allowed:?}: {path:?}");
        }
    }
}
