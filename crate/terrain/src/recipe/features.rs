//! The features that add to the ground.

use super::canvas::{Canvas, TooMuch};
use super::check::{PerPoint, Table};
use super::line::Line;
use crate::terrain::TerrainFault;
use glam::DVec2;
use mapless_world::noise::GradientNoise;
use mapless_world::smooth_step;
use serde::Deserialize;

/// A Gaussian is cut where it has fallen below 2e-8 of its height.
pub(super) const GAUSSIAN_REACH: f64 = 6.0;

/// One table of a recipe.
pub(super) trait Feature {
    /// Checks every value.
    fn check(&self, table: &Table, canvas: &Canvas) -> Result<(), TerrainFault>;
    /// Changes the ground; fails if that touches too many samples.
    fn apply(&self, canvas: &mut Canvas, seed: u64) -> Result<(), TooMuch>;
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Hill {
    centre: [f64; 2],
    height_m: f64,
    radius_m: f64,
    #[serde(default = "one")]
    stretch: f64,
    #[serde(default)]
    heading_rad: f64,
}

fn one() -> f64 {
    1.0
}

impl Feature for Hill {
    fn check(&self, table: &Table, _: &Canvas) -> Result<(), TerrainFault> {
        table.point("centre", self.centre)?;
        table.finite("height_m", self.height_m)?;
        table.positive("radius_m", self.radius_m)?;
        table.positive("stretch", self.stretch)?;
        table.finite("heading_rad", self.heading_rad)
    }

    fn apply(&self, canvas: &mut Canvas, _: u64) -> Result<(), TooMuch> {
        let centre = DVec2::from_array(self.centre);
        let reach = DVec2::splat(GAUSSIAN_REACH * self.radius_m * self.stretch.max(1.0));
        let (sin, cos) = libm::sincos(self.heading_rad);
        canvas.each_within(centre - reach, centre + reach, |at, height_m| {
            let away = (at - centre) / self.radius_m;
            let along = (away.x * cos + away.y * sin) / self.stretch;
            let across = away.y * cos - away.x * sin;
            *height_m += self.height_m * libm::exp(-0.5 * (along * along + across * across));
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plateau {
    centre: [f64; 2],
    height_m: f64,
    top_radius_m: f64,
    flank_m: f64,
}

impl Feature for Plateau {
    fn check(&self, table: &Table, _: &Canvas) -> Result<(), TerrainFault> {
        table.point("centre", self.centre)?;
        table.finite("height_m", self.height_m)?;
        table.not_negative("top_radius_m", self.top_radius_m)?;
        table.positive("flank_m", self.flank_m)
    }

    fn apply(&self, canvas: &mut Canvas, _: u64) -> Result<(), TooMuch> {
        let centre = DVec2::from_array(self.centre);
        let reach = DVec2::splat(self.top_radius_m + self.flank_m);
        canvas.each_within(centre - reach, centre + reach, |at, height_m| {
            let down = (at.distance(centre) - self.top_radius_m) / self.flank_m;
            *height_m += self.height_m * (1.0 - smooth_step(down));
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Ridge {
    points: Vec<[f64; 2]>,
    height_m: PerPoint,
    width_m: f64,
}

impl Feature for Ridge {
    fn check(&self, table: &Table, _: &Canvas) -> Result<(), TerrainFault> {
        table.line(&self.points)?;
        table.per_point("height_m", &self.height_m, self.points.len())?;
        table.positive("width_m", self.width_m)
    }

    fn apply(&self, canvas: &mut Canvas, _: u64) -> Result<(), TooMuch> {
        add_along(canvas, &self.points, self.width_m, &self.height_m.values(self.points.len()), 1.0)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Valley {
    points: Vec<[f64; 2]>,
    depth_m: PerPoint,
    width_m: f64,
}

impl Feature for Valley {
    fn check(&self, table: &Table, _: &Canvas) -> Result<(), TerrainFault> {
        table.line(&self.points)?;
        table.per_point("depth_m", &self.depth_m, self.points.len())?;
        table.positive("width_m", self.width_m)
    }

    fn apply(&self, canvas: &mut Canvas, _: u64) -> Result<(), TooMuch> {
        add_along(canvas, &self.points, self.width_m, &self.depth_m.values(self.points.len()), -1.0)
    }
}

/// Adds `sign` times the heights at the points, with a Gaussian across the line.
fn add_along(
    canvas: &mut Canvas,
    points: &[[f64; 2]],
    width_m: f64,
    heights_m: &[f64],
    sign: f64,
) -> Result<(), TooMuch> {
    let line = Line::through(points);
    line.each_near(canvas, GAUSSIAN_REACH * width_m, |nearest, height_m| {
        let crest_m = line.value(heights_m, nearest.along_m);
        *height_m += sign * crest_m * libm::exp(-0.5 * nearest.distance2_m2 / (width_m * width_m));
    })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Crater {
    centre: [f64; 2],
    radius_m: f64,
    depth_m: f64,
    rim_height_m: f64,
}

/// Width of the outer flank of a crater's rim, in radii: one standard deviation.
const RIM_FLANK: f64 = 0.35;

impl Feature for Crater {
    fn check(&self, table: &Table, _: &Canvas) -> Result<(), TerrainFault> {
        table.point("centre", self.centre)?;
        table.positive("radius_m", self.radius_m)?;
        table.positive("depth_m", self.depth_m)?;
        table.not_negative("rim_height_m", self.rim_height_m)
    }

    fn apply(&self, canvas: &mut Canvas, _: u64) -> Result<(), TooMuch> {
        let centre = DVec2::from_array(self.centre);
        let reach = DVec2::splat(self.radius_m * (1.0 + GAUSSIAN_REACH * RIM_FLANK));
        canvas.each_within(centre - reach, centre + reach, |at, height_m| {
            let radii = at.distance(centre) / self.radius_m;
            *height_m += if radii < 1.0 {
                (self.depth_m + self.rim_height_m) * smooth_step(radii) - self.depth_m
            } else {
                let out = (radii - 1.0) / RIM_FLANK;
                self.rim_height_m * libm::exp(-0.5 * out * out)
            };
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Noise {
    amplitude_m: f64,
    wavelength_m: f64,
    octaves: u32,
}

impl Feature for Noise {
    fn check(&self, table: &Table, canvas: &Canvas) -> Result<(), TerrainFault> {
        table.finite("amplitude_m", self.amplitude_m)?;
        table.positive("wavelength_m", self.wavelength_m)?;
        // Finer octaves would fall between the samples.
        let most = (1..=24)
            .take_while(|&n| self.wavelength_m >= canvas.cell_m * 2.0 * f64::from(1u32 << (n - 1)))
            .count();
        if most == 0 {
            return Err(table.fault(
                "wavelength_m",
                self.wavelength_m,
                format!("at least two cells, {} m", 2.0 * canvas.cell_m),
            ));
        }
        if self.octaves == 0 || self.octaves as usize > most {
            let expected = format!("1 to {most}, so that the finest wave spans two cells");
            return Err(table.fault("octaves", self.octaves, expected));
        }
        Ok(())
    }

    fn apply(&self, canvas: &mut Canvas, seed: u64) -> Result<(), TooMuch> {
        for octave in 0..self.octaves {
            let share = f64::from(1u32 << octave);
            let (amplitude_m, frequency) = (self.amplitude_m / share, share / self.wavelength_m);
            let octave_seed = mapless_world::random::key(seed, u64::from(octave));
            let mut noise = GradientNoise::new(octave_seed);
            canvas.each(|at, height_m| *height_m += amplitude_m * noise.at(at * frequency))?;
        }
        Ok(())
    }
}
