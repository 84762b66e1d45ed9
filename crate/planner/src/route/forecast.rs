//! The forecast of a path: length, climb and tilt, predicted from the elevation window.

/// The predicted length, climb and tilt of a path.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub struct Forecast {
    /// Straight distance from the robot to the end of the path.
    pub reach_m: f64,
    /// Length of the path.
    pub path_m: f64,
    /// Metres up and down along the path, summed.
    pub climb_m: f64,
    /// Mean over the path's places of (slope / slope at the limit)², for the worse of roll and pitch; a place
    /// in a penalised area counts 2 more for each penalty.
    pub mean_risk: f64,
    /// Largest predicted |roll| on the path.
    pub max_roll_rad: f64,
    /// Largest predicted |pitch| on the path.
    pub max_pitch_rad: f64,
    /// Why the path ends before the requested distance.
    pub end: ReachEnd,
}

/// Why a path ends where it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ReachEnd {
    /// The requested distance is reached.
    #[default]
    Whole,
    /// The next place exceeds a tilt limit, margin included.
    Tilt,
    /// The ground beyond was not seen.
    Unseen,
}
