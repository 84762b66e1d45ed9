//! What perception made of a scan: as JSON and as tables.

use std::f64::consts::PI;

use comfy_table::{CellAlignment, Table, presets};
use mapless::occupancy::{COLUMNS, column_azimuth_rad};
use mapless::perception::PredictedSurface;
use mapless::profile::Column;
use mapless::segments::{Segment, Verdict};
use mapless::subgoals::{Refusal, Subgoal};
use mapless::{Status, Step};

/// The result of one step, as `--json` prints it. Angles and places are the sensor's and the world's; both are the
/// robot's here, but for the sensor's height.
#[derive(serde::Serialize)]
pub(crate) struct PerceptionReport {
    #[serde(skip)]
    subject: String,
    /// Returns in the scan.
    returns: usize,
    /// `driving`, `arrived`, `looking` or `stopped`.
    status: &'static str,
    /// Why the planner stopped, where it did.
    reason: Option<String>,
    command: CommandRow,
    surface_radius_m: f64,
    /// Cells of the occupancy surface with a return.
    occupied_cells: usize,
    inducing_inputs: usize,
    /// Largest jitter that a covariance needed.
    jitter: f64,
    /// Always one for each column; unknown where the planner stopped before it saw anything.
    profile: Vec<ColumnRow>,
    segments: Vec<SegmentRow>,
    subgoals: Vec<SubgoalRow>,
    /// Index of the chosen subgoal.
    chosen: Option<usize>,
}

#[derive(serde::Serialize)]
struct CommandRow {
    linear_m_s: f64,
    angular_rad_s: f64,
}

#[derive(serde::Serialize)]
struct ColumnRow {
    azimuth_rad: f64,
    elevation_rad: Option<f64>,
    kind: &'static str,
}

#[derive(serde::Serialize)]
struct SegmentRow {
    begin_rad: f64,
    end_rad: f64,
    extent_rad: f64,
    width_m: f64,
    elevation_rad: Option<f64>,
    height_m: Option<f64>,
    verdict: &'static str,
}

#[derive(serde::Serialize)]
struct SubgoalRow {
    /// Index of its segment; none for the goal itself.
    segment: Option<usize>,
    azimuth_rad: f64,
    elevation_rad: f64,
    bearing_rad: f64,
    position_m: [f64; 3],
    /// `tilt`, `unseen` or none for a candidate.
    refusal: Option<&'static str>,
    /// Weighted terms; none when refused.
    cost: Option<CostRow>,
}

#[derive(serde::Serialize)]
struct CostRow {
    direction: f64,
    distance: f64,
    steepness: f64,
    commitment: f64,
    revisit: f64,
    total: f64,
}

impl PerceptionReport {
    pub(crate) fn new(
        subject: String,
        returns: usize,
        step: &Step<'_>,
        predicted: &PredictedSurface,
    ) -> Self {
        let (status, reason) = match step.status {
            Status::Driving => ("driving", None),
            Status::Arrived => ("arrived", None),
            Status::Looking => ("looking", None),
            Status::Stopped(reason) => ("stopped", Some(reason.to_string())),
        };
        let column = |index: usize| step.profile.get(index).copied().unwrap_or(Column::Unknown);
        Self {
            subject,
            returns,
            status,
            reason,
            command: CommandRow {
                linear_m_s: step.command.linear_m_s,
                angular_rad_s: step.command.angular_rad_s,
            },
            surface_radius_m: step.observed.radius_m(),
            occupied_cells: step.observed.cells().len(),
            inducing_inputs: predicted.inducing_inputs,
            jitter: predicted.jitter,
            profile: (0..COLUMNS).map(|index| ColumnRow::of(index, column(index))).collect(),
            segments: step.segments.iter().map(SegmentRow::of).collect(),
            subgoals: step.subgoals.iter().map(SubgoalRow::of).collect(),
            chosen: step.chosen,
        }
    }

    /// File, revolution and preset.
    pub(crate) fn subject(&self) -> &str {
        &self.subject
    }

    /// What was decided, in a line.
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
            (None, None) if self.status == "looking" => format!("turning to look for a subgoal; {seen}"),
            (None, None) => format!("{}; {seen}", self.status),
        }
    }

    /// The report for people: what was seen, the segments and the subgoals.
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

impl ColumnRow {
    fn of(index: usize, column: Column) -> Self {
        let (elevation_rad, kind) = match column {
            Column::Ground { elevation_rad } => (Some(elevation_rad), "ground"),
            Column::Unknown => (None, "unknown"),
            Column::Wall => (None, "wall"),
        };
        Self { azimuth_rad: column_azimuth_rad(index), elevation_rad, kind }
    }
}

impl SegmentRow {
    fn of(segment: &Segment) -> Self {
        Self {
            begin_rad: segment.begin_rad,
            end_rad: segment.end_rad(),
            extent_rad: segment.extent_rad,
            width_m: segment.width_m,
            elevation_rad: segment.elevation_rad,
            height_m: segment.height_m,
            verdict: match segment.verdict {
                Verdict::Valid => "valid",
                Verdict::TooNarrow => "too_narrow",
                Verdict::TooSteep => "too_steep",
                Verdict::Unknown => "unknown",
                Verdict::Wall => "wall",
            },
        }
    }
}

impl SubgoalRow {
    fn of(subgoal: &Subgoal) -> Self {
        Self {
            segment: subgoal.segment,
            azimuth_rad: subgoal.azimuth_rad,
            elevation_rad: subgoal.elevation_rad,
            bearing_rad: subgoal.bearing_rad,
            position_m: subgoal.position_m.to_array(),
            refusal: subgoal.refusal.map(|refusal| match refusal {
                Refusal::Tilt => "tilt",
                Refusal::Unseen => "unseen",
            }),
            cost: subgoal.cost.map(|cost| CostRow {
                direction: cost.direction,
                distance: cost.distance,
                steepness: cost.steepness,
                commitment: cost.commitment,
                revisit: cost.revisit,
                total: cost.total(),
            }),
        }
    }
}
