//! PCD, the format of the Point Cloud Library.
//!
//! `pcd_rs` reads the points. It trusts the sizes in the header, so they are checked first.

use std::io::Cursor;

use glam::Vec3;
use pcd_rs::{DataKind, DynReader, DynRecord, Field, PcdMeta, ValueKind};

use crate::error::ScanFault;

/// LZF, the compression of PCD, turns three bytes into at most 264.
const MOST_COMPRESSION: usize = 88;

pub(crate) fn read(bytes: &[u8]) -> Result<Vec<Vec3>, ScanFault> {
    let mut cursor = Cursor::new(bytes);
    let meta = PcdMeta::from_reader(&mut cursor).map_err(damaged)?;
    let data = &bytes[(cursor.position() as usize).min(bytes.len())..];
    let axes = axes(&meta)?;
    check_size(&meta, data)?;
    let count = meta.num_points;
    let mut points = Vec::new();
    for (index, record) in DynReader::from_bytes(bytes).map_err(damaged)?.enumerate() {
        let place = || format!("point {} of {count}", index + 1);
        let record = record.map_err(|error| damaged(format!("{}: {error}", place())))?;
        let point = axes.map(|axis| coordinate_m(&record, axis));
        if !point.iter().all(|value| value.is_finite()) {
            continue;
        }
        for (value, axis) in point.into_iter().zip(["x", "y", "z"]) {
            if !(value as f32).is_finite() {
                return Err(ScanFault::value(format!("{}, {axis}", place()), value, "a number of metres"));
            }
        }
        points.push(Vec3::from_array(point.map(|value| value as f32)));
    }
    Ok(points)
}

fn damaged(reason: impl ToString) -> ScanFault {
    ScanFault::Damaged { format: "PCD", reason: reason.to_string() }
}

/// Indices of x, y and z in a record, which leaves out padding.
fn axes(meta: &PcdMeta) -> Result<[usize; 3], ScanFault> {
    let mut axes = [0; 3];
    for (axis, name) in axes.iter_mut().zip(["x", "y", "z"]) {
        let mut fields = meta.field_defs.iter().filter(|field| !field.is_padding()).enumerate();
        let Some((index, field)) = fields.find(|(_, field)| field.name == name) else {
            let names: Vec<&str> = meta.field_defs.iter().map(|field| field.name.as_str()).collect();
            return Err(ScanFault::value("FIELDS", names.join(" "), format!("a field {name}")));
        };
        if !(matches!(field.kind, ValueKind::F32 | ValueKind::F64) && field.count == 1) {
            let value = format!("{:?} × {}", field.kind, field.count);
            return Err(ScanFault::value(format!("field {name}"), value, "one number of type F"));
        }
        *axis = index;
    }
    Ok(axes)
}

/// Fails unless the data can hold as many points as the header says.
fn check_size(meta: &PcdMeta, data: &[u8]) -> Result<(), ScanFault> {
    let count = meta.num_points;
    let sizes = meta.field_defs.iter().map(|field| field.count.checked_mul(field.kind.byte_size() as u64));
    let record_bytes = sizes.into_iter().try_fold(0_u64, |sum, size| sum.checked_add(size?));
    let expected_bytes = record_bytes.and_then(|bytes| bytes.checked_mul(count)).ok_or_else(|| {
        ScanFault::value("POINTS", count, "a number of points whose size in bytes fits into 64 bits")
    })?;
    let too_short = |expected: String| {
        ScanFault::value(
            "POINTS",
            count,
            format!("{expected} of data for as many points, not {}", data.len()),
        )
    };
    match meta.data {
        // The shortest token is a digit and a blank.
        DataKind::Ascii => {
            let tokens: u64 = meta.field_defs.iter().map(|field| field.count).fold(0, u64::saturating_add);
            let least = tokens.saturating_mul(count).saturating_mul(2).saturating_sub(1);
            if (data.len() as u64) < least {
                return Err(too_short(format!("at least {least} bytes")));
            }
        }
        DataKind::Binary => {
            if (data.len() as u64) < expected_bytes {
                return Err(too_short(format!("{expected_bytes} bytes")));
            }
        }
        DataKind::BinaryCompressed => {
            let Some((head, packed)) = data.split_first_chunk::<8>() else {
                return Err(damaged("it ends before the sizes of its data"));
            };
            let [a, b, c, d, e, f, g, h] = *head;
            let packed_bytes = u32::from_le_bytes([a, b, c, d]) as usize;
            let unpacked_bytes = u32::from_le_bytes([e, f, g, h]);
            if packed.len() < packed_bytes {
                let expected = format!("at most {}, what the file holds", packed.len());
                return Err(ScanFault::value("compressed size", packed_bytes, expected));
            }
            if u64::from(unpacked_bytes) != expected_bytes {
                let expected = format!("{expected_bytes}, the size of {count} points");
                return Err(ScanFault::value("uncompressed size", unpacked_bytes, expected));
            }
            if unpacked_bytes as usize > packed_bytes.saturating_mul(MOST_COMPRESSION) {
                let expected = format!("at most {MOST_COMPRESSION} times the compressed {packed_bytes}");
                return Err(ScanFault::value("uncompressed size", unpacked_bytes, expected));
            }
        }
    }
    Ok(())
}

