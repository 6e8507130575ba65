//! Gates: their handles, and what all kinds have in common.

use crate::border;
use crate::error::Failure;
use crate::registry::{Locked, Registry};
use crate::status::*;
use scl::untyped::Gate;

/// A gate. It belongs to its component and lives as long.
#[allow(non_camel_case_types)]
pub struct scl_gate {
    _opaque: [u8; 0],
}

/// What a gate handle stands for.
pub(crate) struct OpenGate {
    pub(crate) gate: Gate,
}

static GATES: Registry<OpenGate> = Registry::new(5, "gate");

/// Returns true if all required peers are connected or, for `rep` and `pull` gates, at least one peer. False for an
/// invalid handle and for a gate that another thread is using.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_is_connected(gate: *const scl_gate) -> bool {
    border::value(|| Ok(lock(gate)?.gate.is_connected())).unwrap_or(false)
}

pub(crate) fn insert(gate: Gate) -> Result<usize, Failure> {
    GATES.insert(OpenGate { gate })
}

/// Invalidates a gate's handle, ends the call that uses it, and drops the gate.
pub(crate) fn remove(handle: usize) -> Result<(), Failure> {
    GATES.remove(handle, || ()).map(drop)
}

/// Locks a gate for one call.
pub(crate) fn lock(gate: *const scl_gate) -> Result<Locked<'static, OpenGate>, Failure> {
    GATES.lock(gate as usize)
}

/// The failure of a call for which the gate has the wrong kind. `call` is what fits these kinds.
#[cold]
pub(crate) fn wrong_kind(gate: &Gate, call: &str) -> Failure {
    let spec = gate.spec();
    let (name, kind) = (spec.name, spec.kind.word());
    let advice = match gate {
        Gate::Pub(_) | Gate::Push(_) => "scl_send",
        Gate::Sub(_) | Gate::Pull(_) => "scl_recv",
        Gate::Req(_) => "scl_call",
        Gate::Rep(_) => "scl_take_request",
        _ => "another call",
    };
    Failure::new(SCL_KIND, format!("gate `{name}` is a `{kind}` gate, for which there is no `{call}`; use `{advice}`"))
}
