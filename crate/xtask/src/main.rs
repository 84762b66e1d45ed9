//! The chores of the repository: `cargo xtask demo`, `cargo xtask test`, `cargo xtask build`, and
//! `cargo xtask profile`, `cargo xtask results`, `cargo xtask bench`, `cargo xtask physics`, `cargo xtask
//! fuzz`, `cargo xtask long-drive` and `cargo xtask soak`, which measure.
//!
//! Each command first sets up what it needs (the wasm target, the wasm-bindgen tools, the npm packages, a
//! browser), so that a fresh clone on a machine with Rust and Node needs nothing by hand.

mod bench;
mod browser;
mod count;
mod fuzz;
mod notices;
mod package;
mod page;
mod physics;
mod profile;
mod python;
mod results;
mod robot;
mod setup;
mod soak;
mod static_programs;
mod test;
mod work;

use std::path::Path;
use std::process::ExitCode;

use anyhow::Context as _;
use clap::{Parser, Subcommand};
use xshell::Shell;

/// Set up, build, show and test mapless.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build the page and serve it on this machine; prints the address.
    Demo {
        /// Port to serve on; the next free one is taken when it is in use.
        #[arg(long, default_value_t = 8080)]
        port: u16,
    },
    /// Write the page, ready for any static host, to dist/.
    Build,
    /// Run every check and test, or one part of them.
    Test {
        /// The part to run; all of them when absent.
        part: Option<test::Part>,
    },
    /// Compare the elevation profile with the true one for several settings, and write docs/PROFILE.md.
    Profile {
        /// Random poses on each terrain.
        #[arg(long, value_name = "N", default_value_t = 200)]
        poses: usize,
    },
    /// Run campaigns of terrains/campaigns, or the rest of them, and write their pages in docs/results and
    /// docs/RESULTS.md.
    Results {
        #[arg(help = format!("Campaigns by name; {} when absent", results::ALL.join(", ")))]
        campaigns: Vec<String>,
        /// The short form: as if quick and quick-generated were named.
        #[arg(long, conflicts_with = "campaigns")]
        quick: bool,
    },
    /// Time mapless beside gpflow, Embree and Jolt, natively and as wasm, and write docs/BENCHMARKS.md.
    Bench {
        /// Rounds in which every side is asked in turn.
        #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..))]
        rounds: u32,
    },
    /// Drive ten routes and twenty generated tasks in MuJoCo and in our own world, and write
    /// docs/results/physics.md.
    Physics {
        /// Two routes only; prints the page.
        #[arg(long)]
        short: bool,
        /// Three routes with ten seeds each, driven by the node for robots over DDS in MuJoCo; writes
        /// docs/results/physics-over-ros.md. Its short form is the begin of one route.
        #[arg(long)]
        over_ros: bool,
    },
    /// Build a Debian package of mapless-node, with a static program, into target/package, and install and
    /// purge it in an empty system.
    Package {
        /// The ROS 2 distribution that the robot runs.
        #[arg(long)]
        distro: package::Distro,
        /// The robot's processor.
        #[arg(long)]
        arch: package::Arch,
    },
    /// Run every fuzz target for a while, and write docs/FUZZ.md.
    Fuzz {
        /// Time for each target.
        #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..))]
        seconds: u32,
    },
    /// Have mapless-node drive beside a robot of another DDS for minutes: every cloud must be answered once.
    ///
    /// Half of them have best-effort clouds, half reliable ones; other peers come and go.
    LongDrive {
        /// What the robot speaks.
        peer: robot::Peer,
        /// What lies between the robot and the node.
        #[arg(long, default_value = "loopback")]
        link: robot::Link,
        /// Minutes in all.
        #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
        minutes: u32,
    },
    /// Drive by the parts of the node for hours of simulated time, with faults of every kind: memory must not
    /// grow, and no command may break a rule. The tests have five minutes of it.
    Soak {
        /// Simulated hours.
        #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=1000))]
        hours: u32,
    },
}

fn main() -> ExitCode {
    match run(Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("\nerror: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: Args) -> anyhow::Result<()> {
    let sh = Shell::new()?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).context("xtask has moved")?;
    sh.change_dir(root);
    match args.command {
        Command::Demo { port } => page::demo(&sh, port),
        Command::Build => page::build(&sh),
        Command::Test { part } => test::run(&sh, part),
        Command::Profile { poses } => profile::run(&sh, poses),
        Command::Results { quick: true, .. } => results::run(&sh, &results::QUICK.map(str::to_owned)),
        Command::Results { campaigns, .. } => results::run(&sh, &campaigns),
        Command::Bench { rounds } => bench::run(&sh, rounds),
        Command::Physics { short, over_ros: false } => physics::run(&sh, short),
        Command::Physics { short, over_ros: true } => physics::over_ros::run(&sh, short),
        Command::Package { distro, arch } => package::run(&sh, distro, arch),
        Command::Fuzz { seconds } => fuzz::run(&sh, seconds),
        Command::LongDrive { peer, link, minutes } => robot::drive_long(&sh, peer, link, minutes),
        Command::Soak { hours } => soak::run(&sh, hours),
    }
}
