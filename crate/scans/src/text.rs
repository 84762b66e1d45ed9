//! Text with one point a line.
//!
//! Programs write it in many ways, so every line is split by what it holds, and a header is one if it names
//! x, y and z.

use glam::{DVec3, Vec3};

use crate::cloud_warning::CloudWarning;
use crate::error::ScanFault;
use crate::scan::{Scan, ScanWarning};
use crate::values::{self, AXES, shortened};

pub(crate) fn read(bytes: &[u8]) -> Result<Scan, ScanFault> {
    if let Some(at) = bytes.iter().position(|&byte| byte == 0) {
        return Err(damaged(format!("byte {at} is 0: expected ASCII or UTF-8, not UTF-16 or binary data")));
    }
    let text = String::from_utf8_lossy(bytes);
    // Spreadsheets begin a file with a byte-order mark.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let mut cloud = Cloud::default();
    for (index, line) in lines(text).enumerate() {
        cloud.add(index + 1, line.trim_matches(' '))?;
    }
    cloud.finish()
}

fn damaged(reason: impl Into<String>) -> ScanFault {
    ScanFault::Damaged { format: "text", reason: reason.into() }
}

/// Lines that end as on any system: LF, CR LF, or CR alone.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let end = if text.contains('\n') { '\n' } else { '\r' };
    text.split(end).map(|line| line.trim_end_matches('\r'))
}

/// What was read so far.
#[derive(Default)]
struct Cloud {
    points: Vec<Vec3>,
    /// Rows read, those without a return too.
    rows: usize,
    /// The first line and the number of points that it says, as in a .pts file.
    announced: Option<(usize, usize)>,
    /// Columns that a comment names; they hold if the first row has as many values.
    noted: Option<Columns>,
    /// The columns and the line that they come from, once known.
    columns: Option<(usize, Columns)>,
}

impl Cloud {
    fn add(&mut self, number: usize, line: &str) -> Result<(), ScanFault> {
        if line.trim().is_empty() {
            return Ok(());
        }
        if let Some(comment) = line.strip_prefix('#').or_else(|| line.strip_prefix("//")) {
            self.noted = self.noted.take().or_else(|| Columns::named(&fields(comment.trim())));
            return Ok(());
        }
        let fields = fields(line);
        let columns = match &self.columns {
            Some(columns) => columns,
            None => match self.begin(number, line, &fields)? {
                Some(columns) => self.columns.insert((number, columns)),
                None => return Ok(()),
            },
        };
        self.rows += 1;
        self.points.extend(columns.1.point(number, line, &fields, columns.0)?);
        Ok(())
    }

    /// The columns if this line is the first point; `None` if it stands before the points.
    fn begin(&mut self, number: usize, line: &str, fields: &[&str]) -> Result<Option<Columns>, ScanFault> {
        if line.to_ascii_lowercase().starts_with("ncols") {
            return Err(damaged("it is an ESRI ASCII grid, which is a terrain and no scan"));
        }
        if let ([count], None) = (fields, self.announced)
            && let Ok(count) = count.parse()
        {
            self.announced = Some((number, count));
            return Ok(None);
        }
        let values = fields.iter().take(3).filter(|field| value(field).is_some()).count();
        if values == 3 {
            let first = Columns::first(fields);
            let noted = self.noted.take().filter(|noted| noted.count == first.count);
            return Ok(Some(noted.unwrap_or(first)));
        }
        let Some(columns) = Columns::named(fields) else {
            let expected = "x, y and z, or a header that names these columns, in m, cm or mm";
            return Err(ScanFault::value(format!("line {number}"), shortened(line), expected));
        };
        self.columns = Some((number, columns));
        Ok(None)
    }

    fn finish(self) -> Result<Scan, ScanFault> {
        let mut scan = Scan::from(self.points);
        if let Some((number, said)) = self.announced.filter(|(_, said)| *said != self.rows) {
            let warning = CloudWarning::Count { place: format!("line {number}"), said, read: self.rows };
            scan.warnings.push(ScanWarning::Cloud(warning));
        }
        Ok(scan)
    }
}

/// Where the coordinates stand in a line, and what they mean.
#[derive(Clone, Debug, PartialEq)]
struct Columns {
    xyz: [usize; 3],
    /// Number of values in a line.
    count: usize,
    metres: [f64; 3],
    /// Whether x looks right and y forward, as in VeloView.
    turned: bool,
}

impl Columns {
    /// x, y and z first, in metres. Fields are counted up to the last that is not empty.
    fn first(fields: &[&str]) -> Self {
        let count = fields.iter().rposition(|field| !field.is_empty()).map_or(3, |last| 3.max(last + 1));
        Self { xyz: [0, 1, 2], count, metres: [1.0; 3], turned: false }
    }

