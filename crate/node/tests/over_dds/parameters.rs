//! Parameters over the services of a ROS 2 node.

use std::time::Duration;

use ros2_client::dds::{Client, ServiceMapping};
use ros2_client::parameters::raw::SetParametersResult;
use ros2_client::qos::History;
use ros2_client::rcl_interfaces::{
    GetParametersRequest, GetParametersResponse, SetParametersRequest, SetParametersResponse,
};
use ros2_client::{Message, Name, Node, Parameter, ParameterValue, QosProfile, ServiceTypeName};

use crate::robot::Robot;
use crate::{DISCOVERY, Process, client, drive, peer, until};

fn ask<Req, Resp>(node: &mut Node, name: &str, kind: &str) -> Client<Req, Resp>
where
    Req: Message + Clone + 'static,
    Resp: Message + 'static,
{
    let qos = QosProfile::publisher_default().history(History::KeepLast { depth: 10 });
    let name = Name::new("/a200_0000/mapless", name).unwrap();
    let kind = ServiceTypeName::new("rcl_interfaces", kind);
    node.create_client(ServiceMapping::Enhanced, &name, &kind, qos.clone(), qos).unwrap()
}

fn answered<Req: Message + Clone + 'static, Resp: Message + 'static>(
    client: &Client<Req, Resp>,
    request: &Req,
) -> Resp {
    // The first requests may be sent before both sides know each other.
    let answer = until(DISCOVERY, || {
        client.send_request(request.clone()).unwrap();
        until(Duration::from_secs(1), || client.receive_response().unwrap())
    });
    answer.expect("no answer").1
}

#[test]
fn limits_change_while_the_robot_drives_and_others_are_refused() {
    let domain_id = 126 + (std::process::id() % 25) as u16;
    let mut process = Process::start(domain_id, "");
    let robot = Robot::start(peer(domain_id, "robot"));
    let mut node = peer(domain_id, "client");
    let goals = client(&mut node);
    let setter: Client<SetParametersRequest, SetParametersResponse> =
        ask(&mut node, "set_parameters", "SetParameters");
    let getter: Client<GetParametersRequest, GetParametersResponse> =
        ask(&mut node, "get_parameters", "GetParameters");
    let set = |name: &str, value: ParameterValue| -> SetParametersResult {
        let parameter = Parameter { name: name.to_owned(), value }.into();
        answered(&setter, &SetParametersRequest { parameter: vec![parameter] }).results.remove(0)
    };

    let limit = "supervisor.max_speed_m_s";
    let told = answered(&getter, &GetParametersRequest { names: vec![limit.to_owned()] });
    assert!((told.values[0].double_value - 0.5).abs() < 1e-12, "as in the file");
    let tolerance = "planner.goal_tolerance_m";
    assert!(set(tolerance, ParameterValue::Double(1.5)).successful, "no goal is pursued");
    drive(&goals, &robot);
    until(Duration::from_secs(20), || (robot.speed_m_s() > 0.4).then_some(())).expect("it is slow");
    assert!(set(limit, ParameterValue::Double(0.2)).successful);
    until(Duration::from_secs(2), || (robot.speed_m_s() <= 0.2 + 1e-9).then_some(())).expect("it is fast");
    for _ in 0..100 {
        std::thread::sleep(Duration::from_millis(5));
        assert!(robot.speed_m_s() <= 0.2 + 1e-9, "{}", robot.speed_m_s());
    }
    // A loaded machine may have paused the drive.
    until(Duration::from_secs(10), || robot.is_driven().then_some(())).expect("it does not drive");

    let refused = set(limit, ParameterValue::Double(-1.0));
    assert_eq!(refused.reason, "supervisor.max_speed_m_s = -1: expected a positive number");
    let refused = set(tolerance, ParameterValue::Double(1.0));
    assert!(!refused.successful && refused.reason.contains("a goal is pursued"), "{}", refused.reason);
    until(Duration::from_secs(10), || robot.is_driven().then_some(())).expect("it does not drive");
    process.end();
}
