//! Farthest-point choice of inducing inputs.
//!
//! Strided subsets of a scan alias with its rings and leave false holes in the variance surface; the
//! farthest-point order covers the observed area evenly. Distances are in length-scales, and wrap in azimuth.

use core::f64::consts::TAU;

use glam::DVec2;
use multiversion::multiversion;

use crate::config::PerceptionConfig;
use crate::math::panels::{Row, WIDTH};
use crate::skyline::occupancy::OccupancySurface;

/// Reusable memory of the selection.
#[derive(Clone, Debug, Default)]
pub(crate) struct FarthestPoints {
    directions: Vec<DVec2>,
    panels: Vec<Panel>,
}

/// Eight inputs.
#[derive(Clone, Copy, Debug, Default)]
struct Panel {
    azimuths_rad: Row,
    elevations_rad: Row,
    /// Square of the distance to the nearest chosen input, in length-scales; zero where the panel has no
    /// input.
    distances_squared: Row,
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

    /// Writes to `chosen` the indices of inputs, each the farthest from those before it, until every input is
    /// within `spacing` length-scales of one or `most` are chosen. Starts with the first input.
    fn choose(
        &mut self,
        inputs: &[DVec2],
        length_scales_rad: [f64; 2],
        spacing: f64,
        most: usize,
        chosen: &mut Vec<usize>,
    ) {
        chosen.clear();
        self.panels.clear();
        self.panels.extend(inputs.chunks(WIDTH).map(|chunk| {
            let mut panel = Panel::default();
            for (lane, input) in chunk.iter().enumerate() {
                (panel.azimuths_rad[lane], panel.elevations_rad[lane]) = (input.x, input.y);
                panel.distances_squared[lane] = f64::INFINITY;
            }
            panel
        }));
        let inverse = [1.0 / length_scales_rad[0], 1.0 / length_scales_rad[1]];
        let mut next = 0;
        while chosen.len() < most.min(inputs.len()) {
            chosen.push(next);
            let farthest;
            (next, farthest) = approach(&mut self.panels, inputs[next], inverse);
            if farthest <= spacing * spacing {
                break;
            }
        }
    }
}

/// Updates the distances with one more chosen input, `centre`; returns the first of the farthest inputs and
/// the square of its distance.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq", "x86_64+avx2"))]
fn approach(panels: &mut [Panel], centre: DVec2, inverse_length_scales: [f64; 2]) -> (usize, f64) {
    let mut farthest = [0.0; WIDTH];
    let mut at = [0; WIDTH];
    for (index, panel) in panels.iter_mut().enumerate() {
        for lane in 0..WIDTH {
            let around = (panel.azimuths_rad[lane] - centre.x).abs();
            let dx = lesser(around, TAU - around) * inverse_length_scales[0];
            let dy = (panel.elevations_rad[lane] - centre.y) * inverse_length_scales[1];
            panel.distances_squared[lane] = lesser(panel.distances_squared[lane], dx * dx + dy * dy);
        }
        for lane in 0..WIDTH {
            let distance = panel.distances_squared[lane];
            at[lane] = if distance > farthest[lane] { index } else { at[lane] };
            farthest[lane] = if distance > farthest[lane] { distance } else { farthest[lane] };
        }
    }
    let most = farthest.iter().fold(0.0, |most, &distance| if distance > most { distance } else { most });
    let first = (0..WIDTH).filter(|&lane| farthest[lane] >= most).map(|lane| at[lane] * WIDTH + lane).min();
    (first.unwrap_or(0), most)
}

/// The lesser of two numbers; unlike [`f64::min`] one instruction.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The definition, without shortcuts.
    fn chosen_one_by_one(inputs: &[DVec2], scales: [f64; 2], spacing: f64, most: usize) -> Vec<usize> {
        let distance_squared = |a: DVec2, b: DVec2| {
            let around = (a.x - b.x).abs();
            let dx = around.min(TAU - around) * (1.0 / scales[0]);
            let dy = (a.y - b.y) * (1.0 / scales[1]);
            dx * dx + dy * dy
        };
        let mut chosen = vec![0];
        while chosen.len() < most.min(inputs.len()) {
            let to_chosen = |&input: &DVec2| {
                let distances = chosen.iter().map(|&c| distance_squared(input, inputs[c]));
                distances.fold(f64::INFINITY, f64::min)
            };
            let distances: Vec<f64> = inputs.iter().map(to_chosen).collect();
            let most = distances.iter().copied().fold(0.0, f64::max);
            if most <= spacing * spacing {
                break;
            }
            chosen.extend(distances.iter().position(|&distance| distance >= most));
        }
        chosen
    }

    proptest! {
        #[test]
        fn chooses_as_the_rule_says_with_ties_and_any_number_of_inputs(
            points in prop::collection::vec((-31..31_i32, -3..3_i32), 1..120), most in 1..40_usize,
        ) {
            let inputs: Vec<DVec2> =
                points.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y)) * 0.1).collect();
            let (scales, mut chosen) = ([0.15, 0.05], Vec::new());
            FarthestPoints::default().choose(&inputs, scales, 0.9, most, &mut chosen);
            prop_assert_eq!(chosen, chosen_one_by_one(&inputs, scales, 0.9, most));
        }

        #[test]
        fn every_input_is_near_a_chosen_one_and_the_chosen_are_apart(
            points in prop::collection::vec((-3.1..3.1_f64, -0.26..0.26_f64), 1..200),
        ) {
            let inputs: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
            let scales = [0.15, 0.05];
            let mut chosen = Vec::new();
            FarthestPoints::default().choose(&inputs, scales, 0.9, usize::MAX, &mut chosen);
            let distance = |a: DVec2, b: DVec2| {
                let dx = crate::math::angle::difference_rad(a.x, b.x) / scales[0];
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
