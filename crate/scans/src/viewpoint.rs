//! The viewpoint of a PCD file: the pose of the sensor.
//!
//! Some programs write points in the world's frame beside it, others points in the sensor's own frame, and no
//! entry of the header says which. The beams of a sensor do: they have few elevations, so the points lie on
//! cones about the sensor in its own frame alone.
//!
//! Either way the points come out in a level frame at the sensor that faces where the sensor faces, because
//! the viewpoint says how far the sensor is tilted.

use glam::{DMat3, DQuat, DVec3};

use crate::cloud_warning::CloudWarning;
use crate::error::ScanFault;

/// Fewer points do not show the cones.
const LEAST_POINTS: usize = 100;
/// How much more crowded the elevations must be in one frame than in the other.
const CLEARLY: f64 = 3.0;
/// Number of bins of the elevations.
const BINS: usize = 500;
/// Smallest sine of an elevation that counts: a flat floor at the height of the origin is no cone.
const LEAST_SINE: f64 = 1e-3;
/// Largest distance of a sensor from the middle of its points, in their standard deviations.
const MOST_DEVIATIONS: f64 = 3.0;
/// Largest deviation of a quaternion's length from 1 that is rounding.
const ROUNDING: f64 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Viewpoint {
    at_m: DVec3,
    /// From the sensor's frame to the one of its pose.
    turn: DQuat,
}

/// The frame that points were written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Frame {
    World,
    Sensor,
    Unclear,
}

impl Viewpoint {
    pub(crate) const NONE: Self = Self { at_m: DVec3::ZERO, turn: DQuat::IDENTITY };

    /// From the values of the entry: x y z, and the quaternion with its real part first.
    pub(crate) fn new(values: &[f64], warnings: &mut Vec<CloudWarning>) -> Result<Self, ScanFault> {
        let written = || values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let &[x, y, z, qw, qx, qy, qz] = values else {
            return Err(ScanFault::value("VIEWPOINT", written(), "seven numbers: x y z qw qx qy qz"));
        };
        let quaternion = DQuat::from_xyzw(qx, qy, qz, qw);
        let length = quaternion.length();
        if !(DVec3::new(x, y, z).is_finite() && length.is_finite()) {
            return Err(ScanFault::value("VIEWPOINT", written(), "finite numbers"));
        }
        let mut doubt =
            |taken_for| warnings.push(CloudWarning::Quaternion { viewpoint: written(), taken_for });
        let turn = if length < ROUNDING {
            doubt("no rotation");
            DQuat::IDENTITY
        } else {
            if (length - 1.0).abs() > ROUNDING {
                doubt("the same at length 1");
            }
            quaternion / length
        };
        Ok(Self { at_m: DVec3::new(x, y, z), turn })
    }

    /// Brings points into a level frame at the sensor that faces where the sensor faces.
    pub(crate) fn apply(self, points_m: &mut [DVec3], warnings: &mut Vec<CloudWarning>) {
        if self == Self::NONE {
            return;
        }
        let level = heading(self.turn).transpose();
        let frame = self.frame(points_m);
        if frame == Frame::Unclear {
            warnings.push(CloudWarning::Viewpoint);
        }
        for point in points_m {
            *point = level
                * match frame {
                    Frame::Sensor => self.turn * *point,
                    Frame::World | Frame::Unclear => *point - self.at_m,
                };
        }
    }

    fn frame(self, points_m: &[DVec3]) -> Frame {
        let back = self.turn.conjugate();
        let sensor = crowding(points_m.iter().copied());
        let world = crowding(points_m.iter().map(|point| back * (*point - self.at_m)));
        if sensor > CLEARLY * world {
            Frame::Sensor
        } else if world > CLEARLY * sensor {
            Frame::World
        } else {
            Frame::Unclear
        }
    }
}

/// The turn about z alone that faces where `turn` faces.
fn heading(turn: DQuat) -> DMat3 {
    let ahead = turn * DVec3::X;
    let ahead = DVec3::new(ahead.x, ahead.y, 0.0).normalize_or(DVec3::X);
    DMat3::from_cols(ahead, DVec3::new(-ahead.y, ahead.x, 0.0), DVec3::Z)
}

