//! The unfolded variance surface with the profile, its segments and the subgoals (the paper's variance
//! image).

use std::fmt::{self, Write as _};

use glam::DVec2;
use mapless::Step;
use mapless::decision::subgoals::Subgoal;
use mapless::skyline::columns::{COLUMNS, column_azimuth_rad};
use mapless::skyline::profile::Column;
use mapless::skyline::segments::{Segment, Verdict};
use mapless::skyline::surface::PredictedSurface;

use super::directions::{LEFT, Panel, SIZE, grey};
use mapless_figures::marks;
use mapless_figures::page::{self, ColourBar, INK, css};

const PANEL: Panel = Panel { top: 88.0 };
const WIDTH: f64 = LEFT + SIZE.x + 190.0;
const LEGEND: f64 = PANEL.top + SIZE.y + 68.0;
const HEIGHT: f64 = LEGEND + 52.0;
/// Colour of the edge between observed and free.
const PROFILE: &str = "#00a0e0";

/// The contents of the picture.
pub(crate) struct VarianceImage<'a> {
    pub(crate) title: &'a str,
    pub(crate) subtitle: &'a str,
    pub(crate) step: &'a Step<'a>,
    pub(crate) predicted: &'a PredictedSurface,
    /// V_th, a share of the signal variance.
    pub(crate) variance_threshold: f64,
}

impl VarianceImage<'_> {
    /// Draws the picture.
    pub(crate) fn svg(&self) -> anyhow::Result<String> {
        let mut svg = String::new();
        page::begin(&mut svg, DVec2::new(WIDTH, HEIGHT), LEFT, self.title, self.subtitle)?;
        writeln!(
            svg,
            r##"<pattern id="unknown" width="7" height="7" patternUnits="userSpaceOnUse" patternTransform="rotate(45)"><rect width="7" height="7" fill="#fff"/><path stroke="#8a8a8a" stroke-width="2" d="M0 0V7"/></pattern>"##
        )?;
        PANEL.paint(&mut svg, self.predicted.rows(), |column, row| {
            grey(self.predicted.variance_column(column)[row])
        })?;
        for segment in self.step.segments {
            area(&mut svg, segment)?;
        }
        self.profile(&mut svg)?;
        for segment in self.step.segments {
            level(&mut svg, segment)?;
        }
        PANEL.frame(&mut svg, "Variance: dark where ground was observed, white where space is free")?;
        PANEL.azimuth_label(&mut svg)?;
        self.subgoals(&mut svg)?;
        self.bars(&mut svg)?;
        legend(&mut svg, self.step.observed.radius_m())?;
        writeln!(svg, "</svg>")?;
        Ok(svg)
    }

    /// A line through the columns with ground, broken elsewhere and behind the robot.
    fn profile(&self, svg: &mut String) -> fmt::Result {
        let mut line = String::new();
        let mut drawing = false;
        for (column, kind) in self.step.profile.iter().enumerate().take(COLUMNS) {
            if let Column::Ground { elevation_rad } = *kind {
                let at = PANEL.place(column_azimuth_rad(column), elevation_rad);
                write!(line, "{}{:.1} {:.1}", if drawing { 'L' } else { 'M' }, at.x, at.y)?;
            }
            drawing = matches!(kind, Column::Ground { .. });
        }
        for (stroke, width) in [("#fff", 4.0), (PROFILE, 1.8)] {
            writeln!(
                svg,
                r#"<path fill="none" stroke="{stroke}" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round" d="{line}"/>"#
            )?;
        }
        Ok(())
    }

    /// Every subgoal, the chosen one last and ringed.
    fn subgoals(&self, svg: &mut String) -> fmt::Result {
        let costs = self.cost_range();
        let chosen = self.step.chosen;
        let others = self.step.subgoals.iter().enumerate().filter(|(index, _)| Some(*index) != chosen);
        for (_, subgoal) in others {
            mark(svg, place(subgoal), subgoal_colour(subgoal, costs).as_deref())?;
        }
        if let Some(subgoal) = chosen.and_then(|index| self.step.subgoals.get(index)) {
            ring(svg, place(subgoal))?;
            mark(svg, place(subgoal), subgoal_colour(subgoal, costs).as_deref())?;
        }
        Ok(())
    }

    /// Least and greatest cost of the candidates.
    fn cost_range(&self) -> (f64, f64) {
        let costs = self.step.subgoals.iter().filter_map(|subgoal| subgoal.cost).map(|cost| cost.total());
        costs
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), cost| (least.min(cost), most.max(cost)))
    }

    fn bars(&self, svg: &mut String) -> fmt::Result {
        let left = LEFT + SIZE.x + 20.0;
        let bar = ColourBar {
            id: "variance",
            label: "share of prior variance",
            place: DVec2::new(left, PANEL.top),
            height: SIZE.y,
            range: (0.0, 1.0),
            ticks: 5.0,
        };
        bar.draw(svg, grey)?;
        let y = PANEL.top + SIZE.y * (1.0 - self.variance_threshold);
        for (stroke, width) in [("#fff", 4.0), (PROFILE, 2.0)] {
            writeln!(svg, r#"<path stroke="{stroke}" stroke-width="{width}" d="M{left:.1} {y:.1}h16"/>"#)?;
        }
        let range = self.cost_range();
        if range.0 > range.1 {
            return Ok(());
        }
        let bar = ColourBar {
            id: "cost",
            label: "cost of a subgoal",
            place: DVec2::new(left + 88.0, PANEL.top),
            range,
            ..bar
        };
        bar.draw(svg, cost_colour)
    }
}

