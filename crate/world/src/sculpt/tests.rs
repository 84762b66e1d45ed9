//! Every brush: what it does where, and what it never does.

use super::*;
use proptest::prelude::*;

fn flat() -> HeightField {
    HeightField::new(21, 21, 0.5, vec![0.0; 441]).unwrap()
}

fn brush(kind: BrushKind) -> Brush {
    Brush { centre: DVec2::new(5.0, 5.0), radius_m: 2.0, strength_m: 0.5, kind }
}

#[test]
fn raising_lifts_the_centre_by_the_strength_and_nothing_beyond_the_radius() {
    let mut field = flat();
    let rect = field.sculpt(&brush(BrushKind::Raise)).unwrap().unwrap();
    assert_eq!(field.height_m(DVec2::new(5.0, 5.0)), Some(0.5));
    for row in 0..21 {
        for column in 0..21 {
            let away = (DVec2::new(column as f64, row as f64) * 0.5).distance(DVec2::new(5.0, 5.0));
            let height = field.heights_m()[row * 21 + column];
            assert_eq!(height > 0.0, away < 2.0, "{column}, {row}: {height}");
            let inside = (rect.column_begin..rect.column_end).contains(&column)
                && (rect.row_begin..rect.row_end).contains(&row);
            assert!(inside || height == 0.0);
        }
    }
    field.sculpt(&brush(BrushKind::Lower)).unwrap();
    assert!(field.heights_m().iter().all(|h| h.abs() < 1e-6), "lowering undoes raising");
}

#[test]
fn smoothing_levels_a_spike() {
    let mut field = flat();
    field.heights_mut()[10 * 21 + 10] = 3.0;
    for _ in 0..100 {
        field.sculpt(&brush(BrushKind::Smooth)).unwrap();
    }
    assert!(field.height_range_m().1 < 0.3, "{:?}", field.height_range_m());
}

#[test]
fn bad_brushes_are_refused() {
    let mut field = flat();
    let good = brush(BrushKind::Raise);
    for bad in [
        Brush { radius_m: 0.0, ..good },
        Brush { radius_m: f64::NAN, ..good },
        Brush { strength_m: -1.0, ..good },
        Brush { centre: DVec2::new(f64::INFINITY, 0.0), ..good },
    ] {
        assert!(field.sculpt(&bad).is_err(), "{bad:?}");
    }
    let away = Brush { centre: DVec2::new(-10.0, 5.0), ..good };
    assert_eq!(field.sculpt(&away), Ok(None));
    assert_eq!(field, flat());
}

fn height_at(field: &HeightField, x: f64, y: f64) -> f64 {
    field.height_m(DVec2::new(x, y)).unwrap()
}

/// Rough ground, the same each time.
fn hills() -> HeightField {
    let heights_m = (0..41 * 31).map(|i| ((i * 7919) % 97) as f32 / 60.0).collect();
    HeightField::new(41, 31, 0.25, heights_m).unwrap()
}

#[test]
fn levelling_reaches_the_height_and_stays_there() {
    let mut field = hills();
    for _ in 0..60 {
        field.sculpt(&brush(BrushKind::Level { height_m: 0.75 })).unwrap();
    }
    assert_eq!(height_at(&field, 5.0, 5.0), 0.75);
    assert!((height_at(&field, 5.75, 5.0) - 0.75).abs() < 1e-6);
}

#[test]
fn a_ramp_joins_the_heights_of_its_ends_with_an_even_slope() {
    let mut field = flat();
    let raised = Brush { centre: DVec2::new(8.0, 5.0), radius_m: 1.0, ..brush(BrushKind::Raise) };
    for _ in 0..4 {
        field.sculpt(&raised).unwrap();
    }
    let ramp = Brush { strength_m: 100.0, ..brush(BrushKind::Ramp { to: DVec2::new(8.0, 5.0) }) };
    field.sculpt(&Brush { centre: DVec2::new(2.0, 5.0), ..ramp }).unwrap();
    for (x, expected) in [(2.0, 0.0), (3.5, 0.5), (5.0, 1.0), (6.5, 1.5), (8.0, 2.0)] {
        for y in [4.0, 5.0, 6.0] {
            assert!((height_at(&field, x, y) - expected).abs() < 1e-6, "({x}, {y})");
        }
    }
    assert_eq!(height_at(&field, 5.0, 7.0), 0.0);
}

#[test]
fn a_ditch_is_as_deep_as_its_strength_all_along() {
    let mut field = flat();
    let ditch = brush(BrushKind::Ditch { to: DVec2::new(8.0, 5.0) });
    field.sculpt(&Brush { centre: DVec2::new(2.0, 5.0), ..ditch }).unwrap();
    for x in [2.0, 4.0, 6.0, 8.0] {
        assert_eq!(height_at(&field, x, 5.0), -0.5, "{x}");
        assert_eq!(height_at(&field, x, 7.0), 0.0, "{x}");
    }
}

