//! What the way to a subgoal promises, from the ground that the last scans saw.

/// What a way promises.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Forecast {
    /// Straight distance from the robot to where the way ends.
    pub reach_m: f64,
    /// Length of the way.
    pub path_m: f64,
    /// What it goes up and down.
    pub climb_m: f64,
    /// Mean over the way of (slope / slope at the limit)², the worse of roll and pitch at each place, and 2 for each time that the place
    /// turned out steeper than it had looked.
    pub mean_risk: f64,
    /// Largest predicted |roll| on the way.
    pub max_roll_rad: f64,
    /// Largest predicted |pitch| on the way.
    pub max_pitch_rad: f64,
    /// Why it ends before the distance that was asked for.
    pub end: ReachEnd,
}

/// Why a way ends where it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ReachEnd {
    /// It goes as far as asked.
    #[default]
    Whole,
    /// The next place would tilt the robot too far.
    Tilt,
    /// Nothing was seen of the ground beyond.
    Unseen,
}
