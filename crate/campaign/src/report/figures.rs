//! The figures: paths over the elevation, the attitude along a route, the surface of the steepness cost.

use std::fmt::Write as _;

use glam::DVec2;
use mapless::decision::cost;
use mapless_figures::FigureError;
use mapless_figures::map::Map;
use mapless_figures::marks;
use mapless_figures::page::{self, ColourBar, INK, embed};
use mapless_figures::plot::{COLOURS, Line, Plot, Scale};
use mapless_figures::scale::ticks;
use mapless_trials::LoadedScenario;

use super::trajectory::{self, State};
use super::{MOST_ROUTES, Results};
use crate::error::CampaignError;
use crate::results::{ManifestRoute, trajectory_path};
use crate::row::TrialRow;

/// Map pixels per pixel on the page: sharp enough in a report, at a quarter of the file size.
const DETAIL: f64 = 0.5;
/// Stride between the states that a plot shows: half a second.
const STRIDE: usize = 5;
/// The route whose attitude the paper shows.
const ATTITUDE_ROUTE: &str = "cht-ab";

/// A quantity of the motion over a few successive states, at least one.
type Quantity = fn(&[State]) -> f64;

/// Figures by file name, in the order of the report.
#[derive(Default)]
pub(super) struct Figures {
    pub(super) drawn: Vec<(String, String)>,
}

/// A planner's trial on a route, with its trajectory.
struct Drive<'a> {
    row: &'a TrialRow,
    states: Vec<State>,
    colour: &'static str,
}

impl Figures {
    /// Adds a figure; returns the Markdown that shows it.
    pub(super) fn add(&mut self, file: String, title: &str, svg: String) -> String {
        let words = format!("![{title}]({file})");
        self.drawn.push((file, svg));
        words
    }

    /// Adds the paths of every route that has some, and the attitude along one; returns the Markdown that
    /// shows them.
    pub(super) fn maps(&mut self, results: &Results) -> Result<String, CampaignError> {
        let mut text = String::new();
        if results.manifest.routes.len() > MOST_ROUTES {
            return Ok(text);
        }
        let mut with_attitude: Option<(&ManifestRoute, Vec<Drive<'_>>)> = None;
        for route in &results.manifest.routes {
            let drives = drives(results, &route.name)?;
            if drives.is_empty() {
                continue;
            }
            let file = std::path::Path::new(&route.file);
            let loaded = LoadedScenario::read(file).map_err(|error| CampaignError::read(file, error))?;
            let svg =
                paths(&route.name, &loaded, &drives).map_err(|error| CampaignError::write(file, error))?;
            let name = format!("{}-paths-{}.svg", results.manifest.name, route.name);
            let words = self.add(name, &format!("Paths on {}", route.name), svg);
            text.push_str(&format!("\n{words}\n"));
            if with_attitude.is_none() || route.name == ATTITUDE_ROUTE {
                with_attitude = Some((route, drives));
            }
        }
        if let Some((route, drives)) = with_attitude {
            text.push_str(&format!("\n## Attitude along {}\n\nThe first seed, over time.\n", route.name));
            self.attitude(&mut text, &results.manifest.name, &route.name, &drives);
        }
        if !text.is_empty() {
            text.insert_str(0, "\n## Paths\n\nThe first seed's path of every planner over the elevation.\n");
        }
        Ok(text)
    }

    fn attitude(&mut self, text: &mut String, campaign: &str, route: &str, drives: &[Drive<'_>]) {
        let quantities: [(&str, &str, Quantity); 3] = [
            ("roll", "roll φ, rad", |states| states[0].roll_rad),
            ("pitch", "pitch ψ, rad", |states| states[0].pitch_rad),
            ("elevation-rate", "elevation rate, cm/s", |states| {
                let (first, last) = (states[0], states[states.len() - 1]);
                let duration_s = last.time_s - first.time_s;
                if duration_s > 0.0 { 100.0 * (last.z_m - first.z_m) / duration_s } else { 0.0 }
            }),
        ];
        for (name, label, value) in quantities {
            let line = |drive: &Drive<'_>| Line {
                name: drive.row.planner.clone(),
                points: drive.states.chunks(STRIDE).map(|states| (states[0].time_s, value(states))).collect(),
            };
            let plot = Plot {
                x_label: "time, s".to_owned(),
                y_label: label.to_owned(),
                lines: drives.iter().map(line).collect(),
                mark_x: None,
                scale: Scale::Linear,
            };
            let words = self.add(
                format!("{campaign}-{route}-{name}.svg"),
                &format!("{label} along {route}"),
                plot.svg(),
            );
            text.push_str(&format!("\n{words}\n"));
        }
    }
}

/// The paper's figure of C_stp over pitch and height, with its file name.
pub(super) fn steepness_cost() -> Result<(&'static str, String), FigureError> {
    const SIDE: u32 = 241;
    const MOST_PITCH_RAD: f64 = 0.785;
    const MOST_RISE_M: f64 = 2.0;
    let (place, size) = (DVec2::new(64.0, 62.0), DVec2::splat(440.0));
    let across = |share: f64, most: f64| (2.0 * share - 1.0) * most;
    let most = cost::steepness_cost(MOST_RISE_M, MOST_PITCH_RAD);
    let mut rgb = Vec::new();
    for row in 0..SIDE {
        for column in 0..SIDE {
            let share = |index: u32| f64::from(index) / f64::from(SIDE - 1);
            let pitch_rad = across(share(column), MOST_PITCH_RAD);
            let rise_m = -across(share(row), MOST_RISE_M);
            rgb.extend(heat(cost::steepness_cost(rise_m, pitch_rad) / most));
        }
    }
    let mut svg = String::new();
    let title = "Steepness cost C_stp = dz² + exp(sign(ψ) dz) |ψ|";
    let subtitle = "pitch ψ nose-up positive, dz the subgoal's height over the robot's";
    page::begin(&mut svg, DVec2::new(640.0, 568.0), place.x, title, subtitle)?;
    embed(&mut svg, place, size, &page::png(SIDE, SIDE, &rgb)?)?;
    let (right, bottom) = (place.x + size.x, place.y + size.y);
    for pitch_rad in ticks(-MOST_PITCH_RAD, MOST_PITCH_RAD, 0.2) {
        let x = place.x + size.x * (pitch_rad / MOST_PITCH_RAD + 1.0) / 2.0;
        writeln!(
            svg,
            r#"<path stroke="{INK}" d="M{x:.1} {bottom}v5"/><text x="{x:.1}" y="{}" text-anchor="middle">{pitch_rad}</text>"#,
            bottom + 19.0
        )?;
    }
    for rise_m in ticks(-MOST_RISE_M, MOST_RISE_M, 0.5) {
        let y = place.y + size.y * (1.0 - rise_m / MOST_RISE_M) / 2.0;
        writeln!(
            svg,
            r#"<path stroke="{INK}" d="M{} {y:.1}h-5"/><text x="{}" y="{:.1}" text-anchor="end">{rise_m}</text>"#,
            place.x,
            place.x - 9.0,
            y + 4.5
        )?;
    }
    let middle = place + size / 2.0;
    writeln!(
        svg,
        r#"<text x="{}" y="{}" text-anchor="middle">pitch ψ (rad)</text>"#,
        middle.x,
        bottom + 38.0
    )?;
    writeln!(
        svg,
        r#"<text transform="translate(18 {}) rotate(-90)" text-anchor="middle">dz (m)</text>"#,
        middle.y
    )?;
    let bar = ColourBar {
        id: "cost",
        label: "C_stp",
        place: DVec2::new(right + 20.0, place.y),
        height: size.y,
        range: (0.0, most),
        ticks: 6.0,
    };
    bar.draw(&mut svg, heat)?;
    svg.push_str("</svg>\n");
    Ok(("steepness-cost.svg", svg))
}

/// The kept trajectories of unchanged planners, in the campaign's order of planners.
fn drives<'a>(results: &'a Results, route: &str) -> Result<Vec<Drive<'a>>, CampaignError> {
    let mut drives = Vec::new();
    for (planner, colour) in results.manifest.planners.iter().zip(COLOURS.iter().cycle()) {
        for row in results.plain().filter(|row| row.planner == *planner && row.route == route) {
            if let Some(states) = trajectory::read(&trajectory_path(&results.folder, &row.id))? {
                drives.push(Drive { row, states, colour });
            }
        }
    }
    Ok(drives)
}

