//! The kinds of landform.
//!
//! Each draws the steepest slope of a flank and a size; height or depth follow from both. Counts are those of
//! a moderate terrain of 65 m with this kind alone.

use super::writer::Writer;
use glam::DVec2;
use mapless_world::random::Sequence;
use std::f64::consts::{PI, TAU};

/// Steepest slope of a Gaussian of unit height and unit standard deviation.
const GAUSSIAN_SLOPE: f64 = 0.607;
/// Steepest slope of a smooth step of unit height and unit width.
const STEP_SLOPE: f64 = 1.5;
/// Slope of a pass or a ford: safe for a Husky in every direction.
const PASS_SLOPE: [f64; 2] = [0.05, 0.30];

/// The square to be shaped.
pub(super) struct Site {
    pub(super) side_m: f64,
    /// Steepest slope of a flank, from and to.
    pub(super) flank: [f64; 2],
    /// Number of landforms, as a share of those on a moderate terrain with one kind alone.
    pub(super) share: f64,
}

pub(super) struct Landform {
    pub(super) name: &'static str,
    pub(super) shape: fn(&Site, &mut Sequence, &mut Writer),
}

pub(super) const LANDFORMS: [Landform; 6] = [
    Landform { name: "hills and basins", shape: hills_and_basins },
    Landform { name: "ridges with passes", shape: ridges_with_passes },
    Landform { name: "valleys with fords", shape: valleys_with_fords },
    Landform { name: "terraces with ramps", shape: terraces_with_ramps },
    Landform { name: "craters and ditches", shape: craters_and_ditches },
    Landform { name: "rough ground", shape: rough_ground },
];

impl Site {
    /// A number of landforms, `usual` on a moderate terrain of 65 m; at least one.
    fn count(&self, usual: f64, draw: &mut Sequence) -> u32 {
        let area = self.side_m / 65.0;
        ((usual * self.share * area * area * draw.between([0.8, 1.2])).round() as u32).max(1)
    }

    fn place(&self, draw: &mut Sequence) -> DVec2 {
        DVec2::new(draw.share(), draw.share()) * self.side_m
    }

    fn slope(&self, draw: &mut Sequence) -> f64 {
        draw.between(self.flank)
    }

    /// A winding line from one border to another, in `points` points that are 8 to 14 m apart.
    fn crossing(&self, draw: &mut Sequence) -> Vec<DVec2> {
        let middle = DVec2::splat(self.side_m / 2.0);
        let (sin, cos) = libm::sincos(draw.share() * TAU);
        let (along, aside) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
        let offset_m = draw.between([-0.35, 0.35]) * self.side_m;
        let reach_m = 0.75 * self.side_m;
        let count = (2.0 * reach_m / draw.between([8.0, 14.0])).round();
        let at = |index: u32, draw: &mut Sequence| {
            let along_m = reach_m * (2.0 * f64::from(index) / count - 1.0);
            middle + along * along_m + aside * (offset_m + draw.between([-3.0, 3.0]))
        };
        (0..=count as u32).map(|index| at(index, draw)).collect()
    }

    /// A slope for each point of a line: that of a flank, but that of a pass at one point in three or four.
    fn slopes_with_passes(&self, count: usize, draw: &mut Sequence) -> Vec<f64> {
        let flank = self.slope(draw);
        let every = draw.whole([3, 4]);
        let first = draw.whole([0, every - 1]);
        let at = |index: u32| {
            if index % every == first {
                draw.between(PASS_SLOPE).min(flank)
            } else {
                flank * draw.between([0.8, 1.1])
            }
        };
        (0..count as u32).map(at).collect()
    }
}

fn hills_and_basins(site: &Site, draw: &mut Sequence, tables: &mut Writer) {
    for _ in 0..site.count(22.0, draw) {
        let radius_m = draw.between([2.0, 5.5]);
        let sign = if draw.happens(0.3) { -1.0 } else { 1.0 };
        let height_m = sign * site.slope(draw) * radius_m / GAUSSIAN_SLOPE;
        let (stretch, heading_rad) = (draw.between([1.0, 1.8]), draw.share() * PI);
        tables.hill(site.place(draw), height_m, radius_m, stretch, heading_rad);
    }
}

