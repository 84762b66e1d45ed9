//! Farthest-point choice of inducing inputs.
//!
//! Strided subsets of a scan alias with its rings and leave false holes in the variance surface; the farthest-point
//! order covers the observed area evenly. Distances are in length-scales, and wrap in azimuth.

use core::f64::consts::TAU;

use glam::DVec2;

use crate::config::PerceptionConfig;
use crate::occupancy::OccupancySurface;

/// Reusable memory of the selection.
#[derive(Clone, Debug, Default)]
pub(crate) struct FarthestPoints {
    directions: Vec<DVec2>,
    distances_squared: Vec<f64>,
}

impl FarthestPoints {
    /// Chooses among the cells of an occupancy surface, as configured.
    pub(crate) fn choose_cells(
        &mut self,
        observed: &OccupancySurface,
        config: &PerceptionConfig,
        chosen: &mut Vec<usize>,
    ) {
        let mut directions = core::mem::take(&mut self.directions);
        directions.clear();
        directions.extend(observed.cells().iter().map(|cell| cell.direction_rad()));
        let PerceptionConfig { kernel, inducing_spacing_length_scales, max_inducing_inputs, .. } = config;
        let spacing = *inducing_spacing_length_scales;
        self.choose(&directions, kernel.length_scales_rad, spacing, *max_inducing_inputs, chosen);
        self.directions = directions;
    }

    /// Writes to `chosen` the indices of inputs, each the farthest from those before it, until every input is within
    /// `spacing` length-scales of one or `most` are chosen. Starts with the first input.
    fn choose(
        &mut self,
        inputs: &[DVec2],
        length_scales_rad: [f64; 2],
        spacing: f64,
        most: usize,
        chosen: &mut Vec<usize>,
    ) {
        chosen.clear();
        self.distances_squared.clear();
        self.distances_squared.resize(inputs.len(), f64::INFINITY);
        let inverse = [1.0 / length_scales_rad[0], 1.0 / length_scales_rad[1]];
        let mut next = 0;
        while chosen.len() < most.min(inputs.len()) {
            chosen.push(next);
            let centre = inputs[next];
            let mut farthest = 0.0;
            for (i, (input, distance)) in inputs.iter().zip(&mut self.distances_squared).enumerate() {
                let around = (input.x - centre.x).abs();
                let dx = around.min(TAU - around) * inverse[0];
                let dy = (input.y - centre.y) * inverse[1];
                *distance = distance.min(dx * dx + dy * dy);
                if *distance > farthest {
                    farthest = *distance;
                    next = i;
                }
            }
            if farthest <= spacing * spacing {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_input_is_near_a_chosen_one_and_the_chosen_are_apart(
            points in prop::collection::vec((-3.1..3.1_f64, -0.26..0.26_f64), 1..200),
        ) {
            let inputs: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
            let scales = [0.15, 0.05];
            let mut chosen = Vec::new();
            FarthestPoints::default().choose(&inputs, scales, 0.9, usize::MAX, &mut chosen);
            let distance = |a: DVec2, b: DVec2| {
                let dx = crate::angle::difference_rad(a.x, b.x) / scales[0];
                let dy = (a.y - b.y) / scales[1];
                libm::hypot(dx, dy)
            };
            for &input in &inputs {
                prop_assert!(chosen.iter().any(|&c| distance(input, inputs[c]) <= 0.9 + 1e-9));
            }
            for (k, &a) in chosen.iter().enumerate() {
                for &b in &chosen[..k] {
                    prop_assert!(distance(inputs[a], inputs[b]) > 0.9 - 1e-9);
                }
            }
        }
    }
}
