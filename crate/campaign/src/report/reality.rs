//! What each condition of a campaign costs each planner: the same trials as in the scenarios' own reality.

use std::collections::HashMap;
use std::fmt::{self, Write as _};

use super::worst::{address, tilt_utilisation};
use super::{Results, failures, rate, stats};
use crate::row::TrialRow;

/// Words for the scenarios' own reality.
const OWN: &str = "own";
/// Trials of a planner and a condition that are listed, of those that the condition spoils.
const SHOWN: usize = 5;

/// A table of the conditions, one of what each costs each planner, one by route, and the spoilt trials.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    if results.manifest.realities.is_empty() {
        return Ok(());
    }
    writeln!(
        text,
        "\n## What reality costs\n\nThe same trials under conditions that the scenarios do not have: what each sets in \
         `[reality]` is laid over the scenario's own, which is `ideal`, with bodies that touch the ground on generated tasks \
         with obstacles. [What each key does](../design/reality.md).\n\n| condition | sets |\n|---|---|"
    )?;
    for reality in &results.manifest.realities {
        writeln!(text, "| {} | `{}` |", reality.name, reality.sets)?;
    }
    let drives: Vec<Drives<'_>> = results
        .manifest
        .planners
        .iter()
        .flat_map(|planner| names(results).map(move |name| Drives::of(results, planner, name)))
        .filter(|drives| !drives.rows.is_empty())
        .collect();
    costs(text, &drives)?;
    by_group(text, results, &drives)?;
    spoilt(text, results, &drives)
}

/// Names of the conditions, the scenarios' own first.
fn names(results: &Results) -> impl Iterator<Item = &str> {
    std::iter::once("").chain(results.manifest.realities.iter().map(|reality| reality.name.as_str()))
}

/// A planner's trials under a condition, each with that of the same route and seed in the scenarios' own.
struct Drives<'a> {
    planner: &'a str,
    condition: &'a str,
    rows: Vec<&'a TrialRow>,
    pairs: Vec<(&'a TrialRow, &'a TrialRow)>,
}

impl<'a> Drives<'a> {
    fn of(results: &'a Results, planner: &'a str, condition: &'a str) -> Self {
        let of_planner =
            |condition| results.unchanged(condition).filter(move |row: &&TrialRow| row.planner == planner);
        let own: HashMap<(&str, u64), &TrialRow> =
            of_planner("").map(|row| ((row.route.as_str(), row.seed), row)).collect();
        let rows: Vec<&TrialRow> = of_planner(condition).collect();
        let pair = |row: &&'a TrialRow| Some((*row, *own.get(&(row.route.as_str(), row.seed))?));
        Self { planner, condition, pairs: rows.iter().filter_map(pair).collect(), rows }
    }

    fn shown(&self) -> &'a str {
        if self.condition.is_empty() { OWN } else { self.condition }
    }

    /// Mean over the pairs that both reach of a value here / there.
    fn ratio(&self, of: fn(&TrialRow) -> Option<f64>) -> Option<f64> {
        let both = self.pairs.iter().filter(|(here, own)| here.has_reached() && own.has_reached());
        let ratios: Vec<f64> = both.filter_map(|(here, own)| Some(of(here)? / of(own)?)).collect();
        stats::mean(&ratios)
    }

    /// The trials that reach in the scenarios' own reality and fail here.
    fn lost(&self) -> impl Iterator<Item = &'a TrialRow> {
        let lost = self.pairs.iter().filter(|(here, own)| !here.has_reached() && own.has_reached());
        lost.map(|(here, _)| *here)
    }
}

