//! Success rates by time limit.

use std::fmt::{self, Write as _};

use mapless_trials::{BASE_TIME_LIMIT_S, MOST_STRAIGHT_TIMES};

use super::{MANY_TRIALS, Results};
use crate::row::TrialRow;

/// Success is counted within these multiples of the straight-line time at full speed.
const TIMES: [f64; 6] = [1.5, 3.0, 6.0, 12.0, 24.0, MOST_STRAIGHT_TIMES];

/// The share of trials that reached in time, by planner, for each of several times.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    writeln!(
        text,
        "\n## How soon\n\nPer cent of the trials that reached within a minute plus so many times the straight-line time \
         at full speed; after {MOST_STRAIGHT_TIMES} times the progress checker ends a trial, as `timeout`.\n"
    )?;
    let headings: Vec<String> = TIMES.iter().map(|times| format!(" {times} × |")).collect();
    writeln!(text, "| planner | routes |{}", headings.concat())?;
    writeln!(text, "|---|---|{}", "---:|".repeat(TIMES.len()))?;
    for planner in &results.manifest.planners {
        for (routes, rows) in results.all_and_groups(planner) {
            line(text, planner, routes, &rows)?;
        }
    }
    Ok(())
}

fn line(text: &mut String, planner: &str, routes: &str, rows: &[&TrialRow]) -> fmt::Result {
    if rows.is_empty() {
        return Ok(());
    }
    let reached: Vec<f64> = rows.iter().filter(|row| row.has_reached()).map(|row| times(row)).collect();
    let decimals = usize::from(rows.len() >= MANY_TRIALS);
    let shares: Vec<String> = (TIMES.iter())
        .map(|most| {
            let within = reached.iter().filter(|times| *times <= most).count();
            format!(" {:.decimals$} |", 100.0 * within as f64 / rows.len() as f64)
        })
        .collect();
    writeln!(text, "| `{planner}` | {routes} |{}", shares.concat())
}

/// A trial's time beyond a minute, as a multiple of the straight-line time at full speed. Trials of several
/// legs may take longer than the largest multiple and count as it, as do trials whose speed is not known.
fn times(row: &TrialRow) -> f64 {
    let times = || Some((row.sim_time_s? - BASE_TIME_LIMIT_S) * full_speed_m_s(row)? / row.straight_m);
    times().map_or(MOST_STRAIGHT_TIMES, |times| times.min(MOST_STRAIGHT_TIMES))
}

/// The planner's full speed.
pub(super) fn full_speed_m_s(row: &TrialRow) -> Option<f64> {
    let configuration: serde_json::Value = serde_json::from_str(&row.configuration).ok()?;
    configuration.pointer("/controller/max_speed_m_s")?.as_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{results, row};

    #[test]
    fn success_grows_with_time_and_ends_with_all_that_reached() {
        // 8 m at 0.8 m/s are 10 s: a minute plus 1.5, 6, 12 or 48 times that are 75, 120, 180 and 540 s.
        let trial = |seed: u64, outcome: &str, took_s: f64| TrialRow {
            sim_time_s: Some(took_s),
            straight_m: 8.0,
            configuration: "{\"controller\":{\"max_speed_m_s\":0.8}}".to_owned(),
            ..row("default", "a", "none", seed, outcome)
        };
        let rows = vec![
            trial(1, "reached", 75.0),
            trial(2, "reached", 121.0),
            trial(3, "reached", 539.0),
            trial(4, "tilt_limit", 20.0),
        ];
        let mut text = String::new();
        section(&mut text, &results(&["default"], &["a"], rows)).unwrap();
        let expected = "| `default` | all | 25 | 25 | 25 | 50 | 50 | 75 |";
        assert_eq!(text.lines().last(), Some(expected), "{text}");
    }
}
