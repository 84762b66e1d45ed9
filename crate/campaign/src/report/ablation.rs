//! The effect of each value of a parameter on the metrics.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use mapless::PlannerConfig;
use mapless_figures::plot::{Line, Plot, Scale};
use mapless_trials::parameters::groups;
use mapless_trials::{RealityConfig, current_path};
use mapless_world::{RobotConfig, SensorConfig};

use super::comparison::{Contest, EVEN, contests};
use super::figures::Figures;
use super::{METRICS, Metric, Results, failures, rate, stats, tables};
use crate::row::TrialRow;

/// The paper's names of parameters.
const SYMBOLS: [(&str, &str); 6] = [
    ("planner.decision.direction_weight", "k_dir"),
    ("planner.decision.distance_weight", "k_dst"),
    ("planner.decision.steepness_weight", "k_stp"),
    ("planner.perception.variance_threshold", "V_th"),
    ("planner.perception.surface_radius_m", "r_oc"),
    ("planner.segments.safety_margin_m", "δ"),
];
/// Significance level of the changes that sentences name.
const CHANCE: f64 = 0.05;
/// Note for routes with one trial for each value.
const ONE_SEED: &str =
    " Each value has one trial a route, so one odd drive shifts a mean: the counts say more.";
/// The first four metrics are drawn: distance, roll, pitch and vibration.
const DRAWN: usize = 4;

/// The effect of each parameter that was set alone: a sentence for each value, then tables and figures; and a
/// table of the combinations.
pub(super) fn section(text: &mut String, results: &Results, figures: &mut Figures) -> fmt::Result {
    let varied: Vec<&TrialRow> = own_reality(results).filter(|row| !row.parameters.is_empty()).collect();
    if varied.is_empty() {
        return Ok(());
    }
    let mut alone: Vec<&str> = Vec::new();
    for row in varied.iter().filter(|row| !row.parameters.contains(' ')) {
        let path = row.parameters.split('=').next().unwrap_or_default();
        if !alone.contains(&path) {
            alone.push(path);
        }
    }
    if !alone.is_empty() {
        writeln!(
            text,
            "\n## What the parameters buy\n\nThe same trials again, with one parameter set to another value than the planner's own. Each value is compared \
             with the planner's own over the trials that reach with both, so that none gains by failing where it is hard. A change of a metric is named \
             where a sign test over these trials lets less than {:.0} % to chance, and differences below {:.1} % count for neither side; of many comparisons a few are named by chance all the same.{}\n",
            100.0 * CHANCE,
            100.0 * EVEN,
            if results.manifest.seeds.len() == 1 { ONE_SEED } else { "" }
        )?;
        for path in &alone {
            for planner in &results.manifest.planners {
                sentence(text, planner, path, &values(results, planner, path))?;
            }
        }
    }
    for path in alone {
        parameter(text, results, figures, path)?;
    }
    let combined: Vec<&TrialRow> = varied.into_iter().filter(|row| row.parameters.contains(' ')).collect();
    if combined.is_empty() { Ok(()) } else { combinations(text, &combined) }
}

/// The trials without a perception override, in the scenarios' own reality.
fn own_reality(results: &Results) -> impl Iterator<Item = &TrialRow> {
    results.rows.iter().filter(|row| row.truth == "none" && row.reality.is_empty())
}

/// The paper's name of a parameter, or its path.
fn name(path: &str) -> String {
    let symbol = SYMBOLS.iter().find(|(known, _)| *known == path);
    symbol.map_or_else(|| format!("`{path}`"), |(_, symbol)| format!("{symbol} (`{path}`)"))
}

/// The description of a parameter, from the table of all parameters.
fn purpose(path: &str) -> Option<&'static str> {
    let path = current_path(path);
    let (table, name) = path.rsplit_once('.')?;
    let (sensor, robot) = (SensorConfig::default(), RobotConfig::default());
    let groups = groups(&PlannerConfig::default(), &sensor, &robot, &RealityConfig::default());
    let parameters = groups.into_iter().find(|group| group.table == table)?.parameters;
    parameters.iter().map(|valued| valued.parameter).find(|one| one.name == name).map(|one| one.text)
}

fn heading(text: &mut String, first: &str) -> fmt::Result {
    let headings: Vec<String> = METRICS.iter().map(|metric| format!(" {} |", metric.heading)).collect();
    writeln!(text, "\n| planner | {first} | reached | failures |{}", headings.concat())?;
    writeln!(text, "|---|---:|---|---|{}", "---:|".repeat(METRICS.len()))
}

