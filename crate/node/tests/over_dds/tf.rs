//! The sensor's mount by tf.

use std::time::Duration;

use mapless_node::messages::{Header, TfMessage, Transform, TransformStamped, Vector3, now};
use ros2_client::qos::{Durability, History, Reliability, WhenFull};
use ros2_client::{MessageTypeName, Name, QosProfile};

use crate::robot::Robot;
use crate::{DISCOVERY, Process, client, drive, peer, until};

fn told(parent: &str, child: &str, z: f64) -> TransformStamped {
    let translation = Vector3 { z, ..Vector3::default() };
    TransformStamped {
        header: Header { stamp: now(), frame_id: parent.to_owned() },
        child_frame_id: child.to_owned(),
        transform: Transform { translation, ..Transform::default() },
    }
}

#[test]
fn a_robot_is_driven_once_tf_told_the_mount() {
    let domain_id = 151 + (std::process::id() % 25) as u16;
    // Published before the node begins, and once.
    let mut node = peer(domain_id, "state_publisher");
    let qos = QosProfile::publisher_default()
        .reliability(Reliability::Reliable { when_full: WhenFull::Fail })
        .history(History::KeepLast { depth: 1 })
        .durability(Durability::TransientLocal);
    let name = Name::parse("tf_static").unwrap();
    let topic = node.create_topic(&name, MessageTypeName::new("tf2_msgs", "TFMessage"), &qos).unwrap();
    let publisher = node.create_publisher::<TfMessage>(&topic, Some(qos)).unwrap();
    // 0.8 m over the ground, with the 0.165 m of base_link.
    let transforms = vec![told("base_link", "plate", 0.335), told("plate", "lidar3d_0_laser", 0.3)];
    publisher.publish(TfMessage { transforms }).unwrap();
    let mut process = Process::start(domain_id, "    sensor_mount: {source: tf}\n");
    let robot = Robot::start(peer(domain_id, "robot"));
    drive(&client(&mut peer(domain_id, "client")), &robot);
    until(Duration::from_secs(20), || (robot.speed_m_s() > 0.4).then_some(())).expect("it is slow");
    process.end();
}

#[test]
fn transforms_of_a_simulation_are_as_old_as_its_clock_says() {
    let domain_id = 226 + (std::process::id() % 7) as u16;
    let process = Process::start(domain_id, "    use_sim_time: true\n    sensor_mount: {source: tf}\n");
    let robot = Robot::start_simulated(peer(domain_id, "robot"), 1.0);
    let mut node = peer(domain_id, "state_publisher");
    let topic = mapless_peer::publisher(&mut node, "tf", "tf2_msgs/TFMessage", 1).unwrap();
    let mounted = until(DISCOVERY, || {
        // By the system's clock they would be half a century old.
        let mut transform = told("base_link", "lidar3d_0_laser", 0.635);
        transform.header.stamp = robot.stamp();
        topic.publish(TfMessage { transforms: vec![transform] }).unwrap();
        process.log().contains("the sensor's mount by tf").then_some(())
    });
    assert!(mounted.is_some(), "{}", process.log());
}

#[test]
fn without_tf_the_node_ends_and_says_what_is_missing() {
    let domain_id = 176 + (std::process::id() % 25) as u16;
    let mut process = Process::start(domain_id, "    sensor_mount: {source: tf, timeout_s: 2.0}\n");
    let status = until(DISCOVERY, || process.child.try_wait().unwrap()).expect("it goes on");
    assert_eq!(status.code(), Some(1));
    let said = process.log();
    let expected = "tf: no transforms lead from frame \"base_link\" to \"lidar3d_0_laser\"; known are none";
    assert!(said.contains(expected), "{said}");
}
