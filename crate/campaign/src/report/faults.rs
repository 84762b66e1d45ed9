//! Whether perception, decision or control is to blame for a failure: what becomes of it when the planner is told the truth.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use super::Results;
use crate::results::TrialRow;

/// What was told, in the order in which a failure is looked for.
const TOLD: [(&str, &str); 3] = [
    ("profile", "perception of the profile"),
    ("ground", "perception of the ground"),
    ("both", "perception of both"),
];

/// A trial but for what was told.
type Key<'a> = (&'a str, &'a str, &'a str, u64);

/// Sorts every failure by the first truth that mends it.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    let mut trials: BTreeMap<Key<'_>, BTreeMap<&str, &TrialRow>> = BTreeMap::new();
    for row in &results.rows {
        let key = (row.planner.as_str(), row.route.as_str(), row.parameters.as_str(), row.seed);
        trials.entry(key).or_default().insert(&row.truth, row);
    }
    trials.retain(|_, told| told.len() > 1 && told.contains_key("none"));
    if trials.is_empty() {
        return Ok(());
    }
    let oracle_reached = |route: &str| {
        results.rows.iter().any(|row| row.planner == "oracle" && row.route == route && row.has_reached())
    };
    writeln!(
        text,
        "\n### Where failures come from\n\nThe same trials again, with the planner told the true elevation profile, the true ground, or both. A failure that \
         goes away is one of perception. One that stays is one of decision where the oracle, driven by the same controller, reaches, \
         and one of control or of the route where it does not or did not run.\n"
    )?;
    let headings: Vec<String> = TOLD.iter().map(|(_, blame)| format!(" {blame} |")).collect();
    writeln!(
        text,
        "| planner | trials | failed |{} decision | control or route | reached, but not when told |",
        headings.concat()
    )?;
    writeln!(text, "|---|---:|---:|{}---:|---:|---:|", "---:|".repeat(TOLD.len()))?;
    for planner in &results.manifest.planners {
        let of_planner: Vec<_> = trials.iter().filter(|((name, ..), _)| name == planner).collect();
        if of_planner.is_empty() {
            continue;
        }
        let (mut mended, mut decision, mut rest, mut spoilt, mut failed) = ([0; TOLD.len()], 0, 0, 0, 0);
        for ((_, route, ..), told) in &of_planner {
            let reached = |truth: &str| told.get(truth).is_some_and(|row| row.has_reached());
            if reached("none") {
                spoilt += usize::from(told.values().any(|row| !row.has_reached()));
                continue;
            }
            failed += 1;
            match TOLD.iter().position(|(truth, _)| reached(truth)) {
                Some(index) => mended[index] += 1,
                None if oracle_reached(route) => decision += 1,
                None => rest += 1,
            }
        }
        let mended: Vec<String> = mended.iter().map(|count| format!(" {count} |")).collect();
        writeln!(
            text,
            "| `{planner}` | {} | {failed} |{} {decision} | {rest} | {spoilt} |",
            of_planner.len(),
            mended.concat()
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{results, row};

    #[test]
    fn every_failure_has_one_blame() {
        let mut rows = Vec::new();
        // Seeds by what they reach with: nothing told, the profile, the ground, both.
        for (seed, reached) in [
            (1, [true; 4]),
            (2, [false, true, false, true]),
            (3, [false, false, true, true]),
            (4, [false; 4]),
            (5, [true, true, false, true]),
        ] {
            for (truth, reached) in ["none", "profile", "ground", "both"].into_iter().zip(reached) {
                rows.push(row("default", "a", truth, seed, if reached { "reached" } else { "stuck" }));
            }
        }
        rows.push(row("paper", "a", "none", 1, "stuck"));
        let table = |rows| {
            let mut text = String::new();
            section(&mut text, &results(&["default", "paper", "oracle"], &["a"], rows)).unwrap();
            text
        };
        assert!(
            table(rows.clone()).ends_with("| `default` | 5 | 3 | 1 | 1 | 0 | 0 | 1 | 1 |\n"),
            "{}",
            table(rows)
        );
        rows.push(row("oracle", "a", "none", 1, "reached"));
        assert!(
            table(rows.clone()).ends_with("| `default` | 5 | 3 | 1 | 1 | 0 | 1 | 0 | 1 |\n"),
            "{}",
            table(rows)
        );
        rows.retain(|row| row.truth == "none");
        assert_eq!(table(rows), "");
    }
}