fn paths(route: &str, loaded: &LoadedScenario, drives: &[Drive<'_>]) -> Result<String, FigureError> {
    let mut svg = String::new();
    let seed = drives.first().map_or(0, |drive| drive.row.seed);
    let subtitle = format!("{}, seed {seed}", loaded.terrain.name);
    let legend_lines = 1 + drives.len().div_ceil(3);
    let map = Map::begin(&mut svg, &loaded.terrain.field, route, &subtitle, DETAIL, legend_lines)?;
    for drive in drives {
        let path_m: Vec<DVec2> = drive.states.iter().map(|state| DVec2::new(state.x_m, state.y_m)).collect();
        map.path(&mut svg, &path_m, drive.colour)?;
    }
    for drive in drives.iter().filter(|drive| !drive.row.has_reached()) {
        if let Some(state) = drive.states.last() {
            marks::end(&mut svg, map.place(DVec2::new(state.x_m, state.y_m)))?;
        }
    }
    let scenario = &loaded.scenario;
    marks::flag(&mut svg, map.place(scenario.goal_m))?;
    marks::start(&mut svg, map.place(scenario.start.position_m), scenario.start.heading_rad)?;
    let mut legend = map.legend();
    marks::start(&mut svg, legend.place, 0.0)?;
    legend.words(&mut svg, "start")?;
    marks::flag(&mut svg, legend.place + DVec2::new(-6.0, 9.0))?;
    legend.words(&mut svg, "goal")?;
    if let Some(interval_m) = map.contour_interval_m() {
        legend.stroke(&mut svg, &format!(r#"stroke="{INK}" stroke-opacity="0.55""#))?;
        legend.words(&mut svg, &format!("contours every {interval_m} m"))?;
    }
    for Drive { row, colour, .. } in drives {
        let driven_m = row.distance_m.unwrap_or_default();
        let words = format!("{}: {}, {driven_m:.1} m", row.planner, row.outcome);
        legend.make_room(words.chars().count());
        legend.stroke(&mut svg, &format!(r#"stroke="{colour}" stroke-width="3""#))?;
        legend.words(&mut svg, &words)?;
    }
    svg.push_str("</svg>\n");
    Ok(svg)
}

/// A perceptually uniform colour map from cold to warm.
fn heat(share: f64) -> [u8; 3] {
    let (r, g, b) = colorous::VIRIDIS.eval_continuous(share.clamp(0.0, 1.0)).as_tuple();
    [r, g, b]
}
