//! The closed loop on the repository's scenarios.

use mapless_tests::scenarios_text::{Bundled, SCENARIOS};
use mapless_trials::{Outcome, Trial};

use crate::BenchError;
use crate::work::{Values, Work};

/// One scenario on each terrain.
const DRIVES: [&str; 5] = ["cht-ab", "gsb", "ht", "ml", "vta"];
/// Ticks before the next terrain's turn.
const TURN_TICKS: usize = 20;

fn scenario(name: &str) -> Result<&'static Bundled, BenchError> {
    let found = SCENARIOS.iter().find(|scenario| scenario.name == name);
    found.ok_or_else(|| BenchError::Scenario(format!("{name:?}: expected one of terrains/scenarios")))
}

fn start(scenario: &Bundled) -> Result<Trial, BenchError> {
    scenario.trial().map_err(BenchError::Scenario)
}

/// The planner's steps along drives over every terrain; the world between them is not timed.
pub(crate) struct Drive {
    drives: Vec<(&'static Bundled, Trial)>,
    ticks: usize,
    returns: usize,
    most_cells: usize,
}

impl Drive {
    pub(crate) fn new() -> Result<Self, BenchError> {
        let drive = |name| {
            let scenario = scenario(name)?;
            Ok((scenario, start(scenario)?))
        };
        let drives = DRIVES.into_iter().map(drive).collect::<Result<_, BenchError>>()?;
        Ok(Self { drives, ticks: 0, returns: 0, most_cells: 0 })
    }

    fn current(&self) -> usize {
        self.ticks / TURN_TICKS % DRIVES.len()
    }
}

impl Work for Drive {
    fn prepare(&mut self) -> Result<(), BenchError> {
        let current = self.current();
        let (scenario, trial) = &mut self.drives[current];
        // Moves on from the decision of this drive's last step, if there was one.
        if trial.ticks() > 0 || !trial.scan().points.is_empty() {
            trial.act();
        }
        if trial.outcome().is_some() {
            *trial = start(scenario)?;
        }
        trial.look();
        self.returns += trial.scan().points.len();
        self.ticks += 1;
        Ok(())
    }

    fn run(&mut self) -> Result<(), BenchError> {
        let current = (self.ticks - 1) / TURN_TICKS % DRIVES.len();
        let cells = self.drives[current].1.plan().observed.cells().len();
        self.most_cells = self.most_cells.max(cells);
        Ok(())
    }

    fn values(&mut self) -> Values {
        let position = |(_, trial): &(_, Trial)| trial.pose().position_m.to_array();
        Values::from([
            ("ticks", vec![self.ticks as f64]),
            ("mean_returns", vec![self.returns as f64 / self.ticks as f64]),
            ("most_cells", vec![self.most_cells as f64]),
            ("positions_m", self.drives.iter().flat_map(position).collect()),
        ])
    }
}

/// A whole trial with the preset `default` and the scenario's own seed: scans, planner and motion, without loading its terrain.
pub(crate) struct WholeTrial {
    scenario: &'static Bundled,
    trial: Trial,
}

impl WholeTrial {
    pub(crate) fn new(name: &str) -> Result<Self, BenchError> {
        let scenario = scenario(name)?;
        Ok(Self { scenario, trial: start(scenario)? })
    }
}

impl Work for WholeTrial {
    fn prepare(&mut self) -> Result<(), BenchError> {
        self.trial = start(self.scenario)?;
        Ok(())
    }

    fn run(&mut self) -> Result<(), BenchError> {
        while self.trial.tick().is_none() {}
        Ok(())
    }

    fn values(&mut self) -> Values {
        Values::from([
            ("simulated_s", vec![self.trial.time_s()]),
            ("reached", vec![f64::from(u8::from(self.trial.outcome() == Some(Outcome::Reached)))]),
        ])
    }
}
