//! The report of campaigns: a page for each with its figures and rows, and `RESULTS.md` with the beginning of
//! every page. The same campaigns give the same bytes.

mod ablation;
mod comparison;
mod duration;
mod faults;
mod figures;
mod oracle;
mod published;
mod reality;
mod spread;
mod tables;
mod trajectory;
mod verti_bench;
mod worst;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::error::CampaignError;
use crate::file::Benchmark;
use crate::files::write_atomically;
use crate::results::Manifest;
use crate::row::TrialRow;
use comparison::EVEN;
use mapless_terrain::generate::Family;
use mapless_trials::statistics as stats;

/// Folder of pages, figures and rows beside `RESULTS.md`.
const PAGES: &str = "results";
/// Rates of at least this many trials have a decimal.
const MANY_TRIALS: usize = 200;
/// With more routes than this, a table has one row for all routes whose names begin alike.
const MOST_ROUTES: usize = 12;

/// The introduction of `RESULTS.md`.
fn introduction() -> String {
    format!(
        "A trial counts as reached when the robot arrives with |roll| and |pitch| within their limits all the way, \
         as in the paper. Rates have Wilson's 95 % interval. Metrics are the paper's, mean ± standard deviation \
         over the trials that reached; lower is better in all of them. The paper's numbers come from its own \
         terrains in Gazebo, of which ours are models: they compare methods by kind, and say little about \
         differences between two grounds. `vgf`, `vgf_tuned`, `putn` and `oracle` know the whole ground before \
         they start and can go around obstacles that the others discover on the way. Two planners are compared \
         over the routes that both reach, by their means there. Means within {:.1} % of each other are even; \
         `on average` is the mean of the ratios, route by route, and a few routes can turn it against the count. \
         Seeds draw the noise of the sensor, not the ground: the interval of many seeds on few routes says \
         nothing of other ground. `timeout` and `stuck` come from the progress checker of the trial; a stop of \
         the planner has its reason. For each campaign, this page says how many trials reached and where its \
         first planner wins and loses; the campaign's own page has the rest. A page is of the day on which its \
         campaign was driven: where the simulated world has changed since, docs/design says so (trials.md, \
         physics.md, verti-bench.md).",
        100.0 * EVEN
    )
}

/// A metric of the paper: heading, decimals, and value of a row.
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

/// The paper's six metrics, in its order.
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
    /// The trials of unchanged planners in the scenarios' own reality: no parameter set, no perception
    /// override.
    fn plain(&self) -> impl Iterator<Item = &TrialRow> {
        self.unchanged("")
    }

    /// The trials of unchanged planners under a condition; the scenarios' own has no name.
    fn unchanged(&self, reality: &str) -> impl Iterator<Item = &TrialRow> {
        let is_unchanged = |row: &&TrialRow| row.parameters.is_empty() && row.truth == "none";
        self.rows.iter().filter(is_unchanged).filter(move |row| row.reality == reality)
    }

    /// The plain trials of one planner on the routes of `group`.
    fn of(&self, planner: &str, group: &str) -> Vec<&TrialRow> {
        self.plain().filter(|row| row.planner == planner && self.group(&row.route) == group).collect()
    }

    /// The route itself or, with many routes, the part of its name that it shares with others.
    fn group<'a>(&self, route: &'a str) -> &'a str {
        if !self.has_groups() {
            return route;
        }
        route.split_once('-').map_or(route, |(begin, _)| begin)
    }

    /// Every group once, in the order of their names; families of generated tasks in their own.
    fn groups(&self) -> Vec<&str> {
        let mut groups: Vec<&str> =
            self.manifest.routes.iter().map(|route| self.group(&route.name)).collect();
        let generated = Family::ALL.iter().map(|family| family.name());
        let imported = crate::verti_bench::Difficulty::ALL.iter().map(|difficulty| difficulty.name());
        let names: Vec<&str> = generated.chain(imported).collect();
        groups.sort_unstable_by_key(|group| (names.iter().position(|name| name == group), *group));
        groups.dedup();
        groups
    }

    /// The plain trials of one planner: all of them, then those of each group of several routes.
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

    /// `8 planners, 10 routes, up to 10 seeds`, and what else there is of conditions.
    fn size(&self) -> String {
        let Manifest { planners, routes, seeds, realities, .. } = &self.manifest;
        let number =
            |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        let up_to = if seeds.len() > 1 { "up to " } else { "" };
        let conditions = match realities.len() {
            0 => String::new(),
            count => format!(", {} beside the scenarios' own", number(count, "condition")),
        };
        format!(
            "{}, {}, {up_to}{}{conditions}",
            number(planners.len(), "planner"),
            number(routes.len(), "route"),
            number(seeds.len(), "seed")
        )
    }

    /// What a campaign of changed planners or realities asks: the effect of each parameter, the source of
    /// failures, or the cost of each condition; `None` if nothing is changed.
    fn question(&self) -> Option<&'static str> {
        let any = |of: fn(&TrialRow) -> bool| self.rows.iter().any(of);
        if any(|row| !row.parameters.is_empty()) {
            Some("what the parameters buy")
        } else if any(|row| row.truth != "none") {
            Some("where failures come from")
        } else {
            any(|row| !row.reality.is_empty()).then_some("what reality costs")
        }
    }
}

