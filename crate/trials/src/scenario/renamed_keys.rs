//! Keys with former names. Old scenario and campaign files, links and saved experiments still open.

use mapless_toml::Rename;

/// Keys first, then the tables that the remaining keys move to.
pub(crate) const RENAMED_KEYS: &[Rename] = &[
    Rename::new("planner.period_s", "sensor.period_s"),
    ticks("planner.ground.memory_ticks", "planner.elevation_window.memory_s"),
    ticks("planner.decision.look_ticks", "planner.decision.spin_recovery_s"),
    Rename::new("sensor.stray_probability", "reality.sensing.stray_probability"),
    Rename::new("sensor.self_returns", "reality.sensing.self_returns"),
    Rename::new("planner.robot_width_m", "planner.robot.width_m"),
    Rename::new("planner.wheelbase_m", "planner.robot.wheelbase_m"),
    Rename::new("planner.track_m", "planner.robot.track_m"),
    Rename::new("planner.limits.roll_rad", "planner.robot.roll_limit_rad"),
    Rename::new("planner.limits.pitch_rad", "planner.robot.pitch_limit_rad"),
    Rename::new("planner.ground.curvature_per_m", "planner.elevation_window.slope_deviation_per_m"),
    Rename::new("planner.forecast.escape_margin_rad", "planner.state_lattice.recovery_margin_rad"),
    Rename::new("planner.forecast.impatient_margin_rad", "planner.state_lattice.over_budget_margin_rad"),
    Rename::new("planner.forecast.escape_m", "planner.state_lattice.recovery_radius_m"),
    Rename::new("planner.forecast.deviations", "planner.state_lattice.slope_deviations"),
    Rename::new("planner.forecast.avoids_edges", "planner.state_lattice.avoids_negative_obstacles"),
    Rename::new("planner.decision.dead_end_weight", "planner.decision.correction_weight"),
    Rename::new("planner.controller.turn_first_rad", "planner.controller.rotate_in_place_rad"),
    Rename::new("planner.controller.look_turn_rate_rad_s", "planner.controller.spin_turn_rate_rad_s"),
    Rename::new("planner.controller.slow_from_share", "planner.controller.regulate_from_utilisation"),
    Rename::new("planner.controller.least_speed_share", "planner.controller.min_speed_share"),
    Rename::new("planner.limits", "planner.robot"),
    Rename::new("planner.mount", "planner.sensor"),
    Rename::new("planner.ground", "planner.elevation_window"),
    Rename::new("planner.forecast", "planner.state_lattice"),
];

/// A time that was counted in decisions, ten a second.
const fn ticks(old: &'static str, new: &'static str) -> Rename {
    Rename { old, new, divisor: Some(10.0) }
}

/// The present path of the parameter `path`.
#[must_use]
pub fn current_path(path: &str) -> String {
    let moved = RENAMED_KEYS.iter().find_map(|rename| {
        let rest = path.strip_prefix(rename.old)?;
        (rest.is_empty() || rest.starts_with('.')).then(|| [rename.new, rest].concat())
    });
    moved.unwrap_or_else(|| path.to_owned())
}

