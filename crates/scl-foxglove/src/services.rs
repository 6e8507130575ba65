//! `rep` gates as services.

use crate::channels::any_object;
use crate::graph::topic;
use foxglove::websocket::service::{Service, ServiceSchema};
use scl_observe::{Commands, ObservedGate};
use scl_plan::{GateKind, Payload};

/// The service of a gate, whose calls stand in for one of its requesters; `None` unless it is a `rep` gate.
pub(crate) fn service_of(gate: &ObservedGate, commands: &Commands) -> Option<Service> {
    let (GateKind::Rep, Payload::Exchange { request, reply }) = (gate.kind, &gate.payload) else { return None };
    let schema = ServiceSchema::new(format!("{request} -> {reply}"))
        .with_request("json", any_object(request))
        .with_response("json", any_object(reply));
    let service = Service::builder(topic(&gate.component, &gate.gate), schema);
    let (name, commands) = (gate.name(), commands.clone());
    Some(service.async_handler_fn(move |request| {
        let (name, commands) = (name.clone(), commands.clone());
        async move {
            let request = String::from_utf8_lossy(request.payload()).into_owned();
            let done = commands.run("call", &["--format", "json"], &[&name, &request]).await?;
            match done.status.success() {
                true => Ok(done.stdout),
                false => Err(String::from_utf8_lossy(&done.stderr).into_owned()),
            }
        }
    }))
}
