//! What the node reads and writes.

use std::time::Duration;

use ros2_client::qos::{Durability, History, Reliability as RosReliability, WhenFull};
use ros2_client::{Context, ContextOptions, MessageTypeName, Name, Node, NodeName, NodeOptions, QosProfile};
use ros2_client::{Publisher, Subscription};
use rustdds::mio1::{Interest, Poll, Token, Waker};
use rustdds::policy::ResourceLimits;
use rustdds::qos::HasQoSPolicy as _;
use rustdds::{DomainParticipant, QosPolicyBuilder, TopicDescription as _, TopicKind};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{RosError, making};
use crate::config::{NodeConfig, Reliability};
use crate::messages::{Bool, Clock, Imu, Odometry, PointCloud2, PoseStamped, TfMessage};

/// Messages of odometry and IMU that may wait to be read; of scans one does, as only the newest matters.
const WAITING: usize = 16;
/// Messages of tf that may wait: of many publishers, each tells its own frames.
const TRANSFORMS: usize = 100;

/// A node with its names.
pub(crate) struct Entities {
    pub(crate) node: Node,
    /// What knows the other peers.
    pub(crate) participant: DomainParticipant,
    poll: Poll,
    registered: usize,
}

/// What is read from other nodes.
pub(crate) struct Incoming {
    /// None, if scans come as packets.
    pub(crate) scan: Option<Subscription<PointCloud2>>,
    pub(crate) odometry: Subscription<Odometry>,
    pub(crate) imu: Subscription<Imu>,
    pub(crate) emergency_stop: Subscription<Bool>,
    pub(crate) reset: Subscription<Bool>,
    pub(crate) goal_pose: Subscription<PoseStamped>,
    pub(crate) clock: Option<Subscription<Clock>>,
}

/// What a subscriber of sensors asks for.
pub(super) fn sensor_qos(reliability: Reliability, depth: usize) -> QosProfile {
    let qos = QosProfile::subscription_default().history(History::KeepLast { depth });
    match reliability {
        Reliability::BestEffort => qos,
        Reliability::Reliable => qos.reliability_reliable(WhenFull::DEFAULT),
    }
}

/// What is published: reliable, so that any subscriber takes it, and never waiting for a slow one.
pub(crate) fn published_qos() -> QosProfile {
    QosProfile::publisher_default()
        .reliability(RosReliability::Reliable { when_full: WhenFull::Fail })
        .history(History::KeepLast { depth: 1 })
        .durability(Durability::Volatile)
}

/// What is large and published for viewers alone: best effort, as sensors are. A slow viewer would ask again
/// for parts that are gone.
pub(crate) fn streamed_qos() -> QosProfile {
    published_qos().reliability(RosReliability::BestEffort)
}

impl Entities {
    /// Joins the domain as the node that the configuration names.
    pub(crate) fn join(config: &NodeConfig) -> Result<Self, RosError> {
        let options = ContextOptions::new().domain_id(config.domain_id);
        let context = Context::with_options(options).map_err(making("joining the DDS domain"))?;
        let name = NodeName::new(&config.namespace, &config.node_name).map_err(making("naming the node"))?;
        let node = context
            .new_node(name, NodeOptions::new().enable_rosout(false).start_parameter_services(false))
            .map_err(making("making the node"))?;
        let participant = context.domain_participant();
        let poll = Poll::new().map_err(making("making a poll"))?;
        Ok(Self { node, participant, poll, registered: 0 })
    }

    /// Subscribes to what the node reads.
    pub(crate) fn subscribe(&mut self, config: &NodeConfig) -> Result<Incoming, RosError> {
        let topics = &config.topics;
        let sensor = |depth| sensor_qos(config.sensor_reliability, depth);
        // A best-effort subscriber hears every publisher; goals must not get lost.
        let switch = sensor_qos(Reliability::BestEffort, 1);
        let goal = sensor_qos(Reliability::Reliable, 1);
        Ok(Incoming {
            scan: match config.velodyne {
                Some(_) => None,
                None => Some(self.subscription(&topics.scan, "sensor_msgs/PointCloud2", sensor(1))?),
            },
            odometry: self.subscription(&topics.odometry, "nav_msgs/Odometry", sensor(WAITING))?,
            imu: self.subscription(&topics.imu, "sensor_msgs/Imu", sensor(WAITING))?,
            emergency_stop: self.subscription(&topics.emergency_stop, "std_msgs/Bool", switch.clone())?,
            reset: self.subscription(&topics.reset, "std_msgs/Bool", switch)?,
            goal_pose: self.subscription(&topics.goal_pose, "geometry_msgs/PoseStamped", goal)?,
            clock: self.subscribe_clock(config)?,
        })
    }

    /// Subscribes to the simulation's clock, if time is simulated.
    pub(crate) fn subscribe_clock(
        &mut self,
        config: &NodeConfig,
    ) -> Result<Option<Subscription<Clock>>, RosError> {
        let newest = sensor_qos(Reliability::BestEffort, 1);
        let subscribe = || self.subscription(&config.topics.clock, "rosgraph_msgs/Clock", newest);
        config.use_sim_time.then(subscribe).transpose()
    }

    /// Subscribes to `tf` and `tf_static`.
    pub(crate) fn subscribe_tf(
        &mut self,
        config: &NodeConfig,
    ) -> Result<(Subscription<TfMessage>, Subscription<TfMessage>), RosError> {
        let moving = sensor_qos(Reliability::BestEffort, TRANSFORMS);
        // What was said once is said again to whoever comes later.
        let fixed = sensor_qos(Reliability::Reliable, TRANSFORMS).durability(Durability::TransientLocal);
        let kind = "tf2_msgs/TFMessage";
        Ok((
            self.subscription(&config.topics.tf, kind, moving)?,
            self.subscription(&config.topics.tf_static, kind, fixed)?,
        ))
    }

