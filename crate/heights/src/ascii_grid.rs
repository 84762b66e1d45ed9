//! ESRI ASCII grid: a header of keys and values, then the heights from the north-west, row by row.
//!
//! Heights are samples at the cell centres, so the corner and the centre variant of the origin give the same
//! local grid.

use crate::samples::{FirstRow, Meaning, Samples, count};
use crate::spacing::{MIN_CELL_M, WAY_OUT, square};
use crate::{Fault, Grid, Import};

const FORMAT: &str = "ESRI ASCII grid";
const KEYS: &str =
    "ncols, nrows, xllcorner, yllcorner, xllcenter, yllcenter, cellsize, dx, dy or NODATA_value";
const DECIMAL_COMMAS: &str = "decimal commas are read as decimal points";

#[derive(Default)]
struct Header {
    columns: Option<usize>,
    rows: Option<usize>,
    cell: Option<f64>,
    dx: Option<f64>,
    dy: Option<f64>,
    /// Of a corner or a centre.
    x: Option<f64>,
    y: Option<f64>,
    no_data: Option<f64>,
    punctuation: Punctuation,
}

/// What separates whole numbers from fractions in a header, or in the heights: they may differ.
#[derive(Default)]
struct Punctuation {
    points: bool,
    commas: bool,
}

pub(crate) fn read(bytes: &[u8], import: &Import) -> Result<Grid, Fault> {
    let text = std::str::from_utf8(bytes).map_err(|error| Fault::damaged(FORMAT, error))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().enumerate().peekable();
    let mut header = Header::default();
    while let Some((index, line)) = lines.next_if(|(_, line)| belongs_to_header(line)) {
        header.take(index + 1, line)?;
    }
    let missing = |key: &str| Fault::damaged(FORMAT, format!("the header has no {key}"));
    let columns = header.columns.ok_or_else(|| missing("ncols"))?;
    let rows = header.rows.ok_or_else(|| missing("nrows"))?;
    let cell_m = match import.cell_m {
        Some(cell_m) => cell_m,
        None => header.cell_m()?,
    };
    let count = count(columns, rows)?;
    let mut samples = Samples::new(columns, rows)?;
    let meaning = Meaning { no_data: header.no_data, scale: 1.0, offset_m: 0.0 };
    let mut punctuation = Punctuation::default();
    let mut at = 0;
    for (index, line) in lines {
        for token in line.split_ascii_whitespace() {
            let place =
                || format!("line {}, row {}, column {}", index + 1, at / columns + 1, at % columns + 1);
            if at == count {
                let expected = format!("the end after {count} heights");
                return Err(Fault::value(format!("line {}", index + 1), token, expected));
            }
            let number = punctuation.number(token, place, "a height in metres")?;
            match meaning.height_m(number) {
                Some(height_m) => samples.put(at, height_m),
                None => samples.hole(at, || format!("line {}, ", index + 1), || token.to_owned()),
            }
            at += 1;
        }
    }
    if at < count {
        let reason = format!("it ends after {at} of {count} heights");
        return Err(Fault::damaged(FORMAT, reason));
    }
    let warnings = if punctuation.commas || header.punctuation.commas {
        vec![DECIMAL_COMMAS.to_owned()]
    } else {
        Vec::new()
    };
    samples.grid(cell_m, FirstRow::North, import.holes, warnings)
}

/// Whether a line begins with a word. `nan` and `inf` are numbers, though not heights.
fn belongs_to_header(line: &str) -> bool {
    let first = line.split_ascii_whitespace().next();
    first.is_none_or(|token| {
        token.starts_with(|c: char| c.is_ascii_alphabetic()) && token.parse::<f64>().is_err()
    })
}

