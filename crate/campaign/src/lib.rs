//! Campaigns: many trials, planners × routes × seeds × parameter values × realities, run on every core.
//!
//! A campaign is a TOML file ([`Campaign`]). [`Plan::read`] expands it into trials, [`run`] runs those that
//! no journal in the results' folder has yet, and once all have run the folder holds
//!
//! | file | what |
//! |---|---|
//! | `trials.parquet`, `trials.csv` | a row for each trial: outcome, metrics, configuration ([`TrialRow`]) |
//! | `campaign.json` | the parts of the campaign ([`Manifest`]) |
//! | `trajectories/` | the first seed's trajectories, by planner and route, if they are kept |
//! | `timing.csv` | wall-clock times, which differ from run to run |
//! | `journal*.jsonl` | the trials that have run, a line for each |
//!
//! All but the last two are the same bytes whenever, wherever and in whatever order the trials ran.

mod columns;
mod error;
mod file;
mod files;
mod hash;
mod journal;
mod navigators;
mod pace;
mod parameters;
mod plan;
mod reality;
pub mod report;
mod results;
mod row;
mod runner;
#[cfg(test)]
mod testing;
mod trial;
pub mod verti_bench;

pub use error::{CampaignError, CampaignFault};
pub use file::{Benchmark, Campaign, Combine};
pub use journal::{Entry, Timing, TrialResult};
pub use mapless_baselines::Truth;
pub use plan::{Plan, Route, Shard, TrialSpec};
pub use reality::Condition;
pub use results::{Manifest, ManifestReality, ManifestRoute};
pub use row::TrialRow;
pub use runner::{Done, Options, Progress, run, run_one};
