//! The occupancy surface as observed, its reconstruction and the variance surface, one below the other (the
//! paper shows them as rings around the robot).

use std::fmt::Write as _;

use glam::DVec2;
use mapless::skyline::occupancy::OccupancySurface;
use mapless::skyline::surface::PredictedSurface;

use super::directions::{LEFT, Panel, SIZE, grey};
use mapless_figures::page::{self, ColourBar};

const TOP: f64 = 88.0;
const SPACING: f64 = SIZE.y + 58.0;
const WIDTH: f64 = LEFT + SIZE.x + 100.0;
const HEIGHT: f64 = TOP + 3.0 * SPACING + 4.0;
/// Directions without a return.
const UNSEEN: [u8; 3] = [255; 3];

/// The contents of the picture.
pub(crate) struct OccupancyPicture<'a> {
    pub(crate) title: &'a str,
    pub(crate) subtitle: &'a str,
    pub(crate) observed: &'a OccupancySurface,
    pub(crate) predicted: &'a PredictedSurface,
}

impl OccupancyPicture<'_> {
    /// Draws the picture.
    pub(crate) fn svg(&self) -> anyhow::Result<String> {
        let panels = [0.0, 1.0, 2.0].map(|index| Panel { top: TOP + SPACING * index });
        let radius_m = self.observed.radius_m();
        let colour = |occupancy_m: f64| warmth(1.0 - occupancy_m / radius_m);
        let mut svg = String::new();
        page::begin(&mut svg, DVec2::new(WIDTH, HEIGHT), LEFT, self.title, self.subtitle)?;

        // Half a degree each: a ring reaches a degree to either side of its elevation, half of it beyond the
        // panel's edge.
        panels[0].paint(&mut svg, 2 * self.predicted.rows(), |column, row| {
            let ring = (2 * row + 3) / 8;
            let cell = self.observed.column(column).iter().find(|cell| cell.ring == ring);
            cell.map_or(UNSEEN, |cell| colour(cell.occupancy_m))
        })?;
        let mean_m = &self.predicted.mean_m;
        panels[1].paint(&mut svg, self.predicted.rows(), |column, row| {
            colour(mean_m[column * self.predicted.rows() + row])
        })?;
        panels[2].paint(&mut svg, self.predicted.rows(), |column, row| {
            grey(self.predicted.variance_column(column)[row])
        })?;

        let titles = [
            format!(
                "Observed occupancy, {radius_m} m − range; white where there is no return within {radius_m} m"
            ),
            "Its reconstruction, the mean of the Gaussian process".to_owned(),
            "Its variance: dark where ground was observed, white where space is free".to_owned(),
        ];
        for (panel, title) in panels.into_iter().zip(titles) {
            panel.frame(&mut svg, &title)?;
        }
        panels[2].azimuth_label(&mut svg)?;
        for (index, (panel, label)) in
            panels.into_iter().zip(["occupancy (m)", "occupancy (m)", "share of prior variance"]).enumerate()
        {
            let bar = ColourBar {
                id: ["observed", "mean", "variance"][index],
                label,
                place: DVec2::new(LEFT + SIZE.x + 20.0, panel.top),
                height: SIZE.y,
                range: if index < 2 { (0.0, radius_m) } else { (0.0, 1.0) },
                ticks: 5.0,
            };
            bar.draw(&mut svg, |share| if index < 2 { colour(share * radius_m) } else { grey(share) })?;
        }
        writeln!(svg, "</svg>")?;
        Ok(svg)
    }
}

/// A perceptually uniform map from cold to warm; as in the paper, warm is little occupancy.
fn warmth(share: f64) -> [u8; 3] {
    let (r, g, b) = colorous::PLASMA.eval_continuous(share.clamp(0.0, 1.0)).as_tuple();
    [r, g, b]
}
