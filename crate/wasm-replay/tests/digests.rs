//! In the browser, a recording is decided as natively, to the bit, and its topics are told apart likewise.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::io::Cursor;

use js_sys::{Function, JSON, Uint8Array};
use mapless_wasm_replay::{RecordingFile, replay_recording, topic_choices};
use mcap::records::MessageHeader;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};

wasm_bindgen_test_configure!(run_in_dedicated_worker);

#[wasm_bindgen_test]
fn a_recorded_drive_gives_the_native_digest() {
    let bytes = include_bytes!("../../recording/tests/kept/drive.mcap");
    let replayed = replay_recording("drive.mcap", bytes).ok().unwrap();
    assert!(replayed.answers() > 5.0 && replayed.differences() == 0.0);
    assert_eq!(replayed.digest(), include_str!("../../recording/tests/kept/drive.digest").trim());
    let cut = replay_recording("cut.mcap", &bytes[..bytes.len() / 2]).ok().unwrap();
    assert!(cut.differences() == 0.0 && cut.until_s() < replayed.until_s());
}

/// As the page's worker gives it.
fn file(bytes: &[u8]) -> RecordingFile {
    let make = Function::new_with_args(
        "bytes",
        "return { name: 'bag.mcap', size: bytes.length, read: (at, length) => bytes.slice(at, at + length) }",
    );
    make.call1(&JsValue::NULL, &Uint8Array::from(bytes)).unwrap().unchecked_into()
}

#[wasm_bindgen_test]
fn topics_of_one_type_are_candidates_for_one_role() {
    let topics = [
        ("/odom", "nav_msgs/msg/Odometry", 1),
        ("/imu", "sensor_msgs/msg/Imu", 1),
        ("/front", "sensor_msgs/msg/PointCloud2", 1),
        ("/rear", "sensor_msgs/msg/PointCloud2", 2),
    ];
    let mut writer = mcap::WriteOptions::new().compression(None).create(Cursor::new(Vec::new())).unwrap();
    for (topic, schema, messages) in topics {
        let schema = writer.add_schema(schema, "ros2msg", b"").unwrap();
        let channel_id = writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).unwrap();
        for sequence in 0..messages {
            let header = MessageHeader { channel_id, sequence, log_time: 0, publish_time: 0 };
            writer.write_to_known_channel(&header, &[0, 1, 0, 0]).unwrap();
        }
    }
    writer.finish().unwrap();
    let bytes = writer.into_inner().into_inner();
    let told = |bytes: &[u8]| {
        let choices = JsValue::from(topic_choices(file(bytes)).ok().unwrap());
        String::from(JSON::stringify(&choices).unwrap())
    };
    let expected = r#"[{"role":"scan","schema":"sensor_msgs/msg/PointCloud2","candidates":[{"topic":"/rear","messages":2},{"topic":"/front","messages":1}]}]"#;
    assert_eq!(told(&bytes), expected);
    assert_eq!(told(include_bytes!("../../recording/tests/kept/drive.mcap")), "[]");
}
