//! Attribution of failures to perception, elevation window, decision or control: the same trials with ground
//! truth in place of perception.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use super::{Results, failures, rate, stats};
use crate::row::TrialRow;

/// The perception overrides: name in the rows, and in words.
const OVERRIDES: [(&str, &str); 4] = [
    ("none", "none"),
    ("profile", "the elevation profile"),
    ("ground", "the ground"),
    ("both", "profile and ground"),
];

/// Failures listed one by one.
const SHOWN: usize = 20;

/// The source of a failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Cause {
    Profile,
    Ground,
    Either,
    Both,
    Decision,
    Control,
    DecisionOrControl,
    OverriddenApart,
}

impl Cause {
    const ALL: [Self; 8] = [
        Self::Profile,
        Self::Ground,
        Self::Either,
        Self::Both,
        Self::Decision,
        Self::Control,
        Self::DecisionOrControl,
        Self::OverriddenApart,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Profile => "perception of the profile",
            Self::Ground => "the elevation window",
            Self::Either => "perception or the elevation window: either truth mends it",
            Self::Both => "perception and the elevation window: only both truths mend it",
            Self::Decision => "decision",
            Self::Control => "control or the route",
            Self::DecisionOrControl => "decision or control",
            Self::OverriddenApart => "nothing: profile and ground were not overridden together",
        }
    }
}

/// A trial without its override: planner, route, parameters, reality, seed.
type Key<'a> = (&'a str, &'a str, &'a str, &'a str, u64);

/// The rows of such a trial by override.
type Trial<'a> = BTreeMap<&'a str, &'a TrialRow>;

/// How often each planner reaches with each override, and the cause of each of its failures.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    let mut trials: BTreeMap<Key<'_>, Trial<'_>> = BTreeMap::new();
    for row in &results.rows {
        let TrialRow { planner, route, parameters, reality, seed, .. } = row;
        let key = (planner.as_str(), route.as_str(), parameters.as_str(), reality.as_str(), *seed);
        trials.entry(key).or_default().insert(&row.truth, row);
    }
    trials.retain(|_, trial| trial.len() > 1 && trial.contains_key("none"));
    if trials.is_empty() {
        return Ok(());
    }
    write!(
        text,
        "\n## Where failures come from\n\nThe same trials again, with a perception override: the true elevation profile \
         in place of the perceived one, the true ground in place of the elevation window, or both. A failure that \
         goes away is put down to what was overridden; one that stays under every override, to decision or control"
    )?;
    if results.manifest.planners.iter().any(|planner| planner == "oracle") {
        write!(
            text,
            ": to decision where the oracle, driven by the same controller, reaches; to control or the route where it does not"
        )?;
    }
    writeln!(
        text,
        ". Chance is a sign test's: how likely is so uneven a pair of mended and spoilt trials if the override makes \
         no difference. There is none if every trial fails without an override, as of tasks chosen for that: any \
         other drive, too, mends some of those.\n"
    )?;
    writeln!(
        text,
        "| planner | override | reached | failures | mended: fail without, reach with | spoilt: reach without, fail with | chance |\n\
         |---|---|---|---|---:|---:|---:|"
    )?;
    let planners: Vec<(&String, Vec<&Trial<'_>>)> = (results.manifest.planners.iter())
        .map(|planner| {
            let of_planner = trials.iter().filter(|((name, ..), _)| name == planner);
            (planner, of_planner.map(|(_, trial)| trial).collect::<Vec<_>>())
        })
        .filter(|(_, trials)| !trials.is_empty())
        .collect();
    for (planner, trials) in &planners {
        by_truth(text, planner, trials)?;
    }
    for (planner, trials) in &planners {
        causes(text, results, planner, trials)?;
    }
    Ok(())
}

