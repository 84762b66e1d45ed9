//! The worst trials, each with the command that runs it again.

use std::fmt::{self, Write as _};
use std::path::Path;

use mapless_baselines::TaskName;

use super::{Results, ending};
use crate::row::TrialRow;

/// Trials shown: every failure, but at least and at most so many.
const LEAST_SHOWN: usize = 10;
const MOST_SHOWN: usize = 100;

/// Failures first, then the largest tilt utilisation.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    let rows = results.rows.iter();
    let mut rows: Vec<(&TrialRow, Option<f64>)> = rows.map(|row| (row, tilt_utilisation(row))).collect();
    rows.sort_by(|(a, a_tilt), (b, b_tilt)| {
        (a.has_reached().cmp(&b.has_reached()))
            .then(b_tilt.unwrap_or_default().total_cmp(&a_tilt.unwrap_or_default()))
            .then_with(|| (&a.planner, &a.route, a.seed, &a.id).cmp(&(&b.planner, &b.route, b.seed, &b.id)))
    });
    let failed = rows.iter().filter(|(row, _)| !row.has_reached()).count();
    writeln!(text, "\n## The worst trials\n")?;
    writeln!(
        text,
        "Failures first, then by the largest tilt utilisation. The command runs a trial again and prints its digest; \
         the page shows it at an address that ends like this, if it has the route and drives that planner.\n"
    )?;
    if results.manifest.routes.iter().any(|route| route.name.parse::<TaskName>().is_ok()) {
        writeln!(
            text,
            "The routes are generated tasks; `mapless generate` writes them again, from the seed and difficulty in \
             their names. `cargo xtask results {}` writes those of a campaign of this repository to the place that \
             the campaign file names, before its trials begin; it may be interrupted then.\n",
            results.manifest.name
        )?;
    }
    writeln!(
        text,
        "| planner | route | seed | outcome | of the tilt limit | command | page |\n|---|---|---:|---|---:|---|---|"
    )?;
    for (row, tilt) in rows.into_iter().take(failed.clamp(LEAST_SHOWN, MOST_SHOWN)) {
        let TrialRow { planner, route, parameters, reality, truth, seed, .. } = row;
        let mut planner = format!("`{planner}`");
        if truth != "none" {
            write!(planner, ", override {truth}")?;
        }
        if !parameters.is_empty() {
            write!(planner, ", {parameters}")?;
        }
        if !reality.is_empty() {
            write!(planner, ", reality {reality}")?;
        }
        let command = results.replay(row);
        writeln!(
            text,
            "| {planner} | {route} | {seed} | {} | {} | `{command}` | {} |",
            ending(row),
            tilt.map_or_else(|| "–".to_owned(), |tilt| format!("{:.0} %", 100.0 * tilt)),
            address(results, row)
        )?;
    }
    Ok(())
}

/// The end of the page's address that shows a trial; empty if the page lacks its route, does not drive its
/// planner, or has no name for its reality.
pub(super) fn address(results: &Results, row: &TrialRow) -> String {
    let TrialRow { planner, route, parameters, reality, truth, seed, .. } = row;
    let is_task = route.parse::<TaskName>().is_ok();
    let file = if is_task { format!("{route}.toml") } else { format!("terrains/scenarios/{route}.toml") };
    let mut routes = results.manifest.routes.iter();
    let has_route = routes.any(|found| found.name == *route && Path::new(&found.file).ends_with(&file));
    let is_driven = matches!(planner.as_str(), "default" | "paper");
    if !(has_route && is_driven && parameters.is_empty() && truth == "none") {
        return String::new();
    }
    let sets = results.manifest.realities.iter().find(|known| known.name == *reality);
    let word = match sets.map(|known| known.preset()) {
        None => String::new(),
        Some(Some(word)) => format!("&reality={word}"),
        Some(None) => return String::new(),
    };
    format!("`?scenario={route}&seed={seed}&preset={planner}{word}`")
}

