//! Whether messages leave and arrive.

use std::time::{Duration, Instant};

use ros2_client::{Publisher, Subscription};

use super::entities::sensor_qos;
use super::{Entities, RosError, published_qos};
use crate::config::Reliability;
use crate::messages::{Time, now};

const KIND: &str = "builtin_interfaces/Time";
/// It beats no faster.
const EVERY: Duration = Duration::from_millis(50);
/// Without one for so long, something is wrong.
const SILENCE: Duration = Duration::from_secs(1);

/// A message to oneself, again and again. A middleware that is busy with other things, as in a flood of
/// malformed packets, takes every message and sends none (RustDDS 0.15.1): what comes back was sent.
pub(crate) struct Heartbeat {
    publisher: Publisher<Time>,
    subscription: Subscription<Time>,
    /// What was sent last, and when.
    sent: Option<(Time, Instant)>,
    /// When one came back last; at first, when it began.
    came: Instant,
}

impl Heartbeat {
    pub(crate) fn new(topic: &str, entities: &mut Entities) -> Result<Self, RosError> {
        Ok(Self {
            subscription: entities.subscription(topic, KIND, sensor_qos(Reliability::Reliable, 1))?,
            publisher: entities.publisher(topic, KIND, published_qos())?,
            sent: None,
            came: Instant::now(),
        })
    }

    /// Sends the next one when it is due. Returns whether the last one has come back.
    pub(crate) fn beat(&mut self) -> bool {
        let mut has_come = false;
        while let Ok(Some((heard, _))) = self.subscription.take() {
            has_come |= self.sent.is_some_and(|(sent, _)| sent == heard);
        }
        if self.sent.is_none_or(|(_, at)| at.elapsed() >= EVERY) {
            let time = now();
            // What cannot be sent does not come back.
            let _ = self.publisher.publish(time);
            self.sent = Some((time, Instant::now()));
        }
        if has_come {
            self.came = Instant::now();
        }
        has_come
    }

    /// Whether none came back for long.
    pub(crate) fn is_silent(&self) -> bool {
        self.came.elapsed() > SILENCE
    }
}