fn costs(text: &mut String, drives: &[Drives<'_>]) -> fmt::Result {
    writeln!(
        text,
        "\n### By planner and condition\n\n\
         `{OWN}` is the scenarios' own reality, and what the others are compared with, trial by trial: same planner, \
         same route, same seed. *Lost* reach there and fail here, *gained* the other way round; chance is a sign test's over both. \
         Path and time are means of the ratios over the trials that reach in both; driven / shortest is the median over those \
         that reach and whose shortest safe path is known. \
         *Tilt violations* are trials that roll or pitch ended; the tilt is the mean over all trials of the largest roll or pitch in \
         per cent of its limit.\n\n\
         | planner | condition | reached | lost | gained | chance | path, × | time, × | driven / shortest | tilt violations | largest tilt, % | failures |\n\
         |---|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---|"
    )?;
    for drives in drives {
        let Drives { planner, condition, rows, pairs } = drives;
        let changes = if condition.is_empty() {
            " | | | | |".to_owned()
        } else {
            let lost = drives.lost().count();
            let gained = pairs.iter().filter(|(here, own)| here.has_reached() && !own.has_reached()).count();
            let ratio = |of| drives.ratio(of).map_or_else(String::new, |ratio| format!("{ratio:.2}"));
            let (path, time) = (ratio(|row| row.distance_m), ratio(|row| row.sim_time_s));
            format!(" {lost} | {gained} | {:.2} | {path} | {time} |", stats::sign_test(lost, gained))
        };
        let reached = rows.iter().filter(|row| row.has_reached());
        let shortest = reached.filter_map(|row| Some(row.distance_m? / row.oracle_length_m?)).collect();
        let shortest = stats::median(shortest).map_or_else(String::new, |ratio| format!("{ratio:.2}"));
        let violations = rows.iter().filter(|row| row.outcome == "tilt_limit").count();
        let tilts: Vec<f64> = rows.iter().filter_map(|row| tilt_utilisation(row)).collect();
        let tilt = stats::mean(&tilts).map_or_else(String::new, |tilt| format!("{:.0}", 100.0 * tilt));
        writeln!(
            text,
            "| `{planner}` | {} | {} |{changes} {shortest} | {violations} | {tilt} | {} |",
            drives.shown(),
            rate(rows),
            failures(rows)
        )?;
    }
    Ok(())
}

fn by_group(text: &mut String, results: &Results, drives: &[Drives<'_>]) -> fmt::Result {
    let groups = results.groups();
    let headings: Vec<String> = groups.iter().map(|group| format!(" {group} |")).collect();
    writeln!(
        text,
        "\n### By ground\n\nTrials that reached, of how many.\n\n| planner | condition |{}\n|---|---|{}",
        headings.concat(),
        "---:|".repeat(groups.len())
    )?;
    for drives in drives {
        write!(text, "| `{}` | {} |", drives.planner, drives.shown())?;
        for group in &groups {
            let rows = drives.rows.iter().filter(|row| results.group(&row.route) == *group);
            let (reached, all) =
                rows.fold((0, 0), |(reached, all), row| (reached + usize::from(row.has_reached()), all + 1));
            write!(text, " {reached} of {all} |")?;
        }
        writeln!(text)?;
    }
    Ok(())
}

fn spoilt(text: &mut String, results: &Results, drives: &[Drives<'_>]) -> fmt::Result {
    if drives.iter().all(|drives| drives.lost().next().is_none()) {
        return writeln!(text, "\nNo condition spoils a trial that reaches in the scenarios' own reality.");
    }
    writeln!(
        text,
        "\n### Spoilt trials\n\nThose that are lost, up to {SHOWN} of each planner and condition. The command runs a trial again; the page \
         shows it at an address that ends like this, where it can.\n\n\
         | planner | condition | route | seed | outcome | command | page |\n|---|---|---|---:|---|---|---|"
    )?;
    for drives in drives {
        for row in drives.lost().take(SHOWN) {
            writeln!(
                text,
                "| `{}` | {} | {} | {} | {} | `{}` | {} |",
                drives.planner,
                drives.condition,
                row.route,
                row.seed,
                super::ending(row),
                results.replay(row),
                address(results, row)
            )?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::ManifestReality;
    use crate::testing::{results, row};

    fn trial(planner: &str, reality: &str, seed: u64, outcome: &str, path_m: f64) -> TrialRow {
        TrialRow {
            reality: reality.to_owned(),
            distance_m: Some(path_m),
            sim_time_s: Some(2.0 * path_m),
            oracle_length_m: Some(5.0),
            max_abs_roll_rad: Some(0.2),
            max_abs_pitch_rad: Some(0.1),
            configuration: r#"{"robot": {"roll_limit_rad": 0.4, "pitch_limit_rad": 0.5}}"#.to_owned(),
            ..row(planner, "gsb", "none", seed, outcome)
        }
    }

    /// Four seeds: with grip, three reach; on ice two of these, on a path half as long again, and none other.
    fn campaign() -> Results {
        let mut rows = Vec::new();
        for (seed, own, ice) in [
            (1, "reached", "reached"),
            (2, "reached", "tilt_limit"),
            (3, "stuck", "stuck"),
            (4, "reached", "reached"),
        ] {
            rows.push(trial("default", "", seed, own, 10.0));
            rows.push(trial("default", "ice", seed, ice, 15.0));
        }
        rows.push(trial("paper", "", 1, "reached", 30.0));
        let mut results = results(&["default", "paper"], &["gsb"], rows);
        "terrains/scenarios/gsb.toml".clone_into(&mut results.manifest.routes[0].file);
        let ice = ManifestReality { name: "ice".to_owned(), sets: "motion.friction=0.1".to_owned() };
        results.manifest.realities = vec![ice];
        results
    }

    #[test]
    fn a_condition_is_compared_trial_by_trial_with_the_scenarios_own() {
        let mut text = String::new();
        section(&mut text, &campaign()).unwrap();
        for line in [
            "| ice | `motion.friction=0.1` |",
            "| `default` | own | 3 of 4 (30–95 %) | | | | | | 2.00 | 0 | 50 | 1 stuck |",
            "| `default` | ice | 2 of 4 (15–85 %) | 1 | 0 | 1.00 | 1.50 | 1.50 | 3.00 | 1 | 50 | 1 stuck, 1 tilt_limit |",
            "| `default` | ice | 2 of 4 |",
            "| `paper` | own | 1 of 1 |",
        ] {
            assert_eq!(text.lines().filter(|found| found == &line).count(), 1, "{line}\n{text}");
        }
        assert!(
            text.contains("| `default` | ice | gsb | 2 | tilt_limit | `mapless trials test.toml --only"),
            "{text}"
        );
        assert!(!text.contains("| `paper` | ice |"), "nobody drove that: {text}");
    }

    #[test]
    fn other_sections_count_the_scenarios_own_reality_alone() {
        let results = campaign();
        assert_eq!(results.plain().count(), 5);
        assert_eq!(results.question(), Some("what reality costs"));
        assert_eq!(results.size(), "2 planners, 1 route, 1 seed, 1 condition beside the scenarios' own");
        let mut text = String::new();
        let mut unspoilt = campaign();
        unspoilt.rows.retain(|row| row.seed == 1);
        section(&mut text, &unspoilt).unwrap();
        assert!(text.contains("No condition spoils a trial") && !text.contains("### Spoilt"), "{text}");
        text.clear();
        section(&mut text, &crate::testing::results(&["default"], &["gsb"], Vec::new())).unwrap();
        assert_eq!(text, "", "a campaign without conditions has no such section");
    }
}