    /// By the names in a header; `None` unless x, y and z are among them.
    fn named(fields: &[&str]) -> Option<Self> {
        let names: Vec<String> = fields.iter().map(|name| name.to_lowercase()).collect();
        let has = |beginning: &str| names.iter().any(|name| name.starts_with(beginning));
        let turned = has("points_m_xyz:") || (has("points:") && has("laser_id"));
        let mut columns = Self { turned, ..Self::first(fields) };
        for (axis, name) in AXES.iter().enumerate() {
            let found = names.iter().enumerate().find_map(|(column, found)| {
                let array = found.strip_prefix("points_m_xyz:").or_else(|| found.strip_prefix("points:"));
                let metres = match array {
                    Some(index) => (index == axis.to_string()).then_some(1.0),
                    None => found.strip_prefix(name).and_then(unit),
                };
                metres.map(|metres| (column, metres))
            });
            (columns.xyz[axis], columns.metres[axis]) = found?;
        }
        Some(columns)
    }

    /// The point of a line; `None` for a beam without a return.
    fn point(
        &self,
        number: usize,
        line: &str,
        fields: &[&str],
        columns_from: usize,
    ) -> Result<Option<Vec3>, ScanFault> {
        let ends_empty = fields.iter().skip(self.count).all(|field| field.is_empty());
        if fields.len() < self.count || !ends_empty {
            let expected = format!("{} values, as in line {columns_from}", self.count);
            return Err(ScanFault::value(format!("line {number}"), shortened(line), expected));
        }
        let xyz = self.xyz.map(|column| fields[column]);
        let no_return = xyz.iter().all(|field| field.is_empty());
        let mut metres = DVec3::NAN;
        for (axis, field) in xyz.into_iter().enumerate().filter(|_| !no_return) {
            let Some(value) = value(field).filter(|_| !field.is_empty()) else {
                let place = format!("line {number}, column {} ({})", self.xyz[axis] + 1, AXES[axis]);
                return Err(ScanFault::value(place, shortened(field), "a number of metres"));
            };
            metres[axis] = value * self.metres[axis];
        }
        if self.turned {
            metres = DVec3::new(metres.y, -metres.x, metres.z);
        }
        values::point(|| format!("line {number}"), metres)
    }
}

/// Metres in the unit that follows the name of an axis, such as ` (m)` or `_mm`.
fn unit(text: &str) -> Option<f64> {
    match text.trim_matches([' ', '_', '(', ')', '[', ']']) {
        "" | "m" | "metres" | "meters" => Some(1.0),
        "cm" => Some(0.01),
        "mm" => Some(0.001),
        _ => None,
    }
}

/// A number, NaN if there is none by any program's word for it; `None` if it is something else.
fn value(field: &str) -> Option<f64> {
    if let Ok(value) = field.parse() {
        return Some(value);
    }
    let magnitude = field.trim_start_matches(['-', '+']).to_ascii_lowercase();
    if ["", "na", "n/a", "null", "none", "nan(ind)", "1.#ind", "1.#qnan"].contains(&magnitude.as_str()) {
        return Some(f64::NAN);
    }
    decimal_comma(field)
}

/// A number with a decimal comma between digits.
fn decimal_comma(field: &str) -> Option<f64> {
    let (whole, fraction) = field.split_once(',')?;
    let between =
        whole.ends_with(|c: char| c.is_ascii_digit()) && fraction.starts_with(|c: char| c.is_ascii_digit());
    if between && !whole.contains('.') { format!("{whole}.{fraction}").parse().ok() } else { None }
}

/// The values of a line without quotes, separated by what gives at least three of them: semicolons, tabs,
/// commas, or else blanks.
fn fields(line: &str) -> Vec<&str> {
    let by_blanks: Vec<&str> = split(line, |c| c == ' ' || c == '\t')
        .into_iter()
        // Units of a header, as in `X (m) Y (m)`.
        .filter(|field| !(field.is_empty() || field.starts_with(['(', '['])))
        .collect();
    // As in `1,5 2,5 0,3`.
    let decimal_commas = by_blanks.len() >= 3 && by_blanks.iter().all(|field| value(field).is_some());
    for separator in [';', '\t', ','] {
        if separator == ',' && decimal_commas {
            break;
        }
        let fields = split(line, |c| c == separator);
        if fields.len() >= 3 && !fields.iter().any(|field| field.ends_with(',')) {
            return fields;
        }
    }
    by_blanks
}

