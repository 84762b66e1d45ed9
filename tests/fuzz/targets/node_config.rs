//! The node's parameter file.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use mapless::Planner;
use mapless_node::config::NodeConfig;

fuzz_target!(|text: &str| {
    match NodeConfig::parse(Path::new("robot.yaml"), text) {
        Ok(config) => assert!(Planner::new(config.drive.planner).is_ok(), "a checked configuration is valid"),
        Err(error) => assert!(error.to_string().starts_with("robot.yaml:"), "{error}"),
    }
});
