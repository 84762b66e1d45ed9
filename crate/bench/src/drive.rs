//! The closed loop on the repository's scenarios.

use mapless_tests::scenarios_text::{Bundled, SCENARIOS};
use mapless_trials::{Outcome, RealityPreset, Trial};

use crate::BenchError;
use crate::work::{Values, Work};

/// One scenario on each terrain.
const DRIVES: [&str; 5] = ["cht-ab", "gsb", "ht", "ml", "vta"];
/// Steps on each terrain; after all of them the drives start again.
const STEPS: usize = 60;

fn scenario(name: &str) -> Result<&'static Bundled, BenchError> {
    let found = SCENARIOS.iter().find(|scenario| scenario.name == name);
    found.ok_or_else(|| BenchError::Scenario(format!("{name:?}: expected one of terrains/scenarios")))
}

fn start(scenario: &Bundled, reality: RealityPreset) -> Result<Trial, BenchError> {
    scenario.trial_in(reality).map_err(BenchError::Scenario)
}

/// The planner's steps along the first seconds of drives over every terrain; the simulated world is not
/// timed.
pub(crate) struct Drive {
    starts: Vec<Trial>,
    trials: Vec<Trial>,
    ticks: usize,
    returns: usize,
    most_cells: usize,
}

impl Drive {
    pub(crate) fn new() -> Result<Self, BenchError> {
        let starts = DRIVES.into_iter().map(|name| start(scenario(name)?, RealityPreset::Ideal));
        let starts = starts.collect::<Result<Vec<_>, BenchError>>()?;
        Ok(Self { trials: starts.clone(), starts, ticks: 0, returns: 0, most_cells: 0 })
    }
}

impl Work for Drive {
    fn prepare(&mut self) -> Result<(), BenchError> {
        if self.ticks == STEPS * DRIVES.len() {
            self.trials.clone_from(&self.starts);
            (self.ticks, self.returns, self.most_cells) = (0, 0, 0);
        }
        let trial = &mut self.trials[self.ticks / STEPS];
        if !self.ticks.is_multiple_of(STEPS) {
            trial.act();
        }
        trial.look_far();
        self.returns += trial.scan().points.len();
        Ok(())
    }

    fn run(&mut self) -> Result<(), BenchError> {
        let trial = &mut self.trials[self.ticks / STEPS];
        trial.plan();
        self.most_cells = self.most_cells.max(trial.step().observed.cells().len());
        self.ticks += 1;
        Ok(())
    }

    fn values(&mut self) -> Values {
        let position = |trial: &Trial| trial.pose().position_m.to_array();
        Values::from([
            ("ticks", vec![self.ticks as f64]),
            ("mean_returns", vec![self.returns as f64 / self.ticks as f64]),
            ("most_cells", vec![self.most_cells as f64]),
            ("positions_m", self.trials.iter().flat_map(position).collect()),
        ])
    }
}

/// A whole trial with the preset `default` and the scenario's own seed: scans, planner and motion, without
/// loading its terrain.
pub(crate) struct WholeTrial {
    scenario: &'static Bundled,
    reality: RealityPreset,
    trial: Trial,
}

impl WholeTrial {
    pub(crate) fn new(name: &str, reality: RealityPreset) -> Result<Self, BenchError> {
        let scenario = scenario(name)?;
        Ok(Self { scenario, reality, trial: start(scenario, reality)? })
    }
}

impl Work for WholeTrial {
    fn prepare(&mut self) -> Result<(), BenchError> {
        self.trial = start(self.scenario, self.reality)?;
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
