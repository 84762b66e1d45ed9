//! The tables of a recipe, as text.

use glam::DVec2;
use std::fmt::Write as _;

/// Collects tables. Trails are applied after all other features, wherever they stand in the recipe.
#[derive(Default)]
pub(super) struct Writer(String);

impl Writer {
    pub(super) fn into_text(self) -> String {
        self.0
    }

    pub(super) fn hill(
        &mut self,
        centre: DVec2,
        height_m: f64,
        radius_m: f64,
        stretch: f64,
        heading_rad: f64,
    ) {
        self.table("hill");
        self.point("centre", centre);
        self.number("height_m", height_m);
        self.number("radius_m", radius_m);
        self.number("stretch", stretch);
        self.number("heading_rad", heading_rad);
    }

    pub(super) fn plateau(&mut self, centre: DVec2, height_m: f64, top_radius_m: f64, flank_m: f64) {
        self.table("plateau");
        self.point("centre", centre);
        self.number("height_m", height_m);
        self.number("top_radius_m", top_radius_m);
        self.number("flank_m", flank_m);
    }

    pub(super) fn ridge(&mut self, points: &[DVec2], heights_m: &[f64], width_m: f64) {
        self.table("ridge");
        self.line(points);
        self.numbers("height_m", heights_m);
        self.number("width_m", width_m);
    }

    pub(super) fn valley(&mut self, points: &[DVec2], depths_m: &[f64], width_m: f64) {
        self.table("valley");
        self.line(points);
        self.numbers("depth_m", depths_m);
        self.number("width_m", width_m);
    }

    pub(super) fn crater(&mut self, centre: DVec2, radius_m: f64, depth_m: f64, rim_height_m: f64) {
        self.table("crater");
        self.point("centre", centre);
        self.number("radius_m", radius_m);
        self.number("depth_m", depth_m);
        self.number("rim_height_m", rim_height_m);
    }

    pub(super) fn noise(&mut self, amplitude_m: f64, wavelength_m: f64, octaves: u32) {
        self.table("noise");
        self.number("amplitude_m", amplitude_m);
        self.number("wavelength_m", wavelength_m);
        self.entry("octaves", &octaves.to_string());
    }

    pub(super) fn trail(&mut self, points: &[DVec2], width_m: f64, shoulder_m: f64, smoothing_m: f64) {
        self.table("trail");
        self.line(points);
        self.number("width_m", width_m);
        self.number("shoulder_m", shoulder_m);
        self.number("smoothing_m", smoothing_m);
    }

    fn table(&mut self, kind: &str) {
        let gap = if self.0.is_empty() { "" } else { "\n" };
        // Writing to a string cannot fail.
        let _ = writeln!(self.0, "{gap}[[{kind}]]");
    }

    fn entry(&mut self, key: &str, value: &str) {
        let _ = writeln!(self.0, "{key} = {value}");
    }

    fn number(&mut self, key: &str, value: f64) {
        self.entry(key, &format!("{value:.3}"));
    }

    fn numbers(&mut self, key: &str, values: &[f64]) {
        let values: Vec<String> = values.iter().map(|value| format!("{value:.3}")).collect();
        self.entry(key, &format!("[{}]", values.join(", ")));
    }

    fn point(&mut self, key: &str, point: DVec2) {
        self.entry(key, &format!("[{:.2}, {:.2}]", point.x, point.y));
    }

    fn line(&mut self, points: &[DVec2]) {
        let points: Vec<String> = points.iter().map(|p| format!("[{:.2}, {:.2}]", p.x, p.y)).collect();
        self.entry("points", &format!("[{}]", points.join(", ")));
    }
}
