//! Sound MCAP files with any messages on the topics that have a role.

#![no_main]

use std::collections::BTreeMap;
use std::io::Cursor;

use arbitrary::Arbitrary;
use byteorder::LittleEndian;
use libfuzzer_sys::fuzz_target;
use mapless_node::messages::{Header, PointCloud2, PointField, Time};
use mapless_recording::{Options, Role, replay};
use mcap::WriteOptions;
use mcap::records::MessageHeader;

#[derive(Arbitrary, Debug)]
struct Message {
    role: u8,
    after_ms: u16,
    is_big_endian: bool,
    body: Body,
}

#[derive(Arbitrary, Debug)]
enum Body {
    Bytes(Vec<u8>),
    /// What most messages are made of.
    Numbers(Vec<f64>),
    Cloud {
        width: u16,
        point_step: u8,
        data: Vec<f32>,
    },
}

fn cloud(stamp: Time, width: u16, point_step: u8, data: &[f32]) -> PointCloud2 {
    let field =
        |(name, offset): (&str, u32)| PointField { name: name.to_owned(), offset, datatype: 7, count: 1 };
    PointCloud2 {
        header: Header { stamp, frame_id: "lidar".to_owned() },
        height: 1,
        width: width.into(),
        fields: [("x", 0), ("y", 4), ("z", 8)].map(field).into(),
        is_bigendian: false,
        point_step: point_step.into(),
        row_step: u32::from(width) * u32::from(point_step),
        data: data.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>().into(),
        is_dense: true,
    }
}

fn topic(role: Role) -> String {
    match role {
        Role::Reset => "/mapless/reset".to_owned(),
        _ if Role::INPUTS.contains(&role) => format!("/{}", role.name()),
        _ => format!("/mapless/{}", role.name()),
    }
}

fuzz_target!(|messages: Vec<Message>| {
    let mut file = Cursor::new(Vec::new());
    let mut writer = WriteOptions::new().compression(None).create(&mut file).unwrap();
    let roles = Role::INPUTS.into_iter().chain(Role::DECISIONS);
    let channels: Vec<u16> = roles
        .map(|role| {
            let schema = writer.add_schema(role.schema(), "ros2msg", &[]).unwrap();
            writer.add_channel(schema, &topic(role), "cdr", &BTreeMap::new()).unwrap()
        })
        .collect();
    let mut time_ns = 1_000_000_000_000_u64;
    for message in &messages {
        time_ns += 1_000_000 * u64::from(message.after_ms);
        let mut bytes = vec![0, u8::from(!message.is_big_endian), 0, 0];
        match &message.body {
            Body::Bytes(any) => bytes.extend(any),
            Body::Numbers(numbers) => bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes())),
            Body::Cloud { width, point_step, data } => {
                let cloud = cloud(Time::from_nanoseconds(time_ns as i64), *width, *point_step, data);
                bytes.extend(cdr_encoding::to_vec::<_, LittleEndian>(&cloud).unwrap());
            }
        }
        let channel_id = channels[usize::from(message.role) % channels.len()];
        let header = MessageHeader { channel_id, sequence: 0, log_time: time_ns, publish_time: time_ns };
        writer.write_to_known_channel(&header, &bytes).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    let _ = replay(Cursor::new(file.get_ref()), &Options::default(), |_| {});
});
