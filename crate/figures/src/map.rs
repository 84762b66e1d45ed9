//! A map of a terrain: shaded relief, contours, axes and a scale, for routes to be drawn on.

use std::fmt::{self, Write as _};

use glam::DVec2;
use mapless_world::HeightField;

use crate::page::{self, ColourBar, INK, embed};
use crate::scale::{nice_step, ticks};
use crate::{FigureError, contours, relief};

/// Largest size of the map on the page; the margins come on top. All in pixels of the SVG.
const MAP_WIDTH: f64 = 820.0;
const MAP_HEIGHT: f64 = 700.0;
const LEFT: f64 = 64.0;
const TOP: f64 = 62.0;
const RIGHT: f64 = 96.0;
const BOTTOM: f64 = 96.0;
/// The legend needs this much even under a narrow map.
const LEAST_WIDTH: f64 = 640.0;

/// A map on its page, drawn but for what goes on it.
pub struct Map<'a> {
    field: &'a HeightField,
    pixels_per_m: f64,
    size: DVec2,
    interval_m: Option<f64>,
}

impl<'a> Map<'a> {
    /// Begins a page with the map of `field`; the caller ends it with `</svg>`. The relief has `detail`
    /// pixels for one of the page: 1 is sharp, less makes a smaller file. Lines of legend beyond the first
    /// make the page longer.
    ///
    /// # Errors
    /// [`FigureError`] when the relief cannot be encoded.
    pub fn begin(
        svg: &mut String,
        field: &'a HeightField,
        title: &str,
        subtitle: &str,
        detail: f64,
        legend_lines: usize,
    ) -> Result<Self, FigureError> {
        let extent_m = field.extent_m();
        let pixels_per_m = (MAP_WIDTH / extent_m.x).min(MAP_HEIGHT / extent_m.y);
        let mut map = Self { field, pixels_per_m, size: extent_m * pixels_per_m, interval_m: None };
        let width = (LEFT + map.size.x + RIGHT).max(LEAST_WIDTH);
        let height = TOP + map.size.y + BOTTOM + LEGEND_LINE * legend_lines.saturating_sub(1) as f64;
        page::begin(svg, DVec2::new(width, height), LEFT, title, subtitle)?;
        embed(svg, DVec2::new(LEFT, TOP), map.size, &relief::png(field, map.size * detail)?)?;
        map.interval_m = map.contours(svg)?;
        map.axes(svg)?;
        map.colour_bar(svg)?;
        map.scale_bar(svg)?;
        Ok(map)
    }

    /// Where a place lies on the page, whose x runs right and whose y runs down.
    pub fn place(&self, at_m: DVec2) -> DVec2 {
        DVec2::new(LEFT + at_m.x * self.pixels_per_m, TOP + self.size.y - at_m.y * self.pixels_per_m)
    }

    /// Pixels of the page for one metre.
    pub fn pixels_per_m(&self) -> f64 {
        self.pixels_per_m
    }

    /// Height between two contour lines; `None` on level ground, which has none.
    pub fn contour_interval_m(&self) -> Option<f64> {
        self.interval_m
    }

    /// Draws a path with a white rim.
    ///
    /// # Errors
    /// None: a `String` takes what is written to it.
    pub fn path(&self, svg: &mut String, path_m: &[DVec2], colour: &str) -> fmt::Result {
        let mut line = String::new();
        for &place in path_m {
            let at = self.place(place);
            write!(line, "{:.1},{:.1} ", at.x, at.y)?;
        }
        for (stroke, width) in [("#fff", 6.0), (colour, 3.0)] {
            writeln!(
                svg,
                r#"<polyline fill="none" stroke="{stroke}" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round" points="{line}"/>"#
            )?;
        }
        Ok(())
    }

    /// Begins the legend under the map.
    pub fn legend(&self) -> Legend {
        let place = DVec2::new(LEFT + 8.0, TOP + self.size.y + 68.0);
        Legend { place, right: (LEFT + self.size.x + RIGHT).max(LEAST_WIDTH) }
    }

