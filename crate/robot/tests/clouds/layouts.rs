//! Clouds as the drivers of sensors write them, and what is read of them.

use mapless::glam::Vec3;
use mapless_robot::cloud::{CloudWarning, Field, PointCloud, Returns, read};

pub(crate) const STAMP_NS: i64 = 1_700_000_000_123_456_789;

/// A point with everything that a driver may write of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    /// NaN without a return.
    pub(crate) point_m: Vec3,
    pub(crate) ring: u16,
    /// Since the stamp.
    pub(crate) since_s: f64,
}

/// How a driver lays out its cloud.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(crate) name: &'static str,
    /// Name, offset and datatype of each coordinate, and of the other fields.
    axes: [(&'static str, u32, u8); 3],
    more: &'static [(&'static str, u32, u8)],
    pub(crate) step: usize,
    is_big_endian: bool,
    /// Rows with padding, and NaN for missing returns.
    pub(crate) is_organised: bool,
    /// The unit of times, seconds, and whether they are since 1970.
    unit_s: f64,
    is_absolute: bool,
}

const PLAIN: Layout = Layout {
    name: "",
    axes: [("x", 0, 7), ("y", 4, 7), ("z", 8, 7)],
    more: &[],
    step: 0,
    is_big_endian: false,
    is_organised: false,
    unit_s: 1.0,
    is_absolute: false,
};

pub(crate) const LAYOUTS: [Layout; 10] = [
    Layout {
        name: "velodyne, 22 bytes",
        more: &[("intensity", 12, 7), ("ring", 16, 4), ("time", 18, 7)],
        step: 22,
        ..PLAIN
    },
    Layout {
        name: "velodyne, 18 bytes, no time",
        more: &[("intensity", 12, 7), ("ring", 16, 4)],
        step: 18,
        ..PLAIN
    },
    Layout {
        name: "velodyne, 32 bytes",
        more: &[("intensity", 16, 7), ("ring", 20, 4), ("time", 24, 7)],
        step: 32,
        ..PLAIN
    },
    Layout { name: "x y z alone", step: 12, ..PLAIN },
    Layout {
        name: "ouster, organised",
        more: &[("intensity", 16, 7), ("t", 20, 6), ("ring", 26, 4)],
        step: 48,
        is_organised: true,
        unit_s: 1e-9,
        ..PLAIN
    },
    Layout {
        name: "hesai, seconds since 1970",
        more: &[("timestamp", 16, 8), ("ring", 24, 4)],
        step: 26,
        is_absolute: true,
        ..PLAIN
    },
    Layout {
        name: "robosense, organised, seconds since 1970",
        more: &[("intensity", 12, 7), ("ring", 16, 4), ("timestamp", 18, 8)],
        step: 26,
        is_organised: true,
        is_absolute: true,
        ..PLAIN
    },
    Layout {
        name: "livox, nanoseconds since 1970",
        more: &[("tag", 16, 2), ("line", 17, 2), ("timestamp", 18, 8)],
        step: 26,
        unit_s: 1e-9,
        is_absolute: true,
        ..PLAIN
    },
    Layout {
        name: "big-endian f64 in another order, milliseconds",
        axes: [("x", 24, 8), ("Y", 16, 8), ("z", 8, 8)],
        more: &[("time", 0, 7)],
        step: 40,
        is_big_endian: true,
        unit_s: 1e-3,
        ..PLAIN
    },
    Layout { name: "microseconds, i32", more: &[("offset_time", 12, 5)], step: 16, unit_s: 1e-6, ..PLAIN },
];

impl Layout {
    pub(crate) fn has_times(&self) -> bool {
        self.more.iter().any(|(name, ..)| name.contains("time") || *name == "t")
    }

    pub(crate) fn fields(&self) -> Vec<Field> {
        let field =
            |&(name, offset, datatype): &(&str, u32, u8)| Field { name: name.to_owned(), offset, datatype };
        self.axes.iter().chain(self.more).map(field).collect()
    }

    /// The bytes of points in columns of `rings`; with their height, width and row step.
    pub(crate) fn write(&self, points: &[Point], rings: usize) -> (Vec<u8>, [u32; 3]) {
        let kept: Vec<&Point> =
            points.iter().filter(|point| self.is_organised || point.point_m.is_finite()).collect();
        let (height, width) = if self.is_organised { (rings, points.len() / rings) } else { (1, kept.len()) };
        let padding = if self.is_organised { 8 } else { 0 };
        let mut data = Vec::new();
        for row in 0..height {
            for column in 0..width {
                let point = if self.is_organised { &points[column * rings + row] } else { kept[column] };
                data.extend(self.bytes(point));
            }
            data.extend(vec![0xab; padding]);
        }
        let row_step = width * self.step + padding;
        (data, [height, width, row_step].map(|size| size as u32))
    }

