//! Who sent a message.

use crate::error::OpenError;
use crate::spec::{ConnectionSpec, GateSpec};
use scl_plan::PlanError;

/// An enum of the gates that can send to a `sub` gate: for the components of a kind the enum of the kind, otherwise one
/// that [`topology!`](crate::topology) generates for the gate.
///
/// See [`Sub::recv_from`](crate::Sub::recv_from).
pub trait Senders: Copy + Send + Sync + 'static {
    /// Returns the sender at the other end of a connection; `None` if it is not one of them.
    #[doc(hidden)]
    fn of(connection: &ConnectionSpec) -> Option<Self>;
}

/// The senders of a gate, in the order of its connections.
///
/// # Errors
/// [`OpenError::Plan`] if one of them is not in the enum: the plan is not that of the program.
pub(crate) fn senders<S: Senders>(component: &str, spec: &GateSpec) -> Result<Box<[S]>, OpenError> {
    let of = |connection| {
        S::of(connection).ok_or_else(|| {
            let ConnectionSpec { peer_component, peer_gate, .. } = connection;
            let reason = format!("is connected to `{peer_component}.{peer_gate}`, which this program does not know");
            let source = PlanError::Inconsistent { part: format!("gate `{component}.{}`", spec.name), reason };
            OpenError::Plan { component: component.to_owned(), source: Box::new(source) }
        })
    };
    spec.connections.iter().map(of).collect()
}