/// The largest tilt utilisation: |angle| / limit of roll or pitch. `None` if the trial did not run, or if its
/// configuration names no limits.
pub(super) fn tilt_utilisation(row: &TrialRow) -> Option<f64> {
    let configuration = serde_json::from_str::<serde_json::Value>(&row.configuration).ok()?;
    // Rows of campaigns before the robot's model have the limits in a table of their own.
    let limit = |key: &str, former: &str| {
        configuration["robot"][key].as_f64().or_else(|| configuration["limits"][former].as_f64())
    };
    let roll = row.max_abs_roll_rad? / limit("roll_limit_rad", "roll_rad")?;
    Some(roll.max(row.max_abs_pitch_rad? / limit("pitch_limit_rad", "pitch_rad")?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::ManifestReality;
    use crate::testing::{results, row};

    #[test]
    fn a_trial_that_the_page_can_show_has_its_address() {
        let rows = vec![
            row("default", "gsb", "none", 7, "stuck"),
            row("default", "gsb", "profile", 8, "stuck"),
            row("oracle", "gsb", "none", 9, "stuck"),
            row("paper", "easy-1-0001", "none", 10, "stuck"),
            row("paper", "ml", "none", 11, "stuck"),
        ];
        let mut results = results(&["default", "oracle", "paper"], &["gsb", "easy-1-0001", "ml"], rows);
        for (route, folder) in results.manifest.routes.iter_mut().zip(["terrains/scenarios", "target", "own"])
        {
            route.file = format!("{folder}/{}.toml", route.name);
        }
        let mut text = String::new();
        section(&mut text, &results).unwrap();
        assert!(text.contains("| `?scenario=gsb&seed=7&preset=default` |"), "{text}");
        assert!(text.contains("| `?scenario=easy-1-0001&seed=10&preset=paper` |"), "{text}");
        assert_eq!(text.matches("?scenario=").count(), 2, "{text}");
    }

    #[test]
    fn an_address_has_the_preset_of_reality_and_none_stands_for_single_effects() {
        let of = |reality: &str| TrialRow {
            reality: reality.to_owned(),
            ..row("default", "easy-1-0001", "none", 7, "stuck")
        };
        let mut results = results(&["default"], &["easy-1-0001"], Vec::new());
        results.manifest.realities = [("rain", "preset=\"harsh\""), ("ice", "motion.friction=0.1")]
            .map(|(name, sets)| ManifestReality { name: name.to_owned(), sets: sets.to_owned() })
            .to_vec();
        let address = |reality: &str| address(&results, &of(reality));
        assert_eq!(address(""), "`?scenario=easy-1-0001&seed=7&preset=default`");
        assert_eq!(address("rain"), "`?scenario=easy-1-0001&seed=7&preset=default&reality=harsh`");
        assert_eq!(address("ice"), "");
        results.manifest.realities[0].sets.push_str(" motion.friction=\"x\"");
        assert_eq!(super::address(&results, &of("rain")), "");
    }

    #[test]
    fn the_limits_of_new_and_of_former_configurations_are_read() {
        let tilted = |configuration: &str| TrialRow {
            max_abs_roll_rad: Some(0.2),
            max_abs_pitch_rad: Some(0.3),
            configuration: configuration.to_owned(),
            ..row("default", "a", "none", 1, "reached")
        };
        for limits in [
            r#"{"robot": {"roll_limit_rad": 0.4, "pitch_limit_rad": 0.5}}"#,
            r#"{"limits": {"roll_rad": 0.4, "pitch_rad": 0.5}}"#,
        ] {
            assert_eq!(tilt_utilisation(&tilted(limits)), Some(0.6), "{limits}");
        }
        assert_eq!(tilt_utilisation(&tilted(r#"{"robot": {"roll_limit_rad": 0.4}}"#)), None);
        let own = serde_json::to_string(&mapless::PlannerConfig::default()).unwrap();
        let limits = mapless::PlannerConfig::default().robot;
        let expected = (0.2 / limits.roll_limit_rad).max(0.3 / limits.pitch_limit_rad);
        assert_eq!(tilt_utilisation(&tilted(&own)), Some(expected));
    }

    #[test]
    fn every_failure_is_shown_and_what_came_near() {
        let shown = |failures: usize, reached: usize| {
            let outcomes =
                std::iter::repeat_n("stuck", failures).chain(std::iter::repeat_n("reached", reached));
            let rows = (0..).zip(outcomes).map(|(seed, outcome)| row("default", "a", "none", seed, outcome));
            let mut text = String::new();
            section(&mut text, &results(&["default"], &["a"], rows.collect())).unwrap();
            (text.matches("| stuck |").count(), text.matches("| reached |").count())
        };
        assert_eq!(shown(3, 20), (3, LEAST_SHOWN - 3));
        assert_eq!(shown(30, 20), (30, 0));
        assert_eq!(shown(MOST_SHOWN + 1, 0), (MOST_SHOWN, 0));
    }
}
