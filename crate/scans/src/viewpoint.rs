//! The viewpoint of a PCD file: the pose of the sensor.
//!
//! Some programs write points in the world's frame beside it, others points in the sensor's own frame, and no
//! entry of the header says which. The beams of a sensor do: they have few elevations, so the points lie on
//! cones about the sensor in its own frame alone.
//!
//! Either way the points come out in a level frame at the sensor that faces where the sensor faces, because
//! the viewpoint says how far the sensor is tilted.

use glam::{DMat3, DQuat, DVec3};

use crate::error::ScanFault;

/// Fewer points do not show the cones.
const LEAST_POINTS: usize = 100;
/// How much more crowded the elevations must be in one frame than in the other.
const CLEARLY: f64 = 3.0;
/// Number of bins of the elevations.
const BINS: usize = 500;
/// Smallest sine of an elevation that counts: a flat floor at the height of the origin is no cone.
const LEAST_SINE: f64 = 1e-3;
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
    pub(crate) fn new(values: &[f64], warnings: &mut Vec<String>) -> Result<Self, ScanFault> {
        let written = || values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let &[x, y, z, qw, qx, qy, qz] = values else {
            return Err(ScanFault::value("VIEWPOINT", written(), "seven numbers: x y z qw qx qy qz"));
        };
        let quaternion = DQuat::from_xyzw(qx, qy, qz, qw);
        let length = quaternion.length();
        if !(DVec3::new(x, y, z).is_finite() && length.is_finite()) {
            return Err(ScanFault::value("VIEWPOINT", written(), "finite numbers"));
        }
        let turn = if length == 0.0 {
            warnings.push(format!("VIEWPOINT = {}: its quaternion is 0, taken as no rotation", written()));
            DQuat::IDENTITY
        } else {
            if (length - 1.0).abs() > ROUNDING {
                warnings.push(format!(
                    "VIEWPOINT = {}: its quaternion is {length:.3} long, taken as if it were 1",
                    written()
                ));
            }
            quaternion / length
        };
        Ok(Self { at_m: DVec3::new(x, y, z), turn })
    }

    /// Brings points into a level frame at the sensor that faces where the sensor faces.
    pub(crate) fn apply(self, points_m: &mut [DVec3], warnings: &mut Vec<String>) {
        if self == Self::NONE {
            return;
        }
        let level = heading(self.turn).transpose();
        let frame = self.frame(points_m);
        if frame == Frame::Unclear {
            warnings.push(
                "the VIEWPOINT was taken as the sensor's pose in the frame of the points, but they may be in the \
                 sensor's own frame: their elevations do not show it"
                    .to_owned(),
            );
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

/// The chance that two points have the same elevation, to a bin; 0 if there are too few points.
fn crowding(points_m: impl Iterator<Item = DVec3>) -> f64 {
    let sines = points_m.map(|point| point.z / point.length());
    let mut sines: Vec<f64> = sines.filter(|sine| sine.abs() >= LEAST_SINE).collect();
    if sines.len() < LEAST_POINTS {
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
    bins.into_iter().map(|count| (f64::from(count) / sines.len() as f64).powi(2)).sum()
}
