//! A robot's own recording, as `rosbag2` makes it: other topics, other frames, no decisions, compressed.

use std::collections::BTreeMap;
use std::io::{Cursor, Write as _};

use mapless_recording::{News, Options, Report, Role, replay};
use mcap::records::{ChunkHeader, MessageHeader, Record};

use crate::drive::{Plan, SHORT, drive, file};

const PLAN: Plan = Plan { seconds: 2.5, pressed_s: 9.0, ..SHORT };

/// The messages of a drive under other names; `rename` gives a topic its name, or leaves it out.
fn bag(rename: impl Fn(&str) -> Option<String>) -> Vec<u8> {
    let own = file(&drive(PLAN));
    let mut writer =
        mcap::WriteOptions::new().profile("ros2").compression(None).create(Cursor::new(Vec::new())).unwrap();
    let (mut schemas, mut channels) = (BTreeMap::new(), BTreeMap::new());
    for record in mcap::read::ChunkFlattener::new(&own).unwrap() {
        match record.unwrap() {
            Record::Schema { header, data } => {
                schemas.insert(header.id, writer.add_schema(&header.name, &header.encoding, &data).unwrap());
            }
            Record::Channel(channel) if !channels.contains_key(&channel.id) => {
                if let Some(name) = rename(&channel.topic) {
                    let id = writer.add_channel(schemas[&channel.schema_id], &name, "cdr", &BTreeMap::new());
                    channels.insert(channel.id, id.unwrap());
                }
            }
            Record::Message { header, data } => {
                if let Some(&channel_id) = channels.get(&header.channel_id) {
                    // As rosbag2: both times are when it was heard.
                    let header = MessageHeader { channel_id, publish_time: header.log_time, ..header };
                    writer.write_to_known_channel(&header, &data).unwrap();
                }
            }
            _ => {}
        }
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// The topics of a robot without those of a node.
fn robots(topic: &str) -> Option<String> {
    let name = topic.rsplit('/').next()?;
    let is_input = ["scan", "odometry", "imu", "goal_pose"].contains(&name);
    (is_input && !topic.starts_with("/mapless")).then(|| format!("/husky/{name}"))
}

/// The bytes of a file whose chunks are compressed.
fn compressed(bytes: &[u8], name: &str, compress: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut out = mcap::MAGIC.to_vec();
    let mut put = |opcode: u8, body: &[u8]| {
        out.push(opcode);
        out.extend((body.len() as u64).to_le_bytes());
        out.extend(body);
    };
    for record in mcap::read::LinearReader::new(bytes).unwrap() {
        match record.unwrap() {
            Record::Chunk { header, data } => {
                let ChunkHeader {
                    message_start_time,
                    message_end_time,
                    uncompressed_size,
                    uncompressed_crc,
                    ..
                } = header;
                let packed = compress(&data);
                let mut body = Vec::new();
                for number in [message_start_time, message_end_time, uncompressed_size] {
                    body.extend(number.to_le_bytes());
                }
                body.extend(uncompressed_crc.to_le_bytes());
                body.extend((name.len() as u32).to_le_bytes());
                body.extend(name.as_bytes());
                body.extend((packed.len() as u64).to_le_bytes());
                body.extend(packed);
                put(0x06, &body);
            }
            Record::Header(header) => {
                let mut body = Vec::new();
                for text in [&header.profile, &header.library] {
                    body.extend((text.len() as u32).to_le_bytes());
                    body.extend(text.as_bytes());
                }
                put(0x01, &body);
            }
            // The index is of another file now; a file without one ends here.
            Record::DataEnd(_) => break,
            _ => {}
        }
    }
    put(0x0f, &[0; 4]);
    put(0x02, &[0; 20]);
    out.extend(mcap::MAGIC);
    out
}

fn replayed(bytes: &[u8], options: &Options) -> (Report, Vec<String>) {
    let mut changes = Vec::new();
    let report = replay(bytes, options, |news| match news {
        News::Change { text, .. } => changes.push(text.clone()),
        News::Difference(difference) => panic!("{difference:?}"),
    });
    (report.unwrap(), changes)
}

fn sensor() -> Options {
    let settings = ["sensor.rings=8", "sensor.columns=90", "supervisor.clear_after_s=0.3"];
    Options { settings: settings.map(str::to_owned).to_vec(), ..Options::default() }
}

fn refusal(bytes: &[u8], options: &Options) -> String {
    replay(bytes, options, |_| {}).unwrap_err().to_string()
}

#[test]
fn a_robots_bag_is_driven_by_the_types_of_its_topics() {
    let (report, changes) = replayed(&bag(robots), &sensor());
    assert!(!report.has_decisions && report.recorded_digest.is_none());
    assert!(report.answers > 5 && report.goals > 0, "{report:?}");
    assert_eq!(changes[0], "Paused: starting: waiting for every input");
    assert!(changes.contains(&"Driving".to_owned()), "{changes:?}");
    let again = replayed(&bag(robots), &sensor());
    assert_eq!(again.0.digest, report.digest);

    // A goal by hand, for a bag without one.
    let bare = bag(|topic| robots(topic).filter(|name| !name.ends_with("goal_pose")));
    assert!(
        refusal(&bare, &sensor()).contains("no goal: expected one on the topic goal_pose, or as --goal X,Y")
    );
    let options = Options { goal_m: Some((37.0, 28.0).into()), ..sensor() };
    assert!(replayed(&bare, &options).1.contains(&"Driving".to_owned()));
}

#[test]
fn lz4_and_zstd_are_read_and_give_the_same_decisions() {
    let plain = bag(robots);
    let lz4 = compressed(&plain, "lz4", |data| {
        let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
        encoder.write_all(data).unwrap();
        encoder.finish().unwrap()
    });
    let zstd = compressed(&plain, "zstd", |data| {
        ruzstd::encoding::compress_to_vec(data, ruzstd::encoding::CompressionLevel::Fastest)
    });
    let digest = replayed(&plain, &sensor()).0.digest;
    assert_eq!(replayed(&compressed(&plain, "", <[u8]>::to_vec), &sensor()).0.digest, digest);
    for packed in [lz4, zstd] {
        assert!(packed.len() < plain.len());
        assert_eq!(replayed(&packed, &sensor()).0.digest, digest);
        let (cut, _) =
            replayed(&packed[..packed.len() / 2], &Options { goal_m: Some((1.0, 1.0).into()), ..sensor() });
        assert!(cut.is_cut);
    }
    let other = compressed(&plain, "xz", <[u8]>::to_vec);
    assert!(refusal(&other, &sensor()).contains("xz"), "{}", refusal(&other, &sensor()));
}

#[test]
fn topics_that_cannot_be_told_apart_are_asked_for() {
    let twice = bag(|topic| robots(topic).map(|name| name.replace("/husky/imu", "/husky/imu_1")));
    assert!(replayed(&twice, &sensor()).0.answers > 0);

    let named = |role, topic: &str| Options { topics: [(role, topic.to_owned())].into(), ..sensor() };
    let wrong = named(Role::Imu, "/husky/odometry");
    assert!(refusal(&twice, &wrong).contains(
        "topic /husky/odometry is nav_msgs/msg/Odometry in cdr: expected sensor_msgs/msg/Imu in cdr"
    ));
    assert!(refusal(&twice, &named(Role::Imu, "/imu_2")).contains("topic /imu_2 for imu is not in the file"));
    let blind = bag(|topic| robots(topic).filter(|name| !name.ends_with("scan")));
    assert!(
        refusal(&blind, &sensor())
            .contains("no topic of type sensor_msgs/msg/PointCloud2: expected one for scan")
    );

    // Two clouds: neither is taken for the other.
    let out = Cursor::new(Vec::new());
    let mut writer = mcap::WriteOptions::new().compression(None).use_chunks(false).create(out).unwrap();
    let schema = writer.add_schema("sensor_msgs/msg/PointCloud2", "ros2msg", b"").unwrap();
    for topic in ["/front/points", "/rear/points"] {
        writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).unwrap();
    }
    writer.finish().unwrap();
    let text = refusal(&writer.into_inner().into_inner(), &sensor());
    let expected = "/front/points and /rear/points are both sensor_msgs/msg/PointCloud2: \
        expected one to be named, as --topic scan=/front/points";
    assert!(text.contains(expected), "{text}");
}
