//! Why a gate cannot be taken out of a component.

use crate::error::GateName;
use crate::spec::{ComponentSpec, GateKind};
use thiserror::Error;

/// A gate was not taken.
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
    #[error("gate `{gate}` was taken before; a gate can be taken once")]
    Taken {
        /// The gate.
        gate: GateName,
    },
}

impl GateError {
    pub(super) fn unknown(spec: &ComponentSpec, gate: &str) -> Self {
        let names = || spec.gates.iter().map(|gate| gate.name);
        Self::Unknown {
            component: spec.name.to_owned(),
            gate: gate.to_owned(),
            nearest: scl_plan::nearest(gate, names()).map(str::to_owned),
            known: names().map(str::to_owned).collect(),
        }
    }
}

/// Maximum number of gates that an error lists.
const LISTED: usize = 10;

fn advice(nearest: &Option<String>, known: &[String]) -> String {
    if let Some(name) = nearest {
        return format!("; did you mean `{name}`?");
    }
    let names: Vec<String> = known.iter().take(LISTED).map(|name| format!("`{name}`")).collect();
    match known.len() {
        0 => "; it has no gates".to_owned(),
        count @ 1..=LISTED => {
            format!("; {} {}", if count == 1 { "its gate is" } else { "its gates are" }, names.join(", "))
        }
        count => format!("; its gates are {} and {} more", names.join(", "), count - LISTED),
    }
}

/// The method that takes a gate of this kind.
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