/// Parts of a line between separators that do not stand in quotes; without the quotes.
fn split(line: &str, is_separator: impl Fn(char) -> bool) -> Vec<&str> {
    let mut quoted = false;
    line.split(|c| {
        quoted ^= c == '"';
        !quoted && is_separator(c)
    })
    .map(|part| part.trim().trim_matches('"').trim())
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const POINTS: [Vec3; 2] = [Vec3::new(1.0, -2.5, 0.25), Vec3::new(-3.0, 4.0, 1e-3)];

    fn fault(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    #[track_caller]
    fn reads(text: &str) {
        assert_eq!(read(text.as_bytes()).unwrap().points_m, POINTS, "{text:?}");
    }

    #[test]
    fn any_separator_is_read() {
        for text in [
            "x,y,z\n1,-2.5,0.25\n-3,4,1e-3\n",
            "1;-2.5;0.25\n-3;4;1e-3",
            "1, -2.5 ,0.25\n-3 ,4 , 1e-3",
            "x y z\n1\t-2.5   0.25\n  -3 4 1e-3  \n\n",
            "x\ty\tz\n1\t-2.5\t0.25\n-3,\t4,\t1e-3",
            "1 -2.5 0.25\n-3,4,0.001",
            "1,-2.5,0.25,\n-3,4,0.001,\n",
            "\u{feff}X, Y, Z\r\n 1.0, -2.5 ,0.25\r\n\r\n-3,4,0.001",
            "1 -2.5 0.25\r-3 4 0.001\r",
        ] {
            reads(text);
        }
    }

    #[test]
    fn decimal_commas_are_read_where_they_do_not_separate() {
        reads("x;y;z\n1;-2,5;0,25\n-3,0;4;0,001");
        reads("1,0 -2,5 0,25\n-3 4 0,001");
        reads("1\t-2,5\t0,25\n-3\t4,0\t0,001");
        reads("\"x\",\"y\",\"z\"\n1,\"-2,5\",\"0,25\"\n-3,4,\"0,001\"");
        assert_eq!(
            fault("1;2;1.234,5"),
            "line 1 = 1;2;1.234,5: expected x, y and z, or a header that names these \
            columns, in m, cm or mm"
        );
    }

    #[test]
    fn columns_go_by_their_names() {
        for text in [
            "intensity,z,y,x\n7,0.25,-2.5,1\n0,1e-3,4,-3",
            "\"\",\"X\",\"Y\",\"Z\",\"ring\"\n\"1\",1,-2.5,0.25,3\n\"2\",-3,4,1e-3,4",
            "time;x [m];y [m];z [m]\n2026-01-01T00:00:00;1;-2.5;0.25\n;-3;4;1e-3",
            "X (m) Y (m) Z (m) I\n1 -2.5 0.25 9\n-3 4 1e-3 9",
            "X (m)\tY (m)\tZ (m)\n1\t-2.5\t0.25\n-3\t4\t1e-3",
            "x_mm,y_mm,z_mm\n1000,-2500,250\n-3000,4000,1",
            "x (cm),y (cm),z (m)\n100,-250,0.25\n-300,400,0.001",
            "Points:0,Points:1,Points:2\n1,-2.5,0.25\n-3,4,1e-3",
            "1 -2.5 0.25 200 3\n-3 4 1e-3 10 4",
            "x,y,z,\n1,-2.5,0.25\n-3,4,1e-3,",
        ] {
            reads(text);
        }
    }

    #[test]
    fn veloviews_axes_are_turned() {
        reads(
            "\"laser_id\",\"Points_m_XYZ:0\",\"Points_m_XYZ:1\",\"Points_m_XYZ:2\"\n0,2.5,1,0.25\n1,-4,-3,1e-3",
        );
        reads(
            "Points_m_XYZ:0,Points_m_XYZ:1,Points_m_XYZ:2,X,Y,Z\n2.5,1,0.25,2.5,1,0.25\n-4,-3,1e-3,-4,-3,1e-3",
        );
        reads("Points:0,Points:1,Points:2,laser_id\n2.5,1,0.25,1\n-4,-3,1e-3,2");
    }

    #[test]
    fn comments_are_passed_over_and_may_name_the_columns() {
        for text in [
            "# x y z\n1 -2.5 0.25\n// between\n-3 4 1e-3\n#",
            "//X Y Z Intensity\n1 -2.5 0.25 7\n-3 4 1e-3 7",
            "#a scan of x y z of mine\n1 -2.5 0.25\n-3 4 1e-3",
            "# made on Monday\n# intensity,z,y,x\n7,0.25,-2.5,1\n7,1e-3,4,-3",
        ] {
            reads(text);
        }
    }

    #[test]
    fn a_number_of_points_may_come_first() {
        reads("2\n1 -2.5 0.25\n-3 4 1e-3");
        reads("2\nx y z\n1 -2.5 0.25\n-3 4 1e-3");
        let warnings = |text: &str| read(text.as_bytes()).unwrap().warnings;
        assert!(warnings("2\n1 2 3\nnan nan nan").is_empty());
        let warned: Vec<String> = warnings("4\n1 2 3").iter().map(ToString::to_string).collect();
        assert_eq!(warned, ["line 1 says 4 points; the 1 that are there were read"]);
    }

    #[test]
    fn rows_without_a_return_are_passed_over() {
        for none in ["nan,nan,nan", "NaN,NaN,NaN", "-nan,1,2", ",,", "NA,NA,NA", "inf,0,0", "-nan(ind),0,0"] {
            reads(&format!("x,y,z\n1,-2.5,0.25\n{none}\n-3,4,1e-3"));
            reads(&format!("{none}\n1,-2.5,0.25\n-3,4,1e-3"));
        }
        assert_eq!(read(b"x,y,z\n"), Ok(Scan::default()), "a scan without returns");
        assert_eq!(read(b"0 0 0"), Ok(vec![Vec3::ZERO].into()), "the planner knows the sensor's least range");
    }

    #[test]
    fn faults_name_line_column_and_value() {
        let number = "expected a number of metres";
        assert_eq!(fault("1 2 3\n\n4 high 6"), format!("line 3, column 2 (y) = high: {number}"));
        assert_eq!(fault("i,x,y,z\n0,1,2,3o"), format!("line 2, column 4 (z) = 3o: {number}"));
        assert_eq!(fault("1,2,3\n1,,3"), format!("line 2, column 2 (y) = : {number}"));
        assert_eq!(fault("1 2 3\nx,y,z"), format!("line 2, column 1 (x) = x: {number}"));
        assert_eq!(fault("1,2,3\n1,2,1e39").split(": ").nth(1), Some("expected a number of metres"));
        let header = "expected x, y and z, or a header that names these columns, in m, cm or mm";
        assert_eq!(fault("1 2"), format!("line 1 = 1 2: {header}"));
        assert_eq!(fault("a,b,c\n1,2,3"), format!("line 1 = a,b,c: {header}"));
        assert_eq!(fault("x (ft),y (ft),z (ft)\n1,2,3"), format!("line 1 = x (ft),y (ft),z (ft): {header}"));
        assert_eq!(fault("2\n3\n1 2 3"), format!("line 2 = 3: {header}"), "a .ptx file");
        assert_eq!(fault("1 2 3\n4 5 6 7"), "line 2 = 4 5 6 7: expected 3 values, as in line 1");
        assert_eq!(fault("x,y,z,i\n4,5,6"), "line 2 = 4,5,6: expected 4 values, as in line 1");
        assert!(fault("ncols 3\nnrows 3\n").contains("a terrain and no scan"));
        assert!(fault("1\u{0}2\u{0}").contains("byte 1 is 0"));
        assert!(fault(&"é".repeat(500)).len() < 200);
        let binary = read(&[b'1', b' ', 0xff]).unwrap_err().to_string();
        assert!(binary.starts_with("line 1 = 1 \u{fffd}: "), "{binary}");
    }

    proptest! {
        #[test]
        fn written_points_read_back_to_the_bit(
            points in prop::collection::vec(prop::array::uniform3(-1e6..1e6_f32), 0..50),
            separator in prop::sample::select(vec![",", ";", "\t", " ", ", "]),
            decimal_commas in any::<bool>(), quotes in any::<bool>(), extra in any::<bool>(),
            before in prop::sample::select(vec!["", "x,y,z,i\n", "# x y z i\n", "//X Y Z I\n", "N\n"]),
            end in prop::sample::select(vec!["\n", "\r\n"]),
        ) {
            let decimal_commas = decimal_commas && !separator.contains(',');
            let extra = extra || before.contains(['i', 'I']);
            let mut text = before.replace('N', &points.len().to_string());
            for point in &points {
                let mut fields: Vec<String> = point.iter().map(|value| format!("{value:?}")).collect();
                if extra {
                    fields.push("17".to_owned());
                }
                for field in &mut fields {
                    if decimal_commas {
                        *field = field.replace('.', ",");
                    }
                    if quotes {
                        *field = format!("\"{field}\"");
                    }
                }
                text += &fields.join(separator);
                text.push('\n');
            }
            let expected: Vec<Vec3> = points.into_iter().map(Vec3::from_array).collect();
            prop_assert_eq!(read(text.replace('\n', end).as_bytes()).unwrap(), expected.into());
        }

        #[test]
        fn any_bytes_give_points_or_a_fault(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            if let Ok(scan) = read(&bytes) {
                prop_assert!(scan.points_m.iter().all(|point| point.is_finite()));
            }
        }

        #[test]
        fn any_text_gives_points_or_a_fault(text in "[-0-9.,;xyzenaif#/\"() \t\n]{0,200}") {
            if let Ok(scan) = read(text.as_bytes()) {
                prop_assert!(scan.points_m.iter().all(|point| point.is_finite()));
            }
        }
    }
}
