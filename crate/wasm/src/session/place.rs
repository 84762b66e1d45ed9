//! Why the robot would or would not stand at a place.

use core::f64::consts::TAU;

use glam::{DVec2, DVec3};
use mapless_world::ContactKind;
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::Session;
use crate::places::Place;
use crate::shared::{give, read};

/// As many headings as the planner's lattice has.
const HEADINGS: usize = 16;

/// What is true of a place, and what the scan in view saw of it.
#[derive(Debug, Serialize, Tsify)]
pub struct PlaceReport {
    /// Seen from above, from the place to the nearest return; absent without returns.
    nearest_return_m: Option<f64>,
    /// Evenly around the circle, from east counter-clockwise; empty off the terrain.
    headings: Vec<HeadingThere>,
}

/// How the robot would stand with one heading, by the true ground.
#[derive(Debug, Serialize, Tsify)]
pub struct HeadingThere {
    heading_rad: f64,
    roll_rad: f64,
    pitch_rad: f64,
    is_too_steep: bool,
    /// What the body would do there, as `run into an object`, if anything.
    touches: Option<&'static str>,
}

#[wasm_bindgen]
impl Session {
    /// Tells of a place on the ground.
    ///
    /// # Errors
    /// None, unless JavaScript runs out of memory.
    pub fn place_report(&self, place: Ts<Place>) -> Result<Ts<PlaceReport>, JsError> {
        let place_m = DVec2::from(read(place)?);
        let shown = self.shown();
        let mapless_world::SensorPose { position, world_from_sensor } = shown.scanned_from;
        let apart = |point: DVec3| (position + world_from_sensor * point).truncate().distance(place_m);
        let nearest = shown.trial.scan().points.iter().map(|point| apart(point.as_dvec3()));
        let headings = (0..HEADINGS).filter_map(|index| {
            let heading_rad = TAU * index as f64 / HEADINGS as f64;
            let stance = shown.trial.stance_at(place_m, heading_rad)?;
            Some(HeadingThere {
                heading_rad,
                roll_rad: stance.attitude.roll_rad,
                pitch_rad: stance.attitude.pitch_rad,
                is_too_steep: stance.is_too_steep,
                touches: stance.contact.map(|contact| match (contact.object, contact.kind) {
                    (Some(_), _) => "run into an object",
                    (None, ContactKind::Step) => "stop a wheel at a step",
                    (None, ContactKind::Collision | ContactKind::HighCentred) => "set the belly down",
                }),
            })
        });
        give(&PlaceReport { nearest_return_m: nearest.min_by(f64::total_cmp), headings: headings.collect() })
    }
}
