//! The node on a robot: the checks against rclpy, and against Cyclone DDS.

use std::path::{Path, PathBuf};

use xshell::{Shell, cmd};

use crate::count::{Count, Runner, count};
use crate::python::Environment;
use crate::setup;

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

/// Installs Cyclone DDS; returns the Python that has it.
pub(crate) fn cyclone_python(sh: &Shell) -> anyhow::Result<PathBuf> {
    let environment = Environment {
        folder: &setup::target_dir(sh).join("cyclone-venv"),
        requirements: "crate/node/peers/requirements-cyclone.txt",
        pythons: &["python3.11", "python3", "python"],
        // No other was tried.
        fits: |version| version == (3, 11),
        missing: "The tests with Cyclone DDS need Python 3.11 with pip on Linux, and none is on PATH. Install one, for \
            example with `sudo apt-get install python3.11 python3.11-venv`, or with pyenv.",
    };
    environment.set_up(sh)
}

/// Runs the node beside a robot of rclpy.
pub(crate) fn test(sh: &Shell) -> anyhow::Result<Count> {
    check(sh, &python(sh)?, "crate/node/peers/check.py")
}

/// Runs the node beside a robot of Cyclone DDS.
pub(crate) fn test_cyclone(sh: &Shell) -> anyhow::Result<Count> {
    check(sh, &cyclone_python(sh)?, "crate/node/peers/check_cyclone.py")
}

fn check(sh: &Shell, python: &Path, checks: &str) -> anyhow::Result<Count> {
    // As the tests build it: without a second build of all it depends on.
    cmd!(sh, "cargo build --package mapless-node").run()?;
    let program = setup::target_dir(sh).join("debug/mapless-node");
    count(cmd!(sh, "{python} {checks} {program} {CONFIG}"), Runner::Playwright)
}
