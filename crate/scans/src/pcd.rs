//! PCD, the format of the Point Cloud Library.

mod header;

use glam::DVec3;

use crate::cloud_warning::CloudWarning;
use crate::error::ScanFault;
use crate::lzf;
use crate::scan::{Scan, ScanWarning};
use crate::values::{self, AXES, shortened};
use header::{Header, Layout};

/// LZF turns three bytes into at most 264.
const MOST_COMPRESSION: usize = 88;

pub(crate) fn read(bytes: &[u8]) -> Result<Scan, ScanFault> {
    let mut warnings = Vec::new();
    let (header, data) = Header::read(bytes, &mut warnings)?;
    let mut points_m = match header.layout {
        Layout::Ascii => ascii(&header, data, &mut warnings)?,
        Layout::Binary => binary(&header, data)?,
        Layout::Compressed => compressed(&header, data)?,
    };
    header.viewpoint.apply(&mut points_m, &mut warnings);
    let points = points_m.into_iter().enumerate().filter_map(|(index, point)| {
        values::point(|| format!("point {} of {}", index + 1, header.points), point).transpose()
    });
    let points_m = points.collect::<Result<_, _>>()?;
    Ok(Scan { points_m, warnings: warnings.into_iter().map(ScanWarning::Cloud).collect() })
}

fn damaged(reason: impl Into<String>) -> ScanFault {
    ScanFault::Damaged { format: "PCD", reason: reason.into() }
}

/// One point a line.
fn ascii(header: &Header, data: &[u8], warnings: &mut Vec<CloudWarning>) -> Result<Vec<DVec3>, ScanFault> {
    let text = String::from_utf8_lossy(data);
    let mut points_m = Vec::new();
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    for (index, line) in lines.by_ref().take(header.points) {
        let number = header.lines + index + 1;
        let values: Vec<&str> = line.split_whitespace().collect();
        if values.len() != header.values {
            let expected = format!("{} values, those of a point", header.values);
            return Err(ScanFault::value(format!("line {number}"), shortened(line), expected));
        }
        let mut point = DVec3::NAN;
        for (axis, place) in header.xyz.iter().enumerate() {
            let value = values[place.values];
            point[axis] = value.parse().map_err(|_| {
                let place = format!("line {number}, {}", AXES[axis]);
                ScanFault::value(place, shortened(value), "a number of metres")
            })?;
        }
        points_m.push(point);
    }
    if points_m.len() < header.points {
        let expected = format!("{}, the number of lines of data", points_m.len());
        return Err(ScanFault::value("POINTS", header.points, expected));
    }
    let more = lines.count();
    if more > 0 {
        let said = header.points + more;
        warnings.push(CloudWarning::Count {
            place: "the number of lines".to_owned(),
            said,
            read: header.points,
        });
    }
    Ok(points_m)
}

/// One record a point.
fn binary(header: &Header, data: &[u8]) -> Result<Vec<DVec3>, ScanFault> {
    let expected_bytes = data_bytes(header)?;
    let Some(data) = data.get(..expected_bytes) else {
        let expected = format!("{expected_bytes} bytes of data for as many points, not {}", data.len());
        return Err(ScanFault::value("POINTS", header.points, expected));
    };
    let records = data.chunks_exact(header.record_bytes);
    Ok(records.map(|record| coordinates(header, |axis| record.get(header.xyz[axis].start..))).collect())
}

/// Compressed, one field of all points after the other.
fn compressed(header: &Header, data: &[u8]) -> Result<Vec<DVec3>, ScanFault> {
    let expected_bytes = data_bytes(header)?;
    if expected_bytes == 0 {
        return Ok(Vec::new());
    }
    let Some((&[a, b, c, d, e, f, g, h], packed)) = data.split_first_chunk::<8>() else {
        return Err(damaged("it ends before the sizes of its data"));
    };
    let packed_bytes = u32::from_le_bytes([a, b, c, d]) as usize;
    let unpacked_bytes = u32::from_le_bytes([e, f, g, h]) as usize;
    let Some(packed) = packed.get(..packed_bytes) else {
        let expected = format!("at most {}, what the file holds", packed.len());
        return Err(ScanFault::value("compressed size", packed_bytes, expected));
    };
    if unpacked_bytes != expected_bytes {
        let expected = format!("{expected_bytes}, the size of {} points", header.points);
        return Err(ScanFault::value("uncompressed size", unpacked_bytes, expected));
    }
    if unpacked_bytes > packed_bytes.saturating_mul(MOST_COMPRESSION) {
        let expected = format!("at most {MOST_COMPRESSION} times the compressed {packed_bytes}");
        return Err(ScanFault::value("uncompressed size", unpacked_bytes, expected));
    }
    let data = match lzf::unpacked(packed, unpacked_bytes) {
        Some(data) => data,
        // What cannot be compressed is stored.
        None if packed_bytes == unpacked_bytes => packed.to_vec(),
        None => return Err(damaged("its data cannot be unpacked: they are not LZF of their size")),
    };
    let point = |index: usize| {
        coordinates(header, |axis| {
            let axis = header.xyz[axis];
            data.get(axis.start * header.points + axis.number.size() * index..)
        })
    };
    Ok((0..header.points).map(point).collect())
}

