//! The tilt that a straight path to a subgoal promises, from the ground the last scans saw.
//!
//! Safety is the paper's: |roll| and |pitch| inside the robot's limits. The paper judges a subgoal by its height at
//! r_oc alone; this looks at the way there. Each place along it is a chance constraint: predicted tilt plus a multiple of
//! its standard deviation must stay below a share of the limit.

use glam::DVec2;

use crate::config::{ForecastConfig, TiltLimits};
use crate::ground::Ground;

/// What a straight path promises.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Forecast {
    /// How far the path is known and within the limits.
    pub reach_m: f64,
    /// Height of the ground there, world frame.
    pub reach_height_m: f64,
    /// Mean over the reach of (tilt / limit)², the worse of roll and pitch at each place.
    pub mean_risk: f64,
    /// Largest predicted |roll| over the reach.
    pub max_roll_rad: f64,
    /// Largest predicted |pitch| over the reach.
    pub max_pitch_rad: f64,
    /// Share of the reach that no scan has seen.
    pub unseen_share: f64,
    /// Why the reach ends before the end of the path.
    pub end: ReachEnd,
}

/// Why a forecast ends where it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ReachEnd {
    /// The whole path is fine.
    #[default]
    Whole,
    /// The next place would tilt the robot too far.
    Tilt,
    /// Nothing was seen of the ground beyond.
    Unseen,
}

/// Follows the straight path from `from_m` (where the ground has height `from_height_m`) in `direction` (unit) for
/// `length_m`.
pub(crate) fn forecast(
    ground: &Ground,
    config: &ForecastConfig,
    limits: &TiltLimits,
    from_m: DVec2,
    from_height_m: f64,
    direction: DVec2,
    length_m: f64,
) -> Forecast {
    let mut result = Forecast::default();
    let mut known = (0.0, from_height_m);
    let (mut risk_sum, mut samples, mut unseen) = (0.0, 0.0, 0.0);
    let steps = (length_m / config.step_m).ceil() as usize;
    for step in 1..=steps {
        let distance = (config.step_m * step as f64).min(length_m);
        let Some(plane) = ground.plane_at(from_m + direction * distance) else { continue };
        let gap = distance - known.0;
        // Close to the robot the sensor is blind: ground that no beam can reach is bridged, further gaps are not.
        let bridge = if known.0 == 0.0 { config.blind_radius_m } else { config.max_gap_m };
        if gap > bridge {
            break;
        }
        let across = DVec2::new(-direction.y, direction.x);
        let mut pitch = libm::atan(plane.gradient.dot(direction)).abs();
        if gap > 1.5 * config.step_m {
            pitch = pitch.max(libm::atan((plane.height_m - known.1).abs() / gap));
        }
        let roll = libm::atan(plane.gradient.dot(across)).abs();
        let margin = config.deviations * plane.gradient_deviation;
        let limit_share = ((roll + margin) / limits.roll_rad).max((pitch + margin) / limits.pitch_rad);
        if limit_share > config.max_limit_share {
            result.end = ReachEnd::Tilt;
            break;
        }
        unseen += gap - config.step_m.min(gap);
        let risk = (roll / limits.roll_rad).max(pitch / limits.pitch_rad);
        risk_sum += risk * risk;
        samples += 1.0;
        result.max_roll_rad = result.max_roll_rad.max(roll);
        result.max_pitch_rad = result.max_pitch_rad.max(pitch);
        known = (distance, plane.height_m);
    }
    (result.reach_m, result.reach_height_m) = known;
    if result.end == ReachEnd::Whole && known.0 + config.max_gap_m < length_m {
        result.end = ReachEnd::Unseen;
    }
    if samples > 0.0 {
        result.mean_risk = risk_sum / samples;
        result.unseen_share = unseen / known.0;
    }
    result
}