fn ridges_with_passes(site: &Site, draw: &mut Sequence, tables: &mut Writer) {
    for _ in 0..site.count(3.5, draw) {
        let points = site.crossing(draw);
        let width_m = draw.between([1.6, 3.5]);
        let slopes = site.slopes_with_passes(points.len(), draw);
        let heights_m: Vec<f64> = slopes.iter().map(|slope| slope * width_m / GAUSSIAN_SLOPE).collect();
        tables.ridge(&points, &heights_m, width_m);
    }
}

fn valleys_with_fords(site: &Site, draw: &mut Sequence, tables: &mut Writer) {
    for _ in 0..site.count(3.5, draw) {
        let points = site.crossing(draw);
        let width_m = draw.between([1.2, 3.0]);
        let slopes = site.slopes_with_passes(points.len(), draw);
        let depths_m: Vec<f64> = slopes.iter().map(|slope| slope * width_m / GAUSSIAN_SLOPE).collect();
        tables.valley(&points, &depths_m, width_m);
    }
}

/// Steps across the whole terrain, each the border of a plateau whose middle lies far outside.
fn terraces_with_ramps(site: &Site, draw: &mut Sequence, tables: &mut Writer) {
    let middle = DVec2::splat(site.side_m / 2.0);
    let (sin, cos) = libm::sincos(draw.share() * TAU);
    let uphill = DVec2::new(cos, sin);
    let steps = site.count(4.0, draw).min(6);
    for step in 0..steps {
        let radius_m = draw.between([1.2, 2.5]) * site.side_m;
        let height_m = draw.between([0.5, 1.6]);
        let flank_m = STEP_SLOPE * height_m / site.slope(draw);
        let along_m = site.side_m * ((f64::from(step) + draw.between([0.3, 0.7])) / f64::from(steps) - 0.5);
        let centre = middle + uphill * (along_m + radius_m);
        tables.plateau(centre, height_m, radius_m, flank_m);
        for _ in 0..draw.whole([2, 4]) {
            let angle_rad = draw.between([-0.35, 0.35]) * site.side_m / radius_m;
            let (turn_sin, turn_cos) = libm::sincos(angle_rad);
            let down = -uphill.rotate(DVec2::new(turn_cos, turn_sin));
            let reach_m = flank_m / 2.0 + 3.0 * height_m + 2.0;
            let at = |out_m: f64| centre + down * (radius_m + flank_m / 2.0 + out_m);
            let points = [at(-reach_m), at(0.0), at(reach_m)];
            let inside = |p: &DVec2| p.min_element() >= 0.0 && p.max_element() <= site.side_m;
            if points.iter().all(inside) {
                tables.trail(&points, draw.between([2.5, 4.0]), draw.between([1.5, 3.0]), 1.6 * reach_m);
            }
        }
    }
}

fn craters_and_ditches(site: &Site, draw: &mut Sequence, tables: &mut Writer) {
    for _ in 0..site.count(14.0, draw) {
        let radius_m = draw.between([1.5, 6.0]);
        let relief_m = site.slope(draw) * radius_m / STEP_SLOPE;
        let rim_m = relief_m * draw.between([0.1, 0.35]);
        tables.crater(site.place(draw), radius_m, relief_m - rim_m, rim_m);
    }
    for _ in 0..site.count(6.0, draw) {
        let begin = site.place(draw);
        let (sin, cos) = libm::sincos(draw.share() * TAU);
        let along = DVec2::new(cos, sin) * draw.between([3.0, 7.0]);
        let bend = DVec2::new(-sin, cos) * draw.between([-2.0, 2.0]);
        let width_m = draw.between([0.7, 1.3]);
        let depth_m = site.slope(draw) * width_m / GAUSSIAN_SLOPE;
        let points = [begin, begin + along + bend, begin + along * 2.0];
        tables.valley(&points, &[0.3 * depth_m, depth_m, 0.3 * depth_m], width_m);
    }
}

/// Fractal noise; with five octaves of one slope each, its steepest places have about the slope drawn.
fn rough_ground(site: &Site, draw: &mut Sequence, tables: &mut Writer) {
    let wavelength_m = draw.between([10.0, 20.0]);
    let share = site.share.min(1.0);
    tables.noise(0.16 * share * site.slope(draw) * wavelength_m, wavelength_m, 5);
}