/// A line for each override.
fn by_truth(text: &mut String, planner: &str, trials: &[&Trial<'_>]) -> fmt::Result {
    let has_failed = |trial: &Trial<'_>| !trial["none"].has_reached();
    for (truth, words) in OVERRIDES {
        let rows: Vec<&TrialRow> = trials.iter().filter_map(|trial| trial.get(truth).copied()).collect();
        if rows.is_empty() {
            continue;
        }
        let mut changes = String::from(" | | |");
        if truth != "none" {
            let both = |failed: bool, reached: bool| {
                let of = trials.iter().filter(|trial| has_failed(trial) == failed);
                let rows: Vec<_> = of.filter_map(|trial| trial.get(truth)).collect();
                (rows.iter().filter(|row| row.has_reached() == reached).count(), rows.len())
            };
            let ((mended, failed), (spoilt, reached)) = (both(true, true), both(false, false));
            let chance = if reached > 0 {
                format!("{:.2}", stats::sign_test(mended, spoilt))
            } else {
                "–".to_owned()
            };
            changes = format!(" {mended} of {failed} | {spoilt} of {reached} | {chance} |");
        }
        writeln!(text, "| `{planner}` | {words} | {} | {} |{changes}", rate(&rows), failures(&rows))?;
    }
    Ok(())
}

/// The number of failures by cause, and the failures one by one.
fn causes(text: &mut String, results: &Results, planner: &str, trials: &[&Trial<'_>]) -> fmt::Result {
    let failed: Vec<(&Trial<'_>, Cause)> = (trials.iter())
        .filter(|trial| !trial["none"].has_reached())
        .map(|trial| (*trial, cause(results, trial)))
        .collect();
    if failed.is_empty() {
        return writeln!(text, "\n`{planner}` fails nowhere here, so there is nothing to explain.");
    }
    let counts = Cause::ALL.map(|cause| (failed.iter().filter(|(_, found)| *found == cause).count(), cause));
    let words: Vec<String> = (counts.iter().filter(|(count, _)| *count > 0))
        .map(|(count, cause)| format!("{count} to {}", cause.name()))
        .collect();
    writeln!(
        text,
        "\nFailures of `{planner}`: {}, put down {}. An override makes another drive from the first step on, and \
         spoils some that reached; so the cause of a single failure may be luck.\n",
        failed.len(),
        words.join(", ")
    )?;
    writeln!(
        text,
        "| planner | route | seed | no override | true profile | true ground | both | put down to | command |\n\
         |---|---|---:|---|---|---|---|---|---|"
    )?;
    for (trial, cause) in failed.iter().take(SHOWN) {
        let row = trial["none"];
        let mut planner = format!("`{planner}`");
        if !row.parameters.is_empty() {
            write!(planner, ", {}", row.parameters)?;
        }
        if !row.reality.is_empty() {
            write!(planner, ", reality {}", row.reality)?;
        }
        let outcomes = OVERRIDES.map(|(truth, _)| {
            trial.get(truth).map_or_else(|| " |".to_owned(), |row| format!(" {} |", row.outcome))
        });
        writeln!(
            text,
            "| {planner} | {} | {} |{} {} | `{}` |",
            row.route,
            row.seed,
            outcomes.concat(),
            cause.name(),
            results.replay(row)
        )?;
    }
    if failed.len() > SHOWN {
        writeln!(text, "\n{} more are in `trials.csv`.", failed.len() - SHOWN)?;
    }
    Ok(())
}

/// The cause of a trial's failure.
fn cause(results: &Results, trial: &Trial<'_>) -> Cause {
    let reached = |truth: &str| trial.get(truth).is_some_and(|row| row.has_reached());
    let route = &trial["none"].route;
    let oracle = || results.rows.iter().find(|row| row.planner == "oracle" && row.route == *route);
    match (reached("profile"), reached("ground"), reached("both")) {
        (true, true, _) => Cause::Either,
        (true, false, _) => Cause::Profile,
        (false, true, _) => Cause::Ground,
        (false, false, true) => Cause::Both,
        (false, false, false) if !trial.contains_key("both") => Cause::OverriddenApart,
        (false, false, false) => match oracle() {
            Some(oracle) if oracle.has_reached() => Cause::Decision,
            Some(_) => Cause::Control,
            None => Cause::DecisionOrControl,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{results, row};

    /// Seeds by the overrides with which they reach: none, the profile, the ground, both.
    const REACHED: [[bool; 4]; 7] = [
        [true; 4],
        [false, true, false, true],
        [false, false, true, true],
        [false, true, true, false],
        [false, false, false, true],
        [false; 4],
        [true, true, false, true],
    ];

    fn rows() -> Vec<TrialRow> {
        let mut rows = Vec::new();
        for (seed, reached) in (1..).zip(REACHED) {
            for ((truth, _), reached) in OVERRIDES.into_iter().zip(reached) {
                rows.push(row("default", "a", truth, seed, if reached { "reached" } else { "stuck" }));
            }
        }
        rows.push(row("paper", "a", "none", 1, "stuck"));
        rows
    }

    fn written(rows: Vec<TrialRow>) -> String {
        let mut text = String::new();
        section(&mut text, &results(&["default", "paper", "oracle"], &["a"], rows)).unwrap();
        text
    }

    #[test]
    fn every_truth_is_counted() {
        let text = written(rows());
        for line in [
            "| `default` | none | 2 of 7 (8–64 %) | 5 stuck | | | |\n",
            "| `default` | the elevation profile | 4 of 7 (25–84 %) | 3 stuck | 2 of 5 | 0 of 2 | 0.50 |\n",
            "| `default` | the ground | 3 of 7 (16–75 %) | 4 stuck | 2 of 5 | 1 of 2 | 1.00 |\n",
            "| `default` | profile and ground | 5 of 7 (36–92 %) | 2 stuck | 3 of 5 | 0 of 2 | 0.25 |\n",
        ] {
            assert!(text.contains(line), "not in the section: {line}\n{text}");
        }
        assert!(!text.contains("| `paper`"), "{text}");
    }

    #[test]
    fn tasks_that_were_chosen_for_failing_say_nothing_of_chance() {
        let mut rows = rows();
        rows.retain(|row| !(row.seed == 1 || row.seed == 7));
        let text = written(rows);
        assert!(
            text.contains("| `default` | the ground | 2 of 5 (12–77 %) | 3 stuck | 2 of 5 | 0 of 0 | – |\n"),
            "{text}"
        );
    }

    #[test]
    fn every_failure_has_one_cause() {
        let mut rows = rows();
        let text = written(rows.clone());
        assert!(
            text.contains(
                "Failures of `default`: 5, put down 1 to perception of the profile, 1 to the elevation window, \
                 1 to perception or the elevation window: either truth mends it, 1 to perception and the \
                 elevation window: only both truths mend it, 1 to decision or control."
            ),
            "{text}"
        );
        assert!(
            text.contains(
                "| `default` | a | 2 | stuck | reached | stuck | reached | perception of the profile | `mapless trials test.toml --only default-a-none-2` |\n"
            ),
            "{text}"
        );
        for (outcome, cause) in [("reached", "1 to decision."), ("tilt_limit", "1 to control or the route.")]
        {
            rows.push(row("oracle", "a", "none", 1, outcome));
            let text = written(rows.clone());
            assert!(text.contains(cause), "{text}");
            rows.pop();
        }
    }

    #[test]
    fn a_failure_without_the_override_of_both_is_put_down_to_nothing() {
        let mut rows = rows();
        rows.retain(|row| row.truth == "none" || row.truth == "profile");
        let text = written(rows);
        assert!(
            text.contains(
                "2 to perception of the profile, 3 to nothing: profile and ground were not overridden together."
            ),
            "{text}"
        );
    }

    #[test]
    fn nothing_is_said_where_nothing_was_overridden_or_failed() {
        let mut rows = rows();
        rows.retain(|row| row.seed == 1 && row.planner == "default");
        assert!(written(rows.clone()).contains("`default` fails nowhere here"));
        rows.retain(|row| row.truth == "none");
        assert_eq!(written(rows), "");
    }
}