/// A table and a figure of one parameter.
fn parameter(text: &mut String, results: &Results, figures: &mut Figures, path: &str) -> fmt::Result {
    writeln!(text, "\n### `{path}`\n")?;
    if let Some(purpose) = purpose(path) {
        write!(text, "{purpose} ")?;
    }
    writeln!(
        text,
        "**Bold** is the planner's own value. Means are over the trials that reached; the change in brackets is the mean of the ratios, trial by \
         trial, over those that reached with the planner's own value, too."
    )?;
    heading(text, path.rsplit('.').next().unwrap_or_default())?;
    let mut drawn = Vec::new();
    for planner in &results.manifest.planners {
        let values = values(results, planner, path);
        let own = values.iter().find(|(value, _)| value.own).map(|(_, rows)| rows.as_slice());
        for (value, rows) in &values {
            let shown = if value.own { format!("**{}**", value.text) } else { value.text.clone() };
            let changes = own.filter(|_| !value.own).map(|own| contests(pairs(rows, own)));
            writeln!(
                text,
                "| `{planner}` | {shown} | {} | {} |{}",
                rate(rows),
                failures(rows),
                cells(rows, changes.as_deref())
            )?;
        }
        let lines = lines(&values);
        if lines.iter().any(|line| line.points.len() > 1) {
            let mark_x =
                values.iter().find(|(value, _)| value.own).and_then(|(value, _)| value.text.parse().ok());
            let plot = Plot {
                x_label: path.to_owned(),
                y_label: "% of what it is with the own value".to_owned(),
                lines,
                mark_x,
                scale: Scale::Linear,
            };
            let file = format!("{}-{planner}-{}.svg", results.manifest.name, path.replace('.', "-"));
            drawn.push(figures.add(file, &format!("`{planner}` over {path}"), plot.svg()));
        }
    }
    for figure in drawn {
        writeln!(text, "\n{figure}")?;
    }
    Ok(())
}

/// The mean of each metric, and its change.
fn cells(rows: &[&TrialRow], changes: Option<&[Contest]>) -> String {
    let cell = |metric: &Metric| {
        let Some(mean) = stats::mean(&super::values(rows, metric)) else { return " |".to_owned() };
        let change = changes.and_then(|all| all.iter().find(|contest| contest.metric == metric.name()));
        let change = change.map_or_else(String::new, |contest| format!(" ({})", contest.percent()));
        format!(" {mean:.*}{change} |", metric.decimals)
    };
    METRICS.iter().map(cell).collect()
}

/// The metrics with a value and with the planner's own value, for each trial that reached with both.
fn pairs<'a>(
    rows: &'a [&TrialRow],
    own: &'a [&TrialRow],
) -> impl Iterator<Item = ([Option<f64>; 6], [Option<f64>; 6])> + 'a {
    let metrics = |row: &TrialRow| METRICS.each_ref().map(|metric| (metric.of)(row));
    rows.iter().filter(|row| row.has_reached()).filter_map(move |row| {
        let same = |other: &&&TrialRow| other.route == row.route && other.seed == row.seed;
        let own = own.iter().filter(|own| own.has_reached()).find(same)?;
        Some((metrics(row), metrics(own)))
    })
}

/// How often each value reaches, and the metrics over the trials that reach with both, in per cent of those
/// with the planner's own value.
fn lines(values: &[(Value, Vec<&TrialRow>)]) -> Vec<Line> {
    let Some((_, own)) = values.iter().find(|(value, _)| value.own) else { return Vec::new() };
    let reached = |rows: &[&TrialRow]| rows.iter().filter(|row| row.has_reached()).count() as f64;
    let mut lines = vec![Line { name: "reached".to_owned(), points: Vec::new() }];
    lines.extend(
        METRICS[..DRAWN]
            .iter()
            .map(|metric| Line { name: metric.name().replace('\\', ""), points: Vec::new() }),
    );
    for (value, rows) in values {
        let Ok(x) = value.text.parse::<f64>() else { continue };
        if reached(own) > 0.0 {
            lines[0].points.push((x, 100.0 * reached(rows) / reached(own)));
        }
        for (line, metric) in lines[1..].iter_mut().zip(&METRICS) {
            let contests = contests(pairs(rows, own));
            if let Some(contest) = contests.iter().find(|contest| contest.metric == metric.name()) {
                line.points.push((x, 100.0 * (1.0 + contest.change)));
            }
        }
    }
    lines.retain(|line| !line.points.is_empty());
    lines
}

/// A sentence about a parameter: which metrics change with each other value.
fn sentence(text: &mut String, planner: &str, path: &str, values: &[(Value, Vec<&TrialRow>)]) -> fmt::Result {
    let Some((own_value, own)) = values.iter().find(|(value, _)| value.own) else { return Ok(()) };
    write!(text, "- **{}** of `{planner}`, {}.", name(path), own_value.text)?;
    for (value, rows) in values.iter().filter(|(value, _)| !value.own) {
        let is_without = value.text.parse::<f64>().is_ok_and(|number| number == 0.0);
        let begin = if is_without { "Without it".to_owned() } else { format!("With {}", value.text) };
        write!(text, " {begin}, {}", success(rows, own))?;
        let contests = contests(pairs(rows, own));
        let clear: Vec<String> = contests
            .iter()
            .filter(|contest| stats::sign_test(contest.lower, contest.higher) < CHANCE)
            .map(|contest| {
                let (count, side) = contest.side();
                format!("{} {} ({side} on {count} of {})", contest.metric, contest.percent(), contest.routes)
            })
            .collect();
        match (contests.is_empty(), clear.is_empty()) {
            (true, _) => write!(text, ".")?,
            (false, true) => write!(text, ", and no metric changes clearly.")?,
            (false, false) => write!(text, "; {}.", clear.join(", "))?,
        }
    }
    writeln!(text)
}

