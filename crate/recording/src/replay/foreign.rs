//! Replays of files that tell of no decisions: a robot's own recordings. The supervisor ticks at 50 Hz, and
//! the planner answers every scan at once.

use core::time::Duration;
use std::collections::VecDeque;

use mapless_robot::messages::PoseStamped;
use mapless_robot::navigation::{End, Ended, goal_of};

use super::Replay;
use super::report::News;
use crate::entry::{Content, Entry};
use crate::message::{AnswerMessage, TickMessage};

impl Replay {
    /// A message of a robot's own recording. Frames of sensors are taken as they are.
    pub(super) fn take_foreign(&mut self, entry: &Entry) {
        let at = entry.arrival.at;
        let frames = &self.config.frames;
        let heard = match &entry.content {
            Content::Scan(cloud) => {
                let mut cloud = cloud.clone();
                cloud.header.frame_id.clone_from(&frames.scan);
                self.senses.take_scan(entry.arrival, &cloud)
            }
            Content::Odometry(odometry) => {
                let mut odometry = (**odometry).clone();
                self.odom.get_or_insert_with(|| odometry.header.frame_id.clone());
                odometry.header.frame_id.clone_from(&frames.odom);
                odometry.child_frame_id.clone_from(&frames.base);
                self.senses.take_odometry(entry.arrival, &odometry)
            }
            Content::Imu(imu) => {
                let mut imu = (**imu).clone();
                imu.header.frame_id.clone_from(&frames.imu);
                self.senses.take_imu(entry.arrival, &imu)
            }
            _ => return,
        };
        self.hear(heard);
        let (Some(task), Some(scan)) = (self.task, self.scans.pop_back()) else { return };
        self.scans.clear();
        let has_jumped = std::mem::take(&mut self.has_jumped);
        let answer = self.pilot.answer(&scan, task, has_jumped);
        self.status = answer.status;
        self.proposals = VecDeque::from([answer.proposal]);
        self.report.answers += 1;
        self.looked(&answer, scan, at);
        self.comparison.answer(at, None, Some(&AnswerMessage::new(&answer, has_jumped)));
    }

    /// A goal by topic, in the frame of the odometry as the file names it.
    pub(super) fn ask(&mut self, mut pose: PoseStamped) {
        if self.odom.as_ref() == Some(&pose.header.frame_id) {
            pose.header.frame_id.clone_from(&self.config.frames.odom);
        }
        self.asked = Some(pose);
    }

    /// A tick that no recording tells of.
    pub(super) fn tick_freely(&mut self, at: Duration, tell: &mut dyn FnMut(&News)) {
        self.inputs.has_peer = true;
        self.inputs.other_publishers = 0;
        let mut proposal = self.proposals.pop_back();
        if !self.faults.tick(at, &mut self.inputs, &mut proposal) {
            return;
        }
        let inputs = self.inputs.take();
        let decision = self.supervisor.tick(at, &inputs, proposal.as_ref());
        self.report.ticks += 1;
        self.report.tell_change(at, &decision, tell);
        self.comparison.tick(at, None, &TickMessage::new(&inputs, proposal.as_ref(), &decision));
        self.decision = Some(decision);
        let ended = self.navigation.check(&decision, self.status, at);
        self.end(at, ended, tell);
        self.accept(at, tell);
    }

    /// Accepts the goal that was asked for, as soon as one would be.
    fn accept(&mut self, at: Duration, tell: &mut dyn FnMut(&News)) {
        let Some(pose) = &self.asked else { return };
        let (odom, has_heading) = (&self.config.frames.odom, self.config.navigation.final_heading);
        match goal_of(pose, odom, self.decision.as_ref(), self.poses, has_heading) {
            Ok(goal) => {
                self.asked = None;
                let before = self.navigation.accept(goal, None, at);
                self.end(at, before, tell);
                tell(&News::Change { at, text: format!("a goal was accepted: {}", goal.position_m) });
            }
            // It is asked for again at the next tick.
            Err(reason) if self.report.last_complaint("goal") == Some(&*reason) => {}
            Err(reason) => self.report.complain("goal", &reason),
        }
    }

    fn end(&mut self, at: Duration, ended: Option<Ended<()>>, tell: &mut dyn FnMut(&News)) {
        let task = self.navigation.task();
        if task != self.task {
            (self.task, self.status) = (task, None);
            self.inputs.goal = task.map(|task| task.number);
        }
        if let Some((_, how)) = ended {
            let text = match how {
                End::Succeeded => "the goal was reached".to_owned(),
                End::Canceled => "the goal was taken back".to_owned(),
                End::Aborted(outcome) => format!("the goal was given up: {}", outcome.text),
            };
            tell(&News::Change { at, text });
        }
    }
}
