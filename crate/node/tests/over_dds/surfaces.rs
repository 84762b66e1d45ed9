//! What viewers are shown with `visualise`.

use std::time::{Duration, Instant};

use mapless_node::messages::PointCloud2;
use ros2_client::{MessageTypeName, Name, Node, QosProfile, Subscription};

use crate::robot::Robot;
use crate::{DISCOVERY, Process, client, drive, peer, until};

/// As a viewer subscribes: best effort.
fn clouds(node: &mut Node, topic: &str) -> Subscription<PointCloud2> {
    let qos = QosProfile::subscription_default();
    let kind = MessageTypeName::new("sensor_msgs", "PointCloud2");
    let topic = node.create_topic(&Name::parse(&format!("mapless/{topic}")).unwrap(), kind, &qos).unwrap();
    node.create_subscription(&topic, Some(qos)).unwrap()
}

fn points(cloud: &PointCloud2) -> impl Iterator<Item = Vec<f32>> {
    let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().unwrap());
    let step = cloud.point_step as usize;
    cloud.data.chunks_exact(step).map(move |point| point.chunks_exact(4).map(number).collect())
}

#[test]
fn variance_comes_with_each_answer_and_remembered_ground_once_a_second() {
    let domain_id = 201 + (std::process::id() % 25) as u16;
    let mut process = Process::start(domain_id, "    visualise: true\n");
    let robot = Robot::start(peer(domain_id, "robot"));
    let mut viewer = peer(domain_id, "viewer");
    let [variance, elevation] = ["variance", "elevation"].map(|topic| clouds(&mut viewer, topic));
    drive(&client(&mut peer(domain_id, "client")), &robot);
    for topic in [&variance, &elevation] {
        until(DISCOVERY, || topic.take().unwrap()).expect("no cloud came");
    }

    let (begun, decided) = (Instant::now(), robot.decisions());
    let (mut surfaces, mut ground) = (0, Vec::new());
    while begun.elapsed() < Duration::from_secs(5) {
        surfaces += usize::from(variance.take().unwrap().is_some());
        ground.extend(elevation.take().unwrap().map(|(cloud, _)| (begun.elapsed(), cloud)));
        std::thread::sleep(Duration::from_millis(5));
    }
    let decided = robot.decisions() - decided;
    assert!(surfaces > decided / 2 && decided > 10, "{surfaces} of {decided}");
    assert!((2..=6).contains(&ground.len()), "{} in 5 s, {decided} answers", ground.len());

    let (_, cloud) = ground.pop().unwrap();
    let names: Vec<_> = cloud.fields.iter().map(|field| field.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "z", "returns", "age", "upright"]);
    assert_eq!((cloud.header.frame_id.as_str(), cloud.data.len() as u32), ("odom", 24 * cloud.width));
    assert!((1000..=96 * 96).contains(&cloud.width), "{}", cloud.width);
    println!("{} bytes of remembered ground, {surfaces} surfaces of {decided}", cloud.data.len());
    let [robot_x, robot_y] = robot.position_m();
    for point in points(&cloud) {
        let [x, y, z, returns, age, upright] = point[..] else { unreachable!() };
        let [from_x, from_y] = [f64::from(x) - robot_x, f64::from(y) - robot_y];
        assert!(from_x.abs() < 14.0 && from_y.abs() < 14.0, "{from_x} {from_y}");
        // Level odometry has `base_link` at the height 0.
        assert!((z + 0.165).abs() < 0.1 && upright == 0.0, "{z} {upright}");
        assert!((1.0..=30.0).contains(&returns) && (0.0..300.0).contains(&age), "{returns} {age}");
    }
    process.end();
}
