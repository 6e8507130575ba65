//! Why a gate cannot be taken out of a component, and why waiting for several ended.

use crate::error::{BlockingError, GateName, RecvError};
use crate::spec::{ComponentSpec, GateKind};
use crate::time::Rounded;
use std::fmt;
use std::time::Duration;
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

/// Waiting for several gates ended without a message.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WaitError {
    /// None of the gates received anything.
    #[error("component `{component}` received nothing at {} within {}", Listed(gates), Rounded(*waited))]
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

/// Names of gates, for messages.
struct Listed<'a>(&'a [GateName]);

impl fmt::Display for Listed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("no gate");
        }
        for (index, gate) in self.0.iter().enumerate() {
            write!(f, "{}`{gate}`", if index == 0 { "" } else { " or " })?;
        }
        Ok(())
    }
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
