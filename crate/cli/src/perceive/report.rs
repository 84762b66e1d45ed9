//! The result of perception on a scan: as JSON and as tables.

use std::f64::consts::PI;

use comfy_table::{CellAlignment, Table, presets};
use mapless::Step;
use mapless::skyline::columns::COLUMNS;
use mapless::skyline::profile::Column;
use mapless_trials::Activity;

use super::rows::{ColumnRow, CommandRow, CostRow, ReturnKindsRow, SegmentRow, SubgoalRow};

/// The result of one step, as `--json` prints it. Azimuths and elevations are the sensor's; positions are the
/// world's, whose origin is the ground under the robot and whose x is its heading.
#[derive(serde::Serialize)]
pub(crate) struct PerceptionReport {
    #[serde(skip)]
    subject: String,
    /// What the reader of the file left out, and what is doubtful about the scan.
    warnings: Vec<String>,
    /// Returns in the scan, and what they are.
    returns: usize,
    return_kinds: ReturnKindsRow,
    /// `driving`, `arrived`, `backtracking`, `searching` or `stopped`.
    status: &'static str,
    /// Why the planner stopped, if it did.
    reason: Option<String>,
    /// What a robot is told that has started from rest.
    pub(super) command: CommandRow,
    surface_radius_m: f64,
    /// Cells of the occupancy surface with a return.
    occupied_cells: usize,
    inducing_inputs: usize,
    /// Largest jitter that a covariance needed.
    jitter: f64,
    /// One for each column; unknown if the planner stopped before perception.
    profile: Vec<ColumnRow>,
    segments: Vec<SegmentRow>,
    subgoals: Vec<SubgoalRow>,
    /// Index of the chosen subgoal.
    chosen: Option<usize>,
}

impl PerceptionReport {
    pub(crate) fn new(subject: String, returns: usize, warnings: Vec<String>, step: &Step<'_>) -> Self {
        let activity = Activity::from(step.status);
        let reason = match activity {
            Activity::Stopped(reason) => Some(reason.to_string()),
            _ => None,
        };
        let column = |index: usize| step.profile.get(index).copied().unwrap_or(Column::Unknown);
        Self {
            subject,
            warnings,
            returns,
            return_kinds: ReturnKindsRow::of(step.return_kinds),
            status: activity.name(),
            reason,
            command: CommandRow::of(step.command),
            surface_radius_m: step.observed.radius_m(),
            occupied_cells: step.observed.cells().len(),
            inducing_inputs: step.diagnostics.inducing_inputs,
            jitter: step.diagnostics.jitter,
            profile: (0..COLUMNS).map(|index| ColumnRow::of(index, column(index))).collect(),
            segments: step.segments.iter().map(SegmentRow::of).collect(),
            subgoals: step.subgoals.iter().map(SubgoalRow::of).collect(),
            chosen: step.chosen,
        }
    }

    /// File, revolution and planner.
    pub(crate) fn subject(&self) -> &str {
        &self.subject
    }

    /// The decision in a line.
    pub(crate) fn headline(&self) -> String {
        let candidates = self.subgoals.iter().filter(|subgoal| subgoal.refusal.is_none()).count();
        let seen = format!(
            "{} segments, {} subgoals, {candidates} of them candidates",
            self.segments.len(),
            self.subgoals.len()
        );
        match (&self.reason, self.chosen.and_then(|index| self.subgoals.get(index))) {
            (Some(reason), _) => format!("stopped: {reason}"),
            (None, Some(subgoal)) => {
                format!("driving to the subgoal at {}; {seen}", direction(subgoal.bearing_rad))
            }
            (None, None) if self.status == "searching" => format!("turning to look for a subgoal; {seen}"),
            (None, None) => format!("{}; {seen}", self.status),
        }
    }

    /// The report as text: perception, the segments and the subgoals.
    pub(crate) fn tables(&self) -> String {
        let mut text = format!("{}\n{}\n\n{}", self.subject, self.headline(), self.summary());
        if !self.segments.is_empty() {
            text += &format!("\n\n{}", self.segment_table());
        }
        if !self.subgoals.is_empty() {
            text += &format!("\n\n{}", self.subgoal_table());
        }
        text
    }

