//! Our means against the spread of the paper's.

use std::fmt::{self, Write as _};

use super::published::PublishedRow;
use super::{METRICS, Results, stats, values};
use crate::row::TrialRow;

/// A value within this many standard deviations of the paper's mean lies within its spread.
const DEVIATIONS: f64 = 2.0;

/// The means within the paper's mean ± 2 sd and those outside, with what is known of the ground there.
pub(super) fn section(text: &mut String, results: &Results, published: &[PublishedRow]) -> fmt::Result {
    let groups = results.groups();
    let rows: Vec<(&PublishedRow, [f64; 6])> = published
        .iter()
        .filter(|row| row.method == "paper" && groups.contains(&row.route.as_str()))
        .filter_map(|row| Some((row, row.deviation?)))
        .collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(text, "\n## Within the paper's spread\n")?;
    writeln!(
        text,
        "Where the paper gives a standard deviation: whether our mean lies within its mean ± 2 sd.\n"
    )?;
    for (row, deviations) in &rows {
        for planner in ["default", "paper"] {
            let ours = results.of(planner, &row.route);
            if ours.iter().any(|row| row.has_reached()) {
                writeln!(text, "{}", sentence(planner, row, deviations, &ours))?;
            }
        }
    }
    for (row, _) in &rows {
        let shortest_m = results.of("oracle", &row.route).first().and_then(|row| row.oracle_length_m);
        if let Some(shortest_m) = shortest_m {
            writeln!(
                text,
                "- On `{}` the shortest safe path is {shortest_m:.1} m long, where the paper's method drove {:.1} m: \
                 its terrain is not given, ours is a model of what its figures show. So distances are comparable only as far as these are.",
                row.route, row.mean[0]
            )?;
        }
    }
    writeln!(
        text,
        "- Curvature change has no agreed sampling: the paper does not say how |ω / v| is sampled, nor what it does where v is near zero. \
         Ours is taken at every step of the motion (0.01 s) with |v| of at least 0.05 m/s, so each start and each turn on the spot enters. \
         Compare it among planners here, not with the paper."
    )
}

fn sentence(planner: &str, row: &PublishedRow, deviations: &[f64; 6], ours: &[&TrialRow]) -> String {
    let (mut within, mut outside) = (Vec::new(), Vec::new());
    for (index, metric) in METRICS.iter().enumerate() {
        let Some(mean) = stats::mean(&values(ours, metric)) else { continue };
        let (name, decimals) = (metric.name(), metric.decimals);
        let off = (mean - row.mean[index]) / deviations[index];
        if off.abs() <= DEVIATIONS {
            within.push(name.to_owned());
        } else {
            outside.push(format!("{name} ({mean:.decimals$}, {off:+.1} sd)"));
        }
    }
    let list = |names: Vec<String>| if names.is_empty() { "nothing".to_owned() } else { names.join(", ") };
    format!("- `{planner}` on `{}`: within {}; outside {}.", row.route, list(within), list(outside))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{results, row};

    #[test]
    fn each_metric_is_named_on_its_side() {
        let published = super::super::published::published().unwrap();
        let ours = TrialRow {
            distance_m: Some(84.0),
            max_abs_roll_rad: Some(0.4),
            max_abs_pitch_rad: Some(0.1),
            mean_vibration_rad_s: Some(0.07),
            mean_elevation_rate_cm_s: Some(9.0),
            curvature_change_rad_m: Some(0.1),
            ..row("default", "ml", "none", 1, "reached")
        };
        let shortest = TrialRow { oracle_length_m: Some(78.0), ..row("oracle", "ml", "none", 1, "reached") };
        let mut text = String::new();
        section(&mut text, &results(&["default", "oracle"], &["ml"], vec![ours, shortest]), &published)
            .unwrap();
        assert!(
            text.contains(
                "- `default` on `ml`: within distance, max \\|roll\\|, vibration, curvature change; \
                 outside max \\|pitch\\| (0.100, -3.6 sd), elevation rate (9.00, +8.3 sd).\n"
            ),
            "{text}"
        );
        assert!(text.contains(
            "On `ml` the shortest safe path is 78.0 m long, where the paper's method drove 84.5 m"
        ));
        assert!(!text.contains("vta"), "{text}");
    }

    #[test]
    fn routes_without_a_published_deviation_have_no_section() {
        let published = super::super::published::published().unwrap();
        let mut text = String::new();
        let rows = vec![row("default", "cht-ad", "none", 1, "reached")];
        section(&mut text, &results(&["default"], &["cht-ad"], rows), &published).unwrap();
        assert!(text.is_empty(), "{text}");
    }
}
