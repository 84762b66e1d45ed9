//! Warnings of point clouds.

use std::fmt;

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
