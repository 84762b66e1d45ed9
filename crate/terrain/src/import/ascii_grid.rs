//! ESRI ASCII grid: a header of keys and values, then the heights from the north-west, row by row.
//!
//! Heights are samples at the cell centres, so the corner and the centre variant of the origin give the same
//! local grid. Holes (`NODATA_value`) are refused.

use super::south_first;
use crate::terrain::TerrainFault;
use mapless_world::{HeightField, check_grid};

const FORMAT: &str = "ESRI ASCII grid";
const KEYS: &str = "ncols, nrows, xllcorner, yllcorner, xllcenter, yllcenter, cellsize or nodata_value";

#[derive(Default)]
struct Header {
    columns: Option<usize>,
    rows: Option<usize>,
    cell_m: Option<f64>,
    no_data: Option<f64>,
}

pub(super) fn read(bytes: &[u8], cell_m: Option<f64>) -> Result<HeightField, TerrainFault> {
    let text = std::str::from_utf8(bytes).map_err(|error| TerrainFault::damaged(FORMAT, error))?;
    let mut lines = text.lines().enumerate().peekable();
    let mut header = Header::default();
    while let Some((index, line)) = lines.next_if(|(_, line)| belongs_to_header(line)) {
        header.take(index + 1, line)?;
    }
    let missing = |key: &str| TerrainFault::damaged(FORMAT, format!("the header has no {key}"));
    let columns = header.columns.ok_or_else(|| missing("ncols"))?;
    let rows = header.rows.ok_or_else(|| missing("nrows"))?;
    let cell_m = cell_m.or(header.cell_m).ok_or_else(|| missing("cellsize"))?;
    let count = check_grid(columns, rows, cell_m)?;
    // Each height takes at least a digit and a blank, so a short file cannot ask for much memory.
    let mut heights_m: Vec<f32> = Vec::with_capacity(count.min(bytes.len()));
    for (index, line) in lines {
        for token in line.split_ascii_whitespace() {
            let at = heights_m.len();
            let place =
                || format!("line {}, row {}, column {}", index + 1, at / columns + 1, at % columns + 1);
            if at == count {
                return Err(TerrainFault::value(
                    format!("line {}", index + 1),
                    token,
                    format!("the end after {count} heights"),
                ));
            }
            let height_m: f64 =
                token.parse().map_err(|_| TerrainFault::value(place(), token, "a height in metres"))?;
            let is_hole = header.no_data.is_some_and(|hole| (height_m - hole).abs() <= 1e-6 * hole.abs());
            if is_hole || !height_m.is_finite() {
                return Err(TerrainFault::value(
                    place(),
                    token,
                    "a height in metres; fill the holes of the grid first",
                ));
            }
            heights_m.push(height_m as f32);
        }
    }
    if heights_m.len() < count {
        let reason = format!("it ends after {} of {count} heights", heights_m.len());
        return Err(TerrainFault::damaged(FORMAT, reason));
    }
    south_first(&mut heights_m, columns);
    Ok(HeightField::new(columns, rows, cell_m, heights_m)?)
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
    fn take(&mut self, number: usize, line: &str) -> Result<(), TerrainFault> {
        let mut tokens = line.split_ascii_whitespace();
        let Some(key) = tokens.next() else { return Ok(()) };
        let (Some(value), None) = (tokens.next(), tokens.next()) else {
            return Err(TerrainFault::value(format!("line {number}"), key, "a key and one value"));
        };
        let place = || format!("line {number}, {key}");
        let count = || value.parse().map_err(|_| TerrainFault::value(place(), value, "a whole number"));
        let number = || match value.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(TerrainFault::value(place(), value, "a finite number")),
        };
        let again = match key.to_ascii_lowercase().as_str() {
            "ncols" => self.columns.replace(count()?).is_some(),
            "nrows" => self.rows.replace(count()?).is_some(),
            "cellsize" => self.cell_m.replace(number()?).is_some(),
            // A NaN marks holes, too; every NaN is refused as a height anyway.
            "nodata_value" if value.eq_ignore_ascii_case("nan") => false,
            "nodata_value" => self.no_data.replace(number()?).is_some(),
            "xllcorner" | "yllcorner" | "xllcenter" | "yllcenter" => number().map(|_| false)?,
            _ => return Err(TerrainFault::value(place(), value, format!("one of the keys {KEYS}"))),
        };
        if again {
            return Err(TerrainFault::value(place(), value, "each key once"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fault(text: &str) -> String {
        read(text.as_bytes(), None).unwrap_err().to_string()
    }

    #[test]
    fn corner_and_centre_keys_in_any_case_give_the_local_grid() {
        let values = "1 2 3\n4 5\n6";
        let corner = format!(
            "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 1e6\ncellsize 0.5\nNODATA_value -9999\n{values}"
        );
        let centre = format!("NROWS 2\nNCOLS 3\nXLLCENTER 0\r\nYLLCENTER 0\r\nCELLSIZE 0.5\n\n{values}\n");
        let field = read(corner.as_bytes(), None).unwrap();
        assert_eq!(field.heights_m(), [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
        assert_eq!(field.cell_m(), 0.5);
        assert_eq!(read(centre.as_bytes(), None).unwrap(), field);
        assert_eq!(read(centre.as_bytes(), Some(2.0)).unwrap().cell_m(), 2.0);
    }

    #[test]
    fn holes_and_other_faults_name_their_place() {
        let head = "ncols 2\nnrows 2\ncellsize 1\nnodata_value -9999\n";
        assert_eq!(
            fault(&format!("{head}1 2\n-9999 4\n")),
            "line 6, row 2, column 1 = -9999: expected a height in metres; fill the holes of the grid first"
        );
        assert_eq!(fault(&format!("{head}1 x")), "line 5, row 1, column 2 = x: expected a height in metres");
        assert!(
            fault(&format!("{head}1 2 3 nan"))
                .starts_with("line 5, row 2, column 2 = nan: expected a height")
        );
        assert!(
            fault(&format!("{head}nan 2 3 4"))
                .starts_with("line 5, row 1, column 1 = nan: expected a height")
        );
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
        assert!(fault("nrows 2\ncellsize 1\n1").contains("the header has no ncols"));
        assert!(fault("ncols 99999999999\nnrows 99999999999\ncellsize 1\n").contains("expected at most"));
    }

    proptest! {
        #[test]
        fn a_written_grid_reads_back(
            columns in 2..9usize, rows in 2..9usize, heights in prop::collection::vec(-500.0f32..5000.0, 64),
            cell_m in 0.01..30.0f64,
        ) {
            let mut text = format!("ncols {columns}\nnrows {rows}\ncellsize {cell_m}\n");
            for row in (0..rows).rev() {
                for column in 0..columns {
                    text += &format!("{} ", heights[row * columns + column]);
                }
                text.push('\n');
            }
            let field = read(text.as_bytes(), None).unwrap();
            prop_assert_eq!(field.heights_m(), &heights[..columns * rows]);
            prop_assert_eq!((field.columns(), field.rows(), field.cell_m()), (columns, rows, cell_m));
        }

        #[test]
        fn mutations_never_panic(at in 0..70usize, byte in any::<u8>()) {
            let mut bytes = b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value -9\n1 2 3 4\n".to_vec();
            bytes[at] = byte;
            drop(read(&bytes, None));
        }
    }
}
