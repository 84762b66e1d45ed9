//! The planner's thread. A panic in it is a fault that the supervisor is told of.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use mapless::{ConfigError, Planner, PlannerConfig, Status};
use mapless_robot::supervisor::{Outcome, Proposal};
use ros2_client::Publisher;

use crate::hub::{Hub, Planned, Scan};
use crate::messages::{Header, TwistStamped, Vector3};
use crate::navigation::Task;
use crate::picture::Picture;
use crate::surfaces::Surfaces;

/// How long a wait for a scan may be, so that the end of the node is noticed.
const WAIT: Duration = Duration::from_millis(100);

/// The planner, and what it remembers of the goal.
pub(crate) struct Planning {
    config: PlannerConfig,
    planner: Planner,
    task: Option<u64>,
    stepped: Option<Duration>,
    status: Option<Status>,
    recoveries: i16,
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
        let planner = Planner::new(config.clone())?;
        Ok(Self {
            config,
            planner,
            task: None,
            stepped: None,
            status: None,
            recoveries: 0,
            decisions,
            picture,
            surfaces,
        })
    }

    /// Answers scans until the node ends.
    pub(crate) fn run(mut self, hub: &Hub) {
        while !hub.is_ending() {
            if let Some(config) = hub.planner.take(Duration::ZERO) {
                self.config = config;
                self.begin_anew();
            }
            let Some(scan) = hub.scan.take(WAIT) else { continue };
            let Some(task) = hub.task() else {
                self.task = None;
                continue;
            };
            let outcome = self.guarded(|this| this.step(hub, &scan, task)).unwrap_or(Outcome::Panicked);
            hub.proposal.put(Proposal { goal: task.number, scan_arrived: scan.arrived, outcome });
            self.publish(&scan, outcome);
            if let (Some(poses), true) = (hub.poses(), outcome != Outcome::Panicked) {
                self.guarded(|this| {
                    if let Some(surfaces) = &this.surfaces {
                        surfaces.publish(&mut this.planner, &scan.pose, poses, scan.stamp);
                    }
                });
            }
        }
    }

    /// What the planner is asked, but for a panic. It is made anew then: half a step may have been done.
    fn guarded<T>(&mut self, ask: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let answer = catch_unwind(AssertUnwindSafe(|| ask(self)));
        if answer.is_err() {
            log::error!("the planner panicked");
            self.begin_anew();
        }
        answer.ok()
    }

    /// Another planner, which has seen nothing yet.
    fn begin_anew(&mut self) {
        self.task = None;
        match Planner::new(self.config.clone()) {
            Ok(planner) => self.planner = planner,
            Err(error) => log::error!("the planner cannot be made anew: {error}"),
        }
    }

    fn step(&mut self, hub: &Hub, scan: &Scan, task: Task) -> Outcome {
        if hub.take_jump() {
            self.planner.reset();
            self.task = None;
        }
        if self.task != Some(task.number) {
            self.planner.set_goal(task.goal);
            (self.task, self.status, self.recoveries) = (Some(task.number), None, 0);
        }
        let began = Instant::now();
        let elapsed = self.stepped.map_or(Duration::ZERO, |stepped| scan.arrived.saturating_sub(stepped));
        self.stepped = Some(scan.arrived);
        let step = self.planner.step(&scan.points_m, &scan.pose, elapsed);
        let recovers = |status| matches!(status, Status::Backtracking | Status::Searching);
        if recovers(step.status) && !self.status.is_some_and(recovers) {
            self.recoveries = self.recoveries.saturating_add(1);
        }
        self.status = Some(step.status);
        hub.plan(Planned {
            goal: task.number,
            status: step.status,
            recoveries: self.recoveries,
            took: began.elapsed(),
        });
        if let Some(poses) = hub.poses() {
            self.picture.publish(&step, poses, scan.stamp);
        }
        Outcome::from(&step)
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
