//! The configuration of a replay.

use mapless::PlannerConfig;
use mapless_robot::cloud::check_sensor;
use mapless_robot::drive_config::DriveConfig;
use serde_json::Value;

use crate::error::Fault;

/// Sections of the node's file that stand within the planner's configuration.
const OF_PLANNER: [&str; 2] = ["sensor", "robot"];

/// The recorded configuration with what `settings` change. Without one, it is that of a Husky with a VLP-16,
/// fitted to the sensor and robot that are set; its emergency stop need not tell anything.
pub(super) fn config(recorded: Option<&DriveConfig>, settings: &[String]) -> Result<DriveConfig, Fault> {
    let base = match recorded {
        Some(recorded) => recorded.clone(),
        None => {
            let of_planner =
                settings.iter().filter(|setting| OF_PLANNER.iter().any(|key| setting.starts_with(key)));
            let mut base = of_planner
                .into_iter()
                .try_fold(DriveConfig::default(), |config, setting| set(config, setting))?;
            base.planner = PlannerConfig::for_robot(base.planner.sensor, base.planner.robot);
            base.supervisor.has_emergency_stop = false;
            base
        }
    };
    let config = settings.iter().try_fold(base, |config, setting| set(config, setting))?;
    config.validate()?;
    let (sensor, robot) = (&config.planner.sensor, &config.planner.robot);
    check_sensor(sensor, robot)
        .map_err(|error| Fault::Setting { setting: "sensor".to_owned(), error: error.to_string() })?;
    Ok(config)
}

fn set(config: DriveConfig, setting: &str) -> Result<DriveConfig, Fault> {
    let fail = |error: String| Fault::Setting { setting: setting.to_owned(), error };
    let (path, text) = setting
        .split_once('=')
        .ok_or_else(|| fail("expected KEY=VALUE, as supervisor.scan_s=0.5".to_owned()))?;
    let value = serde_json::from_str(text).unwrap_or_else(|_| Value::from(text));
    let mut tree = serde_json::to_value(&config).map_err(|error| fail(error.to_string()))?;
    let mut place = &mut tree;
    let section = path.split('.').next().unwrap_or_default();
    let within = OF_PLANNER.contains(&section).then_some("planner");
    for key in within.into_iter().chain(path.split('.')) {
        let known: Vec<String> =
            place.as_object().map(|table| table.keys().cloned().collect()).unwrap_or_default();
        place = place
            .get_mut(key)
            .ok_or_else(|| fail(format!("no key {key}: expected one of {}", known.join(", "))))?;
    }
    *place = value;
    serde_json::from_value(tree).map_err(|error| fail(error.to_string()))
}
