//! What a tick saw and weighed, for whoever explains it.

use mapless::decision::subgoals;
use mapless::route::forecast;
use mapless::skyline::profile::Column;
use mapless::skyline::segments;
use mapless::{Command, Status, Step};
use serde::Serialize;
use tsify::Tsify;

/// A run of neighbouring columns at one level of the skyline.
#[derive(Debug, Serialize, Tsify)]
pub struct Segment {
    /// Azimuth in the sensor frame, in [-π, π).
    begin_rad: f64,
    /// At least `begin_rad`; beyond π where the segment crosses the azimuth behind the robot.
    end_rad: f64,
    /// Nothing where the ground is unknown, and so is the height.
    elevation_rad: Option<f64>,
    /// Height over the ground under the robot.
    height_m: Option<f64>,
    width_m: f64,
    verdict: Verdict,
}

/// Whether subgoals may stand on a segment, and if not, why.
#[derive(Clone, Copy, Debug, Serialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Wide and gentle enough.
    Valid,
    /// Not wider than the robot and its margin.
    TooNarrow,
    /// Higher or lower than the robot climbs.
    TooSteep,
    /// No ground was seen.
    Unknown,
    /// Occupied up to the highest ring.
    Wall,
}

impl From<&segments::Segment> for Segment {
    fn from(segment: &segments::Segment) -> Self {
        Self {
            begin_rad: segment.begin_rad,
            end_rad: segment.begin_rad + segment.extent_rad,
            elevation_rad: segment.elevation_rad,
            height_m: segment.height_m,
            width_m: segment.width_m,
            verdict: match segment.verdict {
                segments::Verdict::Valid => Verdict::Valid,
                segments::Verdict::TooNarrow => Verdict::TooNarrow,
                segments::Verdict::TooSteep => Verdict::TooSteep,
                segments::Verdict::Unknown => Verdict::Unknown,
                segments::Verdict::Wall => Verdict::Wall,
            },
        }
    }
}

/// A place where the robot could go next: on the skyline, where it already heads, at the frontier of what was
/// seen, or the goal itself once it is in sight.
#[derive(Debug, Serialize, Tsify)]
pub struct Subgoal {
    /// Direction in the sensor frame.
    azimuth_rad: f64,
    elevation_rad: f64,
    /// Position in the world.
    x: f64,
    y: f64,
    z: f64,
    chosen: bool,
    /// Why it is no candidate, where it is none.
    refusal: Option<Refusal>,
    /// Index of its segment; nothing for a place that is not on the skyline.
    segment: Option<usize>,
    /// Nothing where the cost judges steepness by the paper's height alone.
    forecast: Option<Forecast>,
    /// Nothing for the refused and for the goal itself.
    cost: Option<Cost>,
}

/// Why a subgoal is no candidate.
#[derive(Clone, Copy, Debug, Serialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum Refusal {
    /// The ground on the path tilts the robot too far too soon.
    Tilt,
    /// Too little of the ground on the path was seen.
    Unseen,
}

/// What the path to a subgoal promises, from the ground that the last scans saw.
#[derive(Debug, Serialize, Tsify)]
pub struct Forecast {
    /// Straight distance from the robot to where the path ends.
    reach_m: f64,
    /// Length of the path.
    path_m: f64,
    /// What the path goes up and down, together.
    climb_m: f64,
    /// Mean of (slope / slope at the limit)² over the path.
    mean_risk: f64,
    max_roll_rad: f64,
    max_pitch_rad: f64,
    end: ReachEnd,
}

/// Why a forecast ends where it does.
#[derive(Clone, Copy, Debug, Serialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum ReachEnd {
    /// At the end of the path.
    Whole,
    /// Before ground that tilts the robot too far.
    Tilt,
    /// Before ground never seen.
    Unseen,
}

/// The weighted terms of a subgoal's cost. The paper has the first three.
#[derive(Debug, Serialize, Tsify)]
pub struct Cost {
    direction: f64,
    distance: f64,
    steepness: f64,
    commitment: f64,
    /// What was learned about the way on from there.
    correction: f64,
    /// Their sum.
    total: f64,
}

