//! Who else is on the topic of the commands.

use std::time::{Duration, Instant};

use ros2_client::{Gid, Name, NodeName};

use super::{RosError, making};

/// How often it is asked: the answer copies what is known of every peer.
const EVERY: Duration = Duration::from_millis(50);

/// Counts peers of one topic.
pub(crate) struct Presence {
    dds_name: String,
    /// The publisher of this node, which does not count.
    own: Gid,
    asked: Option<Instant>,
    /// Others that read the topic.
    pub(crate) readers: usize,
    /// Others that write it.
    pub(crate) writers: usize,
}

impl Presence {
    /// Counts on `topic`, on which this node publishes as `own`.
    pub(crate) fn on(topic: &str, node: &NodeName, own: Gid) -> Result<Self, RosError> {
        let name = Name::parse(topic).map_err(making(format!("topic {topic}")))?;
        Ok(Self { dds_name: name.to_dds_name("rt", node, ""), own, asked: None, readers: 0, writers: 0 })
    }

    /// Counts anew, unless it just did.
    pub(crate) fn look(&mut self, participant: &rustdds::DomainParticipant) {
        if self.asked.is_some_and(|asked| asked.elapsed() < EVERY) {
            return;
        }
        self.asked = Some(Instant::now());
        let readers = participant.discovered_readers();
        self.readers =
            readers.iter().filter(|r| *r.subscription_topic_data.topic_name() == self.dds_name).count();
        let writers = participant.discovered_writers();
        let others = writers.iter().filter(|w| {
            w.publication_topic_data.topic_name == self.dds_name
                && Gid::from(w.writer_proxy.remote_writer_guid) != self.own
        });
        self.writers = others.count();
    }
}
