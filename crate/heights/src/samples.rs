//! The samples of a file, holes among them, until they are a grid.

use crate::{Fault, Grid, Holes, holes};

/// The most samples a grid may have: 4096 × 4096.
pub const MAX_SAMPLES: usize = 4096 * 4096;
/// What lies lower is a mark for a hole, whatever the file says: no ground is that low.
const LOWEST_M: f64 = -12_000.0;
/// What lies higher is a mark for a hole.
const HIGHEST_M: f64 = 100_000.0;
/// Holes of ESRI grids that do not say their own, and of many others.
const USUAL_HOLE: f64 = -9999.0;
/// Voids of SRTM, and the least number of 16 bits.
const VOID: f64 = -32768.0;

/// What a file's numbers mean.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meaning {
    /// The number that marks a hole.
    pub(crate) no_data: Option<f64>,
    /// A height in metres is `scale * number + offset_m`.
    pub(crate) scale: f64,
    pub(crate) offset_m: f64,
}

impl Meaning {
    /// The height of a number, in metres; nothing for a hole.
    pub(crate) fn height_m(&self, number: f64) -> Option<f64> {
        let plain = (self.scale - 1.0).abs() < 1e-12 && self.offset_m == 0.0;
        let is_marked = self.no_data.is_some_and(|hole| (number - hole).abs() <= 1e-6 * hole.abs());
        let is_usual = number == VOID || (plain && number == USUAL_HOLE);
        let height_m = number * self.scale + self.offset_m;
        (!is_marked && !is_usual && (LOWEST_M..=HIGHEST_M).contains(&height_m)).then_some(height_m)
    }
}

/// Samples in the order of the file, row by row.
#[derive(Debug)]
pub(crate) struct Samples {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Not a number where there is a hole.
    heights_m: Vec<f32>,
    holes: usize,
    /// The first hole: its index, a place that is known better than by row and column, and what stands there.
    first: Option<(usize, String, String)>,
}

impl Samples {
    pub(crate) fn new(columns: usize, rows: usize) -> Result<Self, Fault> {
        let count = count(columns, rows)?;
        Ok(Self { columns, rows, heights_m: vec![0.0; count], holes: 0, first: None })
    }

    pub(crate) fn put(&mut self, at: usize, height_m: f64) {
        if let Some(sample) = self.heights_m.get_mut(at) {
            *sample = height_m as f32;
        }
    }

    /// Marks a hole. `place` and `value` say where and what it is, if it is the first.
    pub(crate) fn hole(&mut self, at: usize, place: impl FnOnce() -> String, value: impl FnOnce() -> String) {
        let Some(sample) = self.heights_m.get_mut(at) else { return };
        if sample.is_nan() {
            return;
        }
        *sample = f32::NAN;
        self.holes += 1;
        if self.first.as_ref().is_none_or(|(first, _, _)| at < *first) {
            self.first = Some((at, place(), value()));
        }
    }

    /// Makes a grid of the samples: settles its holes, and turns it the right way up.
    pub(crate) fn grid(
        mut self,
        cell_m: f64,
        first_row: FirstRow,
        choice: Holes,
        mut warnings: Vec<String>,
    ) -> Result<Grid, Fault> {
        if let Some((at, place, value)) = &self.first {
            let (holes, all) = (self.holes, self.heights_m.len());
            let were = if holes == 1 { "was a hole" } else { "were holes" };
            match choice {
                Holes::Refuse => {
                    let row_and_column =
                        format!("{place}row {}, column {}", at / self.columns + 1, at % self.columns + 1);
                    let are = if holes == 1 { "is a hole" } else { "are holes" };
                    let expected = format!(
                        "a height in metres; {holes} of {all} samples {are}: holes = \"fill\" or \"crop\" \
                         under [import] of a recipe makes ground of the rest"
                    );
                    return Err(Fault::value(row_and_column, value, expected));
                }
                Holes::Fill if 2 * holes > all => {
                    let expected = "at most half of the samples, to fill them; holes = \"crop\" takes the \
                                    largest rectangle without";
                    return Err(Fault::value("holes", format!("{holes} of {all}"), expected));
                }
                Holes::Fill => {
                    holes::fill(self.columns, &mut self.heights_m);
                    warnings.push(format!("{holes} of {all} samples {were}: filled from the heights around"));
                }
                Holes::Crop => {
                    let kept = holes::largest_whole(self.columns, &self.heights_m);
                    count(kept.columns, kept.rows)?;
                    self.heights_m = kept.cut(self.columns, &self.heights_m);
                    (self.columns, self.rows) = (kept.columns, kept.rows);
                    warnings
                        .push(format!("{holes} of {all} samples {were}: {kept} of the file are the ground"));
                }
            }
        }
        if first_row == FirstRow::North {
            turn(&mut self.heights_m, self.columns);
        }
        let Self { columns, rows, heights_m, .. } = self;
        Ok(Grid { columns, rows, cell_m, heights_m, warnings })
    }
}

