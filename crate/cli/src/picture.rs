//! Pictures as SVG: of a trial, its path over the elevation; of a scan, its perception.

mod directions;
mod occupancy;
mod variance_image;

use std::fmt::{self, Write as _};

use glam::DVec2;
use mapless_figures::map::Map;
use mapless_figures::marks::{self, PATH};
use mapless_figures::page::INK;
use mapless_trials::{Outcome, StartPose};
use mapless_world::HeightField;

pub(crate) use occupancy::OccupancyPicture;
pub(crate) use variance_image::VarianceImage;

/// The contents of a trial's picture.
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

impl Picture<'_> {
    /// Draws the picture.
    pub(crate) fn svg(&self) -> anyhow::Result<String> {
        let mut svg = String::new();
        let map = Map::begin(&mut svg, self.field, &self.title, &self.subtitle, 1.0, 1)?;
        self.route(&mut svg, &map)?;
        self.legend(&mut svg, &map)?;
        writeln!(svg, "</svg>")?;
        Ok(svg)
    }

    fn route(&self, svg: &mut String, map: &Map<'_>) -> fmt::Result {
        for &subgoal in self.subgoals_m.iter().filter(|&&subgoal| self.field.contains(subgoal)) {
            marks::subgoal(svg, map.place(subgoal))?;
        }
        map.path(svg, self.path_m, PATH)?;
        let goal = map.place(self.goal_m);
        marks::arrival(svg, goal, self.goal_tolerance_m * map.pixels_per_m())?;
        marks::flag(svg, goal)?;
        marks::start(svg, map.place(self.start.position_m), self.start.heading_rad)?;
        match self.path_m.last() {
            Some(&end) if self.outcome != Outcome::Reached => marks::end(svg, map.place(end)),
            _ => Ok(()),
        }
    }

    fn legend(&self, svg: &mut String, map: &Map<'_>) -> fmt::Result {
        let mut legend = map.legend();
        marks::start(svg, legend.place, 0.0)?;
        legend.words(svg, "start")?;
        marks::flag(svg, legend.place + DVec2::new(-6.0, 9.0))?;
        legend.words(svg, "goal")?;
        legend.stroke(svg, &format!(r#"stroke="{PATH}" stroke-width="3""#))?;
        legend.words(svg, "path")?;
        marks::subgoal(svg, legend.place)?;
        legend.words(svg, "chosen subgoals")?;
        if self.outcome != Outcome::Reached {
            marks::end(svg, legend.place)?;
            legend.words(svg, self.outcome.name())?;
        }
        if let Some(interval_m) = map.contour_interval_m() {
            legend.stroke(svg, &format!(r#"stroke="{INK}" stroke-opacity="0.55""#))?;
            legend.words(svg, &format!("contours every {interval_m} m"))?;
        }
        Ok(())
    }
}
