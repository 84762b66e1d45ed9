//! Heights over a regular grid, from the points of a cloud.

use std::fmt::Write as _;

use glam::{DVec2, Vec3};
use mapless_heights::MAX_SAMPLES;

/// The mark of a sample over which there is no point.
const HOLE: &str = "-9999";

/// The heights of a cloud over a regular grid.
#[derive(Debug, PartialEq)]
pub(super) struct HeightGrid {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) cell_m: f64,
    /// Where the south-west sample is in the frame of the cloud, metres.
    pub(super) origin_m: DVec2,
    /// Rows from the south, each from west to east; none where there is no point.
    heights_m: Vec<Option<f32>>,
}

impl HeightGrid {
    /// Each sample gets the median height of the points that are nearer to it than to its neighbours; of an
    /// even number, the lower of the two middle ones. x of the points is east and z up, metres.
    pub(super) fn of(points_m: &[Vec3], cell_m: f64) -> Result<Self, String> {
        let plan = |point: &Vec3| point.truncate().as_dvec2();
        let corner = |of: fn(DVec2, DVec2) -> DVec2| points_m.iter().map(plan).reduce(of);
        let (Some(origin_m), Some(farthest_m)) = (corner(DVec2::min), corner(DVec2::max)) else {
            return Err("0 points: expected some".to_owned());
        };
        let index = |place_m: DVec2| ((place_m - origin_m) / cell_m).round();
        let samples = index(farthest_m) + DVec2::ONE;
        if samples.min_element() < 2.0 || samples.x * samples.y > MAX_SAMPLES as f64 {
            let size_m = farthest_m - origin_m;
            return Err(format!(
                "points over {:.2} × {:.2} m, which are {} × {} samples: expected at least 2 × 2, and at most \
                 {MAX_SAMPLES} in all; choose another --cell, or cut strays off the cloud",
                size_m.x, size_m.y, samples.x, samples.y
            ));
        }
        let (columns, rows) = (samples.x as usize, samples.y as usize);
        let sample = |point: &Vec3| {
            let at = index(plan(point));
            at.y as usize * columns + at.x as usize
        };
        let mut points: Vec<(usize, f32)> = points_m.iter().map(|point| (sample(point), point.z)).collect();
        points.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut heights_m = vec![None; columns * rows];
        for of_sample in points.chunk_by(|a, b| a.0 == b.0) {
            let (sample, median_m) = of_sample[(of_sample.len() - 1) / 2];
            heights_m[sample] = Some(median_m);
        }
        Ok(Self { columns, rows, cell_m, origin_m, heights_m })
    }

    /// As an ESRI ASCII grid, in millimetres. The corner is at 0: terrains have coordinates of their own.
    pub(super) fn ascii(&self) -> String {
        let Self { columns, rows, cell_m, .. } = self;
        let mut text = format!(
            "ncols {columns}\nnrows {rows}\nxllcorner 0\nyllcorner 0\ncellsize {cell_m}\nNODATA_value {HOLE}\n"
        );
        for row in self.heights_m.chunks(*columns).rev() {
            for (index, height_m) in row.iter().enumerate() {
                text.push_str(if index == 0 { "" } else { " " });
                // Writing to a String cannot fail.
                let _ = match height_m {
                    Some(height_m) => write!(text, "{height_m:.3}"),
                    None => write!(text, "{HOLE}"),
                };
            }
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless_heights::{Holes, Import, read};

    /// Points 0.2 m apart over 3 × 2 m that rise by a tenth to the east and a fifth to the north, with the
    /// corner at (-20, 7).
    fn slope() -> Vec<Vec3> {
        let places = (0..=10).flat_map(|y| (0..=15).map(move |x| (0.2 * x as f32, 0.2 * y as f32)));
        places.map(|(x, y)| Vec3::new(x - 20.0, y + 7.0, 0.1 * x + 0.2 * y)).collect()
    }

    #[test]
    fn a_sample_has_the_median_of_the_points_around_it_and_strays_do_not_count() {
        let clean = HeightGrid::of(&slope(), 1.0).unwrap();
        assert_eq!((clean.columns, clean.rows, clean.origin_m), (4, 3, DVec2::new(-20.0, 7.0)));
        let mut points = slope();
        points.push(Vec3::new(-19.0, 8.0, 40.0));
        points.push(Vec3::new(-18.9, 8.1, -40.0));
        assert_eq!(HeightGrid::of(&points, 1.0).unwrap(), clean);
        // Within the grid the points around a sample lie evenly, so their median is the height there.
        let height_m = clean.heights_m[4 + 1].unwrap();
        assert!((height_m - 0.3).abs() < 1e-6, "{height_m}");
        let few: Vec<Vec3> = [3.0, 1.0, 2.0, 8.0].map(|z| Vec3::new(0.0, 0.0, z)).to_vec();
        let grid = HeightGrid::of(&[few, vec![Vec3::new(1.0, 1.0, 5.0)]].concat(), 1.0).unwrap();
        assert_eq!(grid.heights_m, [Some(2.0), None, None, Some(5.0)]);
    }

    #[test]
    fn the_grid_is_read_back_with_north_at_the_top_and_its_holes() {
        let mut points = slope();
        // Nothing around the sample 1 m east and north of the corner.
        points.retain(|point| (point.x + 19.0).abs().max((point.y - 8.0).abs()) > 0.51);
        let grid = HeightGrid::of(&points, 1.0).unwrap();
        let refused = read("slope.asc", grid.ascii().as_bytes(), &Import::default()).unwrap_err();
        assert!(refused.to_string().contains("row 2, column 2 = -9999: expected a height"), "{refused}");
        let import = Import { holes: Holes::Fill, ..Import::default() };
        let read = read("slope.asc", grid.ascii().as_bytes(), &import).unwrap();
        assert_eq!((read.columns, read.rows, read.cell_m), (4, 3, 1.0));
        for (read, height) in read.heights_m.iter().zip(&grid.heights_m) {
            assert!(height.is_none_or(|height| (height - read).abs() <= 5.1e-4), "{read} {height:?}");
        }
        assert!((read.heights_m[4 + 1] - 0.3).abs() < 0.05, "{}", read.heights_m[4 + 1]);
    }

    #[test]
    fn sizes_that_are_no_grid_are_named_with_the_way_out() {
        assert_eq!(HeightGrid::of(&[], 0.1).unwrap_err(), "0 points: expected some");
        let line = [Vec3::ZERO, Vec3::X];
        let error = HeightGrid::of(&line, 0.1).unwrap_err();
        assert!(
            error.starts_with("points over 1.00 × 0.00 m, which are 11 × 1 samples: expected"),
            "{error}"
        );
        let far = [Vec3::ZERO, Vec3::new(1e6, 1e6, 0.0)];
        let error = HeightGrid::of(&far, 0.1).unwrap_err();
        assert!(error.contains("at most 16777216 in all; choose another --cell"), "{error}");
    }
}