/// Marks the columns without ground.
fn area(svg: &mut String, segment: &Segment) -> fmt::Result {
    for (left, right) in PANEL.across(segment.begin_rad, segment.extent_rad) {
        shade(svg, DVec2::new(left, PANEL.top), DVec2::new(right - left, SIZE.y), segment.verdict)?;
    }
    Ok(())
}

/// Hatched if unknown, reddened below a red band for a wall.
fn shade(svg: &mut String, place: DVec2, size: DVec2, verdict: Verdict) -> fmt::Result {
    let mut rectangle = |height: f64, fill: &str, opacity: f64| {
        writeln!(
            svg,
            r#"<rect x="{:.1}" y="{:.1}" width="{:.1}" height="{height:.1}" fill="{fill}" fill-opacity="{opacity}"/>"#,
            place.x, place.y, size.x
        )
    };
    match verdict {
        Verdict::Unknown => rectangle(size.y, "url(#unknown)", 0.7),
        Verdict::Wall => {
            rectangle(size.y, verdict_colour(verdict), 0.25)?;
            rectangle(5.0, verdict_colour(verdict), 1.0)
        }
        Verdict::Valid | Verdict::TooNarrow | Verdict::TooSteep => Ok(()),
    }
}

/// The elevation of a segment with ground, in the colour of its verdict.
fn level(svg: &mut String, segment: &Segment) -> fmt::Result {
    let Some(elevation_rad) = segment.elevation_rad else { return Ok(()) };
    let y = PANEL.y(elevation_rad);
    for (left, right) in PANEL.across(segment.begin_rad, segment.extent_rad) {
        stroke(svg, DVec2::new(left, y), right - left, verdict_colour(segment.verdict))?;
    }
    Ok(())
}

fn stroke(svg: &mut String, left: DVec2, length: f64, colour: &str) -> fmt::Result {
    for (stroke, width) in [("#fff", 5.5), (colour, 3.0)] {
        writeln!(
            svg,
            r#"<path stroke="{stroke}" stroke-width="{width}" d="M{:.1} {:.1}h{length:.1}"/>"#,
            left.x, left.y
        )?;
    }
    Ok(())
}

fn verdict_colour(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Valid => "#0a8a3a",
        Verdict::TooNarrow => "#8a5cc4",
        Verdict::TooSteep | Verdict::Wall => "#d4002a",
        Verdict::Unknown => "#8a8a8a",
    }
}

