//! The measurements.

use std::collections::BTreeMap;

use anyhow::{Context as _, ensure};

use super::agreement::Agreement;
use super::memory::Memory;
use super::runner::{Runner, Side, Values};

/// Everything in the report.
#[derive(Default)]
pub(crate) struct Measured {
    pub(crate) machine: String,
    pub(crate) rounds: u32,
    /// Milliseconds of every repetition, by benchmark and side.
    pub(crate) times: BTreeMap<(String, Side), Vec<f64>>,
    /// The values of the benchmarks natively.
    pub(crate) values: BTreeMap<String, Values>,
    pub(crate) agreements: Vec<Agreement>,
    pub(crate) trials: Vec<Trial>,
    pub(crate) memory: Memory,
}

/// A whole trial, in an ideal world and in that of the preset `field`.
pub(crate) struct Trial {
    pub(crate) scenario: &'static str,
    pub(crate) ideal: Drive,
    pub(crate) field: Drive,
}

/// A trial's time.
#[derive(Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) simulated_s: f64,
    /// Processor time.
    pub(crate) computed_s: f64,
}

impl Trial {
    /// Drives it in both worlds.
    pub(crate) fn measure(native: &mut Runner, scenario: &'static str) -> anyhow::Result<Self> {
        let mut drive = |work: &str| -> anyhow::Result<Drive> {
            let computed_s = native.processor_s(work)?;
            Ok(Drive { computed_s, simulated_s: native.values(work)?.number("simulated_s")? })
        };
        let ideal = drive(&format!("trial-{scenario}"))?;
        let field = drive(&format!("field-trial-{scenario}"))?;
        Ok(Self { scenario, ideal, field })
    }
}

impl Drive {
    /// How many times as fast as real time.
    pub(crate) fn speed(self) -> f64 {
        self.simulated_s / self.computed_s
    }
}

/// A sample of times, milliseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Times {
    pub(crate) fastest: f64,
    pub(crate) median: f64,
    pub(crate) p99: f64,
}

impl Times {
    fn of(times: &[f64]) -> anyhow::Result<Self> {
        ensure!(times.iter().all(|ms| ms.is_finite()), "times {times:?}: expected numbers");
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        // The smallest time that this share of the repetitions did not exceed.
        let quantile = |share: f64| {
            let rank = (share * sorted.len() as f64).ceil() as usize;
            sorted.get(rank.saturating_sub(1)).copied().context("nothing was timed")
        };
        Ok(Self { fastest: quantile(0.0)?, median: quantile(0.5)?, p99: quantile(0.99)? })
    }
}

impl Measured {
    /// The times of one side at one benchmark.
    pub(crate) fn times(&self, work: &str, side: Side) -> anyhow::Result<Times> {
        let times = self.times.get(&(work.to_owned(), side));
        Times::of(times.with_context(|| format!("{side:?} was not asked for {work}"))?)
    }

    /// As [`times`](Self::times), each repetition of a round the fastest over all rounds: rounds do the same
    /// work, so the fastest time is free of other load on the machine.
    pub(crate) fn quiet_times(&self, work: &str, side: Side) -> anyhow::Result<Times> {
        let times = self.times.get(&(work.to_owned(), side));
        let times = times.with_context(|| format!("{side:?} was not asked for {work}"))?;
        let mut rounds = times.chunks_exact((times.len() / self.rounds as usize).max(1));
        let mut fastest = rounds.next().unwrap_or_default().to_vec();
        for round in rounds {
            for (fastest, ms) in fastest.iter_mut().zip(round) {
                *fastest = fastest.min(*ms);
            }
        }
        Times::of(&fastest)
    }

    /// A value of a benchmark.
    pub(crate) fn number(&self, work: &str, name: &str) -> anyhow::Result<f64> {
        self.values.get(work).with_context(|| format!("no values of {work}"))?.number(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_times_that_occurred() {
        let times: Vec<f64> = (1..=200).rev().map(f64::from).collect();
        assert_eq!(Times::of(&times).unwrap(), Times { fastest: 1.0, median: 100.0, p99: 198.0 });
        assert_eq!(Times::of(&[7.0]).unwrap(), Times { fastest: 7.0, median: 7.0, p99: 7.0 });
        assert!(Times::of(&[]).is_err() && Times::of(&[f64::NAN]).is_err());
    }

    #[test]
    fn quiet_times_are_those_of_the_quietest_rounds() {
        let mut measured = Measured { rounds: 2, ..Measured::default() };
        let times = vec![1.0, 9.0, 3.0, 8.0, 2.0, 3.5];
        measured.times.insert(("drive".to_owned(), Side::Native), times);
        let quiet = measured.quiet_times("drive", Side::Native).unwrap();
        assert_eq!(quiet, Times { fastest: 1.0, median: 2.0, p99: 3.0 });
    }
}
