//! Text with one point a line.

use glam::Vec3;

use crate::error::ScanFault;

const AXES: [&str; 3] = ["x", "y", "z"];

pub(crate) fn read(bytes: &[u8]) -> Result<Vec<Vec3>, ScanFault> {
    let text = std::str::from_utf8(bytes)
        .map_err(|error| ScanFault::Damaged { format: "CSV", reason: error.to_string() })?;
    // Spreadsheets begin a file with a byte-order mark.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let mut points = Vec::new();
    for (place, (index, line)) in lines.enumerate() {
        let fields = fields(index + 1, line)?;
        let is_header = AXES.iter().zip(fields).all(|(axis, field)| field.eq_ignore_ascii_case(axis));
        if place > 0 || !is_header {
            points.push(point(index + 1, fields)?);
        }
    }
    Ok(points)
}

fn fields(number: usize, line: &str) -> Result<[&str; 3], ScanFault> {
    let fields: Vec<&str> = if line.contains(',') {
        line.split(',').map(str::trim).collect()
    } else {
        line.split_whitespace().collect()
    };
    let expected = "x, y and z, separated by commas or blanks";
    fields.try_into().map_err(|_| ScanFault::value(format!("line {number}"), shortened(line), expected))
}

fn point(number: usize, fields: [&str; 3]) -> Result<Vec3, ScanFault> {
    let mut point = [0.0; 3];
    for ((value, field), axis) in point.iter_mut().zip(fields).zip(AXES) {
        *value = match field.parse::<f32>() {
            Ok(number) if number.is_finite() => number,
            _ => {
                let place = format!("line {number}, {axis}");
                return Err(ScanFault::value(place, shortened(field), "a finite number, metres"));
            }
        };
    }
    Ok(Vec3::from_array(point))
}

/// The beginning of a value, since a wrong file may be one long line.
fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let text = text.trim();
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fault(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn commas_blanks_header_and_empty_lines_are_read() {
        let points = [Vec3::new(1.0, -2.5, 0.25), Vec3::new(-3.0, 4.0, 1e-3)];
        for text in [
            "x,y,z\n1,-2.5,0.25\n-3,4,1e-3\n",
            "\u{feff}X, Y, Z\r\n 1.0, -2.5 ,0.25\r\n\r\n-3,4,0.001",
            "x y z\n1\t-2.5   0.25\n  -3 4 1e-3  \n\n",
            "1 -2.5 0.25\n-3,4,0.001",
        ] {
            assert_eq!(read(text.as_bytes()).unwrap(), points, "{text:?}");
        }
        assert_eq!(read(b"x,y,z\n"), Ok(Vec::new()), "a scan without returns");
    }

    #[test]
    fn faults_name_line_and_value() {
        assert_eq!(fault("1 2 3\n\n4 nan 6"), "line 3, y = nan: expected a finite number, metres");
        assert_eq!(fault("1,2,inf"), "line 1, z = inf: expected a finite number, metres");
        assert_eq!(fault("1,2,1e39"), "line 1, z = 1e39: expected a finite number, metres");
        assert_eq!(fault("1,,3"), "line 1, y = : expected a finite number, metres");
        assert_eq!(fault("1 2 3\nx,y,z"), "line 2, x = x: expected a finite number, metres");
        assert_eq!(fault("1 2"), "line 1 = 1 2: expected x, y and z, separated by commas or blanks");
        assert_eq!(fault("1,2,3,4"), "line 1 = 1,2,3,4: expected x, y and z, separated by commas or blanks");
        assert!(fault(&"é".repeat(500)).len() < 200);
        let binary = read(&[b'1', b' ', 0xff]).unwrap_err().to_string();
        assert!(binary.starts_with("not a valid CSV file: ") && binary.contains("index 2"), "{binary}");
    }

    proptest! {
        #[test]
        fn written_points_read_back_to_the_bit(
            points in prop::collection::vec(prop::array::uniform3(-1e6..1e6_f32), 0..50),
            comma in any::<bool>(), header in any::<bool>(),
        ) {
            let separator = if comma { "," } else { " " };
            let mut text = if header { format!("x{separator}y{separator}z\n") } else { String::new() };
            for [x, y, z] in &points {
                text += &format!("{x}{separator}{y}{separator}{z}\n");
            }
            let expected: Vec<Vec3> = points.into_iter().map(Vec3::from_array).collect();
            prop_assert_eq!(read(text.as_bytes()).unwrap(), expected);
        }

        #[test]
        fn any_bytes_give_points_or_a_fault(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            if let Ok(points) = read(&bytes) {
                prop_assert!(points.iter().all(|point| point.is_finite()));
            }
        }

        #[test]
        fn any_text_gives_points_or_a_fault(text in "[-0-9.,xyzenaif \n]{0,200}") {
            if let Ok(points) = read(text.as_bytes()) {
                prop_assert!(points.iter().all(|point| point.is_finite()));
            }
        }
    }
}
