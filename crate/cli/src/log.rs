//! The folder of `--out`: trajectory.csv, path.svg and result.json.
//!
//! One row of trajectory.csv is one planning period: the state of the robot when the scan was taken, and what the planner
//! decided on it. The last row is where the robot ended, with the outcome in the column `status` and no decision.

use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use glam::DVec2;
use mapless::{Decision, Navigator as _, Status};

use crate::picture::Picture;
use crate::report::Report;
use crate::run::AnyTrial;

const HEADER: &str = "time_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,speed_m_s,turn_rate_rad_s,\
    command_speed_m_s,command_turn_rate_rad_s,subgoal_x_m,subgoal_y_m,status";

pub(crate) struct Log {
    folder: PathBuf,
    trajectory: BufWriter<File>,
    path_m: Vec<DVec2>,
    subgoals_m: Vec<DVec2>,
    goal_tolerance_m: f64,
}

impl Log {
    /// Makes the folder and begins its trajectory, so that what cannot be written shows before the long run. The picture
    /// will show how near the goal counts as reached.
    pub(crate) fn create(folder: &Path, goal_tolerance_m: f64) -> anyhow::Result<Self> {
        fs::create_dir_all(folder).with_context(|| format!("--out: {}", folder.display()))?;
        let path = folder.join("trajectory.csv");
        let file = File::create(&path).with_context(|| format!("--out: {}", path.display()))?;
        let mut log = Self {
            folder: folder.to_owned(),
            trajectory: BufWriter::new(file),
            path_m: Vec::new(),
            subgoals_m: Vec::new(),
            goal_tolerance_m,
        };
        log.row(HEADER)?;
        Ok(log)
    }

    /// Adds the state and the decision of one planning period, before the robot moves.
    pub(crate) fn decided(&mut self, trial: &AnyTrial, decision: &Decision) -> anyhow::Result<()> {
        let Decision { status, command } = decision;
        let subgoal_m = trial.navigator().subgoal_m();
        self.path_m.push(trial.robot().position);
        self.subgoals_m.extend(subgoal_m);
        let subgoal = subgoal_m.map_or(",".to_owned(), |place| format!("{:.6},{:.6}", place.x, place.y));
        let status = match status {
            Status::Driving => "driving",
            Status::Arrived => "arrived",
            Status::Backtracking => "backtracking",
            Status::Searching => "searching",
            Status::Stopped(_) => "stopped",
        };
        let decision = format!("{:.6},{:.6},{subgoal},{status}", command.linear_m_s, command.angular_rad_s);
        self.row(&format!("{},{decision}", state(trial)))
    }

    /// Adds the last row and writes the other files.
    pub(crate) fn finish(mut self, trial: &AnyTrial, report: &Report) -> anyhow::Result<()> {
        self.path_m.push(trial.robot().position);
        self.row(&format!("{},,,,,{}", state(trial), report.outcome.name()))?;
        self.trajectory.flush().with_context(|| self.folder.join("trajectory.csv").display().to_string())?;
        let result = serde_json::to_string_pretty(report)? + "\n";
        self.write("result.json", &result)?;
        self.write("path.svg", &self.picture(trial, report).svg()?)
    }

    fn picture<'a>(&'a self, trial: &'a AnyTrial, report: &Report) -> Picture<'a> {
        Picture {
            title: report.headline(),
            subtitle: format!("{} · {}", report.subject, report.tilts()),
            field: trial.field(),
            start: trial.start(),
            goal_m: trial.goal_m(),
            goal_tolerance_m: self.goal_tolerance_m,
            path_m: &self.path_m,
            subgoals_m: &self.subgoals_m,
            outcome: report.outcome,
        }
    }

    fn write(&self, name: &str, text: &str) -> anyhow::Result<()> {
        let path = self.folder.join(name);
        fs::write(&path, text).with_context(|| format!("--out: {}", path.display()))
    }

    fn row(&mut self, row: &str) -> anyhow::Result<()> {
        let place = || self.folder.join("trajectory.csv").display().to_string();
        writeln!(self.trajectory, "{row}").with_context(place)
    }
}

fn state(trial: &AnyTrial) -> String {
    let values: String = trial.motion().iter().map(|value| format!(",{value:.6}")).collect();
    format!("{:.3}{values}", trial.time_s())
}
