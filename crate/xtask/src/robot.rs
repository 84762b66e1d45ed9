//! The node on a robot: the checks beside peers of other vendors and distributions.

use std::path::PathBuf;

use xshell::{Shell, cmd};

use crate::count::{Count, Runner, count};
use crate::python::Environment;
use crate::setup;

const CONFIG: &str = "crate/node/config/husky-jazzy.yaml";

/// What the robot beside the node speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Peer {
    /// rclpy of Jazzy.
    Jazzy,
    /// rclpy of Kilted.
    Kilted,
    /// Cyclone DDS, without ROS.
    Cyclone,
}

impl Peer {
    /// Its environment under `target/`, its requirements and its checks.
    const fn files(self) -> [&'static str; 3] {
        match self {
            Self::Jazzy => ["ros-venv", "requirements.txt", "check.py"],
            Self::Kilted => ["kilted-venv", "requirements-kilted.txt", "check.py"],
            Self::Cyclone => ["cyclone-venv", "requirements-cyclone.txt", "check_cyclone.py"],
        }
    }

    /// Installs it; returns the Python that has it.
    pub(crate) fn set_up(self, sh: &Shell) -> anyhow::Result<PathBuf> {
        let [folder, requirements, _] = self.files();
        let environment = Environment {
            folder: &setup::target_dir(sh).join(folder),
            requirements: &format!("crate/node/peers/{requirements}"),
            pythons: &["python3.11", "python3", "python"],
            // rclpy's wheels are for this version alone.
            fits: |version| version == (3, 11),
            missing: "The tests beside other peers need Python 3.11 with pip on Linux, and none is on PATH. Install one, for \
                example with `sudo apt-get install python3.11 python3.11-venv`, or with pyenv. Those over DDS without ROS \
                need nothing: cargo test --package mapless-node.",
        };
        environment.set_up(sh)
    }

    /// Runs the node beside a robot of it.
    pub(crate) fn test(self, sh: &Shell) -> anyhow::Result<Count> {
        let (python, [_, _, checks]) = (self.set_up(sh)?, self.files());
        // As the tests build it: without a second build of all it depends on.
        cmd!(sh, "cargo build --package mapless-node").run()?;
        let program = setup::target_dir(sh).join("debug/mapless-node");
        count(cmd!(sh, "{python} crate/node/peers/{checks} {program} {CONFIG}"), Runner::Playwright)
    }
}
