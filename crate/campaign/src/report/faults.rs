//! Whether perception, memory, decision or control is to blame for a failure: what becomes of it when the planner is told the truth.

use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

use super::{Results, failures, rate, stats};
use crate::row::TrialRow;

/// What the planner was told: its name in the rows, and in words.
const TOLD: [(&str, &str); 4] = [
    ("none", "nothing"),
    ("profile", "the elevation profile"),
    ("ground", "the ground"),
    ("both", "profile and ground"),
];

/// How many failures are shown one by one.
const SHOWN: usize = 20;

/// Where a failure comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Cause {
    Profile,
    Ground,
    Either,
    Both,
    Decision,
    Control,
    DecisionOrControl,
    Untold,
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
        Self::Untold,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Profile => "perception of the profile",
            Self::Ground => "memory of the ground",
            Self::Either => "perception or memory: either truth mends it",
            Self::Both => "perception and memory: only both truths mend it",
            Self::Decision => "decision",
            Self::Control => "control or the route",
            Self::DecisionOrControl => "decision or control",
            Self::Untold => "nothing: profile and ground were not told together",
        }
    }
}

/// A trial but for what was told: planner, route, parameters, seed.
type Key<'a> = (&'a str, &'a str, &'a str, u64);

/// The rows of such a trial by what was told.
type Told<'a> = BTreeMap<&'a str, &'a TrialRow>;

/// How often each planner reaches with each truth, and what each of its failures is put down to.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    let mut trials: BTreeMap<Key<'_>, Told<'_>> = BTreeMap::new();
    for row in &results.rows {
        let key = (row.planner.as_str(), row.route.as_str(), row.parameters.as_str(), row.seed);
        trials.entry(key).or_default().insert(&row.truth, row);
    }
    trials.retain(|_, told| told.len() > 1 && told.contains_key("none"));
    if trials.is_empty() {
        return Ok(());
    }
    write!(
        text,
        "\n## Where failures come from\n\nThe same trials again, with the planner told the truth: the elevation profile in place of what it makes of a scan, \
         the ground in place of the returns that it remembers, or both. A failure that goes away is put down to what the truth stood in for, one \
         that stays whatever is told to decision or control"
    )?;
    if results.manifest.planners.iter().any(|planner| planner == "oracle") {
        write!(
            text,
            ": to decision where the oracle, driven by the same controller, reaches, to control or the route where it does not"
        )?;
    }
    writeln!(
        text,
        ". Chance is a sign test's: how likely as uneven a pair of mended and spoilt trials is where the truth makes no difference. There is none where \
         every trial failed untold, as of tasks that were chosen for it: any other drive, too, mends some of those.\n"
    )?;
    writeln!(
        text,
        "| planner | told | reached | failures | mended: fail untold, reach told | spoilt: reach untold, fail told | chance |\n\
         |---|---|---|---|---:|---:|---:|"
    )?;
    let planners: Vec<(&String, Vec<&Told<'_>>)> = (results.manifest.planners.iter())
        .map(|planner| {
            let of_planner = trials.iter().filter(|((name, ..), _)| name == planner);
            (planner, of_planner.map(|(_, told)| told).collect::<Vec<_>>())
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

/// A line for each truth.
fn by_truth(text: &mut String, planner: &str, trials: &[&Told<'_>]) -> fmt::Result {
    let has_failed = |told: &Told<'_>| !told["none"].has_reached();
    for (truth, words) in TOLD {
        let rows: Vec<&TrialRow> = trials.iter().filter_map(|told| told.get(truth).copied()).collect();
        if rows.is_empty() {
            continue;
        }
        let mut changes = String::from(" | | |");
        if truth != "none" {
            let both = |failed: bool, reached: bool| {
                let of = trials.iter().filter(|told| has_failed(told) == failed);
                let rows: Vec<_> = of.filter_map(|told| told.get(truth)).collect();
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

/// How many failures have which cause, and the failures one by one.
fn causes(text: &mut String, results: &Results, planner: &str, trials: &[&Told<'_>]) -> fmt::Result {
    let failed: Vec<(&Told<'_>, Cause)> = (trials.iter())
        .filter(|told| !told["none"].has_reached())
        .map(|told| (*told, cause(results, told)))
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
        "\nOf the failures of `{planner}`, {} in all, are put down {}. A truth makes another drive from the first step on, which spoils \
         some that reached, too; so what one failure is put down to may be luck.\n",
        failed.len(),
        words.join(", ")
    )?;
    writeln!(
        text,
        "| planner | route | seed | told nothing | told the profile | told the ground | told both | put down to | command |\n\
         |---|---|---:|---|---|---|---|---|---|"
    )?;
    for (told, cause) in failed.iter().take(SHOWN) {
        let row = told["none"];
        let mut planner = format!("`{planner}`");
        if !row.parameters.is_empty() {
            write!(planner, ", {}", row.parameters)?;
        }
        let outcomes = TOLD.map(|(truth, _)| {
            told.get(truth).map_or_else(|| " |".to_owned(), |row| format!(" {} |", row.outcome))
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

/// What the failure of a trial is put down to.
fn cause(results: &Results, told: &Told<'_>) -> Cause {
    let reached = |truth: &str| told.get(truth).is_some_and(|row| row.has_reached());
    let route = &told["none"].route;
    let oracle = || results.rows.iter().find(|row| row.planner == "oracle" && row.route == *route);
    match (reached("profile"), reached("ground"), reached("both")) {
        (true, true, _) => Cause::Either,
        (true, false, _) => Cause::Profile,
        (false, true, _) => Cause::Ground,
        (false, false, true) => Cause::Both,
        (false, false, false) if !told.contains_key("both") => Cause::Untold,
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

    /// Seeds by what they reach with: nothing told, the profile, the ground, both.
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
            for ((truth, _), reached) in TOLD.into_iter().zip(reached) {
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
            "| `default` | nothing | 2 of 7 (8–64 %) | 5 stuck | | | |\n",
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
                "Of the failures of `default`, 5 in all, are put down 1 to perception of the profile, 1 to memory of the ground, 1 to perception or memory: either \
                 truth mends it, 1 to perception and memory: only both truths mend it, 1 to decision or control."
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
    fn what_was_not_told_everything_is_put_down_to_nothing() {
        let mut rows = rows();
        rows.retain(|row| row.truth == "none" || row.truth == "profile");
        let text = written(rows);
        assert!(
            text.contains(
                "2 to perception of the profile, 3 to nothing: profile and ground were not told together."
            ),
            "{text}"
        );
    }

    #[test]
    fn nothing_is_said_where_nothing_was_told_or_failed() {
        let mut rows = rows();
        rows.retain(|row| row.seed == 1 && row.planner == "default");
        assert!(written(rows.clone()).contains("`default` fails nowhere here"));
        rows.retain(|row| row.truth == "none");
        assert_eq!(written(rows), "");
    }
}
