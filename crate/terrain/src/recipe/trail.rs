//! Trails: strips of ground, level across, that follow a smooth height profile of their own.

use super::canvas::{Canvas, TooMuch};
use super::check::{PerPoint, Table};
use super::features::Feature;
use super::line::Line;
use crate::terrain::TerrainFault;
use mapless_world::smooth_step;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Trail {
    points: Vec<[f64; 2]>,
    height_m: Option<PerPoint>,
    width_m: f64,
    shoulder_m: f64,
    smoothing_m: Option<f64>,
}

impl Feature for Trail {
    fn check(&self, table: &Table, canvas: &Canvas) -> Result<(), TerrainFault> {
        table.line(&self.points)?;
        let extent = canvas.extent_m();
        for (index, point) in self.points.iter().enumerate() {
            if !((0.0..=extent.x).contains(&point[0]) && (0.0..=extent.y).contains(&point[1])) {
                let expected = format!("a point on the terrain, (0, 0) to ({}, {})", extent.x, extent.y);
                return Err(table.fault(&format!("points[{}]", index + 1), format!("{point:?}"), expected));
            }
        }
        if let Some(height_m) = &self.height_m {
            table.per_point("height_m", height_m, self.points.len())?;
        }
        table.positive("width_m", self.width_m)?;
        table.positive("shoulder_m", self.shoulder_m)?;
        self.smoothing_m.map_or(Ok(()), |smoothing_m| table.not_negative("smoothing_m", smoothing_m))
    }

    fn apply(&self, canvas: &mut Canvas, _: u64) -> Result<(), TooMuch> {
        let line = Line::through(&self.points);
        let profile_m = self.profile_m(canvas, &line)?;
        line.each_near(canvas, self.width_m / 2.0 + self.shoulder_m, |nearest, height_m| {
            let distance_m = nearest.distance2_m2.sqrt();
            let own_share = 1.0 - smooth_step((distance_m - self.width_m / 2.0) / self.shoulder_m);
            let place = nearest.along_m / line.length_m() * (profile_m.len() - 1) as f64;
            let before = (place as usize).min(profile_m.len() - 2);
            let trail_m =
                profile_m[before] + (profile_m[before + 1] - profile_m[before]) * (place - before as f64);
            *height_m += (trail_m - *height_m) * own_share;
        })
    }
}

impl Trail {
    /// The heights of the trail at even steps along the line, about one cell each.
    fn profile_m(&self, canvas: &mut Canvas, line: &Line) -> Result<Vec<f64>, TooMuch> {
        let steps = ((line.length_m() / canvas.cell_m) as usize).max(1);
        canvas.effort.spend(steps)?;
        let step_m = line.length_m() / steps as f64;
        let given = self.height_m.as_ref().map(|height_m| height_m.values(self.points.len()));
        let raw = (0..=steps).map(|step| {
            let along_m = step as f64 * step_m;
            match &given {
                Some(heights_m) => line.value(heights_m, along_m),
                None => canvas.height_m(line.point(along_m)),
            }
        });
        let half_window = (self.smoothing_m.unwrap_or(4.0 * self.width_m) / (2.0 * step_m)).round() as usize;
        // Two boxes make a triangle, whose mean has no kinks in its slope.
        Ok(average(&average(&raw.collect::<Vec<_>>(), half_window / 2), half_window / 2))
    }
}

/// Moving average over `half_window` values to each side, fewer near the ends, which stay as they are.
fn average(values: &[f64], half_window: usize) -> Vec<f64> {
    let mut sums = vec![0.0];
    for value in values {
        sums.push(sums[sums.len() - 1] + value);
    }
    let last = values.len() - 1;
    let mean = |index: usize| {
        let half = half_window.min(index).min(last - index);
        (sums[index + half + 1] - sums[index - half]) / (2 * half + 1) as f64
    };
    (0..=last).map(mean).collect()
}
