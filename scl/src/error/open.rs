//! Errors of opening a component.

use super::GateName;
use crate::transport::{Guarantee, TransportError};
use scl_text::list::either;
use std::fmt;
use thiserror::Error;

/// A component could not be opened.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The component could not be registered in the runtime folder.
    #[error("component `{component}` cannot be opened")]
    RuntimeDir {
        /// The component.
        component: &'static str,
        /// The problem, and what to do.
        source: crate::runtime_dir::RuntimeDirError,
    },
    /// The component could not be registered, see [`OpenOptions::registry`](crate::OpenOptions::registry).
    #[error("component `{component}` cannot be opened")]
    Registry {
        /// The component.
        component: &'static str,
        /// The reason.
        source: crate::registry::RegistryError,
    },
    /// A gate's connection could not be set up.
    #[error("gate `{gate}` cannot be opened")]
    Gate {
        /// The gate.
        gate: GateName,
        /// The reason.
        source: TransportError,
    },
    /// The operating system refused a timer for the gate's `timeout`.
    #[error("gate `{gate}` cannot be opened: the operating system refused a timer")]
    Timer {
        /// The gate.
        gate: GateName,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// The process was started as another component, according to `SCL_COMPONENT`, which `scl run` and the unit files
    /// of `scl deploy` set.
    #[error(
        "component `{component}` of system `{system}` was not expected: this program was started as {expected}; \
         correct its command in the launch file, or allow it there with `opens: [{component}]`"
    )]
    Unexpected {
        /// The component that the program opens.
        component: &'static str,
        /// The system of its topology.
        system: &'static str,
        /// What it was started as, for messages: `` `gps` of system `rover` ``.
        expected: String,
    },
    /// The process was started by one that takes part in a simulation, and does not take part itself.
    #[error(
        "component `{component}` takes no part in the simulation: only the process that `scl simulate` starts does, and \
         not one that this starts; name the program itself in the launch file"
    )]
    OutsideSimulation {
        /// The component.
        component: &'static str,
    },
    /// The plan has no component of this name.
    #[error(transparent)]
    UnknownComponent(#[from] scl_plan::UnknownComponent),
    /// The program is of a kind of components, and was not told which of them it is.
    #[error(
        "this program is a `{kind}`{}: set SCL_COMPONENT to {}",
        started.as_ref().map_or(String::new(), |started| format!(", but was started as {started}")),
        either(components)
    )]
    WhichComponent {
        /// The kind.
        kind: String,
        /// Its components.
        components: Vec<String>,
        /// What the program was started as, for messages: `` `gps` of system `rover` ``.
        started: Option<String>,
    },
    /// `open` was called outside a tokio runtime.
    #[error(
        "component `{component}` was opened outside a tokio runtime; \
         write `#[scl::main]` on `async fn main`, or use `open_blocking`"
    )]
    NoRuntime {
        /// The component.
        component: &'static str,
    },
    /// The operating system refused a runtime for a program without async.
    #[error("component `{component}` cannot start its runtime")]
    Runtime {
        /// The component.
        component: &'static str,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// The `scl` crate was built without any transport.
    #[error(
        "component `{component}` has no transport: enable the feature `zeromq` of the crate `scl`, or choose one with `OpenOptions::transport`"
    )]
    NoTransport {
        /// The component.
        component: &'static str,
    },
    /// A transport is chosen for a gate that the component does not have.
    #[error(
        "component `{component}` has no gate `{gate}`, for which a transport is chosen (`{component}.{gate}={transport}`){}",
        suggestion(nearest)
    )]
    NoSuchGate {
        /// The component.
        component: &'static str,
        /// The name of the gate.
        gate: String,
        /// The transport, as `SCL_TRANSPORT` names it.
        transport: &'static str,
        /// The gate that was probably meant.
        nearest: Option<String>,
    },
    /// A value is set for a parameter that the component does not have.
    #[error("component `{component}` has no parameter `{parameter}`, which is set{}", suggestion(nearest))]
    NoSuchParameter {
        /// The component.
        component: &'static str,
        /// The name of the parameter.
        parameter: String,
        /// The parameter that was probably meant.
        nearest: Option<String>,
    },
    /// The value that a parameter is set to cannot be its value.
    #[error("parameter `{component}.{parameter}` cannot have the value that it is set to: {reason}")]
    WrongValue {
        /// The component.
        component: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Why.
        reason: String,
    },
    /// The socket where live parameters are set could not be opened.
    #[error("component `{component}` cannot open the socket where its parameters are set")]
    SetSocket {
        /// The component.
        component: &'static str,
        /// The reason.
        source: TransportError,
    },
    /// A parameter without a default is not set.
    #[error(
        "parameter `{component}.{parameter}` ({kind}) has no value: set it under `parameters` in the launch file, with \
         `scl run --set {component}.{parameter}=...`, or in the environment, `SCL_SET={component}.{parameter}=...`"
    )]
    NoValue {
        /// The component.
        component: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Its type, for people.
        kind: String,
    },
    /// [`OpenOptions::set`](crate::OpenOptions::set) does not name a parameter.
    #[error("component `{component}` cannot be opened: {reason}")]
    Set {
        /// The component.
        component: &'static str,
        /// What is not understood.
        reason: String,
    },
    /// The component's gates need more than its transport offers.
    #[error(
        "component `{component}` needs more than its transport offers: {}; choose another transport",
        super::listed(missing)
    )]
    Guarantees {
        /// The component.
        component: &'static str,
        /// What is missing.
        missing: Vec<MissingGuarantee>,
    },
    /// A transport is chosen without which the `scl` crate was built.
    #[error(
        "component `{component}` cannot use the transport `{transport}`: enable the feature `{transport}` of the crate \
         `scl`, or choose the transport `ipc`"
    )]
    TransportOff {
        /// The component.
        component: &'static str,
        /// The transport, as `SCL_TRANSPORT` names it, which is also its feature.
        transport: &'static str,
    },
    /// The plan of an untyped component contradicts itself.
    #[error("component `{component}` cannot be opened: its plan is wrong")]
    Plan {
        /// The component.
        component: String,
        /// What is wrong with it.
        source: Box<scl_plan::PlanError>,
    },
    /// This process has opened too many different plans. They are kept until it ends.
    #[error(
        "component `{component}` cannot be opened: the different plans that this process has opened take {limit} bytes, \
         and they are kept until it ends; open each component with the same plan every time"
    )]
    TooManyPlans {
        /// The component.
        component: String,
        /// Maximum size of all plans, in bytes.
        limit: usize,
    },
    /// An environment variable has an invalid value.
    #[error("`{variable}={value}` is not understood; expected {expected}")]
    Environment {
        /// The variable.
        variable: &'static str,
        /// Its value.
        value: String,
        /// The values it may have.
        expected: &'static str,
    },
}

/// A guarantee that a gate needs and its transport does not offer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct MissingGuarantee {
    /// The gate.
    pub gate: GateName,
    /// The part of its declaration that needs it: `queue: 1`.
    pub option: &'static str,
    /// What is missing.
    pub guarantee: Guarantee,
}

impl fmt::Display for MissingGuarantee {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { gate, option, guarantee } = self;
        write!(f, "gate `{gate}` (`{option}`) needs {guarantee}")
    }
}

pub(super) fn suggestion(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}
