//! The parameter services of a ROS 2 node. Those of `ros2-client` have neither descriptions nor ranges.

use ros2_client::dds::{Server, ServiceMapping};
use ros2_client::parameters::raw::{Parameter, ParameterEvent, SetParametersResult};
use ros2_client::qos::History;
use ros2_client::rcl_interfaces::{
    DescribeParametersRequest, DescribeParametersResponse, GetParameterTypesRequest,
    GetParameterTypesResponse, GetParametersRequest, GetParametersResponse, ListParametersRequest,
    ListParametersResponse, SetParametersAtomicallyResponse, SetParametersRequest, SetParametersResponse,
};
use ros2_client::{Message, Name, NodeName, Publisher, QosProfile, ServiceTypeName};

use super::{Entities, RosError, making, published_qos};
use crate::messages::Time;
use crate::parameters::Parameters;

/// The servers.
pub(crate) struct ParameterServices {
    list: Server<ListParametersRequest, ListParametersResponse>,
    get: Server<GetParametersRequest, GetParametersResponse>,
    types: Server<GetParameterTypesRequest, GetParameterTypesResponse>,
    describe: Server<DescribeParametersRequest, DescribeParametersResponse>,
    set: Server<SetParametersRequest, SetParametersResponse>,
    set_atomically: Server<SetParametersRequest, SetParametersAtomicallyResponse>,
    events: Publisher<ParameterEvent>,
    node: String,
}

impl ParameterServices {
    /// Serves the parameters of `node`.
    pub(crate) fn new(node: &NodeName, entities: &mut Entities) -> Result<Self, RosError> {
        let node = node.fully_qualified_name();
        Ok(Self {
            list: server(entities, &node, "list_parameters", "ListParameters")?,
            get: server(entities, &node, "get_parameters", "GetParameters")?,
            types: server(entities, &node, "get_parameter_types", "GetParameterTypes")?,
            describe: server(entities, &node, "describe_parameters", "DescribeParameters")?,
            set: server(entities, &node, "set_parameters", "SetParameters")?,
            set_atomically: server(entities, &node, "set_parameters_atomically", "SetParametersAtomically")?,
            events: entities.publisher(
                "/parameter_events",
                "rcl_interfaces/ParameterEvent",
                published_qos(),
            )?,
            node,
        })
    }

    /// Answers whoever asks or sets. `is_pursuing`: there is a goal.
    pub(crate) fn serve(&self, parameters: &mut Parameters, is_pursuing: bool, stamp: Time) {
        answer(&self.list, |request| ListParametersResponse {
            result: parameters.list(&request.prefixes, request.depth),
        });
        answer(&self.get, |request| GetParametersResponse {
            values: request.names.iter().map(|name| parameters.get(name)).collect(),
        });
        answer(&self.types, |request| GetParameterTypesResponse {
            values: request.names.iter().map(|name| parameters.get(name).ptype).collect(),
        });
        answer(&self.describe, |request| DescribeParametersResponse {
            values: request.names.iter().map(|name| parameters.describe(name)).collect(),
        });
        let mut change = |changes: &[Parameter]| {
            let result = parameters.set(changes, is_pursuing);
            match &result {
                Ok(()) => self.tell(changes, stamp),
                Err(reason) => log::warn!("a parameter is not set: {reason}"),
            }
            SetParametersResult::from(result)
        };
        answer(&self.set, |request| SetParametersResponse {
            results: request.parameter.iter().map(|one| change(std::slice::from_ref(one))).collect(),
        });
        answer(&self.set_atomically, |request| SetParametersAtomicallyResponse {
            result: change(&request.parameter),
        });
    }

    /// Tells everybody of a change.
    fn tell(&self, changes: &[Parameter], stamp: Time) {
        for Parameter { name, .. } in changes {
            log::info!("{name} was set");
        }
        let event = ParameterEvent {
            stamp: ros2_client::builtin_interfaces::Time::from_nanos(stamp.nanoseconds()),
            node: self.node.clone(),
            new_parameters: Vec::new(),
            changed_parameters: changes.to_vec(),
            deleted_parameters: Vec::new(),
        };
        if let Err(error) = self.events.publish(event) {
            log::warn!("a change of parameters could not be published: {error}");
        }
    }
}

fn server<Req: Message + Clone + 'static, Resp: Message + 'static>(
    entities: &mut Entities,
    node: &str,
    name: &str,
    kind: &str,
) -> Result<Server<Req, Resp>, RosError> {
    let what = || format!("service {node}/{name}");
    let qos = QosProfile::publisher_default().history(History::KeepLast { depth: 10 });
    let service = Name::new(node, name).map_err(making(what()))?;
    let kind = ServiceTypeName::new("rcl_interfaces", kind);
    let made = entities.node.create_server(ServiceMapping::Enhanced, &service, &kind, qos.clone(), qos);
    let mut server = made.map_err(making(what()))?;
    entities.wake_by(&mut server)?;
    Ok(server)
}

/// Answers every request that waits.
fn answer<Req: Message + 'static, Resp: Message + 'static>(
    server: &Server<Req, Resp>,
    mut answer: impl FnMut(Req) -> Resp,
) {
    loop {
        match server.receive_request() {
            Ok(Some((id, request))) => {
                if let Err(error) = server.send_response(id, answer(request)) {
                    log::warn!("a request about parameters could not be answered: {error:?}");
                }
            }
            Ok(None) => return,
            Err(error) => log::warn!("a request about parameters could not be read: {error}"),
        }
    }
}
