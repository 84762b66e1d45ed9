//! PLY, the polygon file format: the element `vertex` of it.

mod header;

use glam::{DVec3, Vec3};

use crate::error::ScanFault;
use crate::scan::Scan;
use crate::values::{self, AXES, shortened};
use header::{Element, Header, Layout};

pub(crate) fn read(bytes: &[u8]) -> Result<Scan, ScanFault> {
    let (header, data) = Header::read(bytes)?;
    let Some(at) = header.elements.iter().position(|element| element.name == "vertex") else {
        let names: Vec<&str> = header.elements.iter().map(|element| element.name.as_str()).collect();
        return Err(ScanFault::value("elements", shortened(&names.join(" ")), "vertex among them"));
    };
    let (before, vertices) = (&header.elements[..at], &header.elements[at]);
    let xyz = axes(vertices)?;
    match header.layout {
        Layout::Ascii => ascii(&header, data, before, vertices, xyz),
        Layout::Binary { big_endian } => binary(data, big_endian, before, vertices, xyz),
    }
    .map(Scan::from)
}

fn damaged(reason: impl Into<String>) -> ScanFault {
    ScanFault::Damaged { format: "PLY", reason: reason.into() }
}

/// Indices of the properties x, y and z.
fn axes(vertices: &Element) -> Result<[usize; 3], ScanFault> {
    let index = |axis: &str| {
        let mut properties = vertices.properties.iter();
        properties.position(|property| property.name.eq_ignore_ascii_case(axis) && property.list.is_none())
    };
    let [Some(x), Some(y), Some(z)] = AXES.map(index) else {
        let names: Vec<&str> = vertices.properties.iter().map(|property| property.name.as_str()).collect();
        return Err(ScanFault::value(
            "properties of vertex",
            shortened(&names.join(" ")),
            "x, y and z among them",
        ));
    };
    Ok([x, y, z])
}

/// One element a line.
fn ascii(
    header: &Header,
    data: &[u8],
    before: &[Element],
    vertices: &Element,
    xyz: [usize; 3],
) -> Result<Vec<Vec3>, ScanFault> {
    let text = String::from_utf8_lossy(data);
    let passed_over = before.iter().map(|element| element.count).fold(0, usize::saturating_add);
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let (mut points, mut count) = (Vec::new(), 0);
    for (index, line) in lines.skip(passed_over).take(vertices.count) {
        count += 1;
        let number = header.lines + index + 1;
        let point = vertex(number, line, vertices, xyz)?;
        points.extend(values::point(|| format!("line {number}"), point)?);
    }
    if count < vertices.count {
        let expected = format!("{count}, the number of its lines");
        return Err(ScanFault::value("number of vertex", vertices.count, expected));
    }
    Ok(points)
}

/// The coordinates in a line.
fn vertex(number: usize, line: &str, vertices: &Element, xyz: [usize; 3]) -> Result<DVec3, ScanFault> {
    let mut words = line.split_whitespace();
    let mut point = DVec3::NAN;
    for (index, property) in vertices.properties.iter().enumerate() {
        let place = || format!("line {number}, {}", property.name);
        let word = words.next().ok_or_else(|| {
            let expected = format!("{} values, those of a vertex", vertices.properties.len());
            ScanFault::value(format!("line {number}"), shortened(line), expected)
        })?;
        if property.list.is_some() {
            let count: usize =
                word.parse().map_err(|_| ScanFault::value(place(), shortened(word), "a number of values"))?;
            if count > 0 {
                words.nth(count - 1);
            }
        } else if let Some(axis) = xyz.iter().position(|&axis| axis == index) {
            point[axis] =
                word.parse().map_err(|_| ScanFault::value(place(), shortened(word), "a number of metres"))?;
        }
    }
    Ok(point)
}

/// One element after the other.
fn binary(
    data: &[u8],
    big_endian: bool,
    before: &[Element],
    vertices: &Element,
    xyz: [usize; 3],
) -> Result<Vec<Vec3>, ScanFault> {
    let mut rest = data;
    for element in before {
        take(&mut rest, element, big_endian, |_, _, _| Ok(()))?;
    }
    let mut points = Vec::new();
    let mut point = DVec3::NAN;
    take(&mut rest, vertices, big_endian, |index, property, value| {
        if let Some(axis) = xyz.iter().position(|&axis| axis == property) {
            point[axis] = value;
        }
        if property + 1 == vertices.properties.len() {
            let place = || format!("vertex {} of {}", index + 1, vertices.count);
            points.extend(values::point(place, point)?);
        }
        Ok(())
    })?;
    Ok(points)
}

