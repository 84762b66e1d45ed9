//! Contour lines of a height field by marching squares.

use std::collections::BTreeMap;

use glam::DVec2;
use mapless_world::HeightField;

/// A side of a cell: the samples at its ends.
type Side = (usize, usize);

/// Most cells along the longer side; finer lines would only show the noise of the ground.
const MOST_CELLS: f64 = 240.0;

/// Heights at evenly spaced places, row by row from the south-west.
pub(crate) struct Grid {
    columns: usize,
    spacing_m: DVec2,
    heights_m: Vec<f64>,
}

impl Grid {
    pub(crate) fn sample(field: &HeightField) -> Self {
        let extent = field.extent_m();
        let spacing_m = field.cell_m().max(extent.max_element() / MOST_CELLS);
        let cells = (extent / spacing_m).round().max(DVec2::ONE);
        let spacing_m = extent / cells;
        let (columns, rows) = (cells.x as usize + 1, cells.y as usize + 1);
        let heights_m = (0..rows * columns)
            .map(|index| {
                let at = DVec2::new((index % columns) as f64, (index / columns) as f64) * spacing_m;
                field.height_m(at.min(extent)).unwrap_or_default()
            })
            .collect();
        Self { columns, spacing_m, heights_m }
    }

    /// The lines of the contour at `level_m`; a closed one ends where it began.
    pub(crate) fn contour(&self, level_m: f64) -> Vec<Vec<DVec2>> {
        let mut next_to: BTreeMap<Side, Vec<Side>> = BTreeMap::new();
        for row in 1..self.heights_m.len() / self.columns {
            for column in 1..self.columns {
                for [one, other] in self.cell(column - 1, row - 1, level_m).into_iter().flatten() {
                    next_to.entry(one).or_default().push(other);
                    next_to.entry(other).or_default().push(one);
                }
            }
        }
        // Open lines from one of their ends; what is left then is closed.
        let ends = next_to.iter().filter(|(_, others)| others.len() == 1).map(|(&side, _)| side);
        let starts: Vec<Side> = ends.chain(next_to.keys().copied()).collect();
        let lines = starts.into_iter().filter_map(|start| walk(&mut next_to, start));
        lines.map(|line| line.into_iter().map(|side| self.crossing(side, level_m)).collect()).collect()
    }

    /// The sides of one cell that the contour joins: none, two or, on a saddle, twice two.
    fn cell(&self, column: usize, row: usize, level_m: f64) -> [Option<[Side; 2]>; 2] {
        let south_west = row * self.columns + column;
        let (south_east, north_west) = (south_west + 1, south_west + self.columns);
        let is_high = |sample: usize| self.heights_m[sample] >= level_m;
        let [south, west] = [(south_west, south_east), (south_west, north_west)];
        let [north, east] = [(north_west, north_west + 1), (south_east, north_west + 1)];
        let mut crossed = [south, east, north, west].into_iter().filter(|&(a, b)| is_high(a) != is_high(b));
        match (crossed.next(), crossed.next(), crossed.next()) {
            (Some(one), Some(other), None) => [Some([one, other]), None],
            (Some(_), Some(_), Some(_)) => {
                // The middle decides which two corners are cut off.
                let corners = [south_west, south_east, north_west, north_west + 1];
                let middle_m = corners.iter().map(|&corner| self.heights_m[corner]).sum::<f64>() / 4.0;
                if (middle_m >= level_m) == is_high(south_west) {
                    [Some([south, east]), Some([west, north])]
                } else {
                    [Some([south, west]), Some([east, north])]
                }
            }
            _ => [None, None],
        }
    }

    fn crossing(&self, (from, to): Side, level_m: f64) -> DVec2 {
        let place = |sample: usize| {
            DVec2::new((sample % self.columns) as f64, (sample / self.columns) as f64) * self.spacing_m
        };
        let (from_m, to_m) = (self.heights_m[from], self.heights_m[to]);
        place(from).lerp(place(to), (level_m - from_m) / (to_m - from_m))
    }
}

/// Takes one line out of the pieces that are left; `None` when there is none at `start`.
fn walk(next_to: &mut BTreeMap<Side, Vec<Side>>, start: Side) -> Option<Vec<Side>> {
    let mut line = vec![start];
    let mut here = start;
    while let Some(next) = next_to.get_mut(&here).and_then(Vec::pop) {
        if let Some(back) = next_to.get_mut(&next) {
            back.retain(|&side| side != here);
        }
        line.push(next);
        here = next;
    }
    (line.len() > 1).then_some(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_contour_of_a_cone_is_a_closed_circle() {
        let samples = 81;
        let height = |index: usize| {
            let at = DVec2::new((index % samples) as f64, (index / samples) as f64) * 0.25 - 10.0;
            -at.length() as f32
        };
        let heights = (0..samples * samples).map(height).collect();
        let field = HeightField::new(samples, samples, 0.25, heights).unwrap();
        let lines = Grid::sample(&field).contour(-6.1);
        let [circle] = lines.as_slice() else { panic!("{} lines", lines.len()) };
        assert_eq!(circle.first(), circle.last());
        for place in circle {
            assert!(((*place - 10.0).length() - 6.1).abs() < 0.01, "{place} is not on the circle");
        }
        let length: f64 = circle.windows(2).map(|ends| (ends[1] - ends[0]).length()).sum();
        assert!((length - 2.0 * std::f64::consts::PI * 6.1).abs() < 0.05, "{length} m around");
    }

    #[test]
    fn a_line_that_leaves_the_field_is_one_line() {
        let heights = (0..30).map(|index| (index % 6) as f32).collect();
        let field = HeightField::new(6, 5, 1.0, heights).unwrap();
        let lines = Grid::sample(&field).contour(2.5);
        let straight: Vec<DVec2> = (0..5).map(|row| DVec2::new(2.5, f64::from(row))).collect();
        assert_eq!(lines, [straight]);
    }

    #[test]
    fn a_saddle_is_cut_by_its_middle() {
        let saddle = |level_m: f64| {
            let field = HeightField::new(2, 2, 1.0, vec![1.0, 0.0, 0.0, 1.0]).unwrap();
            Grid::sample(&field).contour(level_m)
        };
        // Below the middle height the high corners are joined, and the low ones cut off.
        let around = |lines: &[Vec<DVec2>], corner: DVec2| {
            lines.iter().any(|line| line.iter().all(|end| (*end - corner).length() < 0.6))
        };
        assert!(around(&saddle(0.45), DVec2::new(1.0, 0.0)) && around(&saddle(0.45), DVec2::new(0.0, 1.0)));
        assert!(around(&saddle(0.55), DVec2::new(0.0, 0.0)) && around(&saddle(0.55), DVec2::new(1.0, 1.0)));
        assert!(saddle(1.5).is_empty());
    }
}