impl Subgoal {
    fn new(subgoal: &subgoals::Subgoal, chosen: bool) -> Self {
        Self {
            azimuth_rad: subgoal.azimuth_rad,
            elevation_rad: subgoal.elevation_rad,
            x: subgoal.position_m.x,
            y: subgoal.position_m.y,
            z: subgoal.position_m.z,
            chosen,
            refusal: subgoal.refusal.map(|refusal| match refusal {
                subgoals::Refusal::Tilt => Refusal::Tilt,
                subgoals::Refusal::Unseen => Refusal::Unseen,
            }),
            segment: subgoal.segment,
            forecast: subgoal.forecast.map(|forecast| Forecast {
                reach_m: forecast.reach_m,
                path_m: forecast.path_m,
                climb_m: forecast.climb_m,
                mean_risk: forecast.mean_risk,
                max_roll_rad: forecast.max_roll_rad,
                max_pitch_rad: forecast.max_pitch_rad,
                end: match forecast.end {
                    forecast::ReachEnd::Whole => ReachEnd::Whole,
                    forecast::ReachEnd::Tilt => ReachEnd::Tilt,
                    forecast::ReachEnd::Unseen => ReachEnd::Unseen,
                },
            }),
            cost: subgoal.cost.map(|cost| Cost {
                direction: cost.direction,
                distance: cost.distance,
                steepness: cost.steepness,
                commitment: cost.commitment,
                correction: cost.correction,
                total: cost.total(),
            }),
        }
    }
}

/// What the planner does at present.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Tsify)]
#[serde(rename_all = "snake_case")]
pub enum Activity {
    /// Drives to the chosen subgoal.
    Driving,
    /// Stands at the goal.
    Arrived,
    /// Turns in place to find a subgoal.
    Searching,
    /// Stands still for good.
    Stopped,
    /// Goes back the way it came.
    Backtracking,
}

impl From<Status> for Activity {
    fn from(status: Status) -> Self {
        match status {
            Status::Driving => Self::Driving,
            Status::Arrived => Self::Arrived,
            Status::Searching => Self::Searching,
            Status::Stopped(_) => Self::Stopped,
            Status::Backtracking => Self::Backtracking,
        }
    }
}

/// Forward speed and counter-clockwise turn rate.
#[derive(Debug, Serialize, Tsify)]
pub struct Velocity {
    v_m_s: f64,
    omega_rad_s: f64,
}

impl From<Command> for Velocity {
    fn from(command: Command) -> Self {
        Self { v_m_s: command.linear_m_s, omega_rad_s: command.angular_rad_s }
    }
}

/// A place on the path to the chosen subgoal.
#[derive(Debug, Serialize, Tsify)]
pub struct PathPoint {
    x: f64,
    y: f64,
    /// Whether the robot gets there in reverse.
    reverse: bool,
}

pub(crate) fn segments(step: &Step<'_>) -> Vec<Segment> {
    step.segments.iter().map(Segment::from).collect()
}

pub(crate) fn subgoals(step: &Step<'_>) -> Vec<Subgoal> {
    let numbered = step.subgoals.iter().enumerate();
    numbered.map(|(index, one)| Subgoal::new(one, step.chosen == Some(index))).collect()
}

pub(crate) fn path(step: &Step<'_>) -> Vec<PathPoint> {
    let point = |x, y, reverse| PathPoint { x, y, reverse };
    step.path.iter().map(|one| point(one.position_m.x, one.position_m.y, one.reverse)).collect()
}

/// 0 ground, 1 unknown, 2 wall.
pub(crate) fn column_kind(column: &Column) -> u8 {
    match column {
        Column::Ground { .. } => 0,
        Column::Unknown => 1,
        Column::Wall => 2,
    }
}

/// The skyline's elevation, NaN where there is none.
pub(crate) fn column_elevation_rad(column: &Column) -> f32 {
    match column {
        Column::Ground { elevation_rad } => *elevation_rad as f32,
        Column::Unknown | Column::Wall => f32::NAN,
    }
}