impl Header {
    /// Takes one line of the header.
    fn take(&mut self, line_number: usize, line: &str) -> Result<(), Fault> {
        let mut tokens = line.split_ascii_whitespace();
        let Some(key) = tokens.next() else { return Ok(()) };
        let (Some(value), None) = (tokens.next(), tokens.next()) else {
            return Err(Fault::value(format!("line {line_number}"), key, "a key and one value"));
        };
        let place = || format!("line {line_number}, {key}");
        let count = || value.parse().map_err(|_| Fault::value(place(), value, "a whole number"));
        let punctuation = &mut self.punctuation;
        let mut finite = || {
            let number = punctuation.number(value, place, "a finite number")?;
            if number.is_finite() { Ok(number) } else { Err(Fault::value(place(), value, "a finite number")) }
        };
        let plain: String = key.to_ascii_lowercase().chars().filter(|letter| *letter != '_').collect();
        let again = match plain.as_str() {
            "ncols" => self.columns.replace(count()?).is_some(),
            "nrows" => self.rows.replace(count()?).is_some(),
            "cellsize" => self.cell.replace(finite()?).is_some(),
            "dx" | "xcellsize" => self.dx.replace(finite()?).is_some(),
            "dy" | "ycellsize" => self.dy.replace(finite()?).is_some(),
            // A NaN marks holes, too; every NaN is a hole anyway.
            "nodata" | "nodatavalue" if value.eq_ignore_ascii_case("nan") => false,
            "nodata" | "nodatavalue" => self.no_data.replace(finite()?).is_some(),
            "xllcorner" | "xllcenter" => self.x.replace(finite()?).is_some(),
            "yllcorner" | "yllcenter" => self.y.replace(finite()?).is_some(),
            _ => return Err(Fault::value(place(), value, format!("one of the keys {KEYS}"))),
        };
        if again {
            return Err(Fault::value(place(), value, "each key once"));
        }
        Ok(())
    }

    fn cell_m(&self) -> Result<f64, Fault> {
        let (key, east, north) = match (self.cell, self.dx, self.dy) {
            (Some(cell), None, None) => ("cellsize", cell, cell),
            (None, Some(dx), Some(dy)) => ("dx, dy", dx, dy),
            (None, None, None) => return Err(Fault::damaged(FORMAT, "the header has no cellsize")),
            _ => return Err(Fault::damaged(FORMAT, "the header has neither cellsize alone nor dx and dy")),
        };
        let on_the_globe = |coordinate: Option<f64>, most: f64| {
            coordinate.is_some_and(|coordinate| coordinate != 0.0 && coordinate.abs() <= most)
        };
        let is_small = east > 0.0 && east < 10.0 * MIN_CELL_M;
        if is_small && on_the_globe(self.x, 360.0) && on_the_globe(self.y, 90.0) {
            let expected = format!(
                "metres; a corner at {}, {} tells of degrees: project the grid, or {WAY_OUT}",
                self.x.unwrap_or_default(),
                self.y.unwrap_or_default()
            );
            return Err(Fault::value(key, east, expected));
        }
        square(key, east, north, 1.0)
    }
}