/// Successes with a value beside those with the planner's own.
fn success(rows: &[&TrialRow], own: &[&TrialRow]) -> String {
    let reached = |rows: &[&TrialRow]| rows.iter().filter(|row| row.has_reached()).count();
    let (count, own_count) = (reached(rows), reached(own));
    if (count, rows.len()) == (own_count, own.len()) {
        return format!("{count} of {} reach as well", rows.len());
    }
    let ended = failures(rows);
    let ended = if ended.is_empty() { ended } else { format!(" ({ended})") };
    let intervals = [(count, rows.len()), (own_count, own.len())].map(|(count, of)| stats::wilson(count, of));
    let is_beyond = intervals[0].0 > intervals[1].1 || intervals[1].0 > intervals[0].1;
    let sure = if is_beyond { "beyond" } else { "within" };
    format!(
        "{count} of {} reach{ended} instead of {own_count} of {}, {sure} the 95 % intervals",
        rows.len(),
        own.len()
    )
}

/// A value of a parameter.
#[derive(PartialEq)]
struct Value {
    text: String,
    /// Whether it is the planner's own.
    own: bool,
}

/// The planner's own value and the others, each with its trials, in the order of their numbers.
fn values<'a>(results: &'a Results, planner: &str, path: &str) -> Vec<(Value, Vec<&'a TrialRow>)> {
    let mut values: Vec<(Value, Vec<&TrialRow>)> = Vec::new();
    for row in own_reality(results).filter(|row| row.planner == planner) {
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

fn combinations(text: &mut String, rows: &[&TrialRow]) -> fmt::Result {
    writeln!(text, "\n### Combinations")?;
    heading(text, "parameters")?;
    let mut groups: BTreeMap<(&str, &str), Vec<&TrialRow>> = BTreeMap::new();
    for row in rows {
        groups.entry((&row.planner, &row.parameters)).or_default().push(row);
    }
    for ((planner, parameters), rows) in groups {
        writeln!(
            text,
            "| `{planner}` | {parameters} | {} | {} |{}",
            rate(&rows),
            failures(&rows),
            tables::cells(&rows)
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{results, row};

    /// Ten seeds with the own weight of one, and ten without it, of which one fails and the others roll by
    /// half more.
    fn rows() -> Vec<TrialRow> {
        let configuration = "{\"decision\":{\"steepness_weight\":1.0}}".to_owned();
        let metrics = |row: TrialRow, roll_rad: f64| TrialRow {
            distance_m: Some(50.0),
            max_abs_roll_rad: Some(roll_rad),
            configuration: configuration.clone(),
            ..row
        };
        let mut rows = Vec::new();
        for seed in 1..=10 {
            rows.push(metrics(row("default", "a", "none", seed, "reached"), 0.2));
            let outcome = if seed == 10 { "tilt_limit" } else { "reached" };
            let without = TrialRow {
                parameters: "planner.decision.steepness_weight=0.0".to_owned(),
                ..row("default", "a", "none", seed, outcome)
            };
            rows.push(metrics(without, 0.3));
        }
        rows
    }

    #[test]
    fn a_sentence_says_what_a_weight_buys() {
        let (mut text, mut figures) = (String::new(), Figures::default());
        section(&mut text, &results(&["default"], &["a"], rows()), &mut figures).unwrap();
        for needle in [
            "- **k_stp (`planner.decision.steepness_weight`)** of `default`, 1.0. Without it, 9 of 10 reach (1 tilt_limit) instead of 10 of 10, \
             within the 95 % intervals; max \\|roll\\| +50 % (higher on 9 of 9).\n",
            "Weight k_stp of steepness: the mean risk of the path. **Bold**",
            "| `default` | 0.0 | 9 of 10 (60–98 %) | 1 tilt_limit | 50.0 (+0 %) | 0.300 (+50 %) | | | | |\n",
            "| `default` | **1.0** | 10 of 10 (72–100 %) |  | 50.0 | 0.200 | | | | |\n",
        ] {
            assert!(text.contains(needle), "not in the section: {needle}\n{text}");
        }
        assert_eq!(figures.drawn.len(), 1);
    }

    #[test]
    fn every_symbol_is_a_parameter() {
        for (path, _) in SYMBOLS {
            assert!(purpose(path).is_some(), "{path}");
        }
        assert_eq!(purpose("planner.forecast.step_m"), purpose("planner.state_lattice.step_m"));
        assert_eq!(purpose("planner.forecast.step"), None);
    }
}