impl TrialRow {
    fn has_reached(&self) -> bool {
        self.outcome == "reached"
    }
}

/// Writes a page for each finished campaign in `folders` to the folder `results` in `out`, with its figures
/// and its rows beside it, and renews `RESULTS.md` in `out`, which also shows the pages that were written
/// before; gives the files written.
///
/// # Errors
/// [`CampaignError`] when a campaign has not finished, a scenario that a figure shows is no longer there, or
/// `out` cannot be written.
pub fn write(folders: &[PathBuf], out: &Path) -> Result<Vec<PathBuf>, CampaignError> {
    let pages = out.join(PAGES);
    std::fs::create_dir_all(&pages).map_err(|error| CampaignError::write(&pages, error))?;
    let published = published::published()?;
    let mut written = Vec::new();
    let mut keep = |path: PathBuf, bytes: &[u8]| {
        write_atomically(&path, bytes)?;
        written.push(path);
        Ok::<(), CampaignError>(())
    };
    for folder in folders {
        let (manifest, rows) = Manifest::read(folder)?;
        let results = Results { folder: folder.clone(), manifest, rows };
        let name = &results.manifest.name;
        let path = pages.join(format!("{name}.md"));
        let (text, figures) = page(&results, &published, &path)?;
        for (name, svg) in figures {
            keep(pages.join(name), svg.as_bytes())?;
        }
        let rows = folder.join("trials.parquet");
        let bytes = std::fs::read(&rows).map_err(|error| CampaignError::read(&rows, error))?;
        keep(pages.join(rows_file(name)), &bytes)?;
        keep(path, text.as_bytes())?;
    }
    let path = out.join("RESULTS.md");
    let (figure, svg) = figures::steepness_cost().map_err(|error| CampaignError::write(&path, error))?;
    keep(pages.join(figure), svg.as_bytes())?;
    let text = index(&pages, figure)?;
    keep(path, text.as_bytes())?;
    Ok(written)
}

/// `RESULTS.md`: the beginning of every page in the folder, in the order of their names.
fn index(pages: &Path, figure: &str) -> Result<String, CampaignError> {
    let files = std::fs::read_dir(pages).map_err(|error| CampaignError::read(pages, error))?;
    let files = files.map(|file| Ok(file?.path())).collect::<std::io::Result<Vec<PathBuf>>>();
    let mut files = files.map_err(|error| CampaignError::read(pages, error))?;
    files.retain(|file| file.extension().is_some_and(|extension| extension == "md"));
    files.sort_unstable();
    let mut text = format!("# Results\n\nWritten by `mapless report`. {}\n", introduction());
    for file in files {
        let page = std::fs::read_to_string(&file).map_err(|error| CampaignError::read(&file, error))?;
        let beginning = page.split("\n## ").next().unwrap_or_default();
        let Some((title, summary)) = beginning.strip_prefix("# ").and_then(|rest| rest.split_once('\n'))
        else {
            return Err(CampaignError::content(
                &file,
                "expected a page that begins with its title, as `mapless report` writes it",
            ));
        };
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        text.push_str(&format!("\n## [{title}]({PAGES}/{name})\n\n{}\n", summary.trim()));
    }
    text.push_str(&format!(
        "\n## The steepness cost\n\n![The steepness cost over pitch and height]({PAGES}/{figure})\n"
    ));
    Ok(text)
}

/// The file with a campaign's rows, beside its page.
fn rows_file(name: &str) -> String {
    format!("{name}.parquet")
}