/// As in the paper, warm is cheap; the map also reads with colour-blind eyes.
fn cost_colour(share: f64) -> [u8; 3] {
    let (r, g, b) = colorous::RED_YELLOW_BLUE.eval_continuous(share.clamp(0.0, 1.0)).as_tuple();
    [r, g, b]
}

/// `None` for a refused subgoal; the goal itself, which has no cost, is the cheapest.
fn subgoal_colour(subgoal: &Subgoal, (least, most): (f64, f64)) -> Option<String> {
    if subgoal.refusal.is_some() {
        return None;
    }
    let above = subgoal.cost.map_or(0.0, |cost| cost.total() - least);
    Some(css(cost_colour(if most > least { above / (most - least) } else { 0.0 })))
}

fn place(subgoal: &Subgoal) -> DVec2 {
    PANEL.place(subgoal.azimuth_rad, subgoal.elevation_rad)
}

/// A disc, or a cross for a refused subgoal.
fn mark(svg: &mut String, at: DVec2, fill: Option<&str>) -> fmt::Result {
    if let Some(fill) = fill {
        return writeln!(
            svg,
            r#"<circle cx="{:.1}" cy="{:.1}" r="6" fill="{fill}" stroke="{INK}" stroke-width="1.4"/>"#,
            at.x, at.y
        );
    }
    marks::cross(svg, at, 4.0, [4.5, 2.0])
}

fn ring(svg: &mut String, at: DVec2) -> fmt::Result {
    for (stroke, width) in [("#fff", 6.0), (INK, 2.5)] {
        writeln!(
            svg,
            r#"<circle cx="{:.1}" cy="{:.1}" r="11" fill="none" stroke="{stroke}" stroke-width="{width}"/>"#,
            at.x, at.y
        )?;
    }
    Ok(())
}

/// Two lines under the panel: perception, and the decision.
fn legend(svg: &mut String, radius_m: f64) -> fmt::Result {
    let (mut x, mut y) = (LEFT + 12.0, LEGEND);
    // Writes the words beside the mark at x; returns the position of the next mark.
    let words = |svg: &mut String, x: f64, y: f64, words: &str| -> Result<f64, fmt::Error> {
        writeln!(svg, r#"<text x="{:.1}" y="{:.1}">{words}</text>"#, x + 20.0, y + 4.5)?;
        Ok(x + 54.0 + 6.6 * words.chars().count() as f64)
    };
    writeln!(svg, r#"<path stroke="{PROFILE}" stroke-width="2" d="M{:.1} {y:.1}h20"/>"#, x - 8.0)?;
    x = words(svg, x, y, "profile, where the variance crosses its threshold")?;
    for (verdict, name) in [
        (Verdict::Unknown, format!("unknown: no return within {radius_m} m")),
        (Verdict::Wall, "wall: occupied up to 15°".to_owned()),
    ] {
        shade(svg, DVec2::new(x - 8.0, y - 8.0), DVec2::new(20.0, 16.0), verdict)?;
        x = words(svg, x, y, &name)?;
    }
    (x, y) = (LEFT + 12.0, LEGEND + 28.0);
    for (verdict, name) in
        [(Verdict::Valid, "segment"), (Verdict::TooNarrow, "too narrow"), (Verdict::TooSteep, "too steep")]
    {
        stroke(svg, DVec2::new(x - 8.0, y), 20.0, verdict_colour(verdict))?;
        x = words(svg, x, y, name)?;
    }
    mark(svg, DVec2::new(x, y), Some(&css(cost_colour(0.1))))?;
    x = words(svg, x, y, "subgoal, warm is cheap")?;
    mark(svg, DVec2::new(x, y), None)?;
    x = words(svg, x, y, "refused")?;
    ring(svg, DVec2::new(x, y))?;
    words(svg, x, y, "chosen")?;
    Ok(())
}