impl Punctuation {
    /// A number with a decimal point, or with a decimal comma where there are no points beside it.
    fn number(&mut self, token: &str, place: impl Fn() -> String, expected: &str) -> Result<f64, Fault> {
        let fault = |expected: &str| Fault::value(place(), token, expected);
        let Some((whole, fraction)) = token.split_once(',') else {
            self.points |= token.contains('.');
            if self.points && self.commas {
                return Err(fault("either decimal points or decimal commas"));
            }
            return token.parse().map_err(|_| fault(expected));
        };
        let digits = |text: &str, at_end: bool| {
            let digit = if at_end { text.bytes().next_back() } else { text.bytes().next() };
            digit.is_some_and(|byte| byte.is_ascii_digit())
        };
        if !digits(whole, true) || !digits(fraction, false) || fraction.contains([',', '.']) {
            return Err(fault("numbers apart by blanks; a comma is read as a decimal comma alone"));
        }
        self.commas = true;
        if self.points {
            return Err(fault("either decimal points or decimal commas"));
        }
        format!("{whole}.{fraction}").parse().map_err(|_| fault(expected))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Holes;
    use proptest::prelude::*;

    fn grid(text: &str) -> Grid {
        read(text.as_bytes(), &Import::default()).unwrap()
    }

    fn fault(text: &str) -> String {
        read(text.as_bytes(), &Import::default()).unwrap_err().to_string()
    }

    #[test]
    fn corner_and_centre_keys_in_any_case_give_the_local_grid() {
        let values = "1 2 3\n4 5\n6";
        let corner = format!(
            "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 1e6\ncellsize 0.5\nNODATA_value -9999\n{values}"
        );
        let centre = format!("NROWS 2\nNCOLS 3\nXLLCENTER 0\r\nYLLCENTER 0\r\nCELLSIZE 0.5\n\n{values}\n");
        let field = grid(&corner);
        assert_eq!(field.heights_m, [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
        assert_eq!((field.cell_m, field.warnings.len()), (0.5, 0));
        assert_eq!(grid(&centre), field);
        let wider = Import { cell_m: Some(2.0), ..Import::default() };
        assert_eq!(read(centre.as_bytes(), &wider).unwrap().cell_m, 2.0);
    }

    #[test]
    fn a_byte_order_mark_exponents_and_sides_of_pixels_are_read() {
        let plain = grid("ncols 2\nnrows 2\ncellsize 0.5\n1.5 2 3 4\n");
        assert_eq!(grid("\u{feff}ncols 2\nnrows 2\ncellsize 5e-1\n1.5e0 2E+00 30e-1 4\n"), plain);
        assert_eq!(grid("ncols 2\nnrows 2\ndx 0.5\nDY 0.5\n1.5 2 3 4\n"), plain);
        assert!(
            fault("ncols 2\nnrows 2\ndx 0.5\ndy 0.7\n1 2 3 4\n")
                .starts_with("dx, dy = 0.5 × 0.7: expected square")
        );
        assert!(
            fault("ncols 2\nnrows 2\ndx 0.5\n1 2 3 4\n").contains("neither cellsize alone nor dx and dy")
        );
    }

    #[test]
    fn decimal_commas_are_read_where_nothing_else_can_be_meant() {
        let commas = grid("ncols 2\nnrows 2\ncellsize 0,5\n1,25 2 -3,5 4\n");
        assert_eq!((commas.heights_m, commas.cell_m), (vec![-3.5, 4.0, 1.25, 2.0], 0.5));
        assert_eq!(commas.warnings, [DECIMAL_COMMAS]);
        let header_with_point = grid("ncols 2\nnrows 2\ncellsize 0.5\n1,25 2 -3,5 4\n");
        assert_eq!((header_with_point.cell_m, header_with_point.warnings.len()), (0.5, 1));
        let head = "ncols 2\nnrows 2\ncellsize 1\n";
        let both = "expected either decimal points or decimal commas";
        assert!(fault(&format!("{head}1,2 3.4 5 6")).contains(both));
        assert!(fault(&format!("{head}1.2 3,4 5 6")).contains(both));
        for list in ["1,2,3,4", "1, 2, 3, 4", ",5 1 2 3", "1,234.5 1 2 3"] {
            assert!(fault(&format!("{head}{list}")).contains("expected numbers apart by blanks"), "{list}");
        }
    }

    #[test]
    fn degrees_are_refused_with_the_way_out() {
        let head = "ncols 2\nnrows 2\nxllcorner -105.56\nyllcorner 40.09\n";
        for cell in ["0.000833333333", "0.0166666"] {
            let text = fault(&format!("{head}cellsize {cell}\n1 2 3 4\n"));
            assert!(text.starts_with(&format!("cellsize = {cell}: expected metres")), "{text}");
            assert!(text.contains("degrees") && text.contains("cell_m under [import]"), "{text}");
        }
        let given = Import { cell_m: Some(90.0), ..Import::default() };
        let text = format!("{head}cellsize 0.000833\n1 2 3 4\n");
        assert_eq!(read(text.as_bytes(), &given).unwrap().cell_m, 90.0);
        assert_eq!(grid("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.02\n1 2 3 4\n").cell_m, 0.02);
    }

    #[test]
    fn holes_are_known_by_their_key_and_without_one() {
        let head = "ncols 2\nnrows 2\ncellsize 1\n";
        let first = |text: &str| fault(text).split(';').next().unwrap().to_owned();
        assert_eq!(
            first(&format!("{head}1 2\n-9999 4\n")),
            "line 5, row 2, column 1 = -9999: expected a height in metres"
        );
        for key in ["nodata_value", "NODATA_VALUE", "NoData", "NODATA"] {
            assert_eq!(
                first(&format!("{head}{key} 7\n1 2 3 7.0\n")),
                "line 5, row 2, column 2 = 7.0: expected a height in metres"
            );
        }
        assert!(first(&format!("{head}nodata_value -1\n1 -32768 3 4\n")).contains("column 2 = -32768"));
        assert!(first(&format!("{head}nodata_value nan\n1 nan 3 4\n")).contains("column 2 = nan"));
        let filled = Import { holes: Holes::Fill, ..Import::default() };
        let filled = read(format!("{head}1 1 1 -9999\n").as_bytes(), &filled).unwrap();
        assert_eq!(filled.heights_m, [1.0; 4]);
        assert_eq!(filled.warnings, ["1 of 4 samples was a hole: filled from the heights around"]);
        let cropped = Import { holes: Holes::Crop, ..Import::default() };
        let text = "ncols 3\nnrows 3\ncellsize 1\n-9999 -9999 -9999\n1 2 -9999\n3 4 -9999\n";
        let cropped = read(text.as_bytes(), &cropped).unwrap();
        assert_eq!((cropped.columns, cropped.heights_m), (2, vec![3.0, 4.0, 1.0, 2.0]));
        assert!(cropped.warnings[0].ends_with("columns 1 to 2, rows 2 to 3 of the file are the ground"));
    }

    #[test]
    fn other_faults_name_their_place() {
        let head = "ncols 2\nnrows 2\ncellsize 1\nnodata_value -9999\n";
        assert_eq!(fault(&format!("{head}1 x")), "line 5, row 1, column 2 = x: expected a height in metres");
        assert_eq!(fault("ncols 2 3\n"), "line 1 = ncols: expected a key and one value");
        assert_eq!(
            fault(&format!("{head}1 2 3")),
            "not a valid ESRI ASCII grid file: it ends after 3 of 4 heights"
        );
        assert_eq!(fault(&format!("{head}1 2 3 4 5")), "line 5 = 5: expected the end after 4 heights");
        assert_eq!(fault("ncols 1\nnrows 1\ncellsize 1\n5"), "1 × 1 samples: expected at least 2 × 2");
        assert_eq!(fault("ncols 2\nncols 2\n"), "line 2, ncols = 2: expected each key once");
        assert!(
            fault("ncols 2\ncolour 7\n").starts_with("line 2, colour = 7: expected one of the keys ncols")
        );
        assert_eq!(fault("ncols two"), "line 1, ncols = two: expected a whole number");
        assert_eq!(fault("cellsize inf"), "line 1, cellsize = inf: expected a finite number");
        assert!(fault("nrows 2\ncellsize 1\n1").contains("the header has no ncols"));
        assert!(fault("ncols 99999999999\nnrows 99999999999\ncellsize 1\n").contains("expected at most"));
        assert!(
            fault("ncols 4000\nnrows 4000\ncellsize 1\n1 2").contains("ends after 2 of 16000000 heights")
        );
    }

    proptest! {
        #[test]
        fn a_written_grid_reads_back(
            columns in 2..9usize, rows in 2..9usize, heights in prop::collection::vec(-500.0f32..5000.0, 64),
            cell_m in 0.01..30.0f64, commas in any::<bool>(),
        ) {
            let mut text = format!("ncols {columns}\nnrows {rows}\ncellsize {cell_m:?}\n");
            for row in (0..rows).rev() {
                for column in 0..columns {
                    text += &format!("{:?} ", heights[row * columns + column]);
                }
                text.push('\n');
            }
            let text = if commas { text.replace('.', ",") } else { text };
            let grid = read(text.as_bytes(), &Import::default()).unwrap();
            prop_assert_eq!(&grid.heights_m, &heights[..columns * rows]);
            prop_assert_eq!((grid.columns, grid.rows, grid.cell_m), (columns, rows, cell_m));
        }

        #[test]
        fn mutations_never_panic(at in 0..70usize, byte in any::<u8>()) {
            let text =
                "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value -9\n1 2 3 4\n";
            let mut bytes = text.as_bytes().to_vec();
            bytes[at] = byte;
            for (_, holes) in Holes::NAMES {
                drop(read(&bytes, &Import { holes, ..Import::default() }));
            }
        }
    }
}
