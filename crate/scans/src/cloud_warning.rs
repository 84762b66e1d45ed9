//! Warnings of point clouds.

use std::fmt;

use glam::Vec3;

use crate::scan::{Scan, ScanWarning};

/// What is doubtful about a point cloud that could be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CloudWarning {
    /// The file says another number of points than it has.
    Count {
        /// Where it says so.
        place: String,
        /// The number there.
        said: usize,
        /// The number of points that were read.
        read: usize,
    },
    /// The quaternion of a PCD's viewpoint is no rotation.
    Quaternion {
        /// The viewpoint as it is written.
        viewpoint: String,
        /// What the quaternion was taken for.
        taken_for: &'static str,
    },
    /// The points do not show whether they are in the world's frame or in the sensor's.
    Viewpoint,
    /// No return is near enough for the planner to see ground.
    OutOfReach {
        /// How far the planner looks at the ground, metres.
        reach: String,
        /// Distance of the nearest return, metres.
        nearest: String,
    },
}

impl fmt::Display for CloudWarning {
    fn fmt(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { place, said, read } => {
                write!(text, "{place} says {said} points; the {read} that are there were read")
            }
            Self::Quaternion { viewpoint, taken_for } => {
                write!(
                    text,
                    "VIEWPOINT = {viewpoint}: its quaternion has not the length 1; taken for {taken_for}"
                )
            }
            Self::Viewpoint => write!(
                text,
                "VIEWPOINT was taken for the sensor's pose in the frame of the points; their elevations do not show \
                 whether they are in that frame or in the sensor's own"
            ),
            Self::OutOfReach { reach, nearest } => write!(
                text,
                "no return within {reach} m, the nearest is {nearest} m away: are the points in millimetres, or in \
                 another frame than the sensor's?"
            ),
        }
    }
}

impl Scan {
    /// A word when no return is within `reach_m` of the sensor, the distance in which the planner looks at
    /// the ground. Returns nearer than `min_range_m`, the least range of the sensor, are none.
    pub fn out_of_reach(&self, min_range_m: f64, reach_m: f64) -> Option<ScanWarning> {
        let ranges_m = self.points_m.iter().map(|point: &Vec3| point.as_dvec3().length());
        let nearest_m = ranges_m.filter(|range_m| *range_m >= min_range_m).reduce(f64::min)?;
        (nearest_m > reach_m).then(|| {
            let (reach, nearest) = (reach_m.to_string(), format!("{nearest_m:.1}"));
            ScanWarning::Cloud(CloudWarning::OutOfReach { reach, nearest })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_said_when_nothing_is_within_reach() {
        let word = |points_m: &[Vec3]| {
            let scan = Scan::from(points_m.to_vec());
            scan.out_of_reach(0.5, 7.0).map(|warning| warning.to_string())
        };
        let far = [Vec3::new(1700.0, 0.0, -700.0), Vec3::new(0.0, 3000.0, -700.0)];
        let said = word(&far).unwrap();
        assert!(said.starts_with("no return within 7 m, the nearest is 1838.5 m away: "), "{said}");
        assert_eq!(word(&[far[0], Vec3::ZERO, Vec3::X * 0.4]), Some(said), "too near to be returns");
        assert_eq!(word(&[far[0], Vec3::X * 6.9]), None);
        assert_eq!(word(&[Vec3::ZERO]), None, "an empty scan is another matter");
        assert_eq!(word(&[]), None);
    }
}
