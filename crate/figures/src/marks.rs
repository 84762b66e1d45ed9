//! The marks on the map, which the legend repeats.

use std::fmt::{self, Write as _};

use glam::DVec2;

use crate::page::INK;

/// Colour of a path and of the flag at its end.
pub const PATH: &str = "#b3002d";

/// A disc with a beak in the heading.
pub fn start(svg: &mut String, at: DVec2, heading_rad: f64) -> fmt::Result {
    writeln!(
        svg,
        r##"<g transform="translate({:.1} {:.1}) rotate({:.1})"><path d="M13 0L5 -5.2A7 7 0 1 0 5 5.2Z" fill="#fff" stroke="{INK}" stroke-width="1.8" stroke-linejoin="round"/></g>"##,
        at.x,
        at.y,
        -heading_rad.to_degrees()
    )
}

/// The circle that counts as arrival.
pub fn arrival(svg: &mut String, at: DVec2, radius: f64) -> fmt::Result {
    writeln!(
        svg,
        r##"<circle cx="{:.1}" cy="{:.1}" r="{radius:.1}" fill="#fff" fill-opacity="0.35" stroke="{INK}" stroke-dasharray="4 3"/>"##,
        at.x, at.y
    )
}

/// A flag with its foot at the goal.
pub fn flag(svg: &mut String, foot: DVec2) -> fmt::Result {
    writeln!(
        svg,
        r#"<path d="M{:.1} {:.1}v-22l16 6l-16 6" fill="{PATH}" stroke="{INK}" stroke-width="1.8" stroke-linejoin="round"/>"#,
        foot.x, foot.y
    )
}

/// A dot where a subgoal was chosen.
pub fn subgoal(svg: &mut String, at: DVec2) -> fmt::Result {
    writeln!(
        svg,
        r##"<circle cx="{:.1}" cy="{:.1}" r="2.4" fill="#fff" fill-opacity="0.8" stroke="{INK}" stroke-opacity="0.5" stroke-width="0.7"/>"##,
        at.x, at.y
    )
}

/// A cross where the robot ended without reaching the goal.
pub fn end(svg: &mut String, at: DVec2) -> fmt::Result {
    cross(svg, at, 7.0, [6.0, 3.0])
}

/// A cross that reaches `half` to each side, its strokes as wide as its white rim and its ink.
pub fn cross(svg: &mut String, at: DVec2, half: f64, [rim, ink]: [f64; 2]) -> fmt::Result {
    let (x, y, side) = (at.x - half, at.y - half, 2.0 * half);
    for (stroke, width) in [("#fff", rim), (INK, ink)] {
        writeln!(
            svg,
            r#"<path stroke="{stroke}" stroke-width="{width}" stroke-linecap="round" d="M{x:.1} {y:.1}l{side} {side}m0 -{side}l-{side} {side}"/>"#
        )?;
    }
    Ok(())
}
