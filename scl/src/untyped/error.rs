//! Why a gate cannot be taken out of a component, and why waiting for several ended.

use crate::error::{BlockingError, GateName, RecvError};
use crate::spec::{ComponentSpec, GateKind};
use crate::time::Rounded;
use scl_text::suggest::closest_name;
use std::time::Duration;
use thiserror::Error;

/// A gate could not be taken out of its component.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum GateError {
    /// The component has no gate with this name.
    #[error("component `{component}` has no gate `{gate}`{}", advice(nearest, known))]
    Unknown {
        /// The component.
        component: String,
        /// The name that was asked for.
        gate: String,
        /// The gate that may have been meant.
        nearest: Option<String>,
        /// The names of its gates.
        known: Vec<String>,
    },
    /// The gate is of another kind.
    #[error("gate `{gate}` is a `{}` gate, not a `{}` gate; take it with `{}`", found.word(), expected.word(), method(*found))]
    Kind {
        /// The gate.
        gate: GateName,
        /// Its kind.
        found: GateKind,
        /// The kind that was asked for.
        expected: GateKind,
    },
    /// The gate was taken before.
    #[error("gate `{gate}` was already taken; a gate can be taken only once")]
    Taken {
        /// The gate.
        gate: GateName,
    },
}

/// Waiting for several gates ended without a message.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WaitError {
    /// None of the gates received anything.
    #[error("component `{component}` received nothing at {} within {}", either(gates), Rounded(*waited))]
    Timeout {
        /// The component.
        component: &'static str,
        /// The gates.
        gates: Vec<GateName>,
        /// How long it waited.
        waited: Duration,
    },
    /// The call could not be made, or had to stop waiting.
    #[error("component `{component}` stopped waiting for its gates")]
    Blocking {
        /// The component.
        component: &'static str,
        /// Why.
        source: BlockingError,
    },
    /// One of the gates cannot be used any more.
    #[error(transparent)]
    Recv(#[from] RecvError),
}

/// Lists names of gates as alternatives, for error messages.
fn either(gates: &[GateName]) -> String {
    let names: Vec<String> = gates.iter().map(|gate| format!("`{gate}`")).collect();
    if names.is_empty() { "no gate".to_owned() } else { names.join(" or ") }
}

impl GateError {
    pub(super) fn unknown(spec: &ComponentSpec, gate: &str) -> Self {
        let names = || spec.gates.iter().map(|gate| gate.name);
        Self::Unknown {
            component: spec.name.to_owned(),
            gate: gate.to_owned(),
            nearest: closest_name(gate, names()).map(str::to_owned),
            known: names().map(str::to_owned).collect(),
        }
    }
}

fn advice(nearest: &Option<String>, known: &[String]) -> String {
    match (nearest, known) {
        (Some(name), _) => format!("; did you mean `{name}`?"),
        (None, []) => "; it has no gates".to_owned(),
        (None, [only]) => format!("; its gate is `{only}`"),
        (None, known) => format!("; its gates are {}", scl_text::list::listed(known)),
    }
}

/// Returns the name of the method that takes a gate of this kind.
fn method(kind: GateKind) -> &'static str {
    match kind {
        GateKind::Pub => "publisher",
        GateKind::Sub => "subscriber",
        GateKind::Req => "requester",
        GateKind::Rep => "replier",
        GateKind::Push => "pusher",
        GateKind::Pull => "puller",
    }
}
