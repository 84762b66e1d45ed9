//! The folder of `--out`: trajectory.csv, path.svg and result.json.
//!
//! A row of trajectory.csv is one planning period: the state of the robot at the scan, and the planner's
//! decision. The last row has the robot's final state, with the outcome in the column `status` and no
//! decision.

use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use glam::DVec2;
use mapless_trials::{Decision, Navigator as _};

use crate::any_trial::AnyTrial;
use crate::picture::Picture;
use crate::trial_report::Report;

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
    /// Makes the folder and begins its trajectory, so that a folder that cannot be written fails before the
    /// long run. The picture shows the goal's tolerance.
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
        let Decision { activity, command } = decision;
        let subgoal_m = trial.navigator().subgoal_m();
        self.path_m.push(trial.robot().position);
        self.subgoals_m.extend(subgoal_m);
        let subgoal = subgoal_m.map_or(",".to_owned(), |place| format!("{:.6},{:.6}", place.x, place.y));
        let decision =
            format!("{:.6},{:.6},{subgoal},{}", command.linear_m_s, command.angular_rad_s, activity.name());
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
