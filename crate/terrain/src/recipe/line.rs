//! Smooth lines through the points of a recipe.

use super::canvas::{Canvas, TooMuch};
use glam::DVec2;

/// Pieces between two points of the recipe.
const PIECES: usize = 12;

/// A polyline fine enough to look smooth.
pub(super) struct Line {
    vertices: Vec<DVec2>,
    /// Arc length from the beginning to each vertex, in metres.
    arc_lengths_m: Vec<f64>,
    /// From each vertex to the next.
    pieces: Vec<Piece>,
}

#[derive(Clone, Copy)]
struct Piece {
    begin: DVec2,
    along: DVec2,
    length2_m2: f64,
    /// Arc length before the piece, and length of the piece.
    before_m: f64,
    along_m: f64,
}

impl Piece {
    /// Squared distance of a place, and the share of the piece before its nearest point.
    fn nearest(&self, at: DVec2) -> (f64, f64) {
        let share = ((at - self.begin).dot(self.along) / self.length2_m2).clamp(0.0, 1.0);
        ((self.begin + self.along * share).distance_squared(at), share)
    }
}

/// Samples along each side of a tile of the canvas, for which the pieces that may be nearest are found
/// together.
const TILE: usize = 4;
/// Comparing a place with this many pieces takes as long as changing a sample.
const PIECES_A_SAMPLE: usize = 4;
/// Bound on the rounding error of a distance.
const SLACK_M: f64 = 1e-6;

/// The nearest point of a line.
pub(super) struct Nearest {
    pub(super) distance2_m2: f64,
    /// Arc length to that point, in metres.
    pub(super) along_m: f64,
}

impl Line {
    /// The cubic Hermite spline through the points, with the tangents of centred differences over the chord
    /// lengths.
    pub(super) fn through(points: &[[f64; 2]]) -> Self {
        let points: Vec<DVec2> = points.iter().map(|&point| DVec2::from_array(point)).collect();
        let tangent = |i: usize| {
            let before = i.saturating_sub(1);
            let after = (i + 1).min(points.len() - 1);
            let chord_m: f64 = (before..after).map(|k| points[k].distance(points[k + 1])).sum();
            (points[after] - points[before]) / chord_m
        };
        let mut vertices = vec![points[0]];
        for (i, pair) in points.windows(2).enumerate() {
            let chord = pair[0].distance(pair[1]);
            let (begin_tangent, end_tangent) = (tangent(i) * chord, tangent(i + 1) * chord);
            for piece in 1..=PIECES {
                let u = piece as f64 / PIECES as f64;
                let smooth = u * u * (3.0 - 2.0 * u);
                let bend = u * (1.0 - u);
                vertices.push(
                    pair[0] * (1.0 - smooth) + pair[1] * smooth + begin_tangent * (bend * (1.0 - u))
                        - end_tangent * (bend * u),
                );
            }
        }
        let mut arc_lengths_m = vec![0.0];
        for pair in vertices.windows(2) {
            arc_lengths_m.push(arc_lengths_m[arc_lengths_m.len() - 1] + pair[0].distance(pair[1]));
        }
        let pieces = vertices.windows(2).zip(arc_lengths_m.windows(2)).map(|(ends, arc_lengths_m)| {
            let along = ends[1] - ends[0];
            let length2_m2 = along.length_squared().max(f64::MIN_POSITIVE);
            Piece {
                begin: ends[0],
                along,
                length2_m2,
                before_m: arc_lengths_m[0],
                along_m: arc_lengths_m[1] - arc_lengths_m[0],
            }
        });
        Self { pieces: pieces.collect(), vertices, arc_lengths_m }
    }

    pub(super) fn length_m(&self) -> f64 {
        self.arc_lengths_m[self.arc_lengths_m.len() - 1]
    }

    /// The point at an arc length.
    pub(super) fn point(&self, along_m: f64) -> DVec2 {
        let (index, share) = locate(&self.arc_lengths_m, along_m);
        self.vertices[index].lerp(self.vertices[index + 1], share)
    }

    /// Interpolates values given at the recipe's points, at an arc length.
    pub(super) fn value(&self, at_points: &[f64], along_m: f64) -> f64 {
        let (index, share) = locate(&self.arc_lengths_m, along_m);
        let point = index / PIECES;
        let share = ((index % PIECES) as f64 + share) / PIECES as f64;
        at_points[point] + (at_points[point + 1] - at_points[point]) * share
    }

