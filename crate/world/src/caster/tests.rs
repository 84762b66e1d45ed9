//! The hierarchy against two independent methods.

use super::*;
use glam::DVec2;
use proptest::prelude::*;

fn field_of(columns: usize, rows: usize, cell_m: f64, heights: &[f32]) -> HeightField {
    HeightField::new(columns, rows, cell_m, heights[..columns * rows].to_vec()).unwrap()
}

/// Tests every cell of the field, with the quadratic solved in its textbook form.
fn brute_force(field: &HeightField, origin: DVec3, direction: DVec3, max_range_m: f64) -> Option<f64> {
    let cell_m = field.cell_m();
    let mut best = None;
    for row in 0..field.rows() - 1 {
        for column in 0..field.columns() - 1 {
            let corner =
                |c: usize, r: usize| f64::from(field.heights_m()[(row + r) * field.columns() + column + c]);
            let (h00, h10, h01, h11) = (corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1));
            let (u, v) = (origin.x / cell_m - column as f64, origin.y / cell_m - row as f64);
            let (du, dv) = (direction.x / cell_m, direction.y / cell_m);
            let (a, b, k) = (h10 - h00, h01 - h00, h11 - h10 - h01 + h00);
            let quadratic = -k * du * dv;
            let linear = direction.z - a * du - b * dv - k * (u * dv + v * du);
            let constant = origin.z - h00 - a * u - b * v - k * u * v;
            // The textbook form loses its digits where the quadratic is nearly linear.
            let roots = if (quadratic * constant).abs() < 1e-9 * linear * linear {
                [-constant / linear; 2]
            } else {
                let root = (linear * linear - 4.0 * quadratic * constant).sqrt();
                [(-linear - root) / (2.0 * quadratic), (-linear + root) / (2.0 * quadratic)]
            };
            for t in roots {
                let slack = 1e-9;
                let inside = |x: f64| x >= -slack && x <= 1.0 + slack;
                if t >= 0.0 && t <= max_range_m && inside(u + du * t) && inside(v + dv * t) {
                    best = Some(best.map_or(t, |known: f64| known.min(t)));
                }
            }
        }
    }
    best
}

fn direction(azimuth: f64, elevation: f64) -> DVec3 {
    let (sin_azimuth, cos_azimuth) = libm::sincos(azimuth);
    let (sin_elevation, cos_elevation) = libm::sincos(elevation);
    DVec3::new(cos_elevation * cos_azimuth, cos_elevation * sin_azimuth, sin_elevation)
}

