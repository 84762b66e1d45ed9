//! Contour lines of a height field by marching squares.

use glam::DVec2;
use mapless_world::HeightField;

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

    /// The pieces of the contour at `level_m`, each within one cell.
    pub(crate) fn contour(&self, level_m: f64) -> Vec<[DVec2; 2]> {
        let mut pieces = Vec::new();
        for row in 1..self.heights_m.len() / self.columns {
            for column in 1..self.columns {
                self.cell(column - 1, row - 1, level_m, &mut pieces);
            }
        }
        pieces
    }

    fn cell(&self, column: usize, row: usize, level_m: f64, pieces: &mut Vec<[DVec2; 2]>) {
        // Anticlockwise from the south-west.
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(east, north)| {
            let (column, row) = (column + east, row + north);
            (
                DVec2::new(column as f64, row as f64) * self.spacing_m,
                self.heights_m[row * self.columns + column],
            )
        });
        // Where the contour crosses each side: into the higher ground, or out of it, going around.
        let crossings = [0, 1, 2, 3].map(|side| {
            let ((from, from_m), (to, to_m)) = (corners[side], corners[(side + 1) % 4]);
            let crosses = (from_m >= level_m) != (to_m >= level_m);
            crosses.then(|| from + (to - from) * ((level_m - from_m) / (to_m - from_m)))
        });
        let mut crossed = crossings.into_iter().flatten();
        match crossings {
            // A saddle: its middle decides which two corners are cut off.
            [Some(south), Some(east), Some(north), Some(west)] => {
                let middle_m = corners.iter().map(|(_, height_m)| height_m).sum::<f64>() / 4.0;
                let around_south_west = (middle_m >= level_m) != (corners[0].1 >= level_m);
                if around_south_west {
                    pieces.extend([[south, west], [east, north]]);
                } else {
                    pieces.extend([[south, east], [west, north]]);
                }
            }
            _ => pieces.extend(crossed.next().zip(crossed.next()).map(|(from, to)| [from, to])),
        }
    }
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
        let pieces = Grid::sample(&field).contour(-6.1);
        for end in pieces.iter().flatten() {
            assert!(((*end - 10.0).length() - 6.1).abs() < 0.01, "{end} is not on the circle");
            let shared = pieces.iter().flatten().filter(|other| (**other - *end).length() < 1e-9).count();
            assert_eq!(shared, 2, "the circle has a gap at {end}");
        }
        let length: f64 = pieces.iter().map(|[from, to]| (*to - *from).length()).sum();
        assert!((length - 2.0 * std::f64::consts::PI * 6.1).abs() < 0.05, "{length} m around");
    }

    #[test]
    fn a_saddle_is_cut_by_its_middle() {
        let saddle = |level_m: f64| {
            let field = HeightField::new(2, 2, 1.0, vec![1.0, 0.0, 0.0, 1.0]).unwrap();
            Grid::sample(&field).contour(level_m)
        };
        // Below the middle height the high corners are joined, and the low ones cut off.
        let around = |pieces: &[[DVec2; 2]], corner: DVec2| {
            pieces.iter().any(|piece| piece.iter().all(|end| (*end - corner).length() < 0.6))
        };
        assert!(around(&saddle(0.45), DVec2::new(1.0, 0.0)) && around(&saddle(0.45), DVec2::new(0.0, 1.0)));
        assert!(around(&saddle(0.55), DVec2::new(0.0, 0.0)) && around(&saddle(0.55), DVec2::new(1.0, 1.0)));
        assert!(saddle(1.5).is_empty());
    }
}
