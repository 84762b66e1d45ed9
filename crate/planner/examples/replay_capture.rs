//! Plans on every revolution of a recorded capture, as if the robot stood still, and prints what it would do.
//!
//! `cargo run --release -p mapless --example replay_capture -- capture.pcap`

use core::time::Duration;
use std::path::Path;

use mapless::glam::{DQuat, DVec2, DVec3};
use mapless::{Goal, Planner, PlannerConfig, Pose, RobotModel, SensorModel};
use mapless_scans::{ScanChoice, read_scan};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: replay_capture FILE.pcap")?;
    let config = PlannerConfig::for_robot(SensorModel::vlp16(), RobotModel::husky());
    let mut planner = Planner::new(config)?;
    planner.set_goal(Goal::at(DVec2::new(50.0, 0.0)));
    let pose = Pose::from_quaternion(DVec3::ZERO, DQuat::IDENTITY);
    let mut revolution = 0;
    loop {
        let points_m = match read_scan(Path::new(&file), ScanChoice::of_revolution(revolution)) {
            Ok(scan) => scan.points_m,
            Err(error) if revolution == 0 => return Err(error.into()),
            Err(end) => {
                println!("{end}");
                return Ok(());
            }
        };
        let step = planner.step(&points_m, &pose, Duration::from_millis(100));
        let (status, command) = (step.status, step.command);
        let candidates = step.subgoals.iter().filter(|subgoal| subgoal.refusal.is_none()).count();
        println!(
            "{revolution}: {} returns, {candidates} candidates, {status:?}, {:.2} m/s, {:.2} rad/s",
            points_m.len(),
            command.linear_m_s,
            command.angular_rad_s
        );
        revolution += 1;
    }
}