/// A campaign's page for `path`, and its figures by file name.
fn page(
    results: &Results,
    published: &[published::PublishedRow],
    path: &Path,
) -> Result<(String, Vec<(String, String)>), CampaignError> {
    let mut figures = figures::Figures::default();
    let maps = figures.maps(results)?;
    let mut text = String::new();
    sections(&mut text, results, published, &mut figures, &maps)
        .map_err(|error| CampaignError::write(path, error))?;
    Ok((text, figures.drawn))
}

fn sections(
    text: &mut String,
    results: &Results,
    published: &[published::PublishedRow],
    figures: &mut figures::Figures,
    maps: &str,
) -> Result<(), mapless_figures::FigureError> {
    let Manifest { name, hash, planners, .. } = &results.manifest;
    let question = results.question().map_or_else(String::new, |question| format!("{question}; "));
    writeln!(text, "# Campaign `{name}`\n")?;
    writeln!(text, "{} trials: {question}{}; identity `{hash}`.", results.rows.len(), results.size())?;
    let has_plain = results.plain().next().is_some();
    // A campaign of one planner with changes compares that planner with itself.
    let compares = has_plain && (planners.len() > 1 || results.question().is_none());
    if has_plain {
        tables::success(text, results)?;
    } else {
        writeln!(
            text,
            "\nNone of them runs a planner unchanged: each sets a parameter or overrides perception."
        )?;
    }
    if compares {
        comparison::of_the_first(text, results, published)?;
    }
    if has_plain && results.manifest.benchmark == Some(Benchmark::VertiBench) {
        verti_bench::section(text, results)?;
    }
    if has_plain {
        duration::section(text, results)?;
    }
    if compares {
        comparison::of_the_others(text, results, published)?;
        tables::metrics(text, results, published)?;
        spread::section(text, results, published)?;
        oracle::section(text, results)?;
    }
    reality::section(text, results)?;
    faults::section(text, results)?;
    ablation::section(text, results, figures)?;
    text.push_str(maps);
    worst::section(text, results)?;
    let rows = rows_file(name);
    writeln!(
        text,
        "\n## Every trial\n\n[`{rows}`]({rows}) has a row for each, with its outcome, metrics, digest and whole configuration."
    )?;
    Ok(())
}

/// How a trial ended, with the reason if there is one, for a cell of a table.
fn ending(row: &TrialRow) -> String {
    let reason = row.stop_reason.as_ref().or(row.error.as_ref());
    let reason = reason
        .map_or_else(String::new, |reason| format!(": {}", reason.replace('|', "\\|").replace('\n', " ")));
    format!("{}{reason}", row.outcome)
}

/// Failures by outcome, the most frequent first.
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
    fn many_routes_are_grouped_by_the_beginning_of_their_names() {
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
        assert_eq!(campaign(&rows).question(), Some("where failures come from"));
    }

    #[test]
    fn the_index_shows_how_every_page_begins() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write("b.md", "# Campaign `b`\n\n2 trials.\n\n| table |\n\n## How soon\n\n## Rest\n");
        write("a.md", "# Campaign `a`\n\n1 trial.\n");
        write("a.svg", "no page");
        let text = index(folder.path(), "cost.svg").unwrap();
        let expected = "\n\n## [Campaign `a`](results/a.md)\n\n1 trial.\n\n## [Campaign `b`](results/b.md)\n\n2 trials.\n\n| table |\n\n## The steep";
        assert!(text.contains(expected) && text.ends_with("(results/cost.svg)\n"), "{text}");
        write("c.md", "notes");
        let error = index(folder.path(), "cost.svg").unwrap_err().to_string();
        assert!(error.contains("c.md") && error.contains("begins with its title"), "{error}");
    }

    #[test]
    fn a_campaign_of_combinations_alone_says_nothing_of_unchanged_planners() {
        let varied = |planner, outcome| TrialRow {
            parameters: "planner.decision.steepness_weight=0.5".to_owned(),
            ..row(planner, "a", "none", 1, outcome)
        };
        let rows = vec![varied("default", "stuck"), varied("paper", "reached")];
        let mut text = String::new();
        let (results, mut figures) =
            (results(&["default", "paper"], &["a"], rows), figures::Figures::default());
        sections(&mut text, &results, &[], &mut figures, "").unwrap();
        assert!(text.contains("None of them runs a planner unchanged"), "{text}");
        assert!(text.contains("| `default` | 0.5 | 0 of 1 "), "{text}");
        assert!(
            !text.contains("fails nowhere") && !text.contains("0 of 0") && !text.contains("How soon"),
            "{text}"
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
