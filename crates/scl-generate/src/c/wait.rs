//! Waiting for several gates of a component at once.

use super::function::Function;
use super::gate::{member, refuse_null};
use crate::system::{Component, Gate};
use scl_plan::GateKind;

/// Each gate is a bit of a `uint64_t`.
const MOST_GATES: usize = 64;

/// The gates that something arrives at; none if there are more than one number can tell.
pub(super) fn gates(component: &Component) -> Vec<&Gate> {
    let receives = |gate: &&Gate| matches!(gate.plan.kind, GateKind::Sub | GateKind::Pull | GateKind::Rep);
    let gates: Vec<&Gate> = component.gates.iter().filter(receives).collect();
    if gates.len() <= MOST_GATES { gates } else { Vec::new() }
}

/// The bit of a gate: `ROVER_CONTROLLER_SENSOR`.
pub(super) fn constant(prefix: &str, gate: &Gate) -> String {
    format!("{prefix}_{}", gate.snake_name).to_ascii_uppercase()
}

/// `rover_controller_wait`, if anything arrives at the component.
pub(super) fn function(prefix: &str, component: &Component) -> Option<Function> {
    let gates = gates(component);
    if gates.is_empty() {
        return None;
    }
    let members: Vec<String> = gates.iter().map(|gate| format!("self->gates.{}", member(gate))).collect();
    let mut body = refuse_null("self");
    body.push("scl_gate *const all[] = {".to_owned());
    body.extend(members.iter().map(|member| format!("    {member},")));
    body.push("};".to_owned());
    body.push("return wait_for(self->component, all, sizeof all / sizeof *all, gates, timeout_ns, ready);".to_owned());
    Some(Function {
        doc: "Waits until something has arrived at one of `gates`, a sum of the constants above; `*ready` tells where.",
        result: "scl_status",
        name: format!("{prefix}_wait"),
        parameters: vec![
            format!("{prefix} *self"),
            "uint64_t gates".to_owned(),
            "int64_t timeout_ns".to_owned(),
            "uint64_t *ready".to_owned(),
        ],
        body,
    })
}
