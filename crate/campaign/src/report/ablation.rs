//! What each value of a parameter buys.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use mapless_figures::plot::{Line, Plot, Scale};

use super::figures::Figures;
use super::{METRICS, Results, rate, stats, tables};
use crate::results::TrialRow;

/// A table for each parameter that was set alone, with a figure where its values are numbers, and one of the combinations.
pub(super) fn section(text: &mut String, results: &Results, figures: &mut Figures) -> fmt::Result {
    let varied: Vec<&TrialRow> =
        results.rows.iter().filter(|row| row.truth == "none" && !row.parameters.is_empty()).collect();
    if varied.is_empty() {
        return Ok(());
    }
    writeln!(
        text,
        "\n### What the parameters buy\n\nOver all routes and seeds of the campaign; **bold** is the planner's own value."
    )?;
    let mut alone: Vec<&str> = Vec::new();
    for row in varied.iter().filter(|row| !row.parameters.contains(' ')) {
        let path = row.parameters.split('=').next().unwrap_or_default();
        if !alone.contains(&path) {
            alone.push(path);
        }
    }
    for path in alone {
        parameter(text, results, figures, path)?;
    }
    let combined: Vec<&TrialRow> = varied.into_iter().filter(|row| row.parameters.contains(' ')).collect();
    if combined.is_empty() { Ok(()) } else { combinations(text, &combined) }
}

fn heading(text: &mut String, first: &str) -> fmt::Result {
    let headings: Vec<String> = METRICS.iter().map(|metric| format!(" {} |", metric.heading)).collect();
    writeln!(text, "\n| planner | {first} | reached |{}", headings.concat())?;
    writeln!(text, "|---|---:|---|{}", "---:|".repeat(METRICS.len()))
}

fn parameter(text: &mut String, results: &Results, figures: &mut Figures, path: &str) -> fmt::Result {
    let name = path.rsplit('.').next().unwrap_or_default();
    writeln!(text, "\n#### `{path}`")?;
    heading(text, name)?;
    let (mut lines, mut remarks) = (Vec::new(), Vec::new());
    for planner in &results.manifest.planners {
        let values = values(results, planner, path);
        for (value, rows) in &values {
            let shown = if value.own { format!("**{}**", value.text) } else { value.text.clone() };
            writeln!(text, "| `{planner}` | {shown} | {} |{}", rate(rows), tables::cells(rows))?;
        }
        remarks.extend(remark(planner, &values));
        let points =
            values.iter().filter_map(|(value, rows)| Some((value.text.parse().ok()?, success_percent(rows))));
        let mut points: Vec<(f64, f64)> = points.collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if points.len() > 1 {
            lines.push(Line { name: planner.clone(), points });
        }
    }
    writeln!(text, "\n{}", remarks.join(" "))?;
    if !lines.is_empty() {
        let plot = Plot {
            x_label: path.to_owned(),
            y_label: "reached, %".to_owned(),
            lines,
            mark_x: None,
            scale: Scale::Linear,
        };
        let file = format!("{}-ablation-{}.svg", results.manifest.name, path.replace('.', "-"));
        writeln!(text, "\n{}", figures.add(file, &format!("Success over {path}"), plot.svg()))?;
    }
    Ok(())
}

/// A value of a parameter.
#[derive(PartialEq)]
struct Value {
    text: String,
    /// Whether the planner has it anyway.
    own: bool,
}

/// The planner's own value and the others, each with its trials, in the order of their numbers.
fn values<'a>(results: &'a Results, planner: &str, path: &str) -> Vec<(Value, Vec<&'a TrialRow>)> {
    let mut values: Vec<(Value, Vec<&TrialRow>)> = Vec::new();
    for row in results.rows.iter().filter(|row| row.planner == planner && row.truth == "none") {
        let value = match row.parameters.split_once('=') {
            None => own_value(row, path).map(|text| Value { text, own: true }),
            Some((set, value)) if set == path && !row.parameters.contains(' ') => {
                Some(Value { text: value.to_owned(), own: false })
            }
            Some(_) => None,
        };
        let Some(value) = value else { continue };
        match values.iter_mut().find(|(before, _)| *before == value) {
            Some((_, rows)) => rows.push(row),
            None => values.push((value, vec![row])),
        }
    }
    let number = |value: &Value| value.text.parse::<f64>().unwrap_or(f64::NAN);
    values.sort_by(|(a, _), (b, _)| number(a).total_cmp(&number(b)));
    values
}

fn own_value(row: &TrialRow, path: &str) -> Option<String> {
    let configuration: serde_json::Value = serde_json::from_str(&row.configuration).ok()?;
    let pointer = path.strip_prefix("planner")?.replace('.', "/");
    configuration.pointer(&pointer).map(ToString::to_string)
}

/// Which value reached most, and what leaving the planner's own costs.
fn remark(planner: &str, values: &[(Value, Vec<&TrialRow>)]) -> Option<String> {
    let (own, own_rows) = values.iter().find(|(value, _)| value.own)?;
    let best = values.iter().map(|(_, rows)| success_percent(rows)).fold(f64::NEG_INFINITY, f64::max);
    let own_percent = success_percent(own_rows);
    if own_percent >= best {
        let worst =
            values.iter().min_by(|(_, a), (_, b)| success_percent(a).total_cmp(&success_percent(b)))?;
        let lost = own_percent - success_percent(&worst.1);
        if lost <= 0.0 {
            return Some(format!("With `{planner}` every value reaches equally often."));
        }
        return Some(format!(
            "No value reaches more often with `{planner}` than its own, {}; {} loses {lost:.0} percentage points.",
            own.text, worst.0.text
        ));
    }
    let (value, rows) = values.iter().find(|(_, rows)| success_percent(rows) >= best)?;
    let reached = |rows: &[&TrialRow]| rows.iter().filter(|row| row.has_reached()).count();
    let sure =
        stats::wilson(reached(rows), rows.len()).0 > stats::wilson(reached(own_rows), own_rows.len()).1;
    let sure = if sure { "beyond" } else { "within" };
    Some(format!(
        "With `{planner}`, {} reaches {:.0} percentage points more often than its own, {}, {sure} the 95 % intervals.",
        value.text,
        best - own_percent,
        own.text
    ))
}

fn success_percent(rows: &[&TrialRow]) -> f64 {
    100.0 * rows.iter().filter(|row| row.has_reached()).count() as f64 / rows.len().max(1) as f64
}

fn combinations(text: &mut String, rows: &[&TrialRow]) -> fmt::Result {
    writeln!(text, "\n#### Combinations")?;
    heading(text, "parameters")?;
    let mut groups: BTreeMap<(&str, &str), Vec<&TrialRow>> = BTreeMap::new();
    for row in rows {
        groups.entry((&row.planner, &row.parameters)).or_default().push(row);
    }
    for ((planner, parameters), rows) in groups {
        writeln!(text, "| `{planner}` | {parameters} | {} |{}", rate(&rows), tables::cells(&rows))?;
    }
    Ok(())
}
