//! Requests and answers, one line each.

use std::collections::BTreeMap;

use crate::BenchError;
use crate::clock::now_ms;
use crate::registry::make;
use crate::work::{Values, Work};

/// The pieces of work in use, each made when first asked for.
#[derive(Default)]
pub struct Bench {
    works: BTreeMap<String, Box<dyn Work>>,
}

/// An answer as JSON.
#[derive(serde::Serialize)]
#[serde(rename_all = "snake_case")]
enum Answer {
    /// The time of each repetition, in milliseconds.
    Ms(Vec<f64>),
    /// What the last repetition gave; `null` stands for what does not exist.
    Values(Values),
    /// Why there is no answer.
    Error(String),
}

impl Bench {
    /// Answers a request with one line of JSON.
    ///
    /// `NAME N` runs the piece of work N times: `{"ms": [...]}`, one time for each. `NAME values` gives what
    /// the last run gave, running it once if it has not run: `{"values": {"what": [...]}}`. A fault is told
    /// as `{"error": "..."}`.
    pub fn answer(&mut self, request: &str) -> String {
        let answer = self.run(request).unwrap_or_else(|error| Answer::Error(error.to_string()));
        // Maps with names for keys and numbers always have a JSON form.
        serde_json::to_string(&answer).unwrap_or_default()
    }

    fn run(&mut self, request: &str) -> Result<Answer, BenchError> {
        let wrong = || BenchError::Request(request.trim().to_owned());
        let (name, what) = request.trim().split_once(' ').ok_or_else(wrong)?;
        let repetitions = match what {
            "values" => None,
            number => Some(number.parse::<usize>().map_err(|_| wrong())?),
        };
        let is_new = !self.works.contains_key(name);
        if is_new {
            self.works.insert(name.to_owned(), make(name)?);
        }
        let work = self.works.get_mut(name).ok_or_else(wrong)?;
        let Some(repetitions) = repetitions else {
            if is_new {
                work.prepare()?;
                work.run()?;
            }
            return Ok(Answer::Values(work.values()));
        };
        let mut ms = Vec::with_capacity(repetitions);
        for _ in 0..repetitions {
            work.prepare()?;
            let start = now_ms();
            work.run()?;
            ms.push(now_ms() - start);
        }
        Ok(Answer::Ms(ms))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_come_as_often_as_asked_for() {
        let mut bench = Bench::default();
        let answer: serde_json::Value = serde_json::from_str(&bench.answer("tick-level 3\n")).unwrap();
        let times = answer["ms"].as_array().unwrap();
        assert_eq!(times.len(), 3);
        assert!(times.iter().all(|ms| ms.as_f64().unwrap() > 0.0));
    }

    #[test]
    fn faults_are_told() {
        let mut bench = Bench::default();
        for (request, told) in [
            ("tick-level", "request \\\"tick-level\\\": expected"),
            ("tick-level often", "request \\\"tick-level often\\\": expected"),
            ("tock 1", "work \\\"tock\\\": expected"),
            ("posterior-0 1", "work \\\"posterior-0\\\": expected"),
            ("trial-moon 1", "scenario: \\\"moon\\\""),
        ] {
            let answer = bench.answer(request);
            assert!(answer.starts_with("{\"error\":") && answer.contains(told), "{answer}");
        }
    }
}
