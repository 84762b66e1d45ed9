//! The worst trials, each with the command that runs it again.

use std::fmt::{self, Write as _};
use std::path::Path;

use mapless_baselines::TaskName;

use super::Results;
use crate::row::TrialRow;

/// At least so many are shown and, if that is more, every failure up to so many.
const LEAST_SHOWN: usize = 10;
const MOST_SHOWN: usize = 100;

/// Failures first, then what came nearest to a tilt limit.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    let mut rows: Vec<(&TrialRow, f64)> = results.rows.iter().map(|row| (row, limit_share(row))).collect();
    rows.sort_by(|(a, a_share), (b, b_share)| {
        (a.has_reached().cmp(&b.has_reached()))
            .then(b_share.total_cmp(a_share))
            .then_with(|| (&a.planner, &a.route, a.seed, &a.id).cmp(&(&b.planner, &b.route, b.seed, &b.id)))
    });
    let failed = rows.iter().filter(|(row, _)| !row.has_reached()).count();
    writeln!(text, "\n## The worst trials\n")?;
    writeln!(
        text,
        "Failures first, then by the largest share of a tilt limit. The command runs a trial again and prints its digest; the page \
         shows it at the address that ends like this, where it has the route and drives that planner.\n"
    )?;
    if results.manifest.routes.iter().any(|route| route.name.parse::<TaskName>().is_ok()) {
        writeln!(
            text,
            "The routes are generated tasks, which `mapless generate` writes again, with the seed and the difficulty that their names begin with. Of a campaign of \
             this repository, `cargo xtask results {}` writes them to where the campaign file says before its trials begin, and may be interrupted then.\n",
            results.manifest.name
        )?;
    }
    writeln!(
        text,
        "| planner | route | seed | outcome | of the tilt limit | command | page |\n|---|---|---:|---|---:|---|---|"
    )?;
    for (row, share) in rows.into_iter().take(failed.clamp(LEAST_SHOWN, MOST_SHOWN)) {
        let TrialRow { planner, route, parameters, truth, seed, outcome, .. } = row;
        let mut planner = format!("`{planner}`");
        if truth != "none" {
            write!(planner, ", told {truth}")?;
        }
        if !parameters.is_empty() {
            write!(planner, ", {parameters}")?;
        }
        let command = results.replay(row);
        let reason = row.stop_reason.as_ref().or(row.error.as_ref());
        let reason = reason.map_or_else(String::new, |reason| {
            format!(": {}", reason.replace('|', "\\|").replace('\n', " "))
        });
        writeln!(
            text,
            "| {planner} | {route} | {seed} | {outcome}{reason} | {:.0} % | `{command}` | {} |",
            100.0 * share,
            address(results, row)
        )?;
    }
    Ok(())
}

/// How the page's address ends that shows a trial; nothing where the page has not its route, or does not drive its planner.
fn address(results: &Results, row: &TrialRow) -> String {
    let TrialRow { planner, route, parameters, truth, seed, .. } = row;
    let is_task = route.parse::<TaskName>().is_ok();
    let file = if is_task { format!("{route}.toml") } else { format!("terrains/scenarios/{route}.toml") };
    let mut routes = results.manifest.routes.iter();
    let has_route = routes.any(|found| found.name == *route && Path::new(&found.file).ends_with(&file));
    let is_driven = matches!(planner.as_str(), "default" | "paper");
    if !(has_route && is_driven && parameters.is_empty() && truth == "none") {
        return String::new();
    }
    format!("`?scenario={route}&seed={seed}&preset={planner}`")
}

/// The largest share of a tilt limit that the robot came to; nothing where the trial did not run.
fn limit_share(row: &TrialRow) -> f64 {
    let limits = serde_json::from_str::<serde_json::Value>(&row.configuration);
    let limit = |name: &str| limits.as_ref().ok().and_then(|limits| limits["limits"][name].as_f64());
    let share = |angle_rad: Option<f64>, name: &str| Some(angle_rad? / limit(name)?);
    let roll = share(row.max_abs_roll_rad, "roll_rad").unwrap_or_default();
    roll.max(share(row.max_abs_pitch_rad, "pitch_rad").unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
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