/// The chance that two points have the same elevation, to a bin; 0 if there are too few points, or if they
/// are far from the origin, from where all elevations look alike.
fn crowding(points_m: impl Iterator<Item = DVec3>) -> f64 {
    let (mut sines, mut sum_m, mut square_sum) = (Vec::new(), DVec3::ZERO, 0.0);
    for point in points_m {
        let sine = point.z / point.length();
        if sine.abs() >= LEAST_SINE {
            sines.push(sine);
            sum_m += point;
            square_sum += point.length_squared();
        }
    }
    let count = sines.len() as f64;
    let mean_square = (sum_m / count).length_squared();
    let is_far = mean_square > MOST_DEVIATIONS * MOST_DEVIATIONS * (square_sum / count - mean_square);
    if sines.len() < LEAST_POINTS || is_far {
        return 0.0;
    }
    sines.sort_unstable_by(f64::total_cmp);
    // Without a few stray ones at both ends.
    let sines = &sines[sines.len() / 50..sines.len() - sines.len() / 50];
    let (low, high) = (sines[0], sines[sines.len() - 1]);
    let mut bins = [0_u32; BINS];
    for sine in sines {
        let bin = (sine - low) / (high - low) * BINS as f64;
        bins[(bin as usize).min(BINS - 1)] += 1;
    }
    let chances = bins.into_iter().map(|count| f64::from(count) / sines.len() as f64);
    chances.map(|chance| chance * chance).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;
    use glam::EulerRot;
    use proptest::prelude::*;

    /// What a sensor of 16 beams sees of a floor below it and of walls around it, in its own frame.
    fn seen(tilt: DQuat) -> Vec<DVec3> {
        let beams =
            (0..1600).map(|beam| (f64::from(beam / 16) / 100.0 * TAU, f64::from(beam % 16) * 2.0 - 15.0));
        let directions = beams.map(|(azimuth, degrees)| {
            let (sin, cos) = libm::sincos(azimuth);
            let (up, level) = libm::sincos(degrees.to_radians());
            DVec3::new(level * cos, level * sin, up)
        });
        let ranges = directions.map(|direction| {
            let level = tilt * direction;
            let floor_m = if level.z < 0.0 { -0.8 / level.z } else { 30.0 };
            direction * floor_m.min(4.0 + 3.0 * libm::sin(7.0 * level.x).abs())
        });
        ranges.collect()
    }

    fn applied(viewpoint: Viewpoint, points: impl Iterator<Item = DVec3>) -> (Vec<DVec3>, Vec<CloudWarning>) {
        let (mut points, mut warnings) = (points.collect::<Vec<_>>(), Vec::new());
        viewpoint.apply(&mut points, &mut warnings);
        (points, warnings)
    }

    fn new(values: &[f64]) -> (Result<Viewpoint, String>, Vec<CloudWarning>) {
        let mut warnings = Vec::new();
        (Viewpoint::new(values, &mut warnings).map_err(|fault| fault.to_string()), warnings)
    }

    #[test]
    fn without_a_viewpoint_nothing_changes() {
        let points = seen(DQuat::IDENTITY);
        assert_eq!(applied(Viewpoint::NONE, points.iter().copied()), (points, Vec::new()));
    }

    #[test]
    fn points_that_do_not_show_their_frame_are_taken_as_the_worlds() {
        let viewpoint = new(&[1.0, 2.0, 3.0, 0.5_f64.sqrt(), 0.0, 0.0, 0.5_f64.sqrt()]).0.unwrap();
        let (points, warnings) = applied(viewpoint, [DVec3::new(1.0, 4.0, 3.0)].into_iter());
        assert!(points[0].distance(DVec3::new(2.0, 0.0, 0.0)) < 1e-9, "{points:?}");
        assert_eq!(warnings, [CloudWarning::Viewpoint]);
    }

    #[test]
    fn a_quaternion_that_is_no_rotation_is_doubted() {
        let written = "0 0 0 0 0 0 0";
        let (zero, warnings) = new(&[0.0; 7]);
        assert_eq!(zero, Ok(Viewpoint::NONE));
        let doubt = |taken_for| CloudWarning::Quaternion { viewpoint: written.to_owned(), taken_for };
        assert_eq!(warnings, [doubt("no rotation")]);
        let (double, warnings) = new(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0]);
        assert_eq!((double, warnings.len()), (Ok(Viewpoint::NONE), 1));
        assert!(new(&[0.0, 0.0, 0.0, 0.98480775, 0.0, 0.17364818, 0.0]).1.is_empty(), "rounding");
        let infinite = new(&[0.0, 0.0, f64::NAN, 1.0, 0.0, 0.0, 0.0]).0.unwrap_err();
        assert_eq!(infinite, "VIEWPOINT = 0 0 NaN 1 0 0 0: expected finite numbers");
        assert_eq!(new(&[1.0]).0.unwrap_err(), "VIEWPOINT = 1: expected seven numbers: x y z qw qx qy qz");
    }

    proptest! {
        #[test]
        fn points_of_either_frame_come_out_level_and_facing_ahead(
            at in prop::array::uniform3(-300.0..300.0_f64), yaw in -3.0..3.0_f64, pitch in 0.1..0.5_f64,
            roll in -0.5..0.5_f64,
        ) {
            let tilt = DQuat::from_euler(EulerRot::ZYX, 0.0, pitch, roll);
            let turn = DQuat::from_rotation_z(yaw) * tilt;
            let viewpoint = Viewpoint { at_m: DVec3::from_array(at), turn };
            let points = seen(tilt);
            let expected: Vec<DVec3> = points.iter().map(|point| tilt * *point).collect();
            let world = applied(viewpoint, points.iter().map(|point| turn * *point + viewpoint.at_m));
            for (found, warnings) in [applied(viewpoint, points.iter().copied()), world] {
                prop_assert!(warnings.is_empty());
                for (found, expected) in found.iter().zip(&expected) {
                    prop_assert!(found.distance(*expected) < 1e-9);
                }
            }
        }
    }
}
