//! Smooth lines through the points of a recipe.

use super::canvas::Canvas;
use glam::DVec2;

/// Pieces between two points of the recipe.
const PIECES: usize = 12;

/// A polyline fine enough to look smooth.
pub(super) struct Line {
    vertices: Vec<DVec2>,
    /// Way from the begin to each vertex, in metres.
    ways_m: Vec<f64>,
}

/// The nearest point of a line for each sample of a canvas.
pub(super) struct Nearest {
    /// Squared distance in m², infinite beyond reach.
    pub(super) distance2_m2: Vec<f64>,
    /// Way along the line to that point, in metres.
    pub(super) way_m: Vec<f64>,
}

impl Line {
    /// The cubic Hermite spline through the points, with the tangents of centred differences over the chord lengths.
    pub(super) fn through(points: &[[f64; 2]]) -> Self {
        let points: Vec<DVec2> = points.iter().map(|&point| DVec2::from_array(point)).collect();
        let tangent = |i: usize| {
            let before = i.saturating_sub(1);
            let after = (i + 1).min(points.len() - 1);
            let way: f64 = (before..after).map(|k| points[k].distance(points[k + 1])).sum();
            (points[after] - points[before]) / way
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
        let mut ways_m = vec![0.0];
        for pair in vertices.windows(2) {
            ways_m.push(ways_m[ways_m.len() - 1] + pair[0].distance(pair[1]));
        }
        Self { vertices, ways_m }
    }

    pub(super) fn length_m(&self) -> f64 {
        self.ways_m[self.ways_m.len() - 1]
    }

    /// The point at a way along the line.
    pub(super) fn point(&self, way_m: f64) -> DVec2 {
        let (index, share) = locate(&self.ways_m, way_m);
        self.vertices[index].lerp(self.vertices[index + 1], share)
    }

    /// Interpolates values given at the recipe's points, at a way along the line.
    pub(super) fn value(&self, at_points: &[f64], way_m: f64) -> f64 {
        let (index, share) = locate(&self.ways_m, way_m);
        let point = index / PIECES;
        let share = ((index % PIECES) as f64 + share) / PIECES as f64;
        at_points[point] + (at_points[point + 1] - at_points[point]) * share
    }

    /// Finds the nearest point of the line for every sample within `reach_m`.
    pub(super) fn nearest(&self, canvas: &Canvas, reach_m: f64) -> Nearest {
        let count = canvas.heights_m.len();
        let mut nearest = Nearest { distance2_m2: vec![f64::INFINITY; count], way_m: vec![0.0; count] };
        for (index, pair) in self.vertices.windows(2).enumerate() {
            let (begin, along) = (pair[0], pair[1] - pair[0]);
            let length2 = along.length_squared().max(f64::MIN_POSITIVE);
            let low = pair[0].min(pair[1]) - DVec2::splat(reach_m);
            let high = pair[0].max(pair[1]) + DVec2::splat(reach_m);
            canvas.indices_within(low, high, |sample, at| {
                let share = ((at - begin).dot(along) / length2).clamp(0.0, 1.0);
                let distance2 = (begin + along * share).distance_squared(at);
                if distance2 < nearest.distance2_m2[sample] && distance2 <= reach_m * reach_m {
                    nearest.distance2_m2[sample] = distance2;
                    let way = self.ways_m[index + 1] - self.ways_m[index];
                    nearest.way_m[sample] = self.ways_m[index] + way * share;
                }
            });
        }
        nearest
    }
}

/// The interval of an ascending list that holds `way_m`, and the share of it that lies before.
fn locate(ways_m: &[f64], way_m: f64) -> (usize, f64) {
    let index = ways_m.partition_point(|&way| way <= way_m).clamp(1, ways_m.len() - 1) - 1;
    let length = (ways_m[index + 1] - ways_m[index]).max(f64::MIN_POSITIVE);
    (index, ((way_m - ways_m[index]) / length).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_its_points_and_keeps_straight_lines_straight() {
        let points = [[0.0, 0.0], [3.0, 4.0], [9.0, 4.0]];
        let line = Line::through(&points);
        for (i, point) in points.iter().enumerate() {
            let way_m = line.ways_m[i * PIECES];
            assert!(line.point(way_m).distance(DVec2::from_array(*point)) < 1e-9);
            assert!((line.value(&[1.0, 5.0, 2.0], way_m) - [1.0, 5.0, 2.0][i]).abs() < 1e-9);
        }
        assert!(line.length_m() > 11.0 && line.length_m() < 11.6, "{}", line.length_m());
        let straight = Line::through(&[[0.0, 1.0], [2.0, 1.0], [10.0, 1.0]]);
        assert!((straight.length_m() - 10.0).abs() < 1e-9);
        assert!(straight.vertices.iter().all(|vertex| (vertex.y - 1.0).abs() < 1e-12));
    }

    #[test]
    fn nearest_point_is_that_of_the_straight_line() {
        let canvas = Canvas { columns: 21, rows: 11, cell_m: 1.0, heights_m: vec![0.0; 231] };
        let nearest = Line::through(&[[5.0, 5.0], [15.0, 5.0]]).nearest(&canvas, 3.0);
        let sample = |column: usize, row: usize| {
            let index = row * 21 + column;
            (nearest.distance2_m2[index], nearest.way_m[index])
        };
        let (distance2, way_m) = sample(9, 7);
        assert!((distance2 - 4.0).abs() < 1e-9 && (way_m - 4.0).abs() < 1e-9);
        assert!((sample(3, 5).0 - 4.0).abs() < 1e-9, "beyond the end");
        assert_eq!(sample(9, 9).0, f64::INFINITY, "beyond reach");
    }
}
