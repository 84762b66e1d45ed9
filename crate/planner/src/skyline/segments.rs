//! Segments: the profile cut into stretches of one elevation level (paper, section V-B).

use core::f64::consts::TAU;

use crate::config::SegmentConfig;
use crate::math::angle::wrap_rad;
use crate::sensor_model::SensorModel;
use crate::skyline::columns::{COLUMNS, column_azimuth_rad};
use crate::skyline::profile::Column;

/// Whether a segment can carry a subgoal, and if not, why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Wide and gentle enough.
    Valid,
    /// Not wider than the robot and its margin: w_s ≤ w_r + δ.
    TooNarrow,
    /// Its height is outside the slope range the robot climbs.
    TooSteep,
    /// No ground was seen within r_oc.
    Unknown,
    /// Occupied up to the highest ring.
    Wall,
}

/// A stretch of the profile.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Segment {
    /// Azimuth α_sb where it begins, in [-π, π), sensor frame.
    pub begin_rad: f64,
    /// Anticlockwise extent α_se - α_sb, in (0, 2π].
    pub extent_rad: f64,
    /// Mean elevation β_s of its columns; `None` where unknown.
    pub elevation_rad: Option<f64>,
    /// Height z_s of the point at r_oc and β_s above the ground under the robot, in the robot frame.
    pub height_m: Option<f64>,
    /// Width w_s = r_oc (α_se - α_sb).
    pub width_m: f64,
    /// The two validity conditions.
    pub verdict: Verdict,
}

impl Segment {
    /// Azimuth α_se where it ends, in [-π, π).
    pub fn end_rad(&self) -> f64 {
        wrap_rad(self.begin_rad + self.extent_rad)
    }
}

/// Cuts the profile into segments, seamlessly at ±π.
pub(crate) fn cut_segments(
    profile: &[Column],
    config: &SegmentConfig,
    radius_m: f64,
    robot_width_m: f64,
    mount: &SensorModel,
    segments: &mut Vec<Segment>,
) {
    segments.clear();
    let start = first_break(profile);
    let mut run: Option<Run> = None;
    for column in (0..COLUMNS).map(|k| (start + k) % COLUMNS) {
        match &mut run {
            Some(open) if open.takes(profile[column], config.elevation_tolerance_rad) => {
                open.add(profile[column]);
            }
            _ => {
                if let Some(closed) = run.replace(Run::open(column, profile[column])) {
                    segments.push(closed.close(config, radius_m, robot_width_m, mount));
                }
            }
        }
    }
    if let Some(closed) = run {
        segments.push(closed.close(config, radius_m, robot_width_m, mount));
    }
}

/// The column after the greatest change, so that no segment is cut at the seam of the circle.
fn first_break(profile: &[Column]) -> usize {
    let change = |column: usize| match (profile[(column + COLUMNS - 1) % COLUMNS], profile[column]) {
        (Column::Ground { elevation_rad: a }, Column::Ground { elevation_rad: b }) => (a - b).abs(),
        (before, here) if core::mem::discriminant(&before) == core::mem::discriminant(&here) => 0.0,
        _ => f64::INFINITY,
    };
    (0..COLUMNS).fold((0, 0.0), |best, c| if change(c) > best.1 { (c, change(c)) } else { best }).0
}

struct Run {
    first_column: usize,
    columns: usize,
    kind: Column,
    elevation_sum_rad: f64,
}

impl Run {
    fn open(first_column: usize, kind: Column) -> Self {
        let mut run = Self { first_column, columns: 0, kind, elevation_sum_rad: 0.0 };
        run.add(kind);
        run
    }

    fn add(&mut self, column: Column) {
        self.columns += 1;
        if let Column::Ground { elevation_rad } = column {
            self.elevation_sum_rad += elevation_rad;
        }
    }

    fn mean_elevation_rad(&self) -> f64 {
        self.elevation_sum_rad / self.columns as f64
    }

    fn takes(&self, column: Column, tolerance_rad: f64) -> bool {
        match (self.kind, column) {
            (Column::Ground { .. }, Column::Ground { elevation_rad }) => {
                (elevation_rad - self.mean_elevation_rad()).abs() <= tolerance_rad
            }
            (Column::Unknown, Column::Unknown) | (Column::Wall, Column::Wall) => true,
            _ => false,
        }
    }

