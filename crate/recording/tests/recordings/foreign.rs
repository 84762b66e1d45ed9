//! A robot's own recording, as `rosbag2` makes it: other topics, other frames, no decisions, compressed.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::io::{Cursor, Write as _};

use mapless_recording::{Candidate, Choice, News, Options, Player, Report, Role, choices, replay};
use mcap::records::{ChunkHeader, MessageHeader, Record};

use crate::drive::{Plan, drive};
use crate::{SHORT, file};

const PLAN: Plan = Plan { seconds: 2.5, pressed_s: 9.0, ..SHORT };

/// The messages of a drive under other names; `rename` gives a topic its name, or leaves it out.
fn bag(rename: impl Fn(&str) -> Option<String>) -> Vec<u8> {
    bag_of(|topic| rename(topic).into_iter().collect())
}

/// Likewise with each topic under any number of names.
fn bag_of(rename: impl Fn(&str) -> Vec<String>) -> Vec<u8> {
    bag_with_clock(rename, |log_ns| log_ns)
}

/// Likewise, heard at other times.
fn bag_with_clock(rename: impl Fn(&str) -> Vec<String>, clock_ns: impl Fn(u64) -> u64) -> Vec<u8> {
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
                let mut add = |name: String| {
                    writer.add_channel(schemas[&channel.schema_id], &name, "cdr", &BTreeMap::new()).unwrap()
                };
                let ids: Vec<u16> = rename(&channel.topic).into_iter().map(&mut add).collect();
                channels.insert(channel.id, ids);
            }
            Record::Message { header, data } => {
                for &channel_id in channels.get(&header.channel_id).into_iter().flatten() {
                    // As rosbag2: both times are when it was heard.
                    let log_time = clock_ns(header.log_time);
                    let header = MessageHeader { channel_id, log_time, publish_time: log_time, ..header };
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
fn a_clock_that_is_set_during_a_recording_holds_nothing_up() {
    const SECOND_NS: u64 = 1_000_000_000;
    let ticks = replayed(&bag(robots), &sensor()).0.ticks;
    let set = |shift_ns: fn(u64) -> u64| {
        let (first_ns, names) = (Cell::new(None), |topic: &str| robots(topic).into_iter().collect());
        let bytes = bag_with_clock(names, |log_ns| {
            let first_ns = first_ns.get().unwrap_or_else(|| {
                first_ns.set(Some(log_ns));
                log_ns
            });
            if log_ns < first_ns + 2 * SECOND_NS { log_ns } else { shift_ns(log_ns) }
        });
        replayed(&bytes, &sensor()).0
    };
    let on = set(|log_ns| log_ns + 365 * 86_400 * SECOND_NS);
    assert!(on.ticks <= ticks + 2 && !on.complaints.contains_key("time"), "{on:?}");
    let back = set(|log_ns| log_ns.saturating_sub(3600 * SECOND_NS));
    let (_, complaint) = &back.complaints["time"];
    assert!(back.ticks <= ticks && complaint.contains("a clock that is not set back"), "{back:?}");
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

#[test]
fn the_topics_among_which_one_must_choose_are_told_beforehand() {
    // A second cloud, and odometry from two sources.
    let two = |topic: &str| match robots(topic) {
        Some(name) if name.ends_with("scan") => vec!["/front/points".to_owned(), "/rear/points".to_owned()],
        Some(name) if name.ends_with("odometry") => vec!["/wheels".to_owned(), "/filtered".to_owned()],
        name => name.into_iter().collect(),
    };
    let bytes = bag_of(two);
    assert!(choices(bag(robots), &Options::default().topics).unwrap().is_empty());
    let choice = |role, topics: [&str; 2], messages| {
        let candidates =
            topics.map(|topic| Candidate { topic: topic.to_owned(), messages }).into_iter().collect();
        Choice { role, candidates }
    };
    let asked = choices(bytes.clone(), &Options::default().topics).unwrap();
    let scans = asked[0].candidates[0].messages;
    assert!(scans > Some(20), "{scans:?}");
    let odometry = asked[1].candidates[0].messages;
    assert!(odometry > scans, "{odometry:?}");
    assert_eq!(
        asked,
        [
            choice(Role::Scan, ["/front/points", "/rear/points"], scans),
            choice(Role::Odometry, ["/filtered", "/wheels"], odometry),
        ]
    );

    // What is named is not asked for; with all that is named the file opens.
    let name = |names: &[(Role, &str)]| {
        names.iter().map(|(role, topic)| (*role, (*topic).to_owned())).collect::<BTreeMap<_, _>>()
    };
    let scan = name(&[(Role::Scan, "/rear/points")]);
    assert_eq!(choices(bytes.clone(), &scan).unwrap(), asked[1..]);
    let both = name(&[(Role::Scan, "/rear/points"), (Role::Odometry, "/wheels")]);
    assert!(choices(bytes.clone(), &both).unwrap().is_empty());
    let options = Options { topics: both, ..sensor() };
    assert_eq!(replayed(&bytes, &options).0.digest, replayed(&bag(robots), &sensor()).0.digest);
    Player::open(bytes.clone(), options).unwrap();
    assert!(Player::open(bytes.clone(), Options { topics: scan, ..sensor() }).is_err());

    // A file that was cut off tells what comes at its begin, but not how often.
    let cut = bytes[..bytes.len() / 2].to_vec();
    assert_eq!(
        choices(cut, &Options::default().topics).unwrap(),
        [
            choice(Role::Scan, ["/front/points", "/rear/points"], None),
            choice(Role::Odometry, ["/filtered", "/wheels"], None),
        ]
    );
    // A recording of the node names its own topics.
    let own = file(&drive(PLAN));
    for bytes in [own[..own.len() / 2].to_vec(), own] {
        assert!(choices(bytes, &Options::default().topics).unwrap().is_empty());
    }
    // Naming a cloud helps nothing where there is no IMU.
    let blind = bag_of(|topic| two(topic).into_iter().filter(|name| !name.ends_with("imu")).collect());
    let text = choices(blind, &Options::default().topics).unwrap_err().to_string();
    assert!(text.contains("no topic of type sensor_msgs/msg/Imu: expected one for imu"), "{text}");
}
