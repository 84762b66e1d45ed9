//! Comparison of driven paths with the shortest safe ones.

use std::fmt::{self, Write as _};

use super::{Results, rate, stats};
use crate::row::TrialRow;

/// SPL and the median ratio of lengths by planner, over the trials whose shortest path is known.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    writeln!(text, "\n## Against the shortest safe path\n")?;
    if results.plain().all(|row| row.oracle_length_m.is_none()) {
        return writeln!(
            text,
            "The shortest safe path of these routes is not known, so nothing is compared with it."
        );
    }
    writeln!(
        text,
        "SPL is success weighted by path length (Anderson et al. 2018) over the trials whose shortest path is known. \
         A driven path is measured along the ground, to within the goal's tolerance. The shortest is measured in \
         plan, to the goal itself, over a lattice of headings that makes it up to 2.8 % longer. So some ratios are \
         a little below one.\n"
    )?;
    writeln!(
        text,
        "| planner | routes | reached | SPL | median of driven / shortest |\n|---|---|---|---:|---:|"
    )?;
    for planner in &results.manifest.planners {
        for (routes, rows) in results.all_and_groups(planner) {
            line(text, planner, routes, &rows)?;
        }
    }
    Ok(())
}

/// A line of the table, of the trials whose shortest path is known.
fn line(text: &mut String, planner: &str, routes: &str, rows: &[&TrialRow]) -> fmt::Result {
    let known: Vec<&TrialRow> = rows.iter().copied().filter(|row| row.oracle_length_m.is_some()).collect();
    let lengths = known.iter().filter_map(|row| {
        let driven_m = row.distance_m.filter(|_| row.has_reached());
        Some((driven_m, row.oracle_length_m?))
    });
    let lengths: Vec<(Option<f64>, f64)> = lengths.collect();
    let ratios =
        lengths.iter().filter_map(|(driven_m, shortest_m)| Some(driven_m.as_ref()? / shortest_m)).collect();
    let shown = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.3}"));
    let (spl, ratio) = (shown(stats::spl(&lengths)), shown(stats::median(ratios)));
    writeln!(text, "| `{planner}` | {routes} | {} | {spl} | {ratio} |", rate(&known))
}