    fn close(
        &self,
        config: &SegmentConfig,
        radius_m: f64,
        robot_width_m: f64,
        mount: &SensorModel,
    ) -> Segment {
        let step = TAU / COLUMNS as f64;
        let extent_rad = step * self.columns as f64;
        let width_m = radius_m * extent_rad;
        let elevation_rad = matches!(self.kind, Column::Ground { .. }).then(|| self.mean_elevation_rad());
        let height_m = elevation_rad.map(|elevation| radius_m * libm::sin(elevation) + mount.height_m);
        let steepest_m = radius_m * libm::sin(config.max_slope_rad);
        let verdict = match (self.kind, height_m) {
            (Column::Wall, _) => Verdict::Wall,
            (Column::Ground { .. }, Some(height)) if height.abs() > steepest_m => Verdict::TooSteep,
            (Column::Ground { .. }, Some(_)) if width_m > robot_width_m + config.safety_margin_m => {
                Verdict::Valid
            }
            (Column::Ground { .. }, _) => Verdict::TooNarrow,
            (Column::Unknown, _) => Verdict::Unknown,
        };
        Segment {
            begin_rad: wrap_rad(column_azimuth_rad(self.first_column) - 0.5 * step),
            extent_rad,
            elevation_rad,
            height_m,
            width_m,
            verdict,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::PlannerConfig;
    use proptest::prelude::*;

    fn cut(profile: &[Column]) -> Vec<Segment> {
        let config = PlannerConfig::default();
        let mut segments = Vec::new();
        cut_segments(profile, &config.segments, 7.0, 0.685, &config.sensor, &mut segments);
        segments
    }

    const LEVEL: Column = Column::Ground { elevation_rad: -0.114 };

    #[test]
    fn level_ground_is_one_segment_around() {
        let segments = cut(&[LEVEL; COLUMNS]);
        assert_eq!(segments.len(), 1);
        assert!((segments[0].extent_rad - TAU).abs() < 1e-12);
        assert!(segments[0].height_m.unwrap().abs() < 0.02);
        assert_eq!(segments[0].verdict, Verdict::Valid);
    }

    #[test]
    fn a_stretch_across_the_seam_stays_whole() {
        let mut profile = [Column::Unknown; COLUMNS];
        profile[350..].fill(LEVEL);
        profile[..10].fill(LEVEL);
        let segments = cut(&profile);
        assert_eq!(segments.len(), 2);
        let ground = segments.iter().find(|s| s.verdict == Verdict::Valid).unwrap();
        assert!((ground.extent_rad.to_degrees() - 20.0).abs() < 1e-9);
        assert!((ground.begin_rad.to_degrees() - 169.5).abs() < 1e-9);
        assert!((ground.end_rad().to_degrees() + 170.5).abs() < 1e-9);
    }

    #[test]
    fn verdicts_name_the_reason() {
        let mut profile = [LEVEL; COLUMNS];
        profile[10..15].fill(Column::Ground { elevation_rad: 0.1 });
        profile[20..60].fill(Column::Ground { elevation_rad: 0.24 });
        profile[60..80].fill(Column::Ground { elevation_rad: -0.25 });
        profile[100..120].fill(Column::Wall);
        profile[200..220].fill(Column::Unknown);
        let mut config = PlannerConfig::default();
        config.segments.max_slope_rad = 0.3;
        let mut segments = Vec::new();
        cut_segments(&profile, &config.segments, 7.0, 0.685, &config.sensor, &mut segments);
        let verdicts: Vec<Verdict> = segments.iter().map(|s| s.verdict).collect();
        for verdict in
            [Verdict::TooNarrow, Verdict::TooSteep, Verdict::Wall, Verdict::Unknown, Verdict::Valid]
        {
            assert!(verdicts.contains(&verdict), "{verdict:?} missing in {verdicts:?}");
        }
    }

    proptest! {
        #[test]
        fn segments_tile_the_circle_and_rotate_with_the_profile(
            levels in prop::collection::vec((0..6_u8, 1..40_usize), 2..20),
            turn in 0..COLUMNS,
        ) {
            let column = |level: u8| match level {
                0 => Column::Unknown,
                1 => Column::Wall,
                _ => Column::Ground { elevation_rad: f64::from(level) * 0.1 - 0.4 },
            };
            let profile: Vec<Column> =
                levels.iter().cycle().flat_map(|&(l, n)| vec![column(l); n]).take(COLUMNS).collect();
            let segments = cut(&profile);
            let total: f64 = segments.iter().map(|s| s.extent_rad).sum();
            prop_assert!((total - TAU).abs() < 1e-9);
            let mut turned = profile.clone();
            turned.rotate_right(turn);
            let sizes = |segments: &[Segment]| {
                let mut sizes: Vec<i64> = segments.iter().map(|s| (s.extent_rad * 1e6) as i64).collect();
                sizes.sort_unstable();
                sizes
            };
            prop_assert_eq!(sizes(&segments), sizes(&cut(&turned)));
        }
    }
}
