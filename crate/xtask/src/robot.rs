//! The node on a robot: the checks beside peers of other vendors and distributions.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::ValueEnum;
use xshell::{Cmd, Shell, cmd};

use crate::count::{Count, Runner, count};
use crate::python::Environment;
use crate::setup;

const CONFIG: &str = "crate/node/config/husky-jazzy.yaml";
/// The ROS package of which rclpy's wheels have none.
const NAV2_MSGS: &str = "crate/node/peers/nav2_msgs";

/// What the robot beside the node speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
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
        let python = environment.set_up(sh)?;
        if self != Self::Cyclone {
            build_nav2_msgs(sh, environment.folder, &python)?;
        }
        Ok(python)
    }

    /// The same, unless it cannot be installed here: then why.
    pub(crate) fn test_where_possible(self, sh: &Shell) -> anyhow::Result<Count> {
        match self.set_up(sh) {
            Ok(_) => self.test(sh),
            Err(error) => {
                println!("skipped: {error:#}");
                Ok(Count { skipped: 1, ..Count::default() })
            }
        }
    }

    /// Runs the node beside a robot of it.
    pub(crate) fn test(self, sh: &Shell) -> anyhow::Result<Count> {
        let (python, [_, _, checks]) = (self.set_up(sh)?, self.files());
        // The very program that the native tests have built for this one.
        cmd!(sh, "cargo test --workspace --test over_dds --no-run").run()?;
        let program = setup::target_dir(sh).join("debug/mapless-node");
        count(cmd!(sh, "{python} crate/node/peers/{checks} {program} {CONFIG}"), Runner::Playwright)
    }
}

/// What lies between the robot and the node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Link {
    /// Both on this computer.
    Loopback,
    /// Each in a network of its own, with a virtual cable between them; needs Linux and root.
    Veth,
}

/// Has the node drive beside a robot of `peer` for some minutes, and counts clouds and answers.
pub(crate) fn drive_long(sh: &Shell, peer: Peer, link: Link, minutes: u32) -> anyhow::Result<()> {
    let python = std::path::absolute(peer.set_up(sh)?)?;
    cmd!(sh, "cargo build --release --package mapless-node").run()?;
    let program = setup::target_dir(sh).join("release/mapless-node");
    let wire = if peer == Peer::Cyclone { "cyclone" } else { "rclpy" };
    let seconds = (60 * minutes).to_string();
    let words = [format!("{}", python.display()), "crate/node/peers/long_drive.py".to_owned()];
    let arguments = [&program.display().to_string(), CONFIG, wire, &seconds];
    match link {
        Link::Loopback => Ok(command(sh, &words).args(arguments).run()?),
        Link::Veth => {
            let _networks = Networks::make(sh)?;
            let drive = command(sh, &inside(ROBOT_NETWORK)).args(words).args(arguments);
            Ok(drive.args(inside(NODE_NETWORK)).run()?)
        }
    }
}

fn command<'a>(sh: &'a Shell, words: &[impl AsRef<str>]) -> Cmd<'a> {
    let mut words = words.iter().map(AsRef::as_ref);
    sh.cmd(words.next().unwrap_or_default()).args(words)
}

const ROBOT_NETWORK: &str = "mapless-robot";
const NODE_NETWORK: &str = "mapless-node";

/// The words that run what follows in a network.
const fn inside(network: &str) -> [&str; 4] {
    ["ip", "netns", "exec", network]
}

/// Two networks with a cable between them. They go when this is dropped.
struct Networks<'a>(&'a Shell);

impl<'a> Networks<'a> {
    fn make(sh: &'a Shell) -> anyhow::Result<Self> {
        let failed = "networks of their own need Linux, iproute2 and root";
        let made = Self(sh);
        for network in [ROBOT_NETWORK, NODE_NETWORK] {
            cmd!(sh, "ip netns add {network}").run().context(failed)?;
        }
        let (robot, node) = ("mapless0", "mapless1");
        cmd!(sh, "ip link add {robot} netns {ROBOT_NETWORK} type veth peer name {node} netns {NODE_NETWORK}")
            .run()
            .context(failed)?;
        for (network, end, address) in
            [(ROBOT_NETWORK, robot, "10.213.0.1/24"), (NODE_NETWORK, node, "10.213.0.2/24")]
        {
            cmd!(sh, "ip -netns {network} address add {address} dev {end}").run()?;
            cmd!(sh, "ip -netns {network} link set {end} up").run()?;
            cmd!(sh, "ip -netns {network} link set lo up").run()?;
        }
        Ok(made)
    }
}

impl Drop for Networks<'_> {
    fn drop(&mut self) {
        for network in [ROBOT_NETWORK, NODE_NETWORK] {
            // One that was not made is not there to go.
            let _ = cmd!(self.0, "ip netns delete {network}").quiet().ignore_stderr().run();
        }
    }
}

/// Builds `nav2_msgs` into the environment, unless it is there as its definition stands.
fn build_nav2_msgs(sh: &Shell, folder: &Path, python: &Path) -> anyhow::Result<()> {
    let definition = "action/NavigateToPose.action";
    let wanted = sh.read_file(Path::new(NAV2_MSGS).join(definition))?;
    // The last that an installation writes.
    let installed = folder.join("share/nav2_msgs/package.xml");
    let is_same = |text: String| text == wanted;
    if sh.path_exists(&installed)
        && sh.read_file(folder.join("share/nav2_msgs").join(definition)).is_ok_and(is_same)
    {
        return Ok(());
    }
    println!("Building nav2_msgs into {}, once.", folder.display());
    let folder = std::path::absolute(folder)?;
    let (build, python) = (folder.join("nav2_msgs-build"), std::path::absolute(python)?);
    sh.remove_path(&build)?;
    sh.remove_path(&installed)?;
    let programs = folder.join("bin");
    let search = std::env::var_os("PATH").unwrap_or_default();
    let search = std::env::join_paths(std::iter::once(programs).chain(std::env::split_paths(&search)))?;
    let _path = sh.push_env("PATH", search);
    let _prefix = sh.push_env("AMENT_PREFIX_PATH", &folder);
    let missing = "nav2_msgs could not be built; it needs a compiler of C and C++, such as Debian's g++";
    cmd!(sh, "cmake -S {NAV2_MSGS} -B {build} -DCMAKE_PREFIX_PATH={folder} -DCMAKE_INSTALL_PREFIX={folder}")
        .args([format!("-DPython3_EXECUTABLE={}", python.display()), "-DBUILD_TESTING=OFF".to_owned()])
        .quiet()
        .ignore_stdout()
        .run()
        .context(missing)?;
    cmd!(sh, "cmake --build {build} --parallel 2").quiet().ignore_stdout().run().context(missing)?;
    Ok(cmd!(sh, "cmake --install {build}").quiet().ignore_stdout().run()?)
}
