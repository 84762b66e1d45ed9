//! Estimate of a campaign's time left. One planner's trials may take a hundred times as long as another's.

use std::collections::BTreeMap;
use std::time::Duration;

/// The trials of one planner.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    run: usize,
    wall_s: f64,
    left: usize,
}

/// Trials that have run and trials that are left, by planner.
#[derive(Debug, Default)]
pub(crate) struct Pace<'a>(BTreeMap<&'a str, Tally>);

impl<'a> Pace<'a> {
    /// Adds a trial of `planner` that is still to run.
    pub(crate) fn expect(&mut self, planner: &'a str) {
        self.0.entry(planner).or_default().left += 1;
    }

    /// Adds a trial of `planner` that took `wall_s` before this run.
    pub(crate) fn know(&mut self, planner: &'a str, wall_s: f64) {
        let tally = self.0.entry(planner).or_default();
        tally.run += 1;
        tally.wall_s += wall_s;
    }

    /// Moves a trial of `planner` from those to run to those that have run, in `wall_s`.
    pub(crate) fn finish(&mut self, planner: &'a str, wall_s: f64) {
        self.know(planner, wall_s);
        let tally = self.0.entry(planner).or_default();
        tally.left = tally.left.saturating_sub(1);
    }

    /// Time left with `jobs` trials at a time: the mean of each planner's trials so far, or the mean of all
    /// for a planner that has not run yet.
    pub(crate) fn left(&self, jobs: usize) -> Duration {
        let mean_s = |run: usize, wall_s: f64| wall_s / run.max(1) as f64;
        let all =
            self.0.values().fold((0, 0.0), |(run, wall_s), tally| (run + tally.run, wall_s + tally.wall_s));
        let overall_s = mean_s(all.0, all.1);
        let left_s = self.0.values().map(|&Tally { run, wall_s, left }| {
            left as f64 * if run == 0 { overall_s } else { mean_s(run, wall_s) }
        });
        Duration::from_secs_f64(left_s.sum::<f64>() / jobs.max(1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_planner_has_a_pace_of_its_own() {
        let mut pace = Pace::default();
        for _ in 0..10 {
            pace.expect("fast");
            pace.expect("slow");
        }
        assert_eq!(pace.left(2), Duration::ZERO, "nothing is known yet");
        pace.finish("fast", 2.0);
        pace.finish("fast", 4.0);
        // Eight of three seconds, and ten at the mean of all, three seconds.
        assert_eq!(pace.left(1), Duration::from_secs(24 + 30));
        pace.finish("slow", 60.0);
        assert_eq!(pace.left(2), Duration::from_secs((24 + 9 * 60) / 2));
    }

    #[test]
    fn what_ran_before_an_interruption_tells_the_pace_and_is_not_left() {
        let mut pace = Pace::default();
        pace.know("slow", 60.0);
        pace.expect("slow");
        pace.expect("slow");
        assert_eq!(pace.left(1), Duration::from_secs(120));
    }
}
