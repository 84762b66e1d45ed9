//! The robot's attitude: slopes now, extrapolated in time, and after a turn.

use core::time::Duration;

use glam::DVec2;

use crate::pose::Pose;
use crate::terrain::slopes::Slopes;

/// A turn is checked in steps of this size.
const TURN_STEP_RAD: f64 = 0.05;

/// The attitude estimate from the poses, more exact than that of any ground ahead.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AttitudeEstimate {
    pub(crate) height_m: f64,
    /// Gradient of the plane under the robot, in the world.
    pub(crate) gradient: DVec2,
    /// Slope ahead and to the left, its change since the last pose, and the time of that change.
    slope: DVec2,
    change: DVec2,
    elapsed: Duration,
    is_known: bool,
}

impl AttitudeEstimate {
    /// Updates the estimate with a pose.
    pub(crate) fn be_at(&mut self, pose: &Pose, elapsed: Duration) {
        let up = pose.world_from_robot().z_axis;
        let gradient = -up.truncate() / up.z;
        let (sin, cos) = libm::sincos(pose.yaw_rad);
        let ahead = DVec2::new(cos, sin);
        let slope = DVec2::new(gradient.dot(ahead), gradient.dot(ahead.perp()));
        let change = if self.is_known { slope - self.slope } else { DVec2::ZERO };
        *self = Self { height_m: pose.position_m.z, gradient, slope, change, elapsed, is_known: true };
    }

    /// The present slopes.
    pub(crate) fn slopes(&self) -> Slopes {
        slopes(self.slope)
    }

    /// For each axis the larger of the present slope and the slope extrapolated over `time` at the present
    /// rate.
    pub(crate) fn slopes_within(&self, time: Duration) -> Slopes {
        if self.elapsed.is_zero() {
            return self.slopes();
        }
        let times = time.as_nanos() as f64 / self.elapsed.as_nanos() as f64;
        slopes(self.slope + times * self.change).max(self.slopes())
    }

    /// The largest part of a turn on the spot, anticlockwise, that keeps the slopes within `allowed` or no
    /// steeper than now, if the ground is a plane.
    pub(crate) fn safe_turn_rad(&self, turn_rad: f64, allowed: &Slopes) -> f64 {
        let most = allowed.max(self.slopes());
        let count = (turn_rad.abs() / TURN_STEP_RAD).ceil();
        let step_rad = if count > 0.0 { turn_rad / count } else { 0.0 };
        let is_safe = |step: i32| {
            let (sin, cos) = libm::sincos(f64::from(step) * step_rad);
            // The ground turns the opposite direction under the robot.
            slopes(DVec2::new(cos, -sin).rotate(self.slope)).within(&most, 0.0)
        };
        let steps = (1..=count as i32).take_while(|&step| is_safe(step)).count();
        steps as f64 * step_rad
    }
}

/// Slopes from that ahead and that to the left.
fn slopes(slope: DVec2) -> Slopes {
    Slopes { along: slope.x.abs(), across: slope.y.abs() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_PI_2, PI};
    use glam::DVec3;

    const STEP: Duration = Duration::from_millis(100);
    const ALLOWED: Slopes = Slopes { across: 0.5, along: 0.9 };

    fn standing(roll_rad: f64, pitch_rad: f64, yaw_rad: f64) -> AttitudeEstimate {
        let mut standing = AttitudeEstimate::default();
        standing.be_at(&Pose::from_roll_pitch_yaw(DVec3::ZERO, roll_rad, pitch_rad, yaw_rad), STEP);
        standing
    }

    #[test]
    fn a_slope_that_is_fine_to_face_may_be_too_steep_to_turn_on() {
        for yaw_rad in [0.0, 1.0, -2.5] {
            let gentle = standing(0.0, 0.4, yaw_rad);
            assert!((gentle.safe_turn_rad(PI, &ALLOWED) - PI).abs() < 1e-12);
            let steep = standing(0.0, libm::atan(0.8), yaw_rad);
            for side in [1.0, -1.0] {
                // Across it has 0.8 sin(turn).
                let most_rad = libm::asin(0.5 / 0.8);
                let turn_rad = side * steep.safe_turn_rad(side * FRAC_PI_2, &ALLOWED);
                assert!(turn_rad <= most_rad && turn_rad > most_rad - TURN_STEP_RAD, "{turn_rad}");
            }
        }
    }

    #[test]
    fn a_turn_out_of_what_is_too_steep_is_safe_and_one_further_into_it_is_not() {
        // Right side up, nose a little up: anticlockwise the nose turns uphill.
        let banked = standing(-0.52, 0.2, 0.3);
        let (into_rad, out_rad) = (banked.safe_turn_rad(1.0, &ALLOWED), banked.safe_turn_rad(-0.6, &ALLOWED));
        assert!(into_rad.abs() < 1e-12 && (out_rad + 0.6).abs() < 1e-12, "{into_rad} {out_rad}");
    }

    #[test]
    fn a_change_counts_on_each_axis_and_to_the_side_it_goes() {
        let pose = |roll_rad: f64, pitch_rad: f64| Pose {
            position_m: DVec3::ZERO,
            roll_rad,
            pitch_rad,
            yaw_rad: 0.4,
        };
        let mut standing = AttitudeEstimate::default();
        standing.be_at(&pose(0.3, 0.1), STEP);
        assert_eq!(standing.slopes_within(5 * STEP), standing.slopes(), "nothing is known to change yet");
        // Over a crest, with more roll than pitch all the time.
        standing.be_at(&pose(0.3, 0.0), STEP);
        let soon = standing.slopes_within(5 * STEP);
        assert!(
            (soon.along - 0.5).abs() < 0.02 && (soon.across - standing.slopes().across).abs() < 0.05,
            "{soon:?}"
        );
    }
}