    fn bytes(&self, point: &Point) -> Vec<u8> {
        // What belongs to no field may be anything.
        let mut bytes = vec![0xcd; self.step];
        for &(name, offset, datatype) in self.axes.iter().chain(self.more) {
            let begin_s = if self.is_absolute { STAMP_NS as f64 * 1e-9 } else { 0.0 };
            let value = match name.to_ascii_lowercase().as_str() {
                "x" => f64::from(point.point_m.x),
                "y" => f64::from(point.point_m.y),
                "z" => f64::from(point.point_m.z),
                "ring" | "line" => f64::from(point.ring),
                "intensity" | "tag" => 7.0,
                _ => (begin_s + point.since_s) / self.unit_s,
            };
            let mut number = match datatype {
                2 => (value as u8).to_le_bytes().to_vec(),
                4 => (value as u16).to_le_bytes().to_vec(),
                5 => (value as i32).to_le_bytes().to_vec(),
                6 => (value as u32).to_le_bytes().to_vec(),
                7 => (value as f32).to_le_bytes().to_vec(),
                _ => value.to_le_bytes().to_vec(),
            };
            if self.is_big_endian {
                number.reverse();
            }
            bytes[offset as usize..][..number.len()].copy_from_slice(&number);
        }
        bytes
    }

    pub(crate) fn read(&self, points: &[Point], rings: usize) -> Returns {
        let (data, [height, width, row_step]) = self.write(points, rings);
        let fields = self.fields();
        let cloud = PointCloud {
            height,
            width,
            fields: &fields,
            is_big_endian: self.is_big_endian,
            point_step: self.step as u32,
            row_step,
            data: &data,
            stamp_ns: STAMP_NS,
        };
        read(&cloud).unwrap()
    }
}

/// Four rings and fifty columns in 0.1 s; every seventh beam has no return.
pub(crate) fn points() -> Vec<Point> {
    let point = |index: usize| {
        let (column, ring) = (index / 4, index % 4);
        let range_m = if index.is_multiple_of(7) { f32::NAN } else { 2.0 + index as f32 / 16.0 };
        let (sin, cos) = (column as f32 / 8.0).sin_cos();
        let point_m = range_m * Vec3::new(cos, sin, -0.1 * ring as f32);
        Point { point_m, ring: ring as u16, since_s: 0.002 * column as f64 }
    };
    (0..200).map(point).collect()
}

#[test]
fn every_layout_gives_the_same_returns_and_times() {
    let points = points();
    for layout in LAYOUTS {
        let found = layout.read(&points, 4);
        let returns: Vec<&Point> = points.iter().filter(|point| point.point_m.is_finite()).collect();
        let mut expected: Vec<(Vec3, f64)> =
            returns.iter().map(|point| (point.point_m, point.since_s)).collect();
        if layout.is_organised {
            // Ring by ring.
            let by_ring = |ring| returns.iter().filter(move |point| point.ring == ring);
            expected = (0..4).flat_map(by_ring).map(|point| (point.point_m, point.since_s)).collect();
        }
        assert_eq!(
            found.points_m,
            expected.iter().map(|(point_m, _)| *point_m).collect::<Vec<_>>(),
            "{}",
            layout.name
        );
        assert_eq!(found.since_stamp_s.is_some(), layout.has_times(), "{}", layout.name);
        assert_eq!(found.warnings, [], "{}", layout.name);
        for (found, (_, since_s)) in found.since_stamp_s.iter().flatten().zip(&expected) {
            // f64 holds seconds since 1970 to 0.24 µs.
            assert!((found - since_s).abs() < 1.1e-6, "{}: {found} {since_s}", layout.name);
        }
    }
}

#[test]
fn zeros_are_no_returns_and_an_empty_cloud_is_no_error() {
    let mut points = points();
    points.iter_mut().filter(|point| point.point_m.is_nan()).for_each(|point| point.point_m = Vec3::ZERO);
    assert_eq!(LAYOUTS[0].read(&points, 4).points_m.len(), 171);
    let empty = LAYOUTS[0].read(&[], 4);
    assert_eq!((empty.points_m.len(), empty.since_stamp_s, empty.warnings.len()), (0, None, 0));
}

#[test]
fn times_before_the_stamp_are_kept() {
    let mut points = points();
    points.iter_mut().for_each(|point| point.since_s -= 0.1);
    let found = LAYOUTS[0].read(&points, 4).since_stamp_s.unwrap();
    assert!((found[0] + 0.1).abs() < 1e-6, "{}", found[0]);
}

#[test]
fn times_of_another_clock_begin_at_the_stamp_with_a_warning() {
    let mut points = points();
    points.iter_mut().for_each(|point| point.since_s += 1674.0);
    let found = LAYOUTS[5].read(&points, 4);
    let (first_s, last_s) =
        (found.since_stamp_s.as_ref().unwrap()[0], *found.since_stamp_s.as_ref().unwrap().last().unwrap());
    assert!(first_s.abs() < 1e-6 && (last_s - 0.098).abs() < 1e-6, "{first_s} {last_s}");
    let [warning] = found.warnings.as_slice() else { panic!("{:?}", found.warnings) };
    assert!(warning.to_string().starts_with("field timestamp is 1674.000 s off the stamp"), "{warning}");
}

#[test]
fn times_that_are_all_one_are_none() {
    let mut points = points();
    points.iter_mut().for_each(|point| point.since_s = 0.0);
    let found = LAYOUTS[0].read(&points, 4);
    assert_eq!(found.since_stamp_s, None);
    assert_eq!(found.warnings, [CloudWarning::Times { name: "time".to_owned(), spread: 0.0 }]);
}
