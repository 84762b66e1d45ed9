//! The report of one or several campaigns: `RESULTS.md` and its figures. The same campaigns give the same bytes.

mod ablation;
mod comparison;
mod duration;
mod faults;
mod figures;
mod oracle;
mod published;
mod spread;
mod tables;
mod trajectory;
mod worst;

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::error::CampaignError;
use crate::files::write_atomically;
use crate::results::{Manifest, TrialRow};
use mapless_trials::statistics as stats;
use mapless_world::generate::Difficulty;

/// The figures stand in a folder of this name beside the report.
const FIGURES: &str = "results";
/// A rate of at least so many trials has a decimal.
const MANY_TRIALS: usize = 200;
/// With more routes than this, a table has one row for all routes whose names begin alike.
const MOST_ROUTES: usize = 20;

/// A metric of the paper: what it is called, its decimals, and where it stands.
struct Metric {
    heading: &'static str,
    decimals: usize,
    of: fn(&TrialRow) -> Option<f64>,
}

impl Metric {
    /// The heading without its unit.
    fn name(&self) -> &'static str {
        self.heading.split(',').next().unwrap_or_default()
    }
}

/// The paper's six, in its order.
const METRICS: [Metric; 6] = [
    Metric { heading: "distance, m", decimals: 1, of: |row| row.distance_m },
    Metric { heading: "max \\|roll\\|, rad", decimals: 3, of: |row| row.max_abs_roll_rad },
    Metric { heading: "max \\|pitch\\|, rad", decimals: 3, of: |row| row.max_abs_pitch_rad },
    Metric { heading: "vibration, rad/s", decimals: 3, of: |row| row.mean_vibration_rad_s },
    Metric { heading: "elevation rate, cm/s", decimals: 2, of: |row| row.mean_elevation_rate_cm_s },
    Metric { heading: "curvature change, rad/m", decimals: 3, of: |row| row.curvature_change_rad_m },
];

/// A finished campaign.
pub(crate) struct Results {
    pub(crate) folder: PathBuf,
    pub(crate) manifest: Manifest,
    pub(crate) rows: Vec<TrialRow>,
}

impl Results {
    /// The trials of the planners as they are: no parameter set, nothing told.
    fn plain(&self) -> impl Iterator<Item = &TrialRow> {
        self.rows.iter().filter(|row| row.parameters.is_empty() && row.truth == "none")
    }

    /// The plain trials of one planner on the routes that `group` names.
    fn of(&self, planner: &str, group: &str) -> Vec<&TrialRow> {
        self.plain().filter(|row| row.planner == planner && self.group(&row.route) == group).collect()
    }

    /// The route itself, or what its name begins with where there are many routes.
    fn group<'a>(&self, route: &'a str) -> &'a str {
        if !self.has_groups() {
            return route;
        }
        route.split_once('-').map_or(route, |(begin, _)| begin)
    }

    /// Every group once, in the order of their names; difficulties begin with the easiest.
    fn groups(&self) -> Vec<&str> {
        let mut groups: Vec<&str> =
            self.manifest.routes.iter().map(|route| self.group(&route.name)).collect();
        groups.sort_unstable_by_key(|group| {
            (Difficulty::ALL.iter().position(|difficulty| difficulty.name() == *group), *group)
        });
        groups.dedup();
        groups
    }

    /// The plain trials of one planner: all of them, then those of each group where groups stand for several routes each.
    fn all_and_groups(&self, planner: &str) -> Vec<(&str, Vec<&TrialRow>)> {
        let all = self.plain().filter(|row| row.planner == planner).collect();
        let groups = if self.has_groups() { self.groups() } else { Vec::new() };
        let of_groups = groups.into_iter().map(|group| (group, self.of(planner, group)));
        core::iter::once(("all", all)).chain(of_groups).collect()
    }

    /// Whether groups stand for several routes each.
    fn has_groups(&self) -> bool {
        self.manifest.routes.len() > MOST_ROUTES
    }

    /// The command that runs a trial again.
    fn replay(&self, row: &TrialRow) -> String {
        format!("mapless trials {} --only {}", self.manifest.file, row.id)
    }

    /// `8 planners, 10 routes, up to 10 seeds`.
    fn size(&self) -> String {
        let Manifest { planners, routes, seeds, .. } = &self.manifest;
        let number =
            |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        let up_to = if seeds.len() > 1 { "up to " } else { "" };
        format!(
            "{}, {}, {up_to}{}",
            number(planners.len(), "planner"),
            number(routes.len(), "route"),
            number(seeds.len(), "seed")
        )
    }

    /// What its trials are run again for: each parameter's worth, or the source of failures; nothing where every planner is as it is.
    fn question(&self) -> Option<&'static str> {
        let any = |of: fn(&TrialRow) -> bool| self.rows.iter().any(of);
        if any(|row| !row.parameters.is_empty()) {
            Some("what the parameters buy")
        } else {
            any(|row| row.truth != "none").then_some("where failures come from")
        }
    }
}

