//! The closed loop for the page: [`Trial`](mapless_trials::Trial) behind plain objects and typed arrays.
//!
//! Nothing is decided here. All numbers are in SI units and radians, in the frames of `mapless-world`. What
//! crosses has a struct of its own, whose TypeScript is made from it: `web/src/wasm/mapless_wasm.d.ts`.

mod decision;
mod objects;
mod opening;
mod parameters;
mod places;
mod returns;
mod session;
mod shared;
mod sight;
mod stroke;
mod terrain;

pub use decision::{
    Activity, Cost, Forecast, PathPoint, ReachEnd, Refusal, Segment, Subgoal, Velocity, Verdict,
};
pub use objects::{ObjectList, Solid, SolidList};
pub use opening::{Learning, Preset, ScenarioRead, SessionOptions, TextFile, read_scenario};
pub use parameters::{Parameter, ParameterGroup, ParameterKind, PresetValue};
pub use places::{Goal, Heading, Place, Route};
pub use returns::SetAside;
pub use session::{
    ClimbStep, Frame, HeadingThere, Inside, InsideQuestion, PlaceReport, Placement, Scene, Session, Standing,
    ThinkingWith, Thought, Tick, Timeline,
};
pub use shared::{Metrics, Outcome, OverrideValue, Overrides, Pose};
pub use sight::{FrameBuffers, ImageSize, Mount, Point, SegmentDemands, SensorPose, TiltLimits};
pub use stroke::{Stroke, StrokeKind};
pub use terrain::{
    Ground, GroundPatch, ImportRequest, LevelPlaces, TerrainFiles, TerrainPreview, generated_recipe,
    import_of, level_places, terrain_preview,
};

use wasm_bindgen::prelude::wasm_bindgen;

/// Runs once when the page loads the module.
#[wasm_bindgen(start)]
pub fn start() {
    shared::panic::install_hook();
}