/// NaN if there is no such number.
fn coordinate_m(record: &DynRecord, index: usize) -> f64 {
    match record.0.get(index) {
        Some(Field::F32(values)) => values.first().map_or(f64::NAN, |&value| value.into()),
        Some(Field::F64(values)) => values.first().copied().unwrap_or(f64::NAN),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcd_rs::{Schema, ViewPoint, Writer, WriterInit};
    use proptest::prelude::*;

    const ASCII: &str = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\n\
        VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n1 2 3\nnan nan nan\n-4.5 5 0.25\n";
    const POINTS: [Vec3; 2] = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(-4.5, 5.0, 0.25)];

    fn fault(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    /// Points with an intensity before them.
    fn written(points: &[Vec3], data_kind: DataKind) -> Vec<u8> {
        let schema = [
            ("intensity", ValueKind::U8),
            ("x", ValueKind::F32),
            ("y", ValueKind::F64),
            ("z", ValueKind::F32),
        ];
        let mut bytes = Cursor::new(Vec::new());
        let init = WriterInit {
            width: points.len() as u64,
            height: 1,
            viewpoint: ViewPoint::default(),
            data_kind,
            schema: Some(schema.map(|(name, kind)| (name, kind, 1)).into_iter().collect::<Schema>()),
            version: None,
        };
        let mut writer: Writer<DynRecord, _> = init.build_from_writer(&mut bytes).unwrap();
        for point in points {
            let [x, y, z] = point.to_array();
            let fields = vec![
                Field::U8(vec![7]),
                Field::F32(vec![x]),
                Field::F64(vec![y.into()]),
                Field::F32(vec![z]),
            ];
            writer.push(&DynRecord(fields)).unwrap();
        }
        writer.finish().unwrap();
        bytes.into_inner()
    }

    #[test]
    fn ascii_is_read_and_beams_without_a_return_are_passed_over() {
        assert_eq!(read(ASCII.as_bytes()).unwrap(), POINTS);
    }

    #[test]
    fn faults_are_named() {
        assert!(
            fault(&ASCII.replace("FIELDS x y z", "FIELDS x y h"))
                .starts_with("FIELDS = x y h: expected a field z")
        );
        assert!(
            fault(&ASCII.replace("TYPE F F F", "TYPE F I F"))
                .starts_with("field y = I32 × 1: expected one number")
        );
        assert!(
            fault(&ASCII.replace("POINTS 3", "POINTS 4")).starts_with("not a valid PCD file: point 4 of 4: ")
        );
        assert!(
            fault(&ASCII.replace("5 0.25", "5 high"))
                .starts_with("not a valid PCD file: point 3 of 3: invalid float")
        );
        assert!(
            fault(&ASCII.replace("POINTS 3", "POINTS 99999999999"))
                .starts_with("POINTS = 99999999999: expected at least")
        );
        assert!(fault(&ASCII.replace("POINTS 3", "POINTS 18446744073709551615")).starts_with("POINTS = "));
        let padded = ASCII.replace("FIELDS x y z", "FIELDS x y z _").replace("SIZE 4 4 4", "SIZE 4 4 4 1");
        let padded = padded
            .replace("TYPE F F F", "TYPE F F F U")
            .replace("COUNT 1 1 1", "COUNT 1 1 1 9223372036854775807");
        assert!(fault(&padded).starts_with("POINTS = 3: expected"), "{}", fault(&padded));
        assert!(
            fault(&padded.replace("POINTS 3", "POINTS 1").replace("ascii", "binary"))
                .starts_with("POINTS = 1: expected")
        );
        assert!(fault("ncols 3").starts_with("not a valid PCD file: "));
        let far = ASCII.replace("SIZE 4 4 4", "SIZE 4 4 8").replace("0.25", "1e200");
        assert!(fault(&far).starts_with("point 3 of 3, z = 1"), "{}", fault(&far));
    }

    #[test]
    fn sizes_that_the_file_cannot_hold_are_refused() {
        let binary = written(&POINTS, DataKind::Binary);
        let short = read(&binary[..binary.len() - 1]).unwrap_err().to_string();
        assert_eq!(short, "POINTS = 2: expected 34 bytes of data for as many points, not 33");

        let packed = written(&[POINTS[0]; 40], DataKind::BinaryCompressed);
        let at = packed.windows(11).position(|window| window == b"compressed\n").unwrap() + 11;
        let with = |offset: usize, size: u32| {
            let mut bytes = packed.clone();
            bytes[at + offset..at + offset + 4].copy_from_slice(&size.to_le_bytes());
            read(&bytes).unwrap_err().to_string()
        };
        assert!(with(0, u32::MAX).starts_with("compressed size = 4294967295: expected at most "));
        assert_eq!(with(4, u32::MAX), "uncompressed size = 4294967295: expected 680, the size of 40 points");
        assert!(with(0, 7).starts_with("uncompressed size = 680: expected at most 88 times"));
        assert!(read(&packed[..at + 3]).unwrap_err().to_string().contains("ends before the sizes"));
    }

    proptest! {
        #[test]
        fn written_points_read_back_to_the_bit(
            points in prop::collection::vec(prop::array::uniform3(-1e6..1e6_f32), 0..40),
            kind in prop::sample::select(vec![DataKind::Ascii, DataKind::Binary, DataKind::BinaryCompressed]),
        ) {
            let points: Vec<Vec3> = points.into_iter().map(Vec3::from_array).collect();
            prop_assert_eq!(read(&written(&points, kind)).unwrap(), points);
        }

        #[test]
        fn damage_anywhere_gives_points_or_a_fault(
            kind in prop::sample::select(vec![DataKind::Ascii, DataKind::Binary, DataKind::BinaryCompressed]),
            damage in prop::collection::vec((0..1000_usize, any::<u8>()), 0..6), end in 0..1000_usize,
        ) {
            let mut bytes = written(&[POINTS[0], POINTS[1], POINTS[0], Vec3::NAN], kind);
            let length = bytes.len();
            for (at, byte) in damage {
                bytes[at % length] = byte;
            }
            bytes.truncate(end);
            if let Ok(points) = read(&bytes) {
                prop_assert!(points.iter().all(|point| point.is_finite()));
            }
        }
    }
}