/// Size of all points in bytes.
fn data_bytes(header: &Header) -> Result<usize, ScanFault> {
    header.record_bytes.checked_mul(header.points).ok_or_else(|| {
        ScanFault::value("POINTS", header.points, "a number of points whose size in bytes can be counted")
    })
}

/// The coordinates that begin where `bytes` says of each axis.
fn coordinates<'a>(header: &Header, bytes: impl Fn(usize) -> Option<&'a [u8]>) -> DVec3 {
    let coordinate = |axis: usize| header.xyz[axis].number.read(bytes(axis)?, false);
    DVec3::from_array([0, 1, 2].map(|axis| coordinate(axis).unwrap_or(f64::NAN)))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use glam::Vec3;

    use super::*;
    use pcd_rs::{DataKind, DynRecord, Field, Schema, ValueKind, ViewPoint, Writer, WriterInit};
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
        assert_eq!(read(ASCII.as_bytes()).unwrap().points_m, POINTS);
    }

    #[test]
    fn faults_are_named() {
        let with = |from: &str, to: &str| fault(&ASCII.replace(from, to));
        assert_eq!(with("FIELDS x y z", "FIELDS x y h"), "FIELDS = x y h: expected x, y and z among them");
        assert_eq!(
            with("SIZE 4 4 4", "SIZE 4 2 4"),
            "field y = F of 2 bytes × 1: expected a number of type I or U, or of type F and 4 or 8 bytes"
        );
        assert_eq!(with("COUNT 1 1 1", "COUNT 1 0 1"), "field y = F of 4 bytes × 0: expected one number");
        assert_eq!(with("SIZE 4 4 4", "SIZE 4 4 four"), "SIZE = four: expected numbers");
        assert_eq!(
            with("SIZE 4 4 4", "SIZE 4 4"),
            "number of values of SIZE = 2: expected 3, one for each of the FIELDS"
        );
        assert_eq!(with("ascii", "zip"), "DATA = zip: expected ascii, binary or binary_compressed");
        assert_eq!(with("POINTS 3", "POINTS 4"), "POINTS = 4: expected 3, the number of lines of data");
        assert_eq!(with("5 0.25", "5 high"), "line 14, z = high: expected a number of metres");
        assert_eq!(with("5 0.25", "5"), "line 14 = -4.5 5: expected 3 values, those of a point");
        assert_eq!(with("5 0.25", "1e200 0.25").split(" = ").next(), Some("point 3 of 3, y"));
        assert!(with("POINTS 3", "POINTS 99999999999").starts_with("POINTS = 99999999999: expected 3"));
        let padded = ASCII
            .replace("FIELDS x y z", "FIELDS x y z _")
            .replace("SIZE 4 4 4", "SIZE 4 4 4 1")
            .replace("TYPE F F F", "TYPE F F F U")
            .replace("COUNT 1 1 1", "COUNT 1 1 1 9223372036854775807");
        assert!(fault(&padded).starts_with("line 12 = 1 2 3: expected 922"), "{}", fault(&padded));
        let binary = padded.replace("ascii", "binary");
        assert!(fault(&binary).starts_with("POINTS = 3: expected"), "{}", fault(&binary));
        assert_eq!(fault("ncols 3"), "not a valid PCD file: it has no DATA entry");
    }

    #[test]
    fn fields_without_values_take_no_bytes() {
        let header = ASCII
            .replace("FIELDS x y z", "FIELDS _ x y ring _ z _")
            .replace("SIZE 4 4 4", "SIZE 1 4 4 2 1 4 1")
            .replace("TYPE F F F", "TYPE U F F U U F U")
            .replace("COUNT 1 1 1", "COUNT 3 1 1 0 2 1 0");
        let text = header.replace("1 2 3\n", "0 0 0 1 2 7 7 3\n");
        let text = text
            .replace("nan nan nan", "0 0 0 nan nan 7 7 nan")
            .replace("-4.5 5 0.25", "0 0 0 -4.5 5 0 0 0.25");
        assert_eq!(read(text.as_bytes()).unwrap().points_m, POINTS);
        let head = header[..header.find("ascii").unwrap()].replace("POINTS 3", "POINTS 2").into_bytes();
        let mut bytes = [&head, b"binary\n".as_slice()].concat();
        for point in POINTS {
            bytes.extend([0; 3]);
            bytes.extend([point.x.to_le_bytes(), point.y.to_le_bytes()].concat());
            bytes.extend([7; 2]);
            bytes.extend(point.z.to_le_bytes());
        }
        assert_eq!(read(&bytes).unwrap().points_m, POINTS);
    }

    #[test]
    fn numbers_of_any_type_and_old_headers_are_read() {
        let text =
            "VERSION .5\nCOLUMNS X Y Z\nSIZE 8 2 4\nTYPE F I U\nWIDTH 2\nDATA ascii\n1 2 3\n-4.5 5 0\n";
        assert_eq!(read(text.as_bytes()).unwrap().points_m, [POINTS[0], Vec3::new(-4.5, 5.0, 0.0)]);
        let mut binary =
            text[..text.find("ascii").unwrap()].replace("WIDTH 2", "WIDTH 2\nHEIGHT 1").into_bytes();
        binary.extend(b"binary\r\n");
        for (x, y, z) in [(1.0_f64, 2_i16, 3_u32), (-4.5, -5, 0)] {
            binary.extend([x.to_le_bytes().as_slice(), &y.to_le_bytes(), &z.to_le_bytes()].concat());
        }
        assert_eq!(read(&binary).unwrap().points_m, [POINTS[0], Vec3::new(-4.5, -5.0, 0.0)]);
    }

    #[test]
    fn organised_clouds_are_read() {
        let text = ASCII.replace("WIDTH 3\nHEIGHT 1", "WIDTH 1\nHEIGHT 3");
        assert_eq!(read(text.as_bytes()).unwrap().points_m, POINTS);
        assert_eq!(read(text.replace("POINTS 3\n", "").as_bytes()).unwrap().points_m, POINTS);
    }

    #[test]
    fn numbers_of_points_that_do_not_agree_are_warned_of() {
        let warned = |from: &str, to: &str| {
            let scan = read(ASCII.replace(from, to).as_bytes()).unwrap();
            (scan.points_m.len(), scan.warnings.iter().map(ToString::to_string).collect::<Vec<_>>())
        };
        assert_eq!(warned("", ""), (2, Vec::new()));
        let (points, warnings) = warned("WIDTH 3", "WIDTH 5");
        assert_eq!(
            (points, warnings),
            (2, vec!["WIDTH × HEIGHT says 5 points; the 3 that are there were read".to_owned()])
        );
        assert_eq!(warned("POINTS 3", "POINTS 1").1.len(), 2);
    }

    #[test]
    fn the_viewpoint_is_applied() {
        let half = 0.5_f64.sqrt();
        let viewpoint = format!("VIEWPOINT 10 0 2 {half} 0 0 {half}");
        let text = ASCII.replace("VIEWPOINT 0 0 0 1 0 0 0", &viewpoint).replace("nan nan nan", "10 3 2.5");
        let scan = read(text.as_bytes()).unwrap();
        assert!(scan.points_m[1].distance(Vec3::new(3.0, 0.0, 0.5)) < 1e-6, "{:?}", scan.points_m);
        assert_eq!(scan.warnings, [ScanWarning::Cloud(CloudWarning::Viewpoint)]);
    }

    #[test]
    fn stored_data_are_read() {
        let head = ASCII[..ASCII.find("ascii").unwrap()]
            .replace("POINTS 3", "POINTS 2")
            .replace("WIDTH 3", "WIDTH 2");
        let mut bytes = (head + "binary_compressed\n").into_bytes();
        bytes.extend([24, 0, 0, 0, 24, 0, 0, 0]);
        for axis in 0..3 {
            bytes.extend(POINTS.iter().flat_map(|point| point[axis].to_le_bytes()));
        }
        assert_eq!(read(&bytes).unwrap().points_m, POINTS);
        let at = bytes.len() - 32;
        bytes[at] = 23;
        assert!(read(&bytes).unwrap_err().to_string().contains("cannot be unpacked"));
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
            prop_assert_eq!(read(&written(&points, kind)).unwrap().points_m, points);
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
            if let Ok(scan) = read(&bytes) {
                prop_assert!(scan.points_m.iter().all(|point| point.is_finite()));
            }
        }
    }
}
