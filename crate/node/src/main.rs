//! `mapless-node`: the planner on a robot, as a ROS 2 node.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use mapless_node::config::NodeConfig;
use mapless_node::run;

/// Drive a robot to goals over uneven terrain, as a ROS 2 node that needs no ROS installation.
#[derive(Parser)]
#[command(version)]
struct Args {
    /// The parameter file.
    config: PathBuf,
    /// Read the file, say whether it is in order, and end.
    #[arg(long)]
    check: bool,
}

fn main() -> ExitCode {
    let args = Args::parse();
    // What the middleware has to say of its own is for those who ask: RUST_LOG=info.
    let filter = env_logger::Env::default().default_filter_or("warn,mapless_node=info,rustdds=error");
    env_logger::Builder::from_env(filter).init();
    match start(&args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn start(args: &Args) -> Result<(), Box<dyn std::error::Error>> {
    let config = NodeConfig::open(&args.config)?;
    if args.check {
        println!("{} is in order.", args.config.display());
        return Ok(());
    }
    Ok(run(&config)?)
}
