//! The planner that answers scans, goal after goal. The same code runs in the node and in a replay.

use core::time::Duration;
use std::panic::{AssertUnwindSafe, catch_unwind};

use mapless::skyline::profile::Column;
use mapless::{ConfigError, Planner, PlannerConfig, Status, Step};
use sha2::{Digest as _, Sha256};

use crate::navigation::Task;
use crate::senses::Scan;
use crate::supervisor::{Outcome, Proposal};

/// What the planner made of a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// For the supervisor.
    pub proposal: Proposal,
    /// How the step ended; `None` after a panic.
    pub status: Option<Status>,
    /// Every bit of the decision as a digest: status, command, profile, subgoals, choice and path. Equal
    /// bits give equal digests on every target; empty after a panic.
    pub digest: String,
}

/// The planner, and what it remembers of the goal.
#[derive(Clone, Debug)]
pub struct Pilot {
    config: PlannerConfig,
    planner: Planner,
    goal: Option<u64>,
    stepped: Option<Duration>,
    status: Option<Status>,
    recoveries: i16,
}

impl Pilot {
    /// A planner without a goal.
    ///
    /// # Errors
    /// [`ConfigError`] for a value that makes no sense.
    pub fn new(config: PlannerConfig) -> Result<Self, ConfigError> {
        let planner = Planner::new(config.clone())?;
        Ok(Self { config, planner, goal: None, stepped: None, status: None, recoveries: 0 })
    }

    /// Times that the planner began to backtrack or to search since the goal was given.
    #[must_use]
    pub fn recoveries(&self) -> i16 {
        self.recoveries
    }

    /// The configuration.
    #[must_use]
    pub fn config(&self) -> &PlannerConfig {
        &self.config
    }

    /// Takes another configuration, and with it a planner that has seen nothing yet.
    ///
    /// # Errors
    /// [`ConfigError`] for a value that makes no sense; nothing has changed then.
    pub fn configure(&mut self, config: PlannerConfig) -> Result<(), ConfigError> {
        self.planner = Planner::new(config.clone())?;
        (self.config, self.goal) = (config, None);
        Ok(())
    }

    /// The planner's last step.
    #[must_use]
    pub fn last_step(&self) -> Step<'_> {
        self.planner.last_step()
    }

    /// What the planner is asked beyond its answers. After a panic it is made anew, and the answer is `None`:
    /// half of what was asked may have been done.
    pub fn ask<T>(&mut self, ask: impl FnOnce(&mut Planner) -> T) -> Option<T> {
        self.guarded(|this| ask(&mut this.planner))
    }

    fn guarded<T>(&mut self, ask: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let answer = catch_unwind(AssertUnwindSafe(|| ask(self)));
        if answer.is_err() {
            self.goal = None;
            // The configuration was in order before.
            if let Ok(planner) = Planner::new(self.config.clone()) {
                self.planner = planner;
            }
        }
        answer.ok()
    }

    /// Answers a scan. `has_jumped`: the localisation jumped since the last one, so the ground is forgotten.
    /// After a panic the planner is made anew.
    pub fn answer(&mut self, scan: &Scan, task: Task, has_jumped: bool) -> Answer {
        let step = self.guarded(|this| this.step(scan, task, has_jumped));
        let (outcome, status, digest) = step.unwrap_or((Outcome::Panicked, None, String::new()));
        let proposal = Proposal { goal: task.number, scan_arrived: scan.arrived, outcome };
        Answer { proposal, status, digest }
    }

    fn step(&mut self, scan: &Scan, task: Task, has_jumped: bool) -> (Outcome, Option<Status>, String) {
        if has_jumped {
            self.planner.reset();
            self.goal = None;
        }
        if self.goal != Some(task.number) {
            if matches!(self.status, Some(Status::Arrived | Status::Stopped(_))) {
                // The same goal again is a new drive, not one that goes on.
                self.planner.cancel_goal();
            }
            self.planner.set_goal(task.goal);
            (self.goal, self.status, self.recoveries) = (Some(task.number), None, 0);
        }
        let elapsed = self.stepped.map_or(Duration::ZERO, |stepped| scan.arrived.saturating_sub(stepped));
        self.stepped = Some(scan.arrived);
        let step = self.planner.step(&scan.points_m, &scan.pose, elapsed);
        let recovers = |status| matches!(status, Status::Backtracking | Status::Searching);
        if recovers(step.status) && !self.status.is_some_and(recovers) {
            self.recoveries = self.recoveries.saturating_add(1);
        }
        self.status = Some(step.status);
        (Outcome::from(&step), Some(step.status), digest(&step))
    }
}

/// The first 16 bytes of SHA-256 over every bit of a decision, in hexadecimal.
fn digest(step: &Step<'_>) -> String {
    let mut hash = Sha256::new();
    let mut add =
        |numbers: &[f64]| numbers.iter().for_each(|number| hash.update(number.to_bits().to_le_bytes()));
    add(&[step.command.linear_m_s, step.command.angular_rad_s]);
    for column in step.profile {
        add(&[match *column {
            Column::Ground { elevation_rad } => elevation_rad,
            Column::Wall => f64::INFINITY,
            Column::Unknown => f64::NEG_INFINITY,
        }]);
    }
    for subgoal in step.subgoals {
        add(&subgoal.position_m.to_array());
    }
    for point in step.path {
        add(&[point.position_m.x, point.position_m.y, point.cost_m]);
    }
    hash.update(format!("{:?} {:?}", step.status, step.chosen));
    crate::hexadecimal(&hash.finalize()[..16])
}