#[test]
fn a_crater_has_a_bowl_and_a_rim_and_a_boulder_a_top() {
    let mut field = flat();
    field.sculpt(&Brush { radius_m: 2.5, ..brush(BrushKind::Crater) }).unwrap();
    assert_eq!(height_at(&field, 5.0, 5.0), -0.5);
    assert!((height_at(&field, 6.5, 5.0) - 0.125).abs() < 1e-6, "{}", height_at(&field, 6.5, 5.0));
    let mut field = flat();
    field.sculpt(&brush(BrushKind::Boulder)).unwrap();
    assert_eq!(height_at(&field, 5.0, 5.0), 0.5);
    assert!(height_at(&field, 6.5, 5.0) > 0.3);
}

#[test]
fn another_seed_gives_other_bumps() {
    let roughened = |seed| {
        let mut field = flat();
        field.sculpt(&Brush { radius_m: 4.0, ..brush(BrushKind::Roughen { seed }) }).unwrap();
        field
    };
    assert_eq!(roughened(1), roughened(1));
    assert_ne!(roughened(1), roughened(2));
    assert!(roughened(1).height_range_m().0 < -0.02 && roughened(1).height_range_m().1 > 0.02);
}

#[test]
fn heights_are_put_back_and_only_where_they_fit() {
    let (before, mut field) = (hills(), hills());
    let rect = field.sculpt(&brush(BrushKind::Raise)).unwrap().unwrap();
    assert_ne!(field, before);
    let lines = before.heights_m().chunks_exact(41).skip(rect.row_begin).take(rect.row_end - rect.row_begin);
    let old: Vec<f32> = lines.flat_map(|line| &line[rect.column_begin..rect.column_end]).copied().collect();
    assert!(field.replace(rect, &old[1..]).is_err());
    assert!(field.replace(SampleRect { column_end: 42, ..rect }, &old).is_err());
    assert!(field.replace(SampleRect { row_end: rect.row_begin, ..rect }, &[]).is_err());
    let hole: Vec<f32> = old.iter().map(|_| f32::NAN).collect();
    assert!(matches!(field.replace(rect, &hole), Err(FieldError::Height { column, row, .. })
        if (column, row) == (rect.column_begin, rect.row_begin)));
    field.replace(rect, &old).unwrap();
    assert_eq!(field, before);
}

fn any_kind() -> impl Strategy<Value = BrushKind> {
    let to = || (-3.0..13.0f64, -3.0..11.0f64).prop_map(|(x, y)| DVec2::new(x, y));
    prop_oneof![
        Just(BrushKind::Raise),
        Just(BrushKind::Lower),
        Just(BrushKind::Smooth),
        (-50.0..50.0f64).prop_map(|height_m| BrushKind::Level { height_m }),
        any::<u64>().prop_map(|seed| BrushKind::Roughen { seed }),
        Just(BrushKind::Crater),
        Just(BrushKind::Boulder),
        to().prop_map(|to| BrushKind::Ramp { to }),
        to().prop_map(|to| BrushKind::Ditch { to }),
    ]
}

proptest! {
    #[test]
    fn no_height_changes_by_more_than_the_strength_or_beyond_the_radius(
        x in -3.0..13.0f64, y in -3.0..11.0f64, radius_m in 0.1..6.0f64, strength_m in 0.0..3.0f64, kind in any_kind(),
    ) {
        let (before, mut field) = (hills(), hills());
        let brush = Brush { centre: DVec2::new(x, y), radius_m, strength_m, kind };
        let rect = field.sculpt(&brush).unwrap();
        for row in 0..31 {
            for column in 0..41 {
                let change = f64::from(field.heights_m()[row * 41 + column] - before.heights_m()[row * 41 + column]);
                prop_assert!(change.abs() <= strength_m + 1e-5, "{change}");
                let (_, radii) = brush.nearest(DVec2::new(column as f64, row as f64) * 0.25);
                prop_assert!(radii < 1.0 || change == 0.0);
                let inside = rect.is_some_and(|rect| (rect.column_begin..rect.column_end).contains(&column)
                    && (rect.row_begin..rect.row_end).contains(&row));
                prop_assert!(inside || change == 0.0);
            }
        }
    }

    #[test]
    fn ground_stays_finite(
        x in -1e6..1e6f64, y in -1e6..1e6f64, radius_m in 0.001..1e9f64, strength_m in 0.0..100.0f64,
        kind in any_kind(), near in any::<bool>(),
    ) {
        let mut field = HeightField::new(9, 7, 0.5, (0..63).map(|i| HEIGHT_LIMIT_M - i as f32).collect()).unwrap();
        let centre = if near { DVec2::new(x, y) / 1e6 * 4.0 } else { DVec2::new(x, y) };
        field.sculpt(&Brush { centre, radius_m, strength_m, kind }).unwrap();
        let heights = field.heights_m().to_vec();
        prop_assert!(HeightField::new(9, 7, 0.5, heights).is_ok());
    }
}
