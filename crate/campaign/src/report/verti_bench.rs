//! A campaign by the rules and figures of Verti-Bench.

use std::fmt::{self, Write as _};

use super::duration::full_speed_m_s;
use super::{Results, failures, stats};
use crate::row::TrialRow;

/// Most time for a task, and for standing still, in multiples of the straight line at the commanded speed:
/// 60 s and 10 s where 120 m at 4 m/s take 30 s.
const MOST_TIMES: f64 = 2.0;
const MOST_STANDSTILL_TIMES: f64 = 1.0 / 3.0;

/// Success, time and tilts by planner and difficulty.
pub(super) fn section(text: &mut String, results: &Results) -> fmt::Result {
    writeln!(
        text,
        "\n## By Verti-Bench's rules\n\n\
         Reached within 8 m of the goal times the scale, as the scenarios say, before {MOST_TIMES} times the straight \
         line at the commanded speed have passed (60 s for 120 m at 4 m/s), and without standing for a third of \
         that line's time (10 s). A robot that turns on the spot stands. Time is the mean over the successes; tilts \
         are means over every trial, as the benchmark's programs return them. Stricter than there: a touch of an \
         object ends a trial, and so does a tilt beyond its limit.\n"
    )?;
    writeln!(
        text,
        "| planner | tasks | success, % | of | time, s | mean \\|roll\\|, ° | mean \\|pitch\\|, ° | too late | stood | other failures |\n\
         |---|---|---:|---:|---:|---:|---:|---:|---:|---|"
    )?;
    for planner in &results.manifest.planners {
        for (tasks, rows) in results.all_and_groups(planner) {
            if !rows.is_empty() {
                line(text, planner, tasks, &rows)?;
            }
        }
    }
    Ok(())
}

fn line(text: &mut String, planner: &str, tasks: &str, rows: &[&TrialRow]) -> fmt::Result {
    let count = |verdict: Verdict| rows.iter().filter(|row| judge(row) == verdict).count();
    let successes = rows.iter().filter(|row| judge(row) == Verdict::Success);
    let times_s: Vec<f64> = successes.filter_map(|row| row.sim_time_s).collect();
    let mean = |values: &[f64], decimals: usize| {
        stats::mean(values).map_or_else(String::new, |mean| format!("{mean:.decimals$}"))
    };
    let tilt = |of: fn(&TrialRow) -> Option<f64>| {
        let degrees: Vec<f64> = rows.iter().filter_map(|row| of(row)).map(f64::to_degrees).collect();
        mean(&degrees, 2)
    };
    writeln!(
        text,
        "| `{planner}` | {tasks} | {:.1} | {} | {} | {} | {} | {} | {} | {} |",
        100.0 * times_s.len() as f64 / rows.len() as f64,
        rows.len(),
        mean(&times_s, 1),
        tilt(|row| row.mean_abs_roll_rad),
        tilt(|row| row.mean_abs_pitch_rad),
        count(Verdict::TooLate),
        count(Verdict::Stood),
        failures(rows)
    )
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Success,
    /// Reached, but after the time limit.
    TooLate,
    /// Reached in time, but stood for too long on the way.
    Stood,
    /// Not reached.
    Failure,
}

/// A trial by the benchmark's rules. Where the commanded speed is not known, none of its times counts.
fn judge(row: &TrialRow) -> Verdict {
    if !row.has_reached() {
        return Verdict::Failure;
    }
    let Some(straight_s) = full_speed_m_s(row).map(|speed_m_s| row.straight_m / speed_m_s) else {
        return Verdict::Success;
    };
    let is_over = |time_s: Option<f64>, times: f64| time_s.is_some_and(|time_s| time_s > times * straight_s);
    if is_over(row.sim_time_s, MOST_TIMES) {
        Verdict::TooLate
    } else if is_over(row.longest_standstill_s, MOST_STANDSTILL_TIMES) {
        Verdict::Stood
    } else {
        Verdict::Success
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{results, row};

    fn trial(route: &str, outcome: &str, took_s: f64, stood_s: f64) -> TrialRow {
        TrialRow {
            sim_time_s: Some(took_s),
            longest_standstill_s: Some(stood_s),
            mean_abs_roll_rad: Some(2_f64.to_radians()),
            mean_abs_pitch_rad: Some(took_s.to_radians() / 10.0),
            straight_m: 24.0,
            configuration: "{\"controller\":{\"max_speed_m_s\":0.8}}".to_owned(),
            ..row("default", route, "none", 1, outcome)
        }
    }

    #[test]
    fn times_follow_the_straight_line_at_the_commanded_speed() {
        // 24 m at 0.8 m/s are 30 s, as 120 m at 4 m/s.
        let judged = |took_s, stood_s| judge(&trial("low-001-01", "reached", took_s, stood_s));
        assert_eq!(judged(60.0, 10.0), Verdict::Success);
        assert_eq!(judged(60.1, 0.0), Verdict::TooLate);
        assert_eq!(judged(60.0, 10.1), Verdict::Stood);
        assert_eq!(judge(&trial("low-001-01", "collision", 5.0, 0.0)), Verdict::Failure);
        let slower = TrialRow { straight_m: 12.0, ..trial("low-001-01", "reached", 31.0, 0.0) };
        assert_eq!(judge(&slower), Verdict::TooLate);
    }

    #[test]
    fn each_difficulty_has_its_line_the_easiest_first() {
        let names: Vec<String> =
            (1..=15).map(|world| format!("{}-{world:03}-01", ["high", "low", "mid"][world % 3])).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let mut rows: Vec<TrialRow> = names.iter().map(|name| trial(name, "reached", 40.0, 1.0)).collect();
        rows[0] = trial("low-001-01", "reached", 70.0, 1.0);
        rows[1] = trial("mid-002-01", "collision", 20.0, 1.0);
        let mut text = String::new();
        section(&mut text, &results(&["default"], &names, rows)).unwrap();
        let lines: Vec<&str> = text.lines().rev().take(4).collect();
        assert_eq!(
            lines,
            [
                "| `default` | high | 100.0 | 5 | 40.0 | 2.00 | 4.00 | 0 | 0 |  |",
                "| `default` | mid | 80.0 | 5 | 40.0 | 2.00 | 3.60 | 0 | 0 | 1 collision |",
                "| `default` | low | 80.0 | 5 | 40.0 | 2.00 | 4.60 | 1 | 0 |  |",
                "| `default` | all | 86.7 | 15 | 40.0 | 2.00 | 4.07 | 1 | 0 | 1 collision |",
            ],
            "{text}"
        );
    }
}
