//! Planner results as flat arrays.

use mapless::decision::subgoals::{Refusal, Subgoal};
use mapless::route::forecast::ReachEnd;
use mapless::skyline::profile::Column;
use mapless::skyline::segments::{Segment, Verdict};

/// Begin and end azimuth (the end not wrapped), elevation, height, width, verdict. What is unknown is NaN.
pub(crate) fn segment(segment: &Segment) -> [f64; 6] {
    let verdict = match segment.verdict {
        Verdict::Valid => 0.0,
        Verdict::TooNarrow => 1.0,
        Verdict::TooSteep => 2.0,
        Verdict::Unknown => 3.0,
        Verdict::Wall => 4.0,
    };
    [
        segment.begin_rad,
        segment.begin_rad + segment.extent_rad,
        segment.elevation_rad.unwrap_or(f64::NAN),
        segment.height_m.unwrap_or(f64::NAN),
        segment.width_m,
        verdict,
    ]
}

/// Azimuth and elevation in the sensor frame, world x, y, z, chosen (0 or 1), refusal (0 none, 1 tilt, 2 unseen), index of
/// its segment (-1 for a place that is not on the skyline); reach, mean risk, largest roll and pitch of the forecast and its end (0 whole,
/// 1 tilt, 2 unseen), NaN without one; the cost's terms: direction, distance, steepness, commitment, dead_end, NaN without one.
pub(crate) fn subgoal(subgoal: &Subgoal, chosen: bool) -> [f64; 18] {
    let refusal = match subgoal.refusal {
        None => 0.0,
        Some(Refusal::Tilt) => 1.0,
        Some(Refusal::Unseen) => 2.0,
    };
    let forecast = subgoal.forecast.map_or([f64::NAN; 5], |f| {
        let end = match f.end {
            ReachEnd::Whole => 0.0,
            ReachEnd::Tilt => 1.0,
            ReachEnd::Unseen => 2.0,
        };
        [f.reach_m, f.mean_risk, f.max_roll_rad, f.max_pitch_rad, end]
    });
    let terms = subgoal
        .cost
        .map_or([f64::NAN; 5], |c| [c.direction, c.distance, c.steepness, c.commitment, c.dead_end]);
    let position = subgoal.position_m;
    let mut values = [0.0; 18];
    values[..8].copy_from_slice(&[
        subgoal.azimuth_rad,
        subgoal.elevation_rad,
        position.x,
        position.y,
        position.z,
        f64::from(u8::from(chosen)),
        refusal,
        subgoal.segment.map_or(-1.0, |index| index as f64),
    ]);
    values[8..13].copy_from_slice(&forecast);
    values[13..].copy_from_slice(&terms);
    values
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
