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

    pub(super) fn rock(&mut self, at: DVec2, radius_m: f64, sunk_m: f64) {
        self.object("rock");
        self.point("at", at);
        self.number("radius_m", radius_m);
        self.number("sunk_m", sunk_m);
    }

    pub(super) fn post(&mut self, at: DVec2, radius_m: f64, height_m: f64) {
        self.object("post");
        self.point("at", at);
        self.number("radius_m", radius_m);
        self.number("height_m", height_m);
    }

    pub(super) fn wall(&mut self, from: DVec2, to: DVec2, height_m: f64) {
        self.object("wall");
        self.point("from", from);
        self.point("to", to);
        self.number("height_m", height_m);
    }

    /// `through` is the direction in which it is driven through.
    pub(super) fn gate(&mut self, at: DVec2, through: DVec2, width_m: f64, height_m: f64) {
        self.object("gate");
        self.point("at", at);
        self.number("yaw_rad", libm::atan2(through.y, through.x));
        self.number("width_m", width_m);
        self.number("height_m", height_m);
    }

    /// A post of this radius and height that walks to a place and back.
    pub(super) fn walker(
        &mut self,
        at: DVec2,
        [radius_m, height_m]: [f64; 2],
        to: DVec2,
        speed_m_s: f64,
        starts_within_m: Option<f64>,
    ) {
        self.post(at, radius_m, height_m);
        let starts = starts_within_m.map(|near_m| format!(", starts_within_m = {near_m:.2}"));
        self.entry(
            "walk",
            &format!(
                "{{ path = [[{:.2}, {:.2}]], speed_m_s = {speed_m_s:.2}{} }}",
                to.x,
                to.y,
                starts.unwrap_or_default()
            ),
        );
    }

    fn object(&mut self, kind: &str) {
        self.table("objects");
        self.entry("kind", &format!("{kind:?}"));
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
