//! What changes only between trials and with the route.

use mapless_trials::RealityPreset;
use serde::Serialize;
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::Session;
use crate::places::{Goal, Heading, Place};
use crate::shared::give;
use crate::sight::{ImageSize, Mount, SegmentDemands, TiltLimits};

/// What a scenario is made of, after its files were read.
#[derive(Debug, Serialize, Tsify)]
pub struct Scene {
    /// Of the sensor's noise.
    seed: u64,
    start: Heading,
    /// Driven to one after the other, before the goal.
    waypoints: Vec<Place>,
    goal: Goal,
    /// Time between two ticks.
    period_s: f64,
    limits: TiltLimits,
    /// Radius of the occupancy surface: what lies farther is not looked at.
    occupancy_radius_m: f64,
    mount: Mount,
    image: ImageSize,
    demands: SegmentDemands,
    /// The preset whose values `reality` has, `own` where they are those of none.
    #[tsify(type = "'ideal' | 'field' | 'harsh' | 'own'")]
    reality: &'static str,
}

#[wasm_bindgen]
impl Session {
    /// What changes only between trials and with the route.
    ///
    /// # Errors
    /// A seed beyond the whole numbers of JavaScript.
    pub fn scene(&self) -> Result<Ts<Scene>, JsError> {
        let trial = &self.shown().trial;
        // A new route holds before it is thought about.
        let route = &self.now.trial;
        let config = trial.planner_config();
        give(&Scene {
            seed: self.seed,
            start: route.start().into(),
            waypoints: route.waypoints_m().iter().copied().map(Place::from).collect(),
            goal: Goal::new(route.goal_m(), route.goal_heading_rad()),
            period_s: trial.period_s(),
            limits: TiltLimits::from(&config.robot),
            occupancy_radius_m: config.perception.surface_radius_m,
            mount: Mount::from(&config.sensor),
            image: ImageSize::from(trial.step().observed.grid()),
            demands: SegmentDemands::from(config),
            reality: self.setting().0.reality.matching_preset().map_or("own", RealityPreset::word),
        })
    }
}
