//! The robot on the network: its sensors and clock, and the commands that it gets.
//!
//! Simulated time waits for the node. So what a drive does hardly depends on how busy the computer is.

use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};
use mapless_node::messages::{Bool, Clock, Imu, Odometry, PointCloud2, Time, Twist, TwistStamped};
use mapless_peer::{publisher, subscription, until};
use ros2_client::{Node, Publisher, Subscription};

/// Messages that are kept for a node that missed them.
const DEPTH: usize = 10;
/// Peers find each other within this, even on a loaded machine.
const DISCOVERY: Duration = Duration::from_secs(60);
/// The clock is told again after this: the node hears it as best effort.
const TELL_AGAIN: Duration = Duration::from_millis(50);
/// A node that says nothing for so long has ended.
const SILENCE: Duration = Duration::from_secs(60);
/// A scan that is not answered within this got lost. A longer wait would seem to the node as if the
/// simulation had ended: its time goes on by itself after some seconds.
const ANSWERED_WITHIN: Duration = Duration::from_secs(1);

/// Topics of the robot.
pub(crate) struct Robot {
    node: Node,
    clock: Publisher<Clock>,
    scan: Publisher<PointCloud2>,
    odometry: Publisher<Odometry>,
    imu: Publisher<Imu>,
    stop: Publisher<Bool>,
    commands: Subscription<TwistStamped>,
    decisions: Subscription<TwistStamped>,
    /// The newest command.
    command: TwistStamped,
}

impl Robot {
    /// On the topics of the sample files.
    pub(crate) fn new(mut node: Node) -> anyhow::Result<Self> {
        Ok(Self {
            clock: publisher(&mut node, "/clock", "rosgraph_msgs/Clock", DEPTH)?,
            scan: publisher(&mut node, "sensors/lidar3d_0/points", "sensor_msgs/PointCloud2", 1)?,
            odometry: publisher(&mut node, "platform/odom/filtered", "nav_msgs/Odometry", DEPTH)?,
            imu: publisher(&mut node, "sensors/imu_0/data", "sensor_msgs/Imu", DEPTH)?,
            stop: publisher(&mut node, "platform/emergency_stop", "std_msgs/Bool", DEPTH)?,
            commands: subscription(&mut node, "cmd_vel", "geometry_msgs/TwistStamped", DEPTH)?,
            decisions: subscription(&mut node, "mapless/decision", "geometry_msgs/TwistStamped", DEPTH)?,
            command: TwistStamped::default(),
            node,
        })
    }

    /// Waits until the node listens to everything and commands.
    pub(crate) fn meet(&mut self) -> anyhow::Result<()> {
        let node = &self.node;
        let meets = || {
            let listens = [
                self.clock.get_subscription_count(node),
                self.scan.get_subscription_count(node),
                self.odometry.get_subscription_count(node),
                self.imu.get_subscription_count(node),
                self.stop.get_subscription_count(node),
            ];
            let speaks = [self.commands.get_publisher_count(node), self.decisions.get_publisher_count(node)];
            (listens.into_iter().chain(speaks).all(|count| count > 0)).then_some(())
        };
        until(DISCOVERY, meets).context("the node does not listen to the robot")
    }

    /// Tells the time.
    pub(crate) fn tell_clock(&self, clock: Time) -> anyhow::Result<()> {
        sent("the clock", self.clock.publish(Clock { clock }))
    }

    /// Tells what the IMU measures.
    pub(crate) fn tell_imu(&self, imu: Imu) -> anyhow::Result<()> {
        sent("the IMU", self.imu.publish(imu))
    }

    /// Tells what the wheels did.
    pub(crate) fn tell_odometry(&self, odometry: Odometry) -> anyhow::Result<()> {
        sent("odometry", self.odometry.publish(odometry))
    }

    /// Tells that the emergency stop is released.
    pub(crate) fn tell_released(&self) -> anyhow::Result<()> {
        sent("the emergency stop", self.stop.publish(Bool { data: false }))
    }

    /// Tells what the sensor sees. Whether the planner answered; it does while it has a goal.
    pub(crate) fn tell_scan(&self, scan: PointCloud2, is_pursuing: bool) -> anyhow::Result<bool> {
        let stamp = scan.header.stamp;
        sent("a scan", self.scan.publish(scan))?;
        if !is_pursuing {
            return Ok(true);
        }
        let is_answer = |decision: &TwistStamped| decision.header.stamp >= stamp;
        let answered = until(ANSWERED_WITHIN, || {
            loop {
                match self.decisions.take() {
                    Ok(Some((decision, _))) if is_answer(&decision) => return Some(()),
                    Ok(Some(_)) => {}
                    Ok(None) | Err(_) => return None,
                }
            }
        });
        Ok(answered.is_some())
    }

    /// The newest command, once there is one for the time `since`; `now` is told again until there is.
    pub(crate) fn command(&mut self, since: Time, now: Time) -> anyhow::Result<Twist> {
        let end = Instant::now() + SILENCE;
        loop {
            let newest = until(TELL_AGAIN, || {
                while let Ok(Some((command, _))) = self.commands.take() {
                    self.command = command;
                }
                (self.command.header.stamp >= since).then_some(self.command.twist)
            });
            match newest {
                Some(command) => return Ok(command),
                None if Instant::now() > end => bail!("the node has commanded nothing for {SILENCE:?}"),
                None => self.tell_clock(now)?,
            }
        }
    }
}

/// Names what could not be sent.
fn sent<E: std::fmt::Display>(what: &str, result: Result<(), E>) -> anyhow::Result<()> {
    result.map_err(|error| anyhow::anyhow!("{what} could not be sent: {error}"))
}