    /// Contour lines, every fifth thicker; gives their interval, `None` on level ground.
    fn contours(&self, svg: &mut String) -> Result<Option<f64>, fmt::Error> {
        let (low, high) = self.height_range_m();
        if high - low < 0.01 {
            return Ok(None);
        }
        let interval_m = nice_step((high - low) / 12.0);
        let grid = contours::Grid::sample(self.field);
        for level_m in ticks(low, high, interval_m) {
            let index = (level_m / interval_m).round() % 5.0 == 0.0;
            let (width, opacity) = if index { (1.1, 0.55) } else { (0.7, 0.35) };
            write!(
                svg,
                r#"<path fill="none" stroke="{INK}" stroke-linecap="round" stroke-width="{width}" stroke-opacity="{opacity}" d=""#
            )?;
            for line in grid.contour(level_m) {
                write!(svg, "M")?;
                for place in line {
                    let at = self.place(place);
                    write!(svg, "{:.1} {:.1} ", at.x, at.y)?;
                }
            }
            writeln!(svg, r#""/>"#)?;
        }
        Ok(Some(interval_m))
    }

    fn axes(&self, svg: &mut String) -> fmt::Result {
        let extent = self.field.extent_m();
        let step = nice_step(extent.max_element() / 9.0);
        let (right, bottom) = (LEFT + self.size.x, TOP + self.size.y);
        writeln!(
            svg,
            r#"<rect x="{LEFT}" y="{TOP}" width="{:.2}" height="{:.2}" fill="none" stroke="{INK}"/>"#,
            self.size.x, self.size.y
        )?;
        for x_m in ticks(0.0, extent.x, step) {
            let x = self.place(DVec2::new(x_m, 0.0)).x;
            writeln!(
                svg,
                r#"<path stroke="{INK}" d="M{x:.1} {bottom:.1}v5"/><text x="{x:.1}" y="{:.1}" text-anchor="middle">{x_m}</text>"#,
                bottom + 19.0
            )?;
        }
        for y_m in ticks(0.0, extent.y, step) {
            let y = self.place(DVec2::new(0.0, y_m)).y;
            writeln!(
                svg,
                r#"<path stroke="{INK}" d="M{LEFT} {y:.1}h-5"/><text x="{:.1}" y="{:.1}" text-anchor="end">{y_m}</text>"#,
                LEFT - 9.0,
                y + 4.5
            )?;
        }
        let (middle_x, middle_y) = ((LEFT + right) / 2.0, (TOP + bottom) / 2.0);
        writeln!(
            svg,
            r#"<text x="{middle_x:.1}" y="{:.1}" text-anchor="middle">x, east (m)</text>"#,
            bottom + 38.0
        )?;
        writeln!(
            svg,
            r#"<text transform="translate(18 {middle_y:.1}) rotate(-90)" text-anchor="middle">y, north (m)</text>"#
        )
    }

    fn colour_bar(&self, svg: &mut String) -> fmt::Result {
        let bar = ColourBar {
            id: "elevation",
            label: "elevation (m)",
            place: DVec2::new(LEFT + self.size.x + 20.0, TOP),
            height: self.size.y,
            range: self.height_range_m(),
            ticks: 6.0,
        };
        bar.draw(svg, |share| relief::tint(share).map(|channel| channel.round() as u8))
    }

    /// At the right under the map, in two halves.
    fn scale_bar(&self, svg: &mut String) -> fmt::Result {
        let length_m = nice_step(self.field.extent_m().x / 8.0);
        let length = length_m * self.pixels_per_m;
        let (right, y) = (LEFT + self.size.x, TOP + self.size.y + 46.0);
        let left = right - length;
        writeln!(
            svg,
            r##"<rect x="{left:.1}" y="{y:.1}" width="{length:.1}" height="6" fill="#fff" stroke="{INK}"/><rect x="{left:.1}" y="{y:.1}" width="{:.1}" height="6"/><text x="{:.1}" y="{:.1}" text-anchor="end">{length_m} m</text>"##,
            length / 2.0,
            left - 8.0,
            y + 7.5
        )
    }

    fn height_range_m(&self) -> (f64, f64) {
        let (low, high) = self.field.height_range_m();
        (f64::from(low), f64::from(high))
    }
}

/// Height of a line of the legend.
const LEGEND_LINE: f64 = 24.0;

/// Marks and what they mean, from left to right.
pub struct Legend {
    /// Where the next mark stands.
    pub place: DVec2,
    right: f64,
}

impl Legend {
    /// Writes the words beside the mark at [`Legend::place`], and goes on to the place of the next one.
    ///
    /// # Errors
    /// None: a `String` takes what is written to it.
    pub fn words(&mut self, svg: &mut String, words: &str) -> fmt::Result {
        let DVec2 { x, y } = self.place;
        writeln!(svg, r#"<text x="{:.1}" y="{:.1}">{}</text>"#, x + 18.0, y + 4.5, page::escape(words))?;
        self.place.x += 52.0 + 6.6 * words.chars().count() as f64;
        Ok(())
    }

    /// Draws a stroke with these attributes as the mark at [`Legend::place`].
    ///
    /// # Errors
    /// None: a `String` takes what is written to it.
    pub fn stroke(&self, svg: &mut String, attributes: &str) -> fmt::Result {
        let DVec2 { x, y } = self.place;
        writeln!(svg, r#"<path {attributes} d="M{:.1} {y:.1}h20"/>"#, x - 10.0)
    }

    /// Begins a line of its own where what has `letters` would not fit any more.
    pub fn make_room(&mut self, letters: usize) {
        if self.place.x + 30.0 + 6.6 * letters as f64 > self.right {
            self.place = DVec2::new(LEFT + 8.0, self.place.y + LEGEND_LINE);
        }
    }
}
