//! Subgoals on the segments (paper, section V-B) and their positions in the world.

use glam::{DVec2, DVec3};

use crate::config::{PlannerConfig, SegmentConfig};
use crate::math::angle::wrap_rad;
use crate::pose::Pose;
use crate::route::forecast::Forecast;
use crate::sensor_model::SensorModel;
use crate::skyline::segments::{Segment, Verdict};

/// The weighted terms of the cost J of one subgoal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Cost {
    /// k_dir times the direction cost.
    pub direction: f64,
    /// k_dst times the distance cost.
    pub distance: f64,
    /// k_stp times the steepness cost.
    pub steepness: f64,
    /// Cost of turning away from the last choice.
    pub commitment: f64,
    /// Cost of the learned correction of the cost-to-go at the subgoal.
    pub correction: f64,
}

impl Cost {
    /// J.
    pub fn total(&self) -> f64 {
        self.direction + self.distance + self.steepness + self.commitment + self.correction
    }
}

/// Why a subgoal is not a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The ground on the path tilts the robot too far too soon.
    Tilt,
    /// Too little of the ground on the path was seen.
    Unseen,
}

/// A place that the robot could drive to next.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Subgoal {
    /// Index of its segment; `None` for the goal itself, the committed target and frontier places.
    pub segment: Option<usize>,
    /// Azimuth α_g in the sensor frame, in [-π, π).
    pub azimuth_rad: f64,
    /// Elevation β_g in the sensor frame.
    pub elevation_rad: f64,
    /// Position in the world frame.
    pub position_m: DVec3,
    /// Bearing of the position from the robot's heading, seen from above, in [-π, π).
    pub bearing_rad: f64,
    /// Forecast of the path there; `None` in the policy `paper`.
    pub forecast: Option<Forecast>,
    /// Why it was refused; `None` for a candidate.
    pub refusal: Option<Refusal>,
    /// Its cost, weighted term by term; `None` if refused.
    pub cost: Option<Cost>,
}

/// Azimuths of a segment's subgoals: its centre or, from three times the least width on, n - 1 spread evenly.
fn spread_azimuths(
    segment: &Segment,
    robot_width_m: f64,
    config: &SegmentConfig,
) -> impl Iterator<Item = f64> + use<> {
    let whole = (segment.width_m / (robot_width_m + config.safety_margin_m)).floor();
    let parts = if whole >= 3.0 { whole as usize } else { 2 };
    let (begin, extent) = (segment.begin_rad, segment.extent_rad);
    (1..parts).map(move |k| wrap_rad(begin + extent * k as f64 / parts as f64))
}

/// Whether a segment may carry subgoals. Unknown ones may if the policy drives on seen ground alone.
fn carries_subgoals(segment: &Segment, robot_width_m: f64, config: &SegmentConfig) -> bool {
    match segment.verdict {
        Verdict::Valid => true,
        Verdict::Unknown => {
            config.subgoals_on_unknown && segment.width_m > robot_width_m + config.safety_margin_m
        }
        Verdict::TooNarrow | Verdict::TooSteep | Verdict::Wall => false,
    }
}

/// The subgoals of the segments, on the skyline at r_oc.
pub(crate) fn on_segments<'a>(
    config: &'a PlannerConfig,
    pose: &'a Pose,
    segments: &'a [Segment],
) -> impl Iterator<Item = Subgoal> + use<'a> {
    let (radius_m, width_m) = (config.perception.surface_radius_m, config.robot.width_m);
    let carrying = segments.iter().enumerate();
    let carrying = carrying.filter(move |(_, segment)| carries_subgoals(segment, width_m, &config.segments));
    carrying.flat_map(move |(index, segment)| {
        let elevation_rad = segment.elevation_rad.unwrap_or(config.sensor.lowest_elevation_rad);
        spread_azimuths(segment, width_m, &config.segments).map(move |azimuth_rad| {
            let skyline_m = world_position_m(pose, &config.sensor, azimuth_rad, elevation_rad, radius_m);
            Subgoal {
                segment: Some(index),
                azimuth_rad,
                elevation_rad,
                position_m: skyline_m,
                bearing_rad: bearing_rad(pose, skyline_m.truncate()),
                forecast: None,
                refusal: None,
                cost: None,
            }
        })
    })
}

/// World position of the point at (azimuth, elevation, range) in the sensor frame: ᵂT_R g_R.
pub(crate) fn world_position_m(
    pose: &Pose,
    mount: &SensorModel,
    azimuth_rad: f64,
    elevation_rad: f64,
    range_m: f64,
) -> DVec3 {
    let (sin_a, cos_a) = libm::sincos(azimuth_rad);
    let (sin_e, cos_e) = libm::sincos(elevation_rad);
    let in_sensor = DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e) * range_m;
    pose.position_m + pose.world_from_robot() * (mount.offset_m() + in_sensor)
}

/// Bearing of a world point from the robot's heading, seen from above.
pub(crate) fn bearing_rad(pose: &Pose, point_m: DVec2) -> f64 {
    let offset = point_m - pose.plan_m();
    wrap_rad(libm::atan2(offset.y, offset.x) - pose.yaw_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn segment(begin_rad: f64, extent_rad: f64) -> Segment {
        Segment {
            begin_rad,
            extent_rad,
            elevation_rad: Some(-0.1),
            height_m: Some(0.1),
            width_m: 7.0 * extent_rad,
            verdict: Verdict::Valid,
        }
    }

    #[test]
    fn a_narrow_segment_has_its_centre_and_a_wide_one_n_minus_one() {
        let config = PlannerConfig::default().segments;
        let least = 0.685 + config.safety_margin_m;
        let narrow: Vec<f64> = spread_azimuths(&segment(3.0, 2.9 * least / 7.0), 0.685, &config).collect();
        assert_eq!(narrow.len(), 1);
        assert!((narrow[0] - wrap_rad(3.0 + 1.45 * least / 7.0)).abs() < 1e-12);
        let wide: Vec<f64> = spread_azimuths(&segment(0.0, 5.5 * least / 7.0), 0.685, &config).collect();
        assert_eq!(wide.len(), 4);
        assert!((wide[1] - wide[0] - 1.1 * least / 7.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn the_world_position_has_the_bearing_and_range_of_its_direction(
            azimuth in -3.1..3.1_f64, elevation in -0.25..0.25_f64, yaw in -3.0..3.0_f64,
            x in -10.0..10.0_f64,
        ) {
            let pose = Pose { position_m: DVec3::new(x, 2.0, 1.0), roll_rad: 0.0, pitch_rad: 0.0, yaw_rad: yaw };
            let mount = SensorModel::default();
            let point = world_position_m(&pose, &mount, azimuth, elevation, 7.0);
            prop_assert!((bearing_rad(&pose, point.truncate()) - azimuth).abs() < 1e-9);
            let sensor = pose.position_m + DVec3::new(0.0, 0.0, mount.height_m);
            prop_assert!(((point - sensor).length() - 7.0).abs() < 1e-9);
            prop_assert!((point.z - sensor.z - 7.0 * libm::sin(elevation)).abs() < 1e-9);
        }
    }
}
