//! The node on a robot: the checks against rclpy.

use std::path::PathBuf;

use xshell::{Shell, cmd};

use crate::count::{Count, Runner, count};
use crate::python::Environment;
use crate::setup;

const CHECKS: &str = "crate/node/peers/check.py";
const CONFIG: &str = "crate/node/config/husky-jazzy.yaml";

/// Installs rclpy; returns the Python that has it.
pub(crate) fn python(sh: &Shell) -> anyhow::Result<PathBuf> {
    let environment = Environment {
        folder: &setup::target_dir(sh).join("ros-venv"),
        requirements: "crate/node/peers/requirements.txt",
        pythons: &["python3.11", "python3", "python"],
        // The wheels are for this version alone.
        fits: |version| version == (3, 11),
        missing: "The tests with rclpy need Python 3.11 with pip on Linux, and none is on PATH. Install one, for example \
            with `sudo apt-get install python3.11 python3.11-venv`, or with pyenv. Those over DDS without ROS need nothing: \
            cargo test --package mapless-node.",
    };
    environment.set_up(sh)
}

/// Runs the node beside a robot of rclpy.
pub(crate) fn test(sh: &Shell) -> anyhow::Result<Count> {
    let python = python(sh)?;
    // As the tests build it: without a second build of all it depends on.
    cmd!(sh, "cargo build --package mapless-node").run()?;
    let program = setup::target_dir(sh).join("debug/mapless-node");
    count(cmd!(sh, "{python} {CHECKS} {program} {CONFIG}"), Runner::Playwright)
}