/// The `value` of the parameter `path` in its present unit.
#[must_use]
pub fn current_value(path: &str, value: &toml::Value) -> toml::Value {
    let divisor = RENAMED_KEYS.iter().find(|rename| rename.old == path).and_then(|rename| rename.divisor);
    let number = value.as_float().or(value.as_integer().map(|whole| whole as f64));
    number.zip(divisor).map_or_else(|| value.clone(), |(number, divisor)| (number / divisor).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{self, Group};
    use crate::{Preset, Scenario};
    use mapless_toml::from_str_renamed;

    const SCENARIO: &str = "terrain = \"a.toml\"\nstart = [1, 2, 0]\ngoal = [3, 4]\nseed = 7\n";

    /// Every key that ever had another name, with a value that is not the default.
    const OLD: &str = "[sensor]\nstray_probability = 0.01\nself_returns = 3\n[planner]\nperiod_s = 0.2\nrobot_width_m = 0.7\nwheelbase_m = 0.6\ntrack_m = 0.65\n\
        [planner.limits]\nroll_rad = 0.5\npitch_rad = 0.6\n\
        [planner.mount]\nforward_m = 0.1\nheight_m = 0.9\n\
        [planner.ground]\ncell_m = 0.25\nradius_m = 8\nmemory_ticks = 200\ncurvature_per_m = 0.7\n\
        [planner.forecast]\nstep_m = 0.6\ntilt_margin_rad = 0.1\nescape_margin_rad = 0.07\nimpatient_margin_rad = 0.04\n\
        escape_m = 3\ndeviations = 2\nblind_radius_m = 7\navoids_edges = false\ntilt_price = 3\nclimb_price = 5\n\
        turn_cost_m = 0.2\nreverse_price = 3\nclearance_m = 0.8\nmin_reach_m = 2\n\
        [planner.decision]\ndead_end_weight = 0.5\nlook_ticks = 60\n\
        [planner.controller]\nturn_first_rad = 0.7\nlook_turn_rate_rad_s = 0.6\nslow_from_share = 0.4\nleast_speed_share = 0.3\n";
    const NEW: &str = "[sensor]\nperiod_s = 0.2\n[planner.robot]\nwidth_m = 0.7\nwheelbase_m = 0.6\ntrack_m = 0.65\nroll_limit_rad = 0.5\n\
        pitch_limit_rad = 0.6\n\
        [planner.sensor]\nforward_m = 0.1\nheight_m = 0.9\n\
        [planner.elevation_window]\ncell_m = 0.25\nradius_m = 8\nmemory_s = 20\nslope_deviation_per_m = 0.7\n\
        [planner.state_lattice]\nstep_m = 0.6\ntilt_margin_rad = 0.1\nrecovery_margin_rad = 0.07\n\
        over_budget_margin_rad = 0.04\nrecovery_radius_m = 3\nslope_deviations = 2\nblind_radius_m = 7\n\
        avoids_negative_obstacles = false\ntilt_price = 3\nclimb_price = 5\nturn_cost_m = 0.2\n\
        reverse_price = 3\nclearance_m = 0.8\nmin_reach_m = 2\n\
        [planner.decision]\ncorrection_weight = 0.5\nspin_recovery_s = 6\n\
        [planner.controller]\nrotate_in_place_rad = 0.7\nspin_turn_rate_rad_s = 0.6\nregulate_from_utilisation = 0.4\n\
        min_speed_share = 0.3\n\
        [reality.sensing]\nstray_probability = 0.01\nself_returns = 3\n";

    fn groups(scenario: &Scenario) -> Vec<Group> {
        parameters::values(scenario, scenario, Preset::Default).unwrap()
    }

    #[test]
    fn old_files_and_sections_open_with_the_same_values() {
        let plain = Scenario::parse("a.toml", SCENARIO).unwrap();
        let parse = |sections: &str| Scenario::parse("a.toml", &format!("{SCENARIO}{sections}")).unwrap();
        let with = |sections: &str| plain.with_parameters("settings", sections).unwrap();
        let expected = groups(&parse(NEW));
        for scenario in [parse(OLD), with(OLD), with(NEW)] {
            assert_eq!(groups(&scenario), expected);
        }
        let values = |groups: &[Group]| -> Vec<_> {
            groups.iter().flat_map(|group| group.parameters.iter().map(|one| one.value)).collect()
        };
        let (before, after) = (values(&groups(&plain)), values(&expected));
        let changed = before.iter().zip(&after).filter(|(before, after)| before != after).count();
        assert_eq!(changed, OLD.lines().filter(|line| line.contains('=')).count());
    }

    #[test]
    fn both_names_at_once_are_refused_and_unknown_keys_told_with_those_that_are_known() {
        let fault = |sections: &str| {
            Scenario::parse("a.toml", &format!("{SCENARIO}{sections}")).unwrap_err().to_string()
        };
        let both = fault("[planner.controller]\nmin_speed_share = 0.3\nleast_speed_share = 0.3\n");
        let expected = "`planner.controller.least_speed_share` is now `planner.controller.min_speed_share`";
        assert!(both.contains("line 7, column 1") && both.contains(expected), "{both}");
        let unknown = fault("[planner.forecast]\nstep = 0.3\n");
        assert!(
            unknown.contains("line 6, column 1") && unknown.contains("unknown field `step`"),
            "{unknown}"
        );
        assert!(unknown.contains("`step_m`"), "{unknown}");
    }

    #[test]
    fn every_new_path_is_a_parameter_or_a_table_of_them() {
        let groups = groups(&Scenario::parse("a.toml", SCENARIO).unwrap());
        for Rename { new, .. } in RENAMED_KEYS {
            let is_parameter = |group: &Group| {
                new.strip_prefix(group.table).and_then(|rest| rest.strip_prefix('.')).is_some_and(|name| {
                    group.parameters.iter().any(|parameter| parameter.parameter.name == name)
                })
            };
            assert!(groups.iter().any(|group| group.table == *new || is_parameter(group)), "{new}");
        }
    }

    #[test]
    fn paths_of_campaigns_are_renamed() {
        assert_eq!(current_path("planner.forecast.escape_m"), "planner.state_lattice.recovery_radius_m");
        assert_eq!(current_path("planner.forecast.step_m"), "planner.state_lattice.step_m");
        for same in ["planner.forecasts.step_m", "planner.state_lattice.step_m", "planner", ""] {
            assert_eq!(current_path(same), same);
        }
    }

    #[test]
    fn ticks_become_seconds() {
        let text = "[planner]\nperiod_s = 0.2\nground.memory_ticks = 3000\ndecision = { look_ticks = 15 }\n";
        let read: toml::Table = from_str_renamed(text, RENAMED_KEYS).unwrap();
        assert_eq!(read["sensor"]["period_s"].as_float(), Some(0.2));
        assert_eq!(read["planner"]["elevation_window"]["memory_s"].as_float(), Some(300.0));
        assert_eq!(read["planner"]["decision"]["spin_recovery_s"].as_float(), Some(1.5));
        let value = |whole| current_value("planner.decision.look_ticks", &toml::Value::Integer(whole));
        assert_eq!(value(3), toml::Value::Float(0.3));
    }
}
