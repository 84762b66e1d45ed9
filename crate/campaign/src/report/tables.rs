//! Success by planner and route, and the paper's metrics.

use std::fmt::{self, Write as _};

use super::published::PublishedRow;
use super::{METRICS, Metric, Results, failures, rate, stats, values};
use crate::row::TrialRow;

/// Routes of the paper's Table I with its letters, and those of Table II.
const TABLE_I: [(&str, &str); 6] = [
    ("cht-ad", "AD"),
    ("cht-ae", "AE"),
    ("cht-ba", "BA"),
    ("cht-ac", "AC"),
    ("cht-bd", "BD"),
    ("cht-ab", "AB"),
];
const TABLE_II: [(&str, &str); 2] = [("vta", "VTA"), ("ml", "ML")];

/// How many trials reached, planner by planner.
pub(super) fn success(text: &mut String, results: &Results) -> fmt::Result {
    writeln!(text)?;
    let groups = results.groups();
    let headings: Vec<String> = groups.iter().map(|group| format!(" {group} |")).collect();
    writeln!(text, "| planner | all (95 % interval) | failures |{}", headings.concat())?;
    writeln!(text, "|---|---|---|{}", "---:|".repeat(groups.len()))?;
    for planner in &results.manifest.planners {
        let all: Vec<&TrialRow> = results.plain().filter(|row| row.planner == *planner).collect();
        write!(text, "| `{planner}` | {} | {} |", rate(&all), failures(&all))?;
        for group in &groups {
            let rows = results.of(planner, group);
            let reached = rows.iter().filter(|row| row.has_reached()).count();
            write!(text, " {reached} of {} |", rows.len())?;
        }
        writeln!(text)?;
    }
    Ok(())
}

/// The paper's tables with its numbers beside ours, and one of the other routes.
pub(super) fn metrics(text: &mut String, results: &Results, published: &[PublishedRow]) -> fmt::Result {
    let groups = results.groups();
    let present = |routes: &[(&'static str, &'static str)]| -> Vec<(String, String)> {
        let present = routes.iter().filter(|(route, _)| groups.contains(route));
        present.map(|(route, letters)| ((*route).to_owned(), format!("{letters} ({route})"))).collect()
    };
    let (first, second) = (present(&TABLE_I), present(&TABLE_II));
    let others: Vec<(String, String)> = (groups.iter())
        .filter(|group| !first.iter().chain(&second).any(|(route, _)| route == *group))
        .map(|group| ((*group).to_owned(), (*group).to_owned()))
        .collect();
    table(text, "The paper's Table I: Challenging Hilly Terrain", &first, results, published)?;
    table(
        text,
        "The paper's Table II: Valley Trail Ascent and Martian Landscape",
        &second,
        results,
        published,
    )?;
    let title = if first.is_empty() && second.is_empty() { "Metrics" } else { "Other routes" };
    table(text, title, &others, results, published)
}

fn table(
    text: &mut String,
    title: &str,
    routes: &[(String, String)],
    results: &Results,
    published: &[PublishedRow],
) -> fmt::Result {
    if routes.is_empty() {
        return Ok(());
    }
    let headings: Vec<String> = METRICS.iter().map(|metric| format!(" {} |", metric.heading)).collect();
    writeln!(text, "\n## {title}\n\n| route | planner | reached |{}", headings.concat())?;
    writeln!(text, "|---|---|---|{}", "---:|".repeat(METRICS.len()))?;
    for (route, shown) in routes {
        for row in published.iter().filter(|row| row.route == *route) {
            let name = if row.method == "paper" { "published: the paper's" } else { "published: VGF" };
            write!(text, "| {shown} | *{name}* | |")?;
            for (index, metric) in METRICS.iter().enumerate() {
                let deviation = row.deviation.map(|deviations| deviations[index]);
                write!(text, " *{}* |", number(row.mean[index], deviation, metric))?;
            }
            writeln!(text)?;
        }
        for planner in &results.manifest.planners {
            let rows = results.of(planner, route);
            writeln!(text, "| {shown} | `{planner}` | {} |{}", rate(&rows), cells(&rows))?;
        }
    }
    Ok(())
}

/// A cell for each metric.
pub(super) fn cells(rows: &[&TrialRow]) -> String {
    let cell = |metric: &Metric| {
        stats::mean_and_deviation(&values(rows, metric)).map_or_else(
            || " |".to_owned(),
            |(mean, deviation)| format!(" {} |", number(mean, deviation, metric)),
        )
    };
    METRICS.iter().map(cell).collect()
}

fn number(mean: f64, deviation: Option<f64>, metric: &Metric) -> String {
    let decimals = metric.decimals;
    let deviation = deviation.map_or_else(String::new, |deviation| format!(" ± {deviation:.decimals$}"));
    format!("{mean:.decimals$}{deviation}")
}
