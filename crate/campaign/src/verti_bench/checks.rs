//! What is odd about imported tasks: starts and goals where a robot cannot stand.

use std::path::Path;

use glam::DVec2;
use mapless_terrain::{Terrain, load_terrain};
use mapless_trials::{LoadedScenario, Scenario};
use mapless_world::{Body, Footing, Objects, Robot};

use super::source::Source;
use super::{recipe_file, scenario_file};
use crate::error::CampaignError;

/// A line for each start and goal of an imported world where its robot cannot stand.
///
/// # Errors
/// [`CampaignError`] when what was imported cannot be read.
pub(super) fn of_world(source: &Source, out: &Path) -> Result<Vec<String>, CampaignError> {
    let Source { world, file: described, .. } = source;
    let recipe = recipe_file(world, out);
    let terrain = load_terrain(&recipe).map_err(|error| CampaignError::content(described, error))?;
    let objects = Objects::new(terrain.objects.clone(), &terrain.field);
    let mut warnings = Vec::new();
    for pair in 0..world.pairs.len() {
        let file = scenario_file(world, pair, out);
        let loaded = LoadedScenario::read(&file);
        let scenario = loaded.map_err(|error| CampaignError::content(described, error))?.scenario;
        for (what, place_m) in [("start", scenario.start.position_m), ("goal", scenario.goal_m)] {
            if let Some(fault) = fault_at(place_m, &scenario, &terrain, &objects) {
                warnings.push(format!("{}: {what} at {place_m} m: {fault}", file.display()));
            }
        }
    }
    Ok(warnings)
}

/// Why the robot cannot stand at a place, heading as at the start.
fn fault_at(place_m: DVec2, scenario: &Scenario, terrain: &Terrain, objects: &Objects) -> Option<String> {
    let ground = Footing { field: &terrain.field, solids: &[] };
    let config = scenario.robot.clone();
    let Ok(robot) = Robot::new(config, &ground, place_m, scenario.start.heading_rad) else {
        return Some(format!("a wheel is off the map, which spans {} m", terrain.field.extent_m()));
    };
    let limits = robot.config();
    let body = Body::new(limits, scenario.sensor.place_on_robot_m());
    if let Some(contact) = body.contact_with(objects.solids(), robot.state()) {
        let object = contact.object.and_then(|object| objects.list().get(object));
        return Some(format!(
            "the robot touches the {} there",
            object.map_or("object", |object| object.name())
        ));
    }
    let attitude = &robot.state().attitude;
    let beyond = |what: &str, tilt_rad: f64, limit_rad: f64| {
        let is_beyond = tilt_rad.abs() > limit_rad;
        is_beyond.then(|| format!("{what} of {tilt_rad:.3} rad there: the limit is {limit_rad} rad"))
    };
    beyond("roll", attitude.roll_rad, limits.roll_limit_rad)
        .or_else(|| beyond("pitch", attitude.pitch_rad, limits.pitch_limit_rad))
}