impl TrialRow {
    fn has_reached(&self) -> bool {
        self.outcome == "reached"
    }
}

/// Writes the report of the finished campaigns in `folders` to `RESULTS.md` in `out`; gives the files written.
///
/// # Errors
/// [`CampaignError`] when a campaign has not finished, a scenario that a figure shows is no longer there, or `out` cannot be
/// written.
pub fn write(folders: &[PathBuf], out: &Path) -> Result<Vec<PathBuf>, CampaignError> {
    let mut campaigns = Vec::new();
    for folder in folders {
        let (manifest, rows) = Manifest::read(folder)?;
        campaigns.push(Results { folder: folder.clone(), manifest, rows });
    }
    let figures_folder = out.join(FIGURES);
    std::fs::create_dir_all(&figures_folder).map_err(|error| CampaignError::write(&figures_folder, error))?;
    let mut figures = figures::Figures::default();
    let path = out.join("RESULTS.md");
    let published = published::published()?;
    let mut text = String::from("# Results\n\nWritten by `mapless report`. ");
    introduction(&mut text).map_err(|error| CampaignError::write(&path, error))?;
    contents(&mut text, &campaigns).map_err(|error| CampaignError::write(&path, error))?;
    figures.steepness_cost(&mut text).map_err(|error| CampaignError::write(&path, error))?;
    for results in &campaigns {
        let maps = figures.maps(results)?;
        chapter(&mut text, results, &published, &mut figures, &maps)
            .map_err(|error| CampaignError::write(&path, error))?;
    }
    let mut written = Vec::new();
    for (name, svg) in figures.drawn {
        let path = figures_folder.join(name);
        write_atomically(&path, svg.as_bytes())?;
        written.push(path);
    }
    write_atomically(&path, text.as_bytes())?;
    written.push(path);
    Ok(written)
}

fn introduction(text: &mut String) -> fmt::Result {
    writeln!(
        text,
        "A trial counts as reached when the robot arrives with |roll| and |pitch| within their limits all the way, \
         as in the paper. Rates have Wilson's 95 % interval. Metrics are the paper's, mean ± standard deviation over the trials that \
         reached; lower is better in all of them. The paper's numbers come from its own terrains in Gazebo, of which ours are models: \
         they say how a method does among its kind, not which of two methods on different ground is better.\n"
    )
}

/// A line for each campaign.
fn contents(text: &mut String, campaigns: &[Results]) -> fmt::Result {
    for results in campaigns {
        let name = &results.manifest.name;
        let question = results.question().map_or_else(String::new, |question| format!("{question}; "));
        writeln!(text, "- [Campaign `{name}`](#campaign-{name}): {question}{}", results.size())?;
    }
    writeln!(text)
}

fn chapter(
    text: &mut String,
    results: &Results,
    published: &[published::PublishedRow],
    figures: &mut figures::Figures,
    maps: &str,
) -> Result<(), mapless_figures::FigureError> {
    let Manifest { name, hash, planners, .. } = &results.manifest;
    writeln!(text, "\n## Campaign `{name}`\n")?;
    writeln!(text, "{} trials: {}; identity `{hash}`.", results.rows.len(), results.size())?;
    tables::success(text, results)?;
    duration::section(text, results)?;
    // One planner that is run again with something changed is compared with itself.
    if planners.len() > 1 || results.question().is_none() {
        comparison::sentences(text, results, published)?;
        tables::metrics(text, results, published)?;
        spread::section(text, results, published)?;
        oracle::section(text, results)?;
    }
    faults::section(text, results)?;
    ablation::section(text, results, figures)?;
    text.push_str(maps);
    worst::section(text, results)?;
    Ok(())
}

