//! A panel of directions: azimuth across with the robot's left on the left and straight ahead in the middle,
//! elevation up.

use std::fmt::{self, Write as _};

use glam::DVec2;
use mapless::skyline::columns::COLUMNS;

use mapless_figures::page::{self, INK, embed};

/// Pixels per degree; elevation has a larger scale, since the ground differs there.
const ACROSS: f64 = 3.0;
const UP: f64 = 7.0;
/// Elevation of the upper edge, half a row above the sensor's highest ring, and minus that of the lower one.
const TOP_DEG: f64 = 15.5;

/// Position of the panels on the page, and their size, pixels.
pub(crate) const LEFT: f64 = 64.0;
pub(crate) const SIZE: DVec2 = DVec2::new(ACROSS * COLUMNS as f64, UP * 2.0 * TOP_DEG);

/// One panel, by its upper edge.
#[derive(Clone, Copy)]
pub(crate) struct Panel {
    pub(crate) top: f64,
}

impl Panel {
    /// Position of a direction on the page. Column 0, straight behind, is the last one on the right.
    pub(crate) fn place(self, azimuth_rad: f64, elevation_rad: f64) -> DVec2 {
        DVec2::new(self.x(azimuth_rad), self.y(elevation_rad))
    }

    /// Horizontal position of an azimuth.
    pub(crate) fn x(self, azimuth_rad: f64) -> f64 {
        LEFT + ACROSS * (179.5 - azimuth_rad.to_degrees()).rem_euclid(360.0)
    }

    /// Vertical position of an elevation.
    pub(crate) fn y(self, elevation_rad: f64) -> f64 {
        self.top + UP * (TOP_DEG - elevation_rad.to_degrees())
    }

    /// The interval of azimuths that begins at `begin_rad` and extends anticlockwise, as pieces from left to
    /// right: two if it passes behind the robot.
    pub(crate) fn across(self, begin_rad: f64, extent_rad: f64) -> Vec<(f64, f64)> {
        let (right, width) = (self.x(begin_rad), ACROSS * extent_rad.to_degrees());
        // An interval that begins on the panel's left edge may as well begin on its right edge.
        let right = if right - LEFT < 1e-6 { LEFT + SIZE.x } else { right };
        if right - width >= LEFT - 1e-6 {
            return vec![(right - width, right)];
        }
        vec![(LEFT, right), (right - width + SIZE.x, LEFT + SIZE.x)]
    }

    /// Paints the panel with `colour` of column and row, `rows` of them, the lowest first.
    pub(crate) fn paint(
        self,
        svg: &mut String,
        rows: usize,
        colour: impl Fn(usize, usize) -> [u8; 3],
    ) -> anyhow::Result<()> {
        // Pixel by pixel, so that no viewer blurs the cells.
        let (width, height) = (SIZE.x as usize, SIZE.y as usize);
        let rgb: Vec<u8> = (0..width * height)
            .flat_map(|pixel| {
                let (across, down) = (pixel % width, pixel / width);
                colour(COLUMNS - 1 - across * COLUMNS / width, rows - 1 - down * rows / height)
            })
            .collect();
        let png = page::png(width as u32, height as u32, &rgb)?;
        Ok(embed(svg, DVec2::new(LEFT, self.top), SIZE, &png)?)
    }

    /// The frame with its ticks, the horizon and the title above.
    pub(crate) fn frame(self, svg: &mut String, title: &str) -> fmt::Result {
        let (right, bottom) = (LEFT + SIZE.x, self.top + SIZE.y);
        let horizon = self.y(0.0);
        writeln!(
            svg,
            r##"<path stroke="#fff" stroke-width="2" stroke-opacity="0.6" d="M{LEFT} {horizon:.1}H{right}"/><path stroke="{INK}" stroke-dasharray="2 5" d="M{LEFT} {horizon:.1}H{right}"/>"##
        )?;
        writeln!(
            svg,
            r#"<rect x="{LEFT}" y="{:.1}" width="{}" height="{}" fill="none" stroke="{INK}"/><text x="{LEFT}" y="{:.1}" font-weight="bold">{title}</text>"#,
            self.top,
            SIZE.x,
            SIZE.y,
            self.top - 8.0
        )?;
        for azimuth_deg in (-135..=135).step_by(45) {
            let x = self.x(f64::from(azimuth_deg).to_radians());
            writeln!(
                svg,
                r#"<path stroke="{INK}" d="M{x:.1} {bottom:.1}v5"/><text x="{x:.1}" y="{:.1}" text-anchor="middle">{azimuth_deg}</text>"#,
                bottom + 19.0
            )?;
        }
        for elevation_deg in [-15, -10, -5, 0, 5, 10, 15] {
            let y = self.y(f64::from(elevation_deg).to_radians());
            writeln!(
                svg,
                r#"<path stroke="{INK}" d="M{LEFT} {y:.1}h-5"/><text x="{:.1}" y="{:.1}" text-anchor="end">{elevation_deg}</text>"#,
                LEFT - 9.0,
                y + 4.5
            )?;
        }
        writeln!(
            svg,
            r#"<text transform="translate(18 {:.1}) rotate(-90)" text-anchor="middle">elevation (°)</text>"#,
            (self.top + bottom) / 2.0
        )
    }

    /// The label of the azimuths, under the last panel.
    pub(crate) fn azimuth_label(self, svg: &mut String) -> fmt::Result {
        let y = self.top + SIZE.y + 38.0;
        let middle = self.x(0.0);
        writeln!(
            svg,
            r##"<text x="{middle:.1}" y="{y:.1}" text-anchor="middle">azimuth (°), straight ahead in the middle</text><text x="{LEFT}" y="{y:.1}" fill="#555">behind, on the left</text><text x="{:.1}" y="{y:.1}" text-anchor="end" fill="#555">behind, on the right</text>"##,
            LEFT + SIZE.x
        )
    }
}

/// Colour of a relative variance: dark where ground was observed, white where space is free.
pub(crate) fn grey(relative_variance: f64) -> [u8; 3] {
    [(255.0 * relative_variance.clamp(0.0, 1.0)).round() as u8; 3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const PANEL: Panel = Panel { top: 100.0 };

    #[test]
    fn left_is_on_the_left_and_up_is_up() {
        let ahead = PANEL.place(0.0, 0.0);
        let left = PANEL.place(0.5, 0.1);
        assert!(left.x < ahead.x && left.y < ahead.y);
        assert!((PANEL.x(-PI) - PANEL.x(PI)).abs() < 1e-9);
        assert!((PANEL.x(-PI) - (LEFT + SIZE.x - 0.5 * ACROSS)).abs() < 1e-9);
    }

    #[test]
    fn a_stretch_behind_the_robot_comes_in_two_pieces_of_its_whole_width() {
        let step = PI / 180.0;
        let whole = |begin: f64, columns: f64| {
            let pieces = PANEL.across(begin, columns * step);
            let width: f64 = pieces.iter().map(|(left, right)| right - left).sum();
            assert!((width - ACROSS * columns).abs() < 1e-6, "{pieces:?}");
            assert!(pieces.iter().all(|&(left, right)| left >= LEFT - 1e-6 && right <= LEFT + SIZE.x + 1e-6));
            pieces.len()
        };
        assert_eq!(whole(-10.5 * step, 21.0), 1);
        assert_eq!(whole(169.5 * step, 20.0), 2);
        assert_eq!(whole(179.5 * step, 360.0), 1, "from edge to edge");
        assert_eq!(whole(-180.5 * step, 5.0), 1);
        assert_eq!(whole(0.5 * step, 360.0), 2);
    }
}
