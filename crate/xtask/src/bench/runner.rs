//! A program that answers requests, a line each.

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context as _, bail, ensure};

/// A side of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Side {
    /// mapless on this machine.
    Native,
    /// gpflow or Embree.
    Peer,
    /// mapless as wasm in Node.
    Node,
    /// mapless as wasm in Chromium.
    Chromium,
    /// Jolt as wasm in Node.
    Jolt,
}

/// The values of a benchmark, by name; `None` for a value that does not exist.
#[derive(Clone, Debug, Default, PartialEq, serde::Deserialize)]
pub(crate) struct Values(BTreeMap<String, Vec<Option<f64>>>);

/// An answer.
#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum Answer {
    Ms(Vec<f64>),
    Values(Values),
    Versions(BTreeMap<String, String>),
    Error(String),
}

/// The running program.
pub(crate) struct Runner {
    pub(crate) side: Side,
    child: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
}

/// Linux counts processor time in hundredths of a second.
const TICKS_PER_S: f64 = 100.0;

/// Processor time in the text of `/proc/PID/stat`, in ticks: user and system, the 14th and 15th field. The
/// second is a name in parentheses, in which there may be spaces.
fn processor_ticks(stat: &str) -> Option<u64> {
    let (_, after) = stat.rsplit_once(") ")?;
    let mut fields = after.split(' ').skip(11);
    Some(fields.next()?.parse::<u64>().ok()? + fields.next()?.parse::<u64>().ok()?)
}

impl Values {
    /// The numbers called `name`.
    pub(crate) fn get(&self, name: &str) -> anyhow::Result<&[Option<f64>]> {
        Ok(self.0.get(name).with_context(|| format!("no values called {name}"))?)
    }

    /// The one number called `name`.
    pub(crate) fn number(&self, name: &str) -> anyhow::Result<f64> {
        match self.get(name)? {
            [Some(number)] => Ok(*number),
            other => bail!("{name} = {other:?}: expected one number"),
        }
    }
}

impl Runner {
    /// Starts the program.
    pub(crate) fn start(side: Side, mut command: Command) -> anyhow::Result<Self> {
        let shown = format!("{command:?}");
        let spawned = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child = spawned.with_context(|| shown.clone())?;
        let requests = child.stdin.take().with_context(|| shown.clone())?;
        let answers = BufReader::new(child.stdout.take().with_context(|| shown.clone())?);
        Ok(Self { side, child, requests, answers })
    }

    /// Runs the benchmark `repetitions` times; returns the time of each in milliseconds.
    pub(crate) fn times(&mut self, work: &str, repetitions: usize) -> anyhow::Result<Vec<f64>> {
        match self.ask(&format!("{work} {repetitions}"))? {
            Answer::Ms(times) if times.len() == repetitions => Ok(times),
            other => bail!("{:?} answered {other:?} to {work} {repetitions}", self.side),
        }
    }

    /// Seconds of processor time of one run, as far as Linux reports it: other load on the machine does not
    /// count. Elsewhere seconds on the clock.
    pub(crate) fn processor_s(&mut self, work: &str) -> anyhow::Result<f64> {
        let ticks = |child: &Child| {
            let stat = std::fs::read_to_string(format!("/proc/{}/stat", child.id())).ok()?;
            processor_ticks(&stat)
        };
        let before = ticks(&self.child);
        let clock_s = self.times(work, 1)?.iter().sum::<f64>() * 1e-3;
        let spent = ticks(&self.child).zip(before).map(|(after, before)| after - before);
        Ok(spent.map_or(clock_s, |ticks| ticks as f64 / TICKS_PER_S))
    }

    /// The values of the last run of the benchmark.
    pub(crate) fn values(&mut self, work: &str) -> anyhow::Result<Values> {
        match self.ask(&format!("{work} values"))? {
            Answer::Values(values) => Ok(values),
            other => bail!("{:?} answered {other:?} to {work} values", self.side),
        }
    }

    /// The versions of the peers on this side.
    pub(crate) fn versions(&mut self) -> anyhow::Result<BTreeMap<String, String>> {
        match self.ask("versions all")? {
            Answer::Versions(versions) => Ok(versions),
            other => bail!("{:?} answered {other:?} to versions", self.side),
        }
    }

    fn ask(&mut self, request: &str) -> anyhow::Result<Answer> {
        let side = self.side;
        let context = || format!("{side:?}, asked for {request}");
        writeln!(self.requests, "{request}").with_context(context)?;
        let mut line = String::new();
        self.answers.read_line(&mut line).with_context(context)?;
        ensure!(!line.is_empty(), "{side:?} ended when asked for {request}");
        match serde_json::from_str(&line).with_context(context)? {
            Answer::Error(error) => bail!("{}: {error}", context()),
            answer => Ok(answer),
        }
    }

    /// Closes the program's input and waits for its end.
    pub(crate) fn end(self) -> anyhow::Result<()> {
        let Self { side, mut child, requests, answers } = self;
        drop((requests, answers));
        let status = child.wait()?;
        ensure!(status.success(), "{side:?} ended with {status}");
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processor_time_is_read() {
        let stat = "42 (a (name) b) S 1 42 42 0 -1 4194304 300 0 0 0 123 45 0 0 20 0 1 0 99 1 2\n";
        assert_eq!(processor_ticks(stat), Some(168));
        assert_eq!(processor_ticks("42 (a) S 1"), None);
    }

    #[test]
    fn answers_are_read() {
        let answer = |text| serde_json::from_str::<Answer>(text).unwrap();
        assert!(matches!(answer("{\"ms\": [1.5, 2]}"), Answer::Ms(times) if times == [1.5, 2.0]));
        assert!(matches!(answer("{\"error\": \"no\"}"), Answer::Error(error) if error == "no"));
        let Answer::Values(values) = answer("{\"values\": {\"range_m\": [3.5, null], \"bound\": [-2]}}")
        else {
            panic!("no values");
        };
        assert_eq!(values.get("range_m").unwrap(), [Some(3.5), None]);
        assert!((values.number("bound").unwrap() + 2.0).abs() < 1e-15);
        assert!(values.number("range_m").is_err() && values.get("mean").is_err());
    }
}
