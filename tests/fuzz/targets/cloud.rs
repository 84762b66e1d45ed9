//! Clouds of any layout, and whether they are of the sensor.

#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use mapless::SensorModel;
use mapless_robot::cloud::{Field, PointCloud, check_view, read};

const NAMES: [&str; 8] = ["x", "y", "z", "time", "t", "timestamp", "ring", "intensity"];

#[derive(Arbitrary, Debug)]
struct Cloud {
    height: u32,
    width: u32,
    fields: Vec<(u8, u32, u8)>,
    /// Sizes that fit together, so that points are read.
    is_sound: bool,
    is_big_endian: bool,
    point_step: u32,
    row_step: u32,
    data: Vec<u8>,
    stamp_ns: i64,
}

fuzz_target!(|cloud: Cloud| {
    let Cloud {
        mut height, mut width, mut point_step, mut row_step, stamp_ns, is_big_endian, ref data, ..
    } = cloud;
    let mut fields: Vec<Field> = Vec::new();
    for &(name, offset, datatype) in &cloud.fields {
        let name = NAMES[usize::from(name) % NAMES.len()].to_owned();
        fields.push(Field { name, offset, datatype });
    }
    if cloud.is_sound {
        point_step = 12 + point_step % 40;
        height = 1 + height % 4;
        row_step = data.len() as u32 / height;
        width = row_step / point_step;
        for field in &mut fields {
            (field.offset, field.datatype) = (field.offset % (point_step - 8), 1 + field.datatype % 8);
        }
        for (index, name) in ["x", "y", "z"].into_iter().enumerate() {
            fields.push(Field { name: name.to_owned(), offset: 4 * index as u32, datatype: 7 });
        }
    }
    let cloud =
        PointCloud { height, width, fields: &fields, is_big_endian, point_step, row_step, data, stamp_ns };
    if let Ok(returns) = read(&cloud) {
        assert!(returns.points_m.len() <= data.len());
        assert!(returns.points_m.iter().all(|point| point.is_finite()));
        if let Some(times) = &returns.since_stamp_s {
            assert_eq!(times.len(), returns.points_m.len());
            assert!(times.iter().all(|time| time.is_finite()));
        }
        let _ = check_view(&returns.points_m, &SensorModel::vlp16());
    }
});
