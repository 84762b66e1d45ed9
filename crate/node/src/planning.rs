//! The planner's thread. A panic in it is a fault that the supervisor is told of.

use std::time::{Duration, Instant};

use mapless::{ConfigError, Planner, PlannerConfig};
use mapless_recording::{AnswerMessage, Content};
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
}

impl Planning {
    /// A planner without a goal; each of its answers goes out on `decisions`.
    pub(crate) fn new(
        config: PlannerConfig,
        decisions: Publisher<TwistStamped>,
        picture: Picture,
        surfaces: Option<Surfaces>,
    ) -> Result<Self, ConfigError> {
        Ok(Self { pilot: Pilot::new(config)?, decisions, picture, surfaces })
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
            let picture = &self.picture;
            let answer = self.pilot.answer(&scan, task, has_jumped, |step, recoveries| {
                let took = began.elapsed();
                hub.plan(Planned { goal: task.number, status: step.status, recoveries, took });
                if let Some(poses) = hub.poses() {
                    picture.publish(step, poses, scan.stamp);
                }
            });
            let has_panicked = answer.proposal.outcome == Outcome::Panicked;
            if has_panicked {
                log::error!("the planner panicked");
            }
            // Before it is put: the supervisor's tick that takes it is recorded later.
            hub.record(|| Content::Answer(AnswerMessage::new(&answer, has_jumped)));
            hub.proposal.put(answer.proposal);
            self.publish(&scan, answer.proposal.outcome);
            if !has_panicked {
                self.show(hub, &scan);
            }
        }
    }

    /// Publishes what the planner perceived, if that is asked for.
    fn show(&mut self, hub: &Hub, scan: &Scan) {
        let (Some(surfaces), Some(poses)) = (&self.surfaces, hub.poses()) else { return };
        let show = |planner: &mut Planner| surfaces.publish(planner, &scan.pose, poses, scan.stamp);
        if self.pilot.ask(show).is_none() {
            log::error!("the planner panicked");
            // A replay asks no surfaces: it hears that the planner was made anew.
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
