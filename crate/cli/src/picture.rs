//! Pictures, as SVG: of a trial, its path over the elevation; of a scan, what perception makes of it.

mod contours;
mod directions;
mod marks;
mod occupancy;
mod page;
mod relief;
mod scale;
mod variance_image;

use std::fmt::{self, Write as _};

use glam::DVec2;
use mapless_trials::{Outcome, StartPose};
use mapless_world::HeightField;

use page::{ColourBar, INK, embed};
use scale::{nice_step, ticks};

pub(crate) use occupancy::OccupancyPicture;
pub(crate) use variance_image::VarianceImage;

/// Largest size of the map on the page; the margins come on top. All in pixels of the SVG.
const MAP_WIDTH: f64 = 820.0;
const MAP_HEIGHT: f64 = 700.0;
const LEFT: f64 = 64.0;
const TOP: f64 = 62.0;
const RIGHT: f64 = 96.0;
const BOTTOM: f64 = 96.0;
/// The legend needs this much even under a narrow map.
const LEAST_WIDTH: f64 = 640.0;

/// Colour of the path and the flag.
const PATH: &str = "#b3002d";

/// What the picture shows of a trial.
pub(crate) struct Picture<'a> {
    pub(crate) title: String,
    pub(crate) subtitle: String,
    pub(crate) field: &'a HeightField,
    pub(crate) start: StartPose,
    pub(crate) goal_m: DVec2,
    pub(crate) goal_tolerance_m: f64,
    pub(crate) path_m: &'a [DVec2],
    pub(crate) subgoals_m: &'a [DVec2],
    pub(crate) outcome: Outcome,
}

/// Where things are on the page.
struct Layout {
    pixels_per_m: f64,
    size: DVec2,
}

impl Layout {
    fn new(extent_m: DVec2) -> Self {
        let pixels_per_m = (MAP_WIDTH / extent_m.x).min(MAP_HEIGHT / extent_m.y);
        Self { pixels_per_m, size: extent_m * pixels_per_m }
    }

    /// The page's x runs right and its y down.
    fn place(&self, at_m: DVec2) -> DVec2 {
        DVec2::new(LEFT + at_m.x * self.pixels_per_m, TOP + self.size.y - at_m.y * self.pixels_per_m)
    }
}