    fn summary(&self) -> String {
        let columns = |kind: &str| self.profile.iter().filter(|column| column.kind == kind).count();
        let mut table = Table::new();
        table.load_preset(presets::NOTHING);
        let mut row = |name: &str, value: String, unit: &str| {
            table.add_row([name, &value, unit]);
        };
        row("returns", self.returns.to_string(), "");
        let kinds = self.return_kinds;
        for (name, count, meaning) in [
            ("no returns", kinds.invalid, "nearer or farther than the sensor measures"),
            ("own body", kinds.body, "within the robot's outline"),
            ("stray", kinds.stray, "rain, dust, insects, multipath"),
            ("overhead", kinds.overhead, "higher than the robot"),
        ] {
            if count > 0 {
                row(name, count.to_string(), meaning);
            }
        }
        row(
            "occupied cells",
            self.occupied_cells.to_string(),
            &format!("within {} m", self.surface_radius_m),
        );
        row("inducing inputs", self.inducing_inputs.to_string(), "");
        row("jitter", format!("{:e}", self.jitter), "");
        row("profile: ground", columns("ground").to_string(), "columns of 1°");
        row("profile: unknown", columns("unknown").to_string(), "columns of 1°");
        row("profile: wall", columns("wall").to_string(), "columns of 1°");
        row("speed", format!("{:.2}", self.command.linear_m_s), "m/s");
        row("turn rate", format!("{:.2}", self.command.angular_rad_s), "rad/s");
        if let Some(values) = table.column_mut(1) {
            values.set_cell_alignment(CellAlignment::Right);
        }
        table.trim_fmt()
    }

    fn segment_table(&self) -> String {
        let rows = self.segments.iter().map(|segment| {
            vec![
                degrees(segment.begin_rad),
                degrees(segment.end_rad),
                format!("{:.2}", segment.width_m),
                segment.elevation_rad.map_or("-".to_owned(), degrees),
                segment.height_m.map_or("-".to_owned(), |height_m| format!("{height_m:.2}")),
                segment.verdict.replace('_', " "),
            ]
        });
        let header = ["segment", "begin °", "end °", "width m", "elevation °", "height m", "verdict"];
        numbered(&header, rows, None)
    }

    fn subgoal_table(&self) -> String {
        let rows = self.subgoals.iter().map(|subgoal| {
            let [x, y, z] = subgoal.position_m.map(|value| format!("{value:.2}"));
            let term = |term: fn(&CostRow) -> f64| {
                subgoal.cost.as_ref().map_or("-".to_owned(), |cost| format!("{:.3}", term(cost)))
            };
            vec![
                degrees(subgoal.azimuth_rad),
                x,
                y,
                z,
                term(|cost| cost.direction),
                term(|cost| cost.distance),
                term(|cost| cost.steepness),
                term(|cost| cost.total),
                subgoal.refusal.map_or(String::new(), |refusal| format!("refused: {refusal}")),
            ]
        });
        let header =
            ["subgoal", "azimuth °", "x m", "y m", "z m", "direction", "distance", "steepness", "cost", ""];
        numbered(&header, rows, self.chosen)
    }
}

/// A table whose rows are counted from 0 in the first column; all columns but the last are numbers.
fn numbered(header: &[&str], rows: impl Iterator<Item = Vec<String>>, chosen: Option<usize>) -> String {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_header(header);
    for (index, mut row) in rows.enumerate() {
        row.insert(0, index.to_string());
        if let (true, Some(last)) = (chosen == Some(index), row.last_mut()) {
            *last = "chosen".to_owned();
        }
        table.add_row(row);
    }
    for column in table.column_iter_mut().take(header.len() - 1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}

fn degrees(angle_rad: f64) -> String {
    format!("{:.1}", angle_rad.to_degrees())
}

/// A bearing in words.
fn direction(bearing_rad: f64) -> String {
    let side = match bearing_rad {
        _ if bearing_rad.abs() < 0.5 * PI / 180.0 => return "0° (straight ahead)".to_owned(),
        _ if bearing_rad > 0.0 => "left",
        _ => "right",
    };
    format!("{:.0}° to the {side}", bearing_rad.abs().to_degrees())
}