    /// Visits every sample within `reach_m` of the line, with the nearest point of the line and the height.
    pub(super) fn each_near(
        &self,
        canvas: &mut Canvas,
        reach_m: f64,
        mut change: impl FnMut(Nearest, &mut f64),
    ) -> Result<(), TooMuch> {
        let bound =
            |pick: fn(DVec2, DVec2) -> DVec2| self.vertices.iter().copied().reduce(pick).unwrap_or_default();
        let (low, high) = (bound(DVec2::min) - reach_m, bound(DVec2::max) + reach_m);
        let (all_columns, all_rows) = canvas.samples_within(low, high);
        let (mut distances_m, mut pieces) = (Vec::new(), Vec::new());
        for row in all_rows.clone().step_by(TILE) {
            let rows = row..(row + TILE).min(all_rows.end);
            for column in all_columns.clone().step_by(TILE) {
                let columns = column..(column + TILE).min(all_columns.end);
                let (first, last) = (canvas.place(column, row), canvas.place(columns.end - 1, rows.end - 1));
                let (centre, radius_m) = ((first + last) / 2.0, first.distance(last) / 2.0);
                canvas.effort.spend(self.pieces.len() / PIECES_A_SAMPLE)?;
                distances_m.clear();
                distances_m.extend(self.pieces.iter().map(|piece| piece.nearest(centre).0.sqrt()));
                let nearest_m = distances_m.iter().copied().fold(f64::INFINITY, f64::min);
                // Pieces farther than this from the centre are nearest to no sample of the tile, or out of
                // reach of all.
                let farthest_m = (nearest_m + radius_m).min(reach_m) + radius_m + SLACK_M;
                pieces.clear();
                pieces.extend(
                    self.pieces
                        .iter()
                        .zip(&distances_m)
                        .filter(|(_, m)| **m <= farthest_m)
                        .map(|(one, _)| *one),
                );
                canvas.effort.spend(rows.len() * columns.len() * (1 + pieces.len() / PIECES_A_SAMPLE))?;
                for (row, column) in
                    rows.clone().flat_map(|row| columns.clone().map(move |column| (row, column)))
                {
                    if let Some(nearest) = nearest(&pieces, canvas.place(column, row), reach_m) {
                        change(nearest, &mut canvas.heights_m[row * canvas.columns + column]);
                    }
                }
            }
        }
        Ok(())
    }
}

/// The nearest point of some pieces, if it is within reach.
fn nearest(pieces: &[Piece], at: DVec2, reach_m: f64) -> Option<Nearest> {
    let mut nearest: Option<Nearest> = None;
    for piece in pieces {
        let (distance2_m2, share) = piece.nearest(at);
        let before_m2 = nearest.as_ref().map_or(f64::INFINITY, |nearest| nearest.distance2_m2);
        if distance2_m2 < before_m2 && distance2_m2 <= reach_m * reach_m {
            nearest = Some(Nearest { distance2_m2, along_m: piece.before_m + piece.along_m * share });
        }
    }
    nearest
}

/// The interval of an ascending list that holds an arc length, and the share of it that lies before.
fn locate(arc_lengths_m: &[f64], along_m: f64) -> (usize, f64) {
    let index =
        arc_lengths_m.partition_point(|&vertex_m| vertex_m <= along_m).clamp(1, arc_lengths_m.len() - 1) - 1;
    let length = (arc_lengths_m[index + 1] - arc_lengths_m[index]).max(f64::MIN_POSITIVE);
    (index, ((along_m - arc_lengths_m[index]) / length).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::canvas::Effort;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn passes_through_its_points_and_keeps_straight_lines_straight() {
        let points = [[0.0, 0.0], [3.0, 4.0], [9.0, 4.0]];
        let line = Line::through(&points);
        for (i, point) in points.iter().enumerate() {
            let along_m = line.arc_lengths_m[i * PIECES];
            assert!(line.point(along_m).distance(DVec2::from_array(*point)) < 1e-9);
            assert!((line.value(&[1.0, 5.0, 2.0], along_m) - [1.0, 5.0, 2.0][i]).abs() < 1e-9);
        }
        assert!(line.length_m() > 11.0 && line.length_m() < 11.6, "{}", line.length_m());
        let straight = Line::through(&[[0.0, 1.0], [2.0, 1.0], [10.0, 1.0]]);
        assert!((straight.length_m() - 10.0).abs() < 1e-9);
        assert!(straight.vertices.iter().all(|vertex| (vertex.y - 1.0).abs() < 1e-12));
    }

    #[test]
    fn nearest_point_is_that_of_the_straight_line() {
        let line = Line::through(&[[5.0, 5.0], [15.0, 5.0]]);
        let sample = |x: f64, y: f64| nearest(&line.pieces, DVec2::new(x, y), 3.0);
        let beside = sample(9.0, 7.0).unwrap();
        assert!((beside.distance2_m2 - 4.0).abs() < 1e-9 && (beside.along_m - 4.0).abs() < 1e-9);
        assert!((sample(3.0, 5.0).unwrap().distance2_m2 - 4.0).abs() < 1e-9, "beyond the end");
        assert!(sample(9.0, 9.0).is_none(), "beyond reach");
    }

    proptest! {
        /// Pieces that a tile leaves out change nothing, not even the last bit.
        #[test]
        fn tiles_find_what_every_piece_gives(
            points in proptest::collection::vec([-5.0..35.0f64, -5.0..35.0f64], 2..6),
            reach_m in 0.1..12.0f64,
        ) {
            let line = Line::through(&points);
            let (columns, rows, cell_m) = (61, 53, 0.5);
            let mut canvas = Canvas { columns, rows, cell_m, heights_m: vec![f64::NAN; columns * rows], effort: Effort::default() };
            let done = line.each_near(&mut canvas, reach_m, |nearest, height_m| *height_m = nearest.along_m);
            prop_assert!(done.is_ok());
            for (index, along_m) in canvas.heights_m.iter().enumerate() {
                let expected = nearest(&line.pieces, canvas.place(index % columns, index / columns), reach_m);
                prop_assert_eq!(along_m.to_bits(), expected.map_or(f64::NAN, |nearest| nearest.along_m).to_bits());
            }
        }
    }
}
