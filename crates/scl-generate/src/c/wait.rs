//! Waiting for several gates of a component at once.

use super::function::Function;
use super::gate::{member, refuse_null};
use crate::system::{Component, Gate};
use scl_plan::GateKind;

/// Maximum number of gates to wait for: each gate is a bit of a `uint64_t`.
const MOST_GATES: usize = 64;

/// The gates that can receive; none if there are more than [`MOST_GATES`].
pub(super) fn gates(component: &Component) -> Vec<&Gate> {
    let receives = |gate: &&Gate| matches!(gate.plan.kind, GateKind::Sub | GateKind::Pull | GateKind::Rep);
    let gates: Vec<&Gate> = component.gates.iter().filter(receives).collect();
    if gates.len() <= MOST_GATES { gates } else { Vec::new() }
}

/// The name of the constant for a gate's bit: `ROVER_CONTROLLER_SENSOR`.
pub(super) fn constant(prefix: &str, gate: &Gate) -> String {
    format!("{prefix}_{}", gate.snake_name).to_ascii_uppercase()
}

/// `rover_controller_wait`, if the component has gates to wait for.
pub(super) fn function(prefix: &str, component: &Component) -> Option<Function> {
    let gates = gates(component);
    if gates.is_empty() {
        return None;
    }
    let (refuse, members) = (refuse_null("self"), gates.iter().map(|gate| member(gate)));
    let all: String = members.map(|member| format!("    self->gates.{member},\n")).collect();
    let body = format!(
        "{refuse}\n\
         scl_gate *const all[] = {{\n{all}}};\n\
         return wait_for(self->component, all, sizeof all / sizeof *all, gates, timeout_ns, ready);"
    );
    let doc =
        "Waits until something has arrived at one of `gates`, a sum of the constants above; `*ready` says at which.";
    let parameters = format!("{prefix} *self, uint64_t gates, int64_t timeout_ns, uint64_t *ready");
    Some(Function::new(prefix, "wait", doc, parameters, body))
}
