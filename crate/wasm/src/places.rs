//! Places on the ground as they cross: seen from above, x east and y north, in metres.

use glam::DVec2;
use mapless_trials::StartPose;
use serde::{Deserialize, Serialize};
use tsify::Tsify;

/// A place seen from above.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, Tsify)]
pub struct Place {
    x: f64,
    y: f64,
}

impl From<DVec2> for Place {
    fn from(place_m: DVec2) -> Self {
        Self { x: place_m.x, y: place_m.y }
    }
}

impl From<Place> for DVec2 {
    fn from(place: Place) -> Self {
        Self::new(place.x, place.y)
    }
}

/// A place and which way the robot faces there.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, Tsify)]
pub struct Heading {
    x: f64,
    y: f64,
    /// Counter-clockwise from east.
    heading_rad: f64,
}

impl From<StartPose> for Heading {
    fn from(start: StartPose) -> Self {
        Self { x: start.position_m.x, y: start.position_m.y, heading_rad: start.heading_rad }
    }
}

impl From<Heading> for StartPose {
    fn from(heading: Heading) -> Self {
        Self { position_m: DVec2::new(heading.x, heading.y), heading_rad: heading.heading_rad }
    }
}

/// Where to drive at last.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, Tsify)]
pub struct Goal {
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// The heading to end with, counter-clockwise from east; any heading without it.
    #[tsify(optional)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) heading_rad: Option<f64>,
}

impl Goal {
    pub(crate) fn new(place_m: DVec2, heading_rad: Option<f64>) -> Self {
        Self { x: place_m.x, y: place_m.y, heading_rad }
    }
}

/// Where to drive: to each waypoint in turn, then to the goal.
#[derive(Clone, Debug, Deserialize, Tsify)]
pub struct Route {
    #[tsify(type = "readonly Place[]")]
    pub(crate) waypoints: Vec<Place>,
    pub(crate) goal: Goal,
}