/// Takes an element from the bytes; tells each value, or the number of values of a list, with the indices of
/// the element and of the property.
fn take(
    rest: &mut &[u8],
    element: &Element,
    big_endian: bool,
    mut tell: impl FnMut(usize, usize, f64) -> Result<(), ScanFault>,
) -> Result<(), ScanFault> {
    let (name, count) = (&element.name, element.count);
    let least_bytes: usize = element.properties.iter().map(header::Property::least_bytes).sum();
    if least_bytes.saturating_mul(count) > rest.len() {
        let expected = format!("at most {}, what the file holds", rest.len() / least_bytes);
        return Err(ScanFault::value(format!("number of {name}"), count, expected));
    }
    if least_bytes == 0 {
        return Ok(());
    }
    for index in 0..count {
        for (place, property) in element.properties.iter().enumerate() {
            let too_short = || damaged(format!("it ends inside {name} {} of {count}", index + 1));
            let number = property.list.unwrap_or(property.number);
            let value = number.read(rest, big_endian).ok_or_else(too_short)?;
            let list_bytes =
                property.list.map_or(0, |_| property.number.size().saturating_mul(value as usize));
            *rest = rest.get(number.size().saturating_add(list_bytes)..).ok_or_else(too_short)?;
            tell(index, place, value)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ply_rs_bw::ply::{self, ElementDef, Encoding, Ply, PropertyDef, PropertyType, ScalarType};
    use ply_rs_bw::writer::Writer;
    use proptest::prelude::*;

    const ASCII: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement camera 1\nproperty float fov\n\
        element vertex 3\nproperty uchar red\nproperty float x\nproperty double y\nproperty list uchar int views\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n90\n\
        1 1 2 0 3\n1 nan nan 0 nan\n1 -4.5 5 2 8 9 0.25\n3 0 1 2\n";
    const POINTS: [Vec3; 2] = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(-4.5, 5.0, 0.25)];

    fn fault(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    /// Points between other elements and properties.
    fn written(points: &[Vec3], encoding: Encoding) -> Vec<u8> {
        let mut cloud = Ply::new();
        cloud.header.encoding = encoding;
        let list = PropertyType::List(ScalarType::UChar, ScalarType::Short);
        let properties = [
            ("camera", "views", list.clone()),
            ("vertex", "intensity", PropertyType::Scalar(ScalarType::UChar)),
            ("vertex", "x", PropertyType::Scalar(ScalarType::Float)),
            ("vertex", "views", list),
            ("vertex", "y", PropertyType::Scalar(ScalarType::Double)),
            ("vertex", "z", PropertyType::Scalar(ScalarType::Float)),
            ("face", "area", PropertyType::Scalar(ScalarType::Double)),
        ];
        for name in ["camera", "vertex", "face"] {
            let mut element = ElementDef::new(name.to_owned());
            for (_, property, kind) in properties.iter().filter(|(element, ..)| *element == name) {
                element
                    .properties
                    .insert((*property).to_owned(), PropertyDef::new((*property).to_owned(), kind.clone()));
            }
            cloud.header.elements.insert(name.to_owned(), element);
        }
        let with = |fields: Vec<(&str, ply::Property)>| {
            fields.into_iter().map(|(name, value)| (name.to_owned(), value)).collect::<ply::DefaultElement>()
        };
        let views = || ("views", ply::Property::ListShort(vec![1, -2, 3]));
        let vertices = points.iter().map(|point| {
            with(vec![
                ("intensity", ply::Property::UChar(7)),
                ("x", ply::Property::Float(point.x)),
                views(),
                ("y", ply::Property::Double(point.y.into())),
                ("z", ply::Property::Float(point.z)),
            ])
        });
        cloud.payload.insert("vertex".to_owned(), vertices.collect());
        cloud.payload.insert("camera".to_owned(), vec![with(vec![views()]); 2]);
        cloud.payload.insert("face".to_owned(), vec![with(vec![("area", ply::Property::Double(1.0))])]);
        let mut bytes = Vec::new();
        Writer::new().write_ply(&mut bytes, &mut cloud).unwrap();
        bytes
    }

    #[test]
    fn ascii_is_read_and_beams_without_a_return_are_passed_over() {
        assert_eq!(read(ASCII.as_bytes()).unwrap().points_m, POINTS);
        assert_eq!(read(ASCII.replace('\n', "\r\n").as_bytes()).unwrap().points_m, POINTS);
    }

    #[test]
    fn a_binary_header_ends_as_on_any_system() {
        let head = "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty double x\nproperty int16 y\n\
            property float Z\nend_header\n";
        for end in ["\n", "\r\n", "\r"] {
            let mut bytes = head.replace('\n', end).into_bytes();
            bytes.extend(
                [1.0_f64.to_be_bytes().as_slice(), &2_i16.to_be_bytes(), &3.0_f32.to_be_bytes()].concat(),
            );
            assert_eq!(read(&bytes).unwrap().points_m, [POINTS[0]], "{end:?}");
        }
    }

    #[test]
    fn faults_are_named() {
        let with = |from: &str, to: &str| fault(&ASCII.replace(from, to));
        assert_eq!(fault("solid"), "line 1 = solid: expected ply");
        assert_eq!(fault("ply\nformat ascii 1.0\n"), "not a valid PLY file: it ends before end_header");
        assert!(with("ascii", "zip").contains("no known format: expected one of ascii"));
        let header = "expected an element, a property of it, a comment or end_header";
        assert_eq!(with("float x", "half x"), format!("line 8 = property half x: {header}"));
        assert_eq!(with("vertex 3", "vertex many"), format!("line 6 = element vertex many: {header}"));
        assert_eq!(with("vertex 3", "point 3"), "elements = camera point face: expected vertex among them");
        assert_eq!(
            with("float x", "float u"),
            "properties of vertex = red u y views z: expected x, y and z among them"
        );
        assert_eq!(with("5 2 8 9 0.25", "5 2 8 9 high"), "line 18, z = high: expected a number of metres");
        assert_eq!(
            with("5 2 8 9 0.25", "5 9 8 9 1"),
            "line 18 = 1 -4.5 5 9 8 9 1: expected 5 values, those of a vertex"
        );
        let short = &ASCII[..ASCII.find("3 0 1 2").unwrap()];
        assert_eq!(
            fault(&short.replace("vertex 3", "vertex 9")),
            "number of vertex = 9: expected 3, the number of its lines"
        );
        let binary = |from: &str, to: &str| {
            let bytes = written(&POINTS, Encoding::BinaryLittleEndian);
            let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
            let head = String::from_utf8_lossy(&bytes[..end]).replace(from, to);
            read(&[head.as_bytes(), &bytes[end..]].concat()).unwrap_err().to_string()
        };
        let huge = usize::MAX.to_string();
        assert!(
            binary("vertex 2", &format!("vertex {huge}"))
                .starts_with(&format!("number of vertex = {huge}: "))
        );
        assert!(
            binary("camera 2", &format!("camera {huge}"))
                .starts_with(&format!("number of camera = {huge}: "))
        );
        assert!(binary("vertex 2", "vertex 3").contains("it ends inside vertex 3 of 3"));
    }

    proptest! {
        #[test]
        fn written_points_read_back_to_the_bit(
            points in prop::collection::vec(prop::array::uniform3(-1e6..1e6_f32), 0..40),
            encoding in prop::sample::select(ENCODINGS.to_vec()),
        ) {
            let points: Vec<Vec3> = points.into_iter().map(Vec3::from_array).collect();
            prop_assert_eq!(read(&written(&points, encoding)).unwrap().points_m, points);
        }

        #[test]
        fn damage_anywhere_gives_points_or_a_fault(
            encoding in prop::sample::select(ENCODINGS.to_vec()),
            damage in prop::collection::vec((0..1000_usize, any::<u8>()), 0..6), end in 0..1000_usize,
        ) {
            let mut bytes = written(&[POINTS[0], POINTS[1], POINTS[0]], encoding);
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

    const ENCODINGS: [Encoding; 3] =
        [Encoding::Ascii, Encoding::BinaryLittleEndian, Encoding::BinaryBigEndian];
}