/// Which row stands first in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FirstRow {
    North,
    South,
}

/// How many samples there are, if that is a number that is allowed.
pub(crate) fn count(columns: usize, rows: usize) -> Result<usize, Fault> {
    let size = |expected: String| Fault::Size { columns, rows, expected };
    if columns < 2 || rows < 2 {
        return Err(size("at least 2 × 2".to_owned()));
    }
    let count = columns.checked_mul(rows).filter(|&count| count <= MAX_SAMPLES);
    count.ok_or_else(|| size(format!("at most {MAX_SAMPLES} in all")))
}

/// Puts the last row first.
fn turn(heights_m: &mut [f32], columns: usize) {
    let rows = heights_m.len() / columns;
    for row in 0..rows / 2 {
        let (before, after) = heights_m.split_at_mut((rows - 1 - row) * columns);
        before[row * columns..(row + 1) * columns].swap_with_slice(&mut after[..columns]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Meaning = Meaning { no_data: None, scale: 1.0, offset_m: 0.0 };

    #[test]
    fn voids_are_holes_whatever_the_file_says() {
        for hole in [-9999.0, -32768.0, -32767.0, -99999.0, -3.4e38, 1e20, f64::NAN, f64::INFINITY] {
            assert_eq!(PLAIN.height_m(hole), None, "{hole}");
            assert_eq!(Meaning { no_data: Some(-1.0), ..PLAIN }.height_m(hole), None, "{hole}");
        }
        for height in [-11_000.0, -430.5, 0.0, 8848.0, -9998.0] {
            assert_eq!(PLAIN.height_m(height), Some(height));
            assert_eq!(Meaning { no_data: Some(height), ..PLAIN }.height_m(height), None);
        }
    }

    #[test]
    fn scaled_numbers_may_be_what_is_a_hole_in_metres() {
        let millimetres = Meaning { no_data: Some(-1.0), scale: 0.001, offset_m: 10.0 };
        assert_eq!(millimetres.height_m(-9999.0), Some(10.0 - 9.999));
        assert_eq!(millimetres.height_m(-32768.0), None);
        assert_eq!(millimetres.height_m(-1.0), None);
    }

    #[test]
    fn holes_are_refused_with_the_first_of_them() {
        let mut samples = Samples::new(2, 2).unwrap();
        for at in [3, 1, 3] {
            samples.hole(at, || format!("line {at}, "), || "-1".to_owned());
        }
        let fault = samples.grid(1.0, FirstRow::North, Holes::Refuse, Vec::new()).unwrap_err().to_string();
        let expected = "line 1, row 1, column 2 = -1: expected a height in metres; 2 of 4 samples are holes: \
                        holes = \"fill\" or \"crop\" under [import] of a recipe makes ground of the rest";
        assert_eq!(fault, expected);
    }

    #[test]
    fn what_is_mostly_hole_is_not_filled_and_what_has_no_whole_rectangle_not_cropped() {
        let holed = |holes: &[usize]| {
            let mut samples = Samples::new(2, 2).unwrap();
            holes.iter().for_each(|&at| samples.hole(at, String::new, || "x".to_owned()));
            samples
        };
        let fault = holed(&[0, 1, 2]).grid(1.0, FirstRow::North, Holes::Fill, Vec::new()).unwrap_err();
        assert!(fault.to_string().starts_with("holes = 3 of 4: expected at most half"), "{fault}");
        assert!(holed(&[0, 1]).grid(1.0, FirstRow::North, Holes::Fill, Vec::new()).is_ok());
        let fault = holed(&[0]).grid(1.0, FirstRow::North, Holes::Crop, Vec::new()).unwrap_err();
        assert!(fault.to_string().ends_with("expected at least 2 × 2"), "{fault}");
    }
}
