//! Sound MCAP files with any messages on the topics that have a role.

#![no_main]

use std::io::Cursor;

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use mapless_recording::{Options, Role, replay};

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
    Cloud { width: u16, point_step: u8, data: Vec<f32> },
}

fn record(file: &mut Vec<u8>, opcode: u8, body: &[u8]) {
    file.push(opcode);
    file.extend((body.len() as u64).to_le_bytes());
    file.extend(body);
}

fn string(into: &mut Vec<u8>, text: &str) {
    into.extend((text.len() as u32).to_le_bytes());
    into.extend(text.as_bytes());
}

/// A string of CDR, on its boundary of four bytes.
fn cdr_string(into: &mut Vec<u8>, text: &str) {
    into.resize(into.len().next_multiple_of(4), 0);
    into.extend((text.len() as u32 + 1).to_le_bytes());
    into.extend(text.as_bytes());
    into.push(0);
}

fn cdr_number(into: &mut Vec<u8>, number: u32) {
    into.resize(into.len().next_multiple_of(4), 0);
    into.extend(number.to_le_bytes());
}

fn cloud(stamp_ms: u64, width: u16, point_step: u8, data: &[f32]) -> Vec<u8> {
    let mut body = Vec::new();
    cdr_number(&mut body, (stamp_ms / 1000) as u32);
    cdr_number(&mut body, (stamp_ms % 1000 * 1_000_000) as u32);
    cdr_string(&mut body, "lidar");
    for number in [1, u32::from(width), 3] {
        cdr_number(&mut body, number);
    }
    for (name, offset) in [("x", 0), ("y", 4), ("z", 8)] {
        cdr_string(&mut body, name);
        cdr_number(&mut body, offset);
        body.push(7);
        cdr_number(&mut body, 1);
    }
    body.push(0);
    cdr_number(&mut body, point_step.into());
    cdr_number(&mut body, u32::from(width) * u32::from(point_step));
    cdr_number(&mut body, 4 * data.len() as u32);
    body.extend(data.iter().flat_map(|number| number.to_le_bytes()));
    body.push(1);
    body
}

fuzz_target!(|messages: Vec<Message>| {
    let roles: Vec<Role> = Role::INPUTS.into_iter().chain(Role::DECISIONS).collect();
    let mut file = b"\x89MCAP0\r\n".to_vec();
    record(&mut file, 0x01, &[0; 8]);
    for (id, role) in (1_u16..).zip(&roles) {
        let mut schema = id.to_le_bytes().to_vec();
        for text in [role.schema(), "ros2msg", ""] {
            string(&mut schema, text);
        }
        record(&mut file, 0x03, &schema);
        let mut channel = [id, id].map(u16::to_le_bytes).concat();
        let topic = match role {
            Role::Reset => "/mapless/reset".to_owned(),
            _ if Role::INPUTS.contains(role) => format!("/{}", role.name()),
            _ => format!("/mapless/{}", role.name()),
        };
        string(&mut channel, &topic);
        string(&mut channel, "cdr");
        channel.extend([0; 4]);
        record(&mut file, 0x04, &channel);
    }
    let mut time_ms = 1_000_000_u64;
    for message in &messages {
        time_ms += u64::from(message.after_ms);
        let id = 1 + u16::from(message.role) % roles.len() as u16;
        let mut body = [id, 0, 0].map(u16::to_le_bytes).concat();
        for _ in 0..2 {
            body.extend((time_ms * 1_000_000).to_le_bytes());
        }
        body.extend([0, u8::from(!message.is_big_endian), 0, 0]);
        match &message.body {
            Body::Bytes(bytes) => body.extend(bytes),
            Body::Numbers(numbers) => body.extend(numbers.iter().flat_map(|number| number.to_le_bytes())),
            Body::Cloud { width, point_step, data } => body.extend(cloud(time_ms, *width, *point_step, data)),
        }
        record(&mut file, 0x05, &body);
    }
    let _ = replay(Cursor::new(&file), &Options::default(), |_| {});
});