/// How many trials ended how, the most frequent first; those that reached are left out.
fn failures(rows: &[&TrialRow]) -> String {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for row in rows.iter().filter(|row| !row.has_reached()) {
        *counts.entry(&row.outcome).or_default() += 1;
    }
    let mut counts: Vec<(&str, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    let words: Vec<String> = counts.iter().map(|(outcome, count)| format!("{count} {outcome}")).collect();
    words.join(", ")
}

/// `95 of 100 (89–98 %)`.
fn rate(rows: &[&TrialRow]) -> String {
    let reached = rows.iter().filter(|row| row.has_reached()).count();
    let (low, high) = stats::wilson(reached, rows.len());
    let decimals = usize::from(rows.len() >= MANY_TRIALS);
    format!("{reached} of {} ({:.decimals$}–{:.decimals$} %)", rows.len(), 100.0 * low, 100.0 * high)
}

/// The metric's values of the trials that reached.
fn values(rows: &[&TrialRow], metric: &Metric) -> Vec<f64> {
    rows.iter().filter(|row| row.has_reached()).filter_map(|row| (metric.of)(row)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{results, row};

    #[test]
    fn many_routes_are_told_by_what_their_names_begin_with() {
        let names: Vec<String> = (0..30)
            .map(|index| format!("{}-1-{index:04}", ["hard", "moderate", "easy"][index % 3]))
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let rows = names.iter().map(|name| row("default", name, "none", 1, "reached")).collect();
        let many = results(&["default"], &names, rows);
        assert_eq!(many.groups(), ["easy", "moderate", "hard"]);
        assert_eq!(many.of("default", "easy").len(), 10);
        let few = results(&["default"], &names[..3], Vec::new());
        assert_eq!(few.groups(), ["easy-1-0002", "hard-1-0000", "moderate-1-0001"]);
    }

    #[test]
    fn a_campaign_says_its_size_and_its_question() {
        let mut rows = vec![row("default", "a", "none", 1, "reached")];
        let campaign = |rows: &[TrialRow]| results(&["default"], &["a", "b"], rows.to_vec());
        assert_eq!(campaign(&rows).size(), "1 planner, 2 routes, 1 seed");
        assert_eq!(campaign(&rows).question(), None);
        rows.push(row("default", "a", "both", 1, "reached"));
        let mut text = String::new();
        contents(&mut text, &[campaign(&rows)]).unwrap();
        assert_eq!(
            text,
            "- [Campaign `test`](#campaign-test): where failures come from; 1 planner, 2 routes, 1 seed\n\n"
        );
    }

    #[test]
    fn failures_are_counted_by_how_they_ended() {
        let outcomes = ["stuck", "timeout", "reached", "timeout"];
        let rows: Vec<TrialRow> =
            outcomes.iter().map(|outcome| row("default", "a", "none", 1, outcome)).collect();
        let rows: Vec<&TrialRow> = rows.iter().collect();
        assert_eq!(failures(&rows), "2 timeout, 1 stuck");
        assert_eq!(rate(&rows), "1 of 4 (5–70 %)");
        assert_eq!(rate(&rows.repeat(50)), "50 of 200 (19.5–31.4 %)");
    }

    #[test]
    fn the_shortest_path_is_the_measure_where_it_is_known() {
        let lengths = |row: TrialRow, driven_m, shortest_m| TrialRow {
            distance_m: Some(driven_m),
            oracle_length_m: shortest_m,
            ..row
        };
        let rows = vec![
            lengths(row("default", "a", "none", 1, "reached"), 20.0, Some(10.0)),
            lengths(row("default", "b", "none", 1, "stuck"), 3.0, Some(10.0)),
            lengths(row("default", "c", "none", 1, "reached"), 8.0, None),
        ];
        let mut text = String::new();
        oracle::section(&mut text, &results(&["default"], &["a", "b", "c"], rows)).unwrap();
        assert!(text.ends_with("| `default` | all | 1 of 2 (9–91 %) | 0.250 | 2.000 |\n"), "{text}");
    }
}