    pub(super) fn subscription<M: DeserializeOwned + 'static>(
        &mut self,
        topic: &str,
        message: &str,
        qos: QosProfile,
    ) -> Result<Subscription<M>, RosError> {
        let told = self.topic(topic, message, &qos)?;
        let mut subscription = self
            .node
            .create_subscription(&told, Some(qos))
            .map_err(making(format!("subscribing to {topic}")))?;
        self.wake_by(&mut subscription)?;
        Ok(subscription)
    }

    /// A publisher of messages of the type `message`, as `package/Type`. Whoever joins, it takes each at
    /// once.
    ///
    /// Until a new peer answers for the first time, the middleware counts all messages since the first as
    /// not yet confirmed. Unless it is told another limit on samples, it takes no more than 8192 of them:
    /// two minutes of commands.
    pub(crate) fn publisher<M: Serialize>(
        &mut self,
        topic: &str,
        message: &str,
        qos: QosProfile,
    ) -> Result<Publisher<M>, RosError> {
        let usual = self.topic(topic, message, &qos)?;
        let limits = ResourceLimits {
            max_samples: i32::MAX,
            max_instances: i32::MAX,
            max_samples_per_instance: i32::MAX,
        };
        let limits = QosPolicyBuilder::new().resource_limits(limits).build();
        let (name, kind) = (usual.name(), usual.get_type().name().to_owned());
        let told = self
            .participant
            .create_topic(name, kind, &usual.qos().modify_by(&limits), TopicKind::NoKey)
            .map_err(making(format!("topic {topic}")))?;
        // Without a profile of its own, it has that of the topic.
        self.node.create_publisher(&told, None).map_err(making(format!("publishing on {topic}")))
    }

    fn topic(&self, topic: &str, message: &str, qos: &QosProfile) -> Result<rustdds::Topic, RosError> {
        let what = || format!("topic {topic}");
        let name = Name::parse(topic).map_err(making(what()))?;
        let (package, kind) = message.split_once('/').unwrap_or(("", message));
        self.node.create_topic(&name, MessageTypeName::new(package, kind), qos).map_err(making(what()))
    }

    /// Has [`Self::wait`] return when `source` has something.
    pub(crate) fn wake_by(&mut self, source: &mut impl rustdds::mio1::event::Source) -> Result<(), RosError> {
        let token = Token(self.registered);
        self.registered += 1;
        self.poll.registry().register(source, token, Interest::READABLE).map_err(making("polling"))
    }

    /// What has [`Self::wait`] return from another thread.
    pub(crate) fn waker(&mut self) -> Result<Waker, RosError> {
        let token = Token(self.registered);
        self.registered += 1;
        Waker::new(self.poll.registry(), token).map_err(making("polling"))
    }

    /// Waits until something came, or for `most`.
    pub(crate) fn wait(&mut self, most: Duration) {
        let mut events = rustdds::mio1::Events::with_capacity(64);
        // A signal may interrupt it: then there is nothing to read.
        let _ = self.poll.poll(&mut events, Some(most));
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::thread::sleep;
    use std::time::Instant;

    use mapless_peer::{join, subscription, until};

    use super::*;
    use crate::config::Distro;

    const TOPIC: &str = "/commands";
    const KIND: &str = "std_msgs/Bool";

    /// The middleware counts what a new peer has not confirmed yet since the first message, and has room for
    /// 8192. A robot that drives for some minutes is not to stop because somebody looks at its commands.
    #[test]
    fn commands_go_out_while_a_peer_joins_after_minutes() {
        let domain_id = 51 + (std::process::id() % 13) as u16;
        let mut base = join(domain_id, "base").unwrap();
        let heard = subscription::<Bool>(&mut base, TOPIC, KIND, 1).unwrap();
        let file = format!(
            "/**:\n  ros__parameters:\n    distro: {}\n    robot_preset: husky\n    domain_id: {domain_id}\n",
            Distro::BUILT.word()
        );
        let config = NodeConfig::parse(Path::new("robot.yaml"), &file).unwrap();
        let mut node = Entities::join(&config).unwrap();
        let publisher = node.publisher::<Bool>(TOPIC, KIND, published_qos()).unwrap();
        let publish = || publisher.publish(Bool { data: true }).is_ok();

        until(Duration::from_secs(60), || {
            publish();
            heard.take().unwrap().is_some().then_some(())
        })
        .expect("the peers do not find each other");
        // As many commands as two minutes have and more.
        let mut published = 0;
        while published < 9000 {
            published += u32::from(publish());
            while heard.take().unwrap().is_some() {}
        }
        let mut failed = 0;
        for visit in 0..4 {
            let mut visitor = join(domain_id, &format!("visitor_{visit}")).unwrap();
            let seen = subscription::<Bool>(&mut visitor, TOPIC, KIND, 1).unwrap();
            let (began, mut has_seen) = (Instant::now(), None);
            while has_seen.is_none_or(|at: Instant| at.elapsed() < Duration::from_millis(300)) {
                assert!(began.elapsed() < Duration::from_secs(60), "the visitor hears nothing");
                failed += u32::from(!publish());
                while heard.take().unwrap().is_some() {}
                if has_seen.is_none() && seen.take().unwrap().is_some() {
                    has_seen = Some(Instant::now());
                }
                sleep(Duration::from_millis(5));
            }
        }
        assert_eq!(failed, 0, "commands were not published");
    }
}
