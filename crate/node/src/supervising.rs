//! The supervisor's thread: it alone commands the robot.

use std::time::{Duration, Instant};

use mapless::Command;
use mapless_recording::Content;
use mapless_robot::supervisor::{Decision, State, Supervisor};
use ros2_client::Publisher;

use crate::config::{CommandType, NodeConfig};
use crate::hub::Hub;
use crate::messages::{Header, Time, Twist, TwistStamped, Vector3};
use crate::ros::{Entities, RosError, published_qos};
use crate::service::Service;

/// 50 Hz.
const PERIOD: Duration = Duration::from_millis(20);
/// Zero commands at the end, should one get lost.
const LAST_COMMANDS: usize = 5;

/// The publisher of commands, of either type.
pub(crate) enum CommandPublisher {
    Twist(Publisher<Twist>),
    Stamped(Publisher<TwistStamped>, String),
}

impl CommandPublisher {
    pub(crate) fn new(config: &NodeConfig, entities: &mut Entities) -> Result<Self, RosError> {
        let topic = &config.topics.cmd_vel;
        Ok(match config.command_type {
            CommandType::Twist => {
                Self::Twist(entities.publisher(topic, "geometry_msgs/Twist", published_qos())?)
            }
            CommandType::TwistStamped => Self::Stamped(
                entities.publisher(topic, "geometry_msgs/TwistStamped", published_qos())?,
                config.drive.frames.base.clone(),
            ),
        })
    }

    /// Its identity on the network.
    pub(crate) fn gid(&self) -> ros2_client::Gid {
        match self {
            Self::Twist(publisher) => publisher.gid(),
            Self::Stamped(publisher, _) => publisher.gid(),
        }
    }

    fn publish(&self, command: Command, stamp: Time) -> Result<(), String> {
        let twist = Twist {
            linear: Vector3 { x: command.linear_m_s, ..Vector3::default() },
            angular: Vector3 { z: command.angular_rad_s, ..Vector3::default() },
        };
        match self {
            Self::Twist(publisher) => publisher.publish(twist).map_err(|error| error.to_string()),
            Self::Stamped(publisher, frame_id) => {
                let header = Header { stamp, frame_id: frame_id.clone() };
                publisher.publish(TwistStamped { header, twist }).map_err(|error| error.to_string())
            }
        }
    }
}

/// Commands the robot until the node ends; the last commands are zero.
pub(crate) fn supervise(
    hub: &Hub,
    mut supervisor: Supervisor,
    publisher: &CommandPublisher,
    service: &Service,
) {
    let mut due = hub.now();
    let mut ticked: Option<Instant> = None;
    let mut before: Option<Decision> = None;
    while !hub.is_ending() {
        let proposal = hub.proposal.take(hub.wait_for(due));
        let now = hub.now();
        // Simulated time may pass slowly or not at all; commands go out all the same.
        let rests = ticked.is_some_and(|ticked| ticked.elapsed() < PERIOD);
        if proposal.is_none() && now < due && rests {
            continue;
        }
        ticked = Some(Instant::now());
        if now >= due {
            // After a pause of the process, ticks that were missed are not made up for.
            due = (due + PERIOD).max(now);
        }
        if let Some(limits) = hub.limits.take(Duration::ZERO) {
            hub.record(|| Content::Limits(Box::new(limits)));
            if let Err(error) = supervisor.limit(&limits) {
                log::error!("the supervisor refuses a limit that was checked: {error}");
            }
        }
        let decision = hub.tick(now, &mut supervisor, proposal.as_ref());
        match publisher.publish(decision.command, hub.stamp()) {
            Ok(()) => {
                if hub.take_beat() {
                    service.fed();
                }
                if let Some(proposal) = proposal {
                    hub.note_answer(proposal.scan_arrived);
                }
            }
            Err(error) => {
                log::warn!("a command could not be published: {error}");
                hub.tell(|inputs| inputs.publish_failed = true);
            }
        }
        tell_change(before.as_ref(), &decision);
        before = Some(decision);
        hub.decide(decision);
    }
    service.stopping();
    for _ in 0..LAST_COMMANDS {
        if let Err(error) = publisher.publish(Command::STOP, hub.stamp()) {
            log::error!("the last command could not be published: {error}");
        }
        std::thread::sleep(PERIOD);
    }
}

fn tell_change(before: Option<&Decision>, decision: &Decision) {
    let is_same =
        before.is_some_and(|before| before.state == decision.state && before.reason == decision.reason);
    if is_same {
        return;
    }
    match (decision.state, decision.reason) {
        (State::Standby | State::Driving, _) | (_, None) => log::info!("{:?}", decision.state),
        (state, Some(reason)) => log::warn!("{state:?}: {reason}"),
    }
}
