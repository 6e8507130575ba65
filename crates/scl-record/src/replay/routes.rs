//! Which gate sends what a channel has recorded.

use super::participants::Participants;
use crate::format::Part;
use crate::recording::{RecordedChannel, type_and_codec};
use scl_plan::{GatePlan, SystemPlan};
use scl_terminal::{Problem, closest_name};

/// What becomes of the messages of a channel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Route {
    /// A played gate sends them.
    Send { component: String, gate: String },
    /// They are the replies of a played or a running replier.
    Reply,
    /// They are not sent, for this reason.
    Skip(String),
}

/// Finds the gate that sent the messages of a channel.
///
/// A tap records what a gate publishes or pulls, or the requests that it receives. Pushers and requesters are found by
/// the plan: if a gate has several, a recording does not say which of them sent a message, so they can only be played
/// together.
///
/// # Errors
/// The recorded contract is not that of the plan, or the plan has no such gate.
pub(super) fn route(plan: &SystemPlan, cast: &Participants, channel: &RecordedChannel) -> Result<Route, Problem> {
    let topic = &channel.topic;
    let Some(component) = plan.components.iter().find(|plan| plan.component == topic.component) else {
        return Ok(Route::Skip(format!("the topology has no component `{}`", topic.component)));
    };
    let Some(gate) = component.gate(&topic.gate) else {
        let problem = Problem::new(format!("`{}` was recorded, but the topology has no such gate", topic.gate_name()));
        return Err(match closest_name(&topic.gate, component.gates.iter().map(|gate| gate.name.as_str())) {
            Some(close) => problem.help(format!("was it renamed to `{}.{close}`?", topic.component)),
            None => problem.help("use the topology of the recording: leave out `--topology`"),
        });
    };
    check_contract(channel, gate)?;
    if topic.part == Part::Reply {
        return Ok(Route::Reply);
    }
    if gate.kind == scl_plan::GateKind::Pub {
        return Ok(match cast.plays(&component.component) {
            true => Route::Send { component: component.component.clone(), gate: gate.name.clone() },
            false => Route::Skip(cast.why_not(&component.component)),
        });
    }
    let absent = gate.connections.iter().find(|connection| !cast.plays(&connection.peer_component));
    Ok(match (gate.connections.first(), absent) {
        (None, _) => Route::Skip("no gate is connected to it".to_owned()),
        (Some(first), None) => Route::Send { component: first.peer_component.clone(), gate: first.peer_gate.clone() },
        (Some(_), Some(absent)) if gate.connections.len() == 1 => Route::Skip(cast.why_not(&absent.peer_component)),
        (Some(_), Some(absent)) => {
            let sender = if topic.part == Part::Request { "requesters" } else { "pushers" };
            let why = cast.why_not(&absent.peer_component);
            Route::Skip(format!("it has several {sender}, which the recording does not distinguish, and {why}"))
        }
    })
}

fn check_contract(channel: &RecordedChannel, gate: &GatePlan) -> Result<(), Problem> {
    if channel.metadata.contract == gate.contract {
        return Ok(());
    }
    let planned = type_and_codec(channel.topic.part.type_name(&gate.payload), &gate.codec);
    let recorded = channel.type_and_codec();
    let name = channel.topic.gate_name();
    let problem = Problem::new(format!("`{name}` was recorded as {recorded}, but the topology declares {planned}"));
    Err(problem.help("use the topology of the recording: leave out `--topology`"))
}