#[test]
fn every_ray_down_meets_level_ground() {
    let caster = Caster::new(field_of(401, 401, 0.25, &[1.0; 401 * 401]));
    for index in 0..10_000 {
        let azimuth_rad = f64::from(index) * 0.1;
        let direction = DVec3::new(libm::cos(azimuth_rad), libm::sin(azimuth_rad), -0.0894).normalize();
        let range_m = caster.cast(DVec3::new(50.1, 49.9, 1.0 + 0.78), direction, 12.0);
        assert!(range_m.is_some(), "{direction}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn agrees_with_brute_force(
        columns in 2..24usize, rows in 2..24usize,
        heights in prop::collection::vec(-1.0f32..1.0, 24 * 24),
        cell_m in 0.1..1.0f64, x in 0.0..1.0f64, y in 0.0..1.0f64, above_m in 0.001..2.0f64,
        azimuth in -3.2..3.2f64, elevation in -1.6..0.8f64,
    ) {
        let field = field_of(columns, rows, cell_m, &heights);
        let at = DVec2::new(x, y) * field.extent_m();
        let origin = at.extend(field.height_m(at).unwrap() + above_m);
        let toward = direction(azimuth, elevation);
        let expected = brute_force(&field, origin, toward, 100.0);
        let found = Caster::new(field).cast(origin, toward, 100.0);
        match (found, expected) {
            (Some(found), Some(expected)) => prop_assert!((found - expected).abs() < 1e-6, "{found} {expected}"),
            _ => prop_assert_eq!(found, expected),
        }
    }

    #[test]
    fn rays_close_above_a_rough_slope_agree_with_brute_force(
        bumps in prop::collection::vec(0.0..1.0f32, 70 * 60), roughness_m in 0.0..0.1f32,
        east in -0.5..0.5f32, north in -0.5..0.5f32, x in 0.0..1.0f64, y in 0.0..1.0f64, above_m in 0.01..0.5f64,
        azimuth in -3.2..3.2f64, steeper in -0.1..0.02f64,
    ) {
        let cell_m = 0.2;
        let height_m = |(index, bump): (usize, &f32)| {
            let (column, row) = ((index % 70) as f32, (index / 70) as f32);
            100.0 + cell_m as f32 * (east * column + north * row) + roughness_m * bump
        };
        let heights: Vec<f32> = bumps.iter().enumerate().map(height_m).collect();
        let field = field_of(70, 60, cell_m, &heights);
        let at = DVec2::new(x, y) * field.extent_m();
        let origin = at.extend(field.height_m(at).unwrap() + above_m);
        let (sin, cos) = libm::sincos(azimuth);
        let slope = f64::from(east) * cos + f64::from(north) * sin;
        let toward = direction(azimuth, libm::atan(slope) + steeper);
        let expected = brute_force(&field, origin, toward, 100.0);
        let found = Caster::new(field).cast(origin, toward, 100.0);
        match (found, expected) {
            (Some(found), Some(expected)) => prop_assert!((found - expected).abs() < 1e-6, "{found} {expected}"),
            _ => prop_assert_eq!(found, expected),
        }
    }

    #[test]
    fn agrees_with_fine_marching(
        heights in prop::collection::vec(-0.7f32..0.7, 17 * 13),
        x in 0.0..1.0f64, y in 0.0..1.0f64, above_m in 0.05..1.0f64, azimuth in -3.2..3.2f64, elevation in -0.6..0.3f64,
    ) {
        let field = field_of(17, 13, 0.5, &heights);
        let at = DVec2::new(x, y) * field.extent_m();
        let origin = at.extend(field.height_m(at).unwrap() + above_m);
        let toward = direction(azimuth, elevation);
        let found = Caster::new(field.clone()).cast(origin, toward, 6.0);
        let mut t = 0.0;
        while t < found.unwrap_or(6.0) {
            let point = origin + toward * t;
            let Some(ground) = field.height_m(point.truncate()) else { break };
            prop_assert!(point.z > ground - 1e-9, "the ray is under ground at {t} m, found {found:?}");
            t += 0.003;
        }
        if let Some(range_m) = found {
            let point = origin + toward * range_m;
            let inside = point.truncate().clamp(DVec2::ZERO, field.extent_m());
            prop_assert!((point.z - field.height_m(inside).unwrap()).abs() < 1e-9);
        }
    }

    #[test]
    fn rays_along_cell_edges_and_through_samples_agree_with_brute_force(
        heights in prop::collection::vec(-1.0f32..1.0, 64),
        column in 0..8usize, row in 0..8usize, quarter in 0..8usize, dz in -1.0..0.3f64,
    ) {
        let field = field_of(8, 8, 0.25, &heights);
        let origin = DVec3::new(column as f64 * 0.25, row as f64 * 0.25, 1.25);
        let along = [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (-1.0, 0.0), (-1.0, -1.0), (0.0, -1.0), (1.0, -1.0)];
        let (dx, dy) = along[quarter];
        let toward = DVec3::new(dx, dy, dz).normalize();
        let expected = brute_force(&field, origin, toward, 50.0);
        let found = Caster::new(field).cast(origin, toward, 50.0);
        match (found, expected) {
            (Some(found), Some(expected)) => prop_assert!((found - expected).abs() < 1e-6, "{found} {expected}"),
            // A ray that leaves over the very border may touch it or not.
            (None, Some(at)) => {
                let end = origin + toward * at;
                let on_border = |value: f64| value.abs() < 1e-9 || (value - 1.75).abs() < 1e-9;
                prop_assert!(on_border(end.x) || on_border(end.y), "{expected:?}");
            }
            _ => prop_assert_eq!(found, expected),
        }
    }
}

#[test]
fn level_ground_is_met_where_trigonometry_says() {
    let caster = Caster::new(HeightField::new(400, 400, 0.25, vec![2.0; 160_000]).unwrap());
    let origin = DVec3::new(50.0, 50.0, 2.8);
    for degrees in [-89.0, -45.0, -15.0, -3.0, -1.0f64] {
        for azimuth in [0.0, 0.3, 1.5, 3.0, -2.0] {
            let elevation = degrees.to_radians();
            let expected = 0.8 / -libm::sin(elevation);
            let found = caster.cast(origin, direction(azimuth, elevation), 100.0);
            assert!((found.unwrap() - expected).abs() < 1e-9, "{degrees}° {azimuth}: {found:?} {expected}");
        }
    }
    assert_eq!(caster.cast(origin, direction(0.3, -0.02), 10.0), None, "beyond the range");
    assert_eq!(caster.cast(origin, direction(0.3, 0.0), 100.0), None, "level");
    assert_eq!(caster.cast(origin, DVec3::Z, 100.0), None);
    let down = caster.cast(origin, DVec3::NEG_Z, 100.0).unwrap();
    assert!((down - 0.8).abs() < 1e-12, "{down}");
}

#[test]
fn edge_rules() {
    let caster = Caster::new(HeightField::new(11, 11, 1.0, vec![1.0; 121]).unwrap());
    let cast = |origin, toward: DVec3| caster.cast(origin, toward.normalize(), 100.0);
    assert_eq!(cast(DVec3::new(5.0, 5.0, 0.5), DVec3::new(1.0, 0.0, 0.5)), None, "from below");
    let outside = DVec3::new(-2.0, 5.0, 2.0);
    let seen = cast(outside, DVec3::new(3.0, 0.0, -1.0)).unwrap();
    assert!((seen - 10.0f64.sqrt()).abs() < 1e-12, "from beside, onto the top: {seen}");
    assert_eq!(cast(outside, DVec3::new(1.0, 0.0, -1.0)), None, "from beside, through the cut");
    assert_eq!(cast(outside, DVec3::new(-1.0, 0.0, -1.0)), None, "away");
    assert_eq!(caster.cast(DVec3::splat(f64::NAN), DVec3::X, 9.0), None);
    assert_eq!(caster.cast(outside, DVec3::X, f64::NAN), None);
}

#[test]
fn a_raised_wall_hides_what_lies_behind() {
    let mut caster = Caster::new(HeightField::new(201, 201, 0.1, vec![0.0; 40_401]).unwrap());
    let origin = DVec3::new(5.0, 10.0, 0.8);
    let toward = DVec3::new(1.0, 0.0, -0.06).normalize();
    let before = caster.cast(origin, toward, 100.0).unwrap();
    let wall = Brush {
        centre: DVec2::new(10.0, 10.0),
        radius_m: 1.5,
        strength_m: 2.0,
        kind: crate::BrushKind::Raise,
    };
    caster.sculpt(&wall).unwrap();
    let after = caster.cast(origin, toward, 100.0).unwrap();
    assert!(before > 13.0 && after < 5.0, "{before} {after}");
}
