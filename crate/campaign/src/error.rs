//! Errors of campaigns. What goes wrong in a single trial is a row of the results.

use std::path::Path;

use mapless_trials::ScenarioError;

/// Why a campaign cannot be run or read: the file and what is wrong with it.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {fault}")]
pub struct CampaignError {
    /// The file.
    pub file: String,
    /// What is wrong.
    pub fault: Box<CampaignFault>,
}

/// What is wrong with a file of a campaign.
#[derive(Debug, thiserror::Error)]
pub enum CampaignFault {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Read(String),
    /// It cannot be written.
    #[error("cannot be written: {0}")]
    Write(String),
    /// A wrong key, or a value of the wrong kind or outside its range; says where and what was expected.
    #[error("{0}")]
    Content(String),
    /// A route's scenario cannot be loaded.
    #[error("routes: {0}")]
    Route(#[from] ScenarioError),
    /// The folder holds the trials of something else.
    #[error(
        "holds trials of another {what} ({found}): expected {expected}; choose another --out or remove the folder"
    )]
    Other {
        /// `campaign` or `build of mapless`.
        what: &'static str,
        /// What the journal says.
        found: String,
        /// What is to be run.
        expected: String,
    },
    /// Two journals disagree on a trial.
    #[error(
        "trial {id} has run twice with different results: {first} and {second}; one of the two programs was another one"
    )]
    Disagreement {
        /// The trial.
        id: String,
        /// Outcome and digest in one journal.
        first: String,
        /// Outcome and digest in the other.
        second: String,
    },
}

impl CampaignError {
    pub(crate) fn new(path: &Path, fault: CampaignFault) -> Self {
        Self { file: path.display().to_string(), fault: Box::new(fault) }
    }

    pub(crate) fn read(path: &Path, reason: impl ToString) -> Self {
        Self::new(path, CampaignFault::Read(reason.to_string()))
    }

    pub(crate) fn write(path: &Path, reason: impl ToString) -> Self {
        Self::new(path, CampaignFault::Write(reason.to_string()))
    }

    pub(crate) fn content(path: &Path, reason: impl ToString) -> Self {
        Self::new(path, CampaignFault::Content(reason.to_string()))
    }
}
