"""Cyclone DDS without ROS 2, with the names that ROS 2 gives to topics and types."""

import threading
import time

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

import cyclone_messages


class Publisher:
    """A writer with the method that rclpy's has."""

    def __init__(self, writer):
        self.writer = writer

    def publish(self, message):
        self.writer.write(message)


class Wire:
    """A participant, with publishers and subscriptions as the robot needs them."""

    messages = cyclone_messages

    def __init__(self, namespace, domain_id):
        self.namespace = namespace
        self.participant = DomainParticipant(domain_id)
        self.heard = []

    def topic(self, kind, topic):
        # An absolute name begins with a slash, as in ROS 2.
        name = topic if topic.startswith("/") else f"{self.namespace}/{topic}"
        return Topic(self.participant, f"rt{name}", kind)

    def publisher(self, kind, topic, is_reliable=True):
        return Publisher(DataWriter(self.participant, self.topic(kind, topic), qos(is_reliable)))

    def remove_publisher(self, publisher):
        # The library deletes a writer that nobody has any more.
        publisher.writer = None

    def subscribe(self, kind, topic, hear, is_reliable=True):
        reader = DataReader(self.participant, self.topic(kind, topic), qos(is_reliable))
        self.heard.append((reader, hear))

    def now(self):
        return cyclone_messages.Time(*divmod(time.time_ns(), 1_000_000_000))

    def spin(self):
        """Has a thread call those who subscribed."""
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        while True:
            for reader, hear in self.heard:
                for message in reader.take(N=10):
                    # A publisher that went away is told by a sample without data.
                    if message.sample_info.valid_data:
                        hear(message)
            time.sleep(0.002)


def qos(is_reliable):
    reliability = Policy.Reliability.Reliable(duration(milliseconds=100)) if is_reliable else Policy.Reliability.BestEffort
    return Qos(reliability, Policy.History.KeepLast(10))