impl Picture<'_> {
    /// Draws the picture.
    pub(crate) fn svg(&self) -> anyhow::Result<String> {
        let layout = Layout::new(self.field.extent_m());
        let relief = relief::png(self.field, layout.size)?;
        let width = (LEFT + layout.size.x + RIGHT).max(LEAST_WIDTH);
        let height = TOP + layout.size.y + BOTTOM;
        let mut svg = String::new();
        page::begin(&mut svg, DVec2::new(width, height), LEFT, &self.title, &self.subtitle)?;
        embed(&mut svg, DVec2::new(LEFT, TOP), layout.size, &relief)?;
        let interval_m = self.contours(&mut svg, &layout)?;
        self.axes(&mut svg, &layout)?;
        self.colour_bar(&mut svg, &layout)?;
        self.route(&mut svg, &layout)?;
        self.legend(&mut svg, &layout, interval_m)?;
        writeln!(svg, "</svg>")?;
        Ok(svg)
    }

    /// Contour lines, every fifth thicker; gives their interval, `None` on level ground.
    fn contours(&self, svg: &mut String, layout: &Layout) -> Result<Option<f64>, fmt::Error> {
        let (low, high) = self.field.height_range_m();
        let (low, high) = (f64::from(low), f64::from(high));
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
                    let at = layout.place(place);
                    write!(svg, "{:.1} {:.1} ", at.x, at.y)?;
                }
            }
            writeln!(svg, r#""/>"#)?;
        }
        Ok(Some(interval_m))
    }

    fn axes(&self, svg: &mut String, layout: &Layout) -> fmt::Result {
        let extent = self.field.extent_m();
        let step = nice_step(extent.max_element() / 9.0);
        let (right, bottom) = (LEFT + layout.size.x, TOP + layout.size.y);
        writeln!(
            svg,
            r#"<rect x="{LEFT}" y="{TOP}" width="{:.2}" height="{:.2}" fill="none" stroke="{INK}"/>"#,
            layout.size.x, layout.size.y
        )?;
        for x_m in ticks(0.0, extent.x, step) {
            let x = layout.place(DVec2::new(x_m, 0.0)).x;
            writeln!(
                svg,
                r#"<path stroke="{INK}" d="M{x:.1} {bottom:.1}v5"/><text x="{x:.1}" y="{:.1}" text-anchor="middle">{x_m}</text>"#,
                bottom + 19.0
            )?;
        }
        for y_m in ticks(0.0, extent.y, step) {
            let y = layout.place(DVec2::new(0.0, y_m)).y;
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

    fn colour_bar(&self, svg: &mut String, layout: &Layout) -> fmt::Result {
        let (low, high) = self.field.height_range_m();
        let (low, high) = (f64::from(low), f64::from(high));
        let bar = ColourBar {
            id: "elevation",
            label: "elevation (m)",
            place: DVec2::new(LEFT + layout.size.x + 20.0, TOP),
            height: layout.size.y,
            range: (low, high),
            ticks: 6.0,
        };
        bar.draw(svg, |share| relief::tint(share).map(|channel| channel.round() as u8))
    }

    fn route(&self, svg: &mut String, layout: &Layout) -> fmt::Result {
        for &subgoal in self.subgoals_m.iter().filter(|&&subgoal| self.field.contains(subgoal)) {
            marks::subgoal(svg, layout.place(subgoal))?;
        }
        let mut line = String::new();
        for &place in self.path_m {
            let at = layout.place(place);
            write!(line, "{:.1},{:.1} ", at.x, at.y)?;
        }
        for (stroke, width) in [("#fff", 6.0), (PATH, 3.0)] {
            writeln!(
                svg,
                r#"<polyline fill="none" stroke="{stroke}" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round" points="{line}"/>"#
            )?;
        }
        let goal = layout.place(self.goal_m);
        marks::arrival(svg, goal, self.goal_tolerance_m * layout.pixels_per_m)?;
        marks::flag(svg, goal)?;
        marks::start(svg, layout.place(self.start.position_m), self.start.heading_rad)?;
        match self.path_m.last() {
            Some(&end) if self.outcome != Outcome::Reached => marks::end(svg, layout.place(end)),
            _ => Ok(()),
        }
    }

    fn legend(&self, svg: &mut String, layout: &Layout, interval_m: Option<f64>) -> fmt::Result {
        let y = TOP + layout.size.y + 68.0;
        let mut x = LEFT + 8.0;
        // Writes the words beside the mark at x and gives the place of the next mark.
        let words = |svg: &mut String, x: f64, words: &str| -> Result<f64, fmt::Error> {
            writeln!(svg, r#"<text x="{:.1}" y="{:.1}">{words}</text>"#, x + 18.0, y + 4.5)?;
            Ok(x + 52.0 + 6.6 * words.chars().count() as f64)
        };
        marks::start(svg, DVec2::new(x, y), 0.0)?;
        x = words(svg, x, "start")?;
        marks::flag(svg, DVec2::new(x - 6.0, y + 9.0))?;
        x = words(svg, x, "goal")?;
        writeln!(svg, r#"<path stroke="{PATH}" stroke-width="3" d="M{:.1} {y:.1}h20"/>"#, x - 10.0)?;
        x = words(svg, x, "path")?;
        marks::subgoal(svg, DVec2::new(x, y))?;
        x = words(svg, x, "chosen subgoals")?;
        if self.outcome != Outcome::Reached {
            marks::end(svg, DVec2::new(x, y))?;
            x = words(svg, x, self.outcome.name())?;
        }
        if let Some(interval_m) = interval_m {
            writeln!(svg, r#"<path stroke="{INK}" stroke-opacity="0.55" d="M{:.1} {y:.1}h20"/>"#, x - 10.0)?;
            words(svg, x, &format!("contours every {interval_m} m"))?;
        }
        self.scale_bar(svg, layout)
    }

    /// At the right under the map, in two halves.
    fn scale_bar(&self, svg: &mut String, layout: &Layout) -> fmt::Result {
        let length_m = nice_step(self.field.extent_m().x / 8.0);
        let length = length_m * layout.pixels_per_m;
        let (right, y) = (LEFT + layout.size.x, TOP + layout.size.y + 46.0);
        let left = right - length;
        writeln!(
            svg,
            r##"<rect x="{left:.1}" y="{y:.1}" width="{length:.1}" height="6" fill="#fff" stroke="{INK}"/><rect x="{left:.1}" y="{y:.1}" width="{:.1}" height="6"/><text x="{:.1}" y="{:.1}" text-anchor="end">{length_m} m</text>"##,
            length / 2.0,
            left - 8.0,
            y + 7.5
        )
    }
}
