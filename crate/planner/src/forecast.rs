//! The tilt that a straight path to a subgoal promises, from the ground the last scans saw.
//!
//! Safety is the paper's: |roll| and |pitch| inside the robot's limits. The paper judges a subgoal by its height at
//! r_oc alone; this looks at the way there. Each place along it is a chance constraint: predicted tilt plus a multiple of
//! its standard deviation must stay below a share of the limit.

use glam::DVec2;

use crate::config::{ForecastConfig, TiltLimits};
use crate::plane::Plane;
use crate::pose::Pose;

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

/// The robot at the start of a path.
pub(crate) struct Standing<'a> {
    pub(crate) pose: &'a Pose,
    /// Unit vector of the path, seen from above.
    pub(crate) direction: DVec2,
}

/// Slope of the ground along and across a path, at a distance along it.
#[derive(Clone, Copy)]
struct Station {
    distance_m: f64,
    height_m: f64,
    slope_along: f64,
    slope_across: f64,
    slope_deviation: f64,
}

/// Follows the straight path from where the robot stands for `length_m`, over the ground that `plane_at` knows.
pub(crate) fn forecast(
    plane_at: &dyn Fn(DVec2) -> Option<Plane>,
    config: &ForecastConfig,
    limits: &TiltLimits,
    standing: &Standing<'_>,
    length_m: f64,
) -> Forecast {
    let mut result = Forecast::default();
    let mut last = standing.station();
    // A robot that already stands on steep ground may leave it, if that gets no steeper.
    let standing_share = limit_share(&last, config, limits);
    let mut risk_sum = 0.0;
    let mut samples = 0.0;
    let mut unseen_m = 0.0;
    let (mut steepest_across, mut steepest_along) = (0.0_f64, 0.0_f64);
    let steps = (length_m / config.step_m).ceil() as usize;
    for step in 1..=steps {
        let distance_m = (config.step_m * step as f64).min(length_m);
        let place = standing.pose.plan_m() + standing.direction * distance_m;
        let Some(plane) = plane_at(place) else { continue };
        let gap_m = distance_m - last.distance_m;
        // No beam reaches the ground that begins at the wheels; until it has driven on, that is bridged.
        let at_the_wheels = last.distance_m <= config.max_gap_m;
        let bridge_m = if at_the_wheels { config.blind_radius_m } else { config.max_gap_m };
        if gap_m > bridge_m + config.step_m {
            break;
        }
        let here = Station {
            distance_m,
            height_m: plane.height_m,
            slope_along: plane.gradient.dot(standing.direction),
            slope_across: plane.gradient.dot(standing.direction.perp()),
            slope_deviation: plane.gradient_deviation,
        };
        let allowed = if distance_m < config.escape_m {
            config.max_limit_share.max(standing_share)
        } else {
            config.max_limit_share
        };
        let stations = bridge(&last, &here, config.step_m);
        if stations.clone().any(|station| limit_share(&station, config, limits) > allowed) {
            result.end = ReachEnd::Tilt;
            break;
        }
        for station in stations {
            let risk = tilt_share(&station, limits);
            risk_sum += risk * risk;
            samples += 1.0;
            steepest_across = steepest_across.max(station.slope_across.abs());
            steepest_along = steepest_along.max(station.slope_along.abs());
        }
        unseen_m += (gap_m - config.step_m).max(0.0);
        last = here;
    }
    result.max_roll_rad = libm::atan(steepest_across);
    result.max_pitch_rad = libm::atan(steepest_along);
    if result.end == ReachEnd::Whole && last.distance_m + config.max_gap_m < length_m {
        result.end = ReachEnd::Unseen;
    }
    // Stop short of what is steep or unseen: the body reaches further than its centre.
    let clearance_m = if result.end == ReachEnd::Whole { 0.0 } else { config.clearance_m };
    result.reach_m = (last.distance_m - clearance_m).max(0.0);
    result.reach_height_m = last.height_m;
    if samples > 0.0 {
        result.mean_risk = risk_sum / samples;
        result.unseen_share = unseen_m / last.distance_m;
    }
    result
}

impl Standing<'_> {
    /// The ground under the wheels.
    fn station(&self) -> Station {
        let up = self.pose.world_from_robot().z_axis;
        let gradient = -up.truncate() / up.z;
        Station {
            distance_m: 0.0,
            height_m: self.pose.position_m.z,
            slope_along: gradient.dot(self.direction),
            slope_across: gradient.dot(self.direction.perp()),
            slope_deviation: 0.0,
        }
    }
}

/// The stations after `from` up to `to`, `step_m` apart: where nothing was seen between, a cubic through both heights
/// and slopes.
fn bridge(from: &Station, to: &Station, step_m: f64) -> impl Iterator<Item = Station> + Clone + use<> {
    let (from, to) = (*from, *to);
    let gap = to.distance_m - from.distance_m;
    let between = (gap / step_m - 0.5).floor().max(0.0) as usize;
    let (d0, d1) = (from.slope_along * gap, to.slope_along * gap);
    let rise = to.height_m - from.height_m;
    (1..=between)
        .map(move |k| {
            let t = k as f64 / (between + 1) as f64;
            // Derivative of the cubic Hermite polynomial.
            let slope =
                6.0 * t * (1.0 - t) * rise + (1.0 - t) * (1.0 - 3.0 * t) * d0 + t * (3.0 * t - 2.0) * d1;
            Station {
                slope_along: slope / gap,
                slope_across: from.slope_across + t * (to.slope_across - from.slope_across),
                ..to
            }
        })
        .chain(core::iter::once(to))
}

/// The greatest share of a tilt limit that driving along here takes up: roll, pitch, and the whole inclination, which
/// becomes roll when the robot turns.
fn tilt_share(station: &Station, limits: &TiltLimits) -> f64 {
    let roll = libm::atan(station.slope_across.abs());
    let pitch = libm::atan(station.slope_along.abs());
    (roll / limits.roll_rad).max(pitch / limits.pitch_rad)
}

/// As [`tilt_share`], with the margin for what is uncertain and room to turn.
fn limit_share(station: &Station, config: &ForecastConfig, limits: &TiltLimits) -> f64 {
    let margin = config.deviations * station.slope_deviation;
    let roll = libm::atan(station.slope_across.abs() + margin);
    let pitch = libm::atan(station.slope_along.abs() + margin);
    let inclination = libm::atan(libm::hypot(station.slope_across, station.slope_along) + margin);
    let turning = inclination * config.turning_share / limits.roll_rad;
    (roll / limits.roll_rad).max(pitch / limits.pitch_rad).max(turning)
}
