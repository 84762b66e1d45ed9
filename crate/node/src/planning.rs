//! The planner's thread. A panic in it is a fault that the supervisor is told of.

use std::time::{Duration, Instant};

use mapless::glam::DVec3;
use mapless::{ConfigError, Planner, Pose};
use mapless_recording::{AnswerMessage, Content};
use mapless_robot::drive_config::DriveConfig;
use mapless_robot::pilot::Pilot;
use mapless_robot::senses::Scan;
use mapless_robot::supervisor::Outcome;
use ros2_client::Publisher;

use crate::hub::{Hub, Planned};
use crate::messages::{Header, TwistStamped, Vector3};
use crate::picture::Picture;
use crate::surfaces::Surfaces;

/// How long a wait for a scan may be, so that the end of the node is noticed.
const WAIT: Duration = Duration::from_millis(100);

/// The planner, and who hears of its answers.
pub(crate) struct Planning {
    pilot: Pilot,
    decisions: Publisher<TwistStamped>,
    picture: Picture,
    /// None, unless they are asked for.
    surfaces: Option<Surfaces>,
    /// Height of `base_link`.
    base_height_m: f64,
}

impl Planning {
    /// A planner without a goal; each of its answers goes out on `decisions`.
    pub(crate) fn new(
        config: &DriveConfig,
        decisions: Publisher<TwistStamped>,
        picture: Picture,
        surfaces: Option<Surfaces>,
    ) -> Result<Self, ConfigError> {
        let pilot = Pilot::new(config.planner.clone())?;
        let base_height_m = config.estimator.base_height_m;
        Ok(Self { pilot, decisions, picture, surfaces, base_height_m })
    }

    /// Answers scans until the node ends.
    pub(crate) fn run(mut self, hub: &Hub) {
        while !hub.is_ending() {
            if let Some(config) = hub.planner.take(Duration::ZERO) {
                hub.record(|| Content::Planner(Box::new(config.clone())));
                if let Err(error) = self.pilot.configure(config) {
                    log::error!("the planner refuses a configuration that was checked: {error}");
                }
            }
            let Some(scan) = hub.scan.take(WAIT) else { continue };
            let Some(task) = hub.task() else { continue };
            let has_jumped = hub.take_jump();
            let began = Instant::now();
            let answer = self.pilot.answer(&scan, task, has_jumped);
            let took = began.elapsed();
            match answer.status {
                Some(status) => {
                    let recoveries = self.pilot.recoveries();
                    hub.plan(Planned { goal: task.number, status, recoveries, took });
                }
                None => log::error!("the planner panicked"),
            }
            // Before it is put: the supervisor's tick that takes it is recorded later.
            hub.record(|| Content::Answer(AnswerMessage::new(&answer, has_jumped)));
            // Before it is shown: a command waits for it.
            hub.proposal.put(answer.proposal);
            self.publish(&scan, answer.proposal.outcome);
            if answer.status.is_some() {
                self.show(hub, &scan);
            }
        }
    }

    /// Publishes what the planner decided, and what it perceived if that is asked for.
    fn show(&mut self, hub: &Hub, scan: &Scan) {
        let Some(poses) = hub.poses() else { return };
        let poses = on_ground(poses, self.base_height_m);
        let (picture, surfaces) = (&self.picture, &mut self.surfaces);
        let show = |planner: &mut Planner| {
            picture.publish(&planner.last_step(), poses, scan.stamp);
            if let Some(surfaces) = surfaces {
                surfaces.publish(planner, &scan.pose, poses, scan.stamp);
            }
        };
        if self.pilot.ask(show).is_none() {
            log::error!("the planner panicked");
            // A replay shows nothing: it hears that the planner was made anew.
            hub.record(|| Content::Planner(Box::new(self.pilot.config().clone())));
        }
    }

    /// One answer to each scan, with the scan's stamp: what the planner proposed, before any limit.
    fn publish(&self, scan: &Scan, outcome: Outcome) {
        let mut decision = TwistStamped {
            header: Header { stamp: scan.stamp, frame_id: String::new() },
            ..TwistStamped::default()
        };
        if let Outcome::Command(command) = outcome {
            decision.twist.linear = Vector3 { x: command.linear_m_s, ..Vector3::default() };
            decision.twist.angular = Vector3 { z: command.angular_rad_s, ..Vector3::default() };
        }
        if let Err(error) = self.decisions.publish(decision) {
            log::warn!("a decision could not be published: {error}");
        }
    }
}

/// The robot's poses in the estimator's frame and in the odometry's, both of the ground between its wheels:
/// odometry tells that of `base_link`, and often as level.
fn on_ground([believed, told]: [Pose; 2], base_height_m: f64) -> [Pose; 2] {
    let Pose { roll_rad, pitch_rad, .. } = believed;
    let base = Pose::from_roll_pitch_yaw(told.position_m, roll_rad, pitch_rad, told.yaw_rad);
    [believed, base.moved(DVec3::NEG_Z * base_height_m)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use mapless_robot::frames::FrameChange;

    #[test]
    fn base_link_is_shown_where_odometry_says() {
        let base_height_m = 0.165;
        let base = Pose::from_roll_pitch_yaw(DVec3::new(3.0, 1.0, 0.5), 0.2, -0.3, 1.0);
        let believed = base.moved(DVec3::NEG_Z * base_height_m);
        let told = Pose::from_roll_pitch_yaw(DVec3::new(-4.0, 2.0, 0.0), 0.0, 0.0, -0.5);
        let [from, to] = on_ground([believed, told], base_height_m);
        let shown_m = FrameChange::new(from, to).point_m(base.position_m);
        assert!((shown_m - told.position_m).length() < 1e-12, "{shown_m}");
    }
}
