//! Clouds that contradict themselves.

use mapless_robot::cloud::{Field, PointCloud, read};
use proptest::prelude::*;

use crate::layouts::{LAYOUTS, points};

/// The message of a cloud of the first layout, organised in 4 rows, that `damage` changes.
fn fault(damage: impl Fn(&mut PointCloud<'_>)) -> String {
    let data = vec![0; 4 * 10 * 22];
    let fields = LAYOUTS[0].fields();
    let mut cloud = PointCloud {
        height: 4,
        width: 10,
        fields: &fields,
        is_big_endian: false,
        point_step: 22,
        row_step: 220,
        data: &data,
        stamp_ns: 0,
    };
    damage(&mut cloud);
    match read(&cloud) {
        Ok(returns) => returns.warnings.first().map(ToString::to_string).unwrap_or_default(),
        Err(error) => error.to_string(),
    }
}

fn field(name: &str, offset: u32, datatype: u8) -> Field {
    Field { name: name.to_owned(), offset, datatype }
}

#[test]
fn every_contradiction_has_its_message() {
    assert_eq!(fault(|_| {}), "");
    assert_eq!(
        fault(|cloud| cloud.point_step = 0),
        "point_step = 0: expected the length of a point in bytes"
    );
    assert_eq!(
        fault(|cloud| cloud.point_step = 20),
        "field time.offset = 18: expected its 4 bytes within the point_step of 20"
    );
    assert_eq!(
        fault(|cloud| cloud.row_step = 200),
        "row_step = 200: expected at least 220, a row of 10 points of 22 bytes"
    );
    assert_eq!(
        fault(|cloud| cloud.data = &cloud.data[..879]),
        "data has 879 bytes: expected at least 880 for 4 rows of 10 points"
    );
    assert_eq!(fault(|cloud| cloud.fields = &cloud.fields[..2]), "fields = [x, y]: expected one named z");
    for (bad, message) in [
        (field("x", 0, 9), "field x.datatype = 9: expected 1 to 8 (INT8 to FLOAT64)"),
        (
            field("x", u32::MAX, 7),
            "field x.offset = 4294967295: expected its 4 bytes within the point_step of 22",
        ),
    ] {
        let fields = [bad, field("y", 4, 7), field("z", 8, 7)];
        let data = [0; 22];
        let cloud = PointCloud {
            height: 1,
            width: 1,
            fields: &fields,
            is_big_endian: false,
            point_step: 22,
            row_step: 22,
            data: &data,
            stamp_ns: 0,
        };
        assert_eq!(read(&cloud).unwrap_err().to_string(), message);
    }
    assert_eq!(
        fault(|cloud| (cloud.height, cloud.width) = (u32::MAX, u32::MAX)),
        "row_step = 220: expected at least 94489280490, a row of 4294967295 points of 22 bytes"
    );
    let warning = "row_step = 7: the only row has 220 bytes; that was taken";
    assert_eq!(fault(|cloud| (cloud.height, cloud.row_step) = (1, 7)), warning);
    assert_eq!(fault(|cloud| cloud.height = 3), "data has 220 bytes after the last point: left out");
}

proptest! {
    #[test]
    fn any_cloud_gives_finite_points_or_an_error(
        sizes in prop::array::uniform4(prop_oneof![0..40_u32, any::<u32>()]),
        fields in prop::collection::vec((0..5_usize, prop_oneof![0..40_u32, any::<u32>()], 0..10_u8), 0..6),
        data in prop::collection::vec(any::<u8>(), 0..2000),
        is_big_endian in any::<bool>(), stamp_ns in any::<i64>(),
    ) {
        let names = ["x", "y", "z", "time", "ring"];
        let fields: Vec<Field> =
            fields.iter().map(|&(name, offset, datatype)| field(names[name], offset, datatype)).collect();
        let [height, width, point_step, row_step] = sizes;
        let cloud =
            PointCloud { height, width, fields: &fields, is_big_endian, point_step, row_step, data: &data, stamp_ns };
        if let Ok(returns) = read(&cloud) {
            prop_assert!(returns.points_m.len() <= data.len());
            prop_assert!(returns.points_m.iter().all(|point_m| point_m.is_finite()));
            if let Some(times) = &returns.since_stamp_s {
                prop_assert_eq!(times.len(), returns.points_m.len());
                prop_assert!(times.iter().all(|time| time.is_finite()));
            }
        }
    }

    #[test]
    fn a_cloud_that_is_cut_anywhere_is_an_error(layout in 0..LAYOUTS.len(), cut in 1..3000_usize) {
        let (data, [height, width, row_step]) = LAYOUTS[layout].write(&points(), 4);
        let fields = LAYOUTS[layout].fields();
        // A last row may lack its padding.
        let padding = if height > 1 { 8 } else { 0 };
        let left = data.len().saturating_sub(cut + padding);
        let cloud = PointCloud {
            height, width, fields: &fields, is_big_endian: false, point_step: LAYOUTS[layout].step as u32, row_step,
            data: &data[..left], stamp_ns: 0,
        };
        prop_assert!(read(&cloud).unwrap_err().to_string().starts_with("data has "));
    }
}
