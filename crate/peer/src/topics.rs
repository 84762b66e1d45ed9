//! Topics of a peer. Both ends are reliable, so that a loaded machine loses nothing.

use anyhow::Context as _;
use ros2_client::qos::History;
use ros2_client::{MessageTypeName, Name, Node, Publisher, QosProfile, Subscription};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::making;

/// Publishes messages of the type `message`, as `package/Type`, on `topic`, and keeps the last `depth` for
/// those who missed them.
///
/// # Errors
/// A name or a type that is none, and those of the middleware.
pub fn publisher<M: Serialize>(
    node: &mut Node,
    topic: &str,
    message: &str,
    depth: usize,
) -> anyhow::Result<Publisher<M>> {
    let qos = qos(depth);
    let told = node.create_topic(&name(topic)?, kind(message)?, &qos).map_err(making(topic))?;
    node.create_publisher(&told, Some(qos)).map_err(making(topic))
}

/// Subscribes to messages of the type `message`, as `package/Type`, on `topic`; `depth` of them may wait.
///
/// # Errors
/// As [`publisher`].
pub fn subscription<M: DeserializeOwned + 'static>(
    node: &mut Node,
    topic: &str,
    message: &str,
    depth: usize,
) -> anyhow::Result<Subscription<M>> {
    let qos = qos(depth);
    let told = node.create_topic(&name(topic)?, kind(message)?, &qos).map_err(making(topic))?;
    node.create_subscription(&told, Some(qos)).map_err(making(topic))
}

fn qos(depth: usize) -> QosProfile {
    QosProfile::publisher_default().history(History::KeepLast { depth })
}

fn name(topic: &str) -> anyhow::Result<Name> {
    Name::parse(topic).map_err(making(topic))
}

fn kind(message: &str) -> anyhow::Result<MessageTypeName> {
    let (package, kind) =
        message.split_once('/').with_context(|| format!("{message:?}: expected package/Type"))?;
    Ok(MessageTypeName::new(package, kind))
}
