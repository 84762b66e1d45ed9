"""Independent readers of MCAP on a recording of ours, and `mapless replay` on files of an independent writer.

    python crate/recording/peers/check.py PROGRAM [RECORDING]

PROGRAM is `mapless`; RECORDING is the kept one of the tests unless it is given. What is needed is in
requirements.txt beside this file.
"""

import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

KEPT = Path(__file__).parent.parent / "tests/kept/drive.mcap"
INPUTS = ("scan", "odometry", "imu", "goal_pose")
SENSOR = ["--set", "sensor.rings=8", "--set", "sensor.columns=90", "--set", "supervisor.clear_after_s=0.3"]


def by_mcap(file: Path) -> tuple[Counter, list]:
    """Messages by topic, and some content, by `mcap` and `mcap-ros2-support`."""
    with file.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        assert reader.get_header().profile == "ros2"
        metadata = {record.name: record.metadata for record in reader.iter_metadata()}
        assert '"planner"' in metadata["mapless"]["config"]
        return collect(
            (channel.topic, message.log_time, decoded)
            for _, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False)
        )


def by_rosbags(file: Path) -> tuple[Counter, list]:
    """The same by `rosbags`, which knows our own types by their schemas alone."""
    with AnyReader([file], default_typestore=get_typestore(Stores.ROS2_JAZZY)) as reader:
        return collect(
            (connection.topic, time, reader.deserialize(raw, connection.msgtype))
            for connection, time, raw in reader.messages()
        )


def collect(messages) -> tuple[Counter, list]:
    count, content = Counter(), []
    for topic, time, message in messages:
        count[topic] += 1
        match topic.rsplit("/", 1)[1]:
            case "scan":
                content.append((time, message.width, bytes(message.data)))
            case "odometry":
                content.append((time, message.pose.pose.position.x, message.twist.twist.linear.x))
            case "tick":
                content.append((time, message.linear_m_s, message.state, message.reason))
            case "answer":
                content.append((time, message.status, message.digest))
    return count, sorted(content, key=lambda item: (item[0], str(item[1:])[:100]))


def rewritten(file: Path, to: Path, compression: CompressionType) -> None:
    """What the robot sent, as its own recorder would have it."""
    with file.open("rb") as stream, to.open("wb") as out:
        writer = Writer(out, compression=compression, chunk_size=100_000)
        writer.start(profile="ros2", library="")
        channels = {}
        for schema, channel, message in make_reader(stream).iter_messages(log_time_order=False):
            if channel.topic.rsplit("/", 1)[1] not in INPUTS:
                continue
            if channel.id not in channels:
                known = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, "cdr", known)
            writer.add_message(channels[channel.id], message.log_time, message.data, message.log_time)
        writer.finish()


def replayed(program: str, file: Path, *options: str) -> str:
    done = subprocess.run([program, "replay", file, *options], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def main() -> None:
    program, file = sys.argv[1], Path(sys.argv[2]) if len(sys.argv) > 2 else KEPT
    (count, content), (other_count, other_content) = by_mcap(file), by_rosbags(file)
    assert count == other_count, (count, other_count)
    assert content == other_content
    for topic, number in sorted(count.items()):
        print(f"{topic}: {number} messages by mcap and by rosbags")
    own = replayed(program, file)
    assert "no decision differs from the recorded one" in own, own
    print(own.splitlines()[-1])
    if len(sys.argv) > 2:
        return
    digests = set()
    with tempfile.TemporaryDirectory() as folder:
        for compression in (CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD):
            foreign = Path(folder) / f"{compression.name}.mcap"
            rewritten(file, foreign, compression)
            lines = replayed(program, foreign, *SENSOR).splitlines()
            digests.add(lines[-1])
            print(f"{compression.name.lower()}, {foreign.stat().st_size} bytes: {lines[-2]}, {lines[-1]}")
    assert len(digests) == 1, digests


if __name__ == "__main__":
    main()
