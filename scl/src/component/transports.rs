//! The transport of each connection of a component.

use crate::error::OpenError;
use crate::runtime_dir::SystemDir;
use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec};
use crate::transport::Transport;
use crate::transport_choice::TransportChoice;
use crate::transport_kind::TransportKind;
use scl_text::suggest::closest_name;
use std::sync::Arc;

/// The transports of a component's connections.
pub(super) enum Transports {
    /// One transport that the user has chosen, for all connections.
    Own(Arc<dyn Transport>),
    /// The transports whose endpoints are in the runtime folder.
    Files(ByKind),
}

/// One transport for each transport that a component listens on.
pub(super) struct ByKind {
    spec: &'static ComponentSpec,
    choice: TransportChoice,
    /// The first entry is the default transport.
    transports: Vec<(TransportKind, Arc<dyn Transport>)>,
}

impl Transports {
    /// The transports of a component whose ends meet in a system's folder.
    ///
    /// # Errors
    /// [`OpenError`] if a transport is chosen for a gate that the component does not have, or one that this crate was
    /// built without.
    pub(super) fn in_folder(
        spec: &'static ComponentSpec,
        dir: &SystemDir,
        choice: TransportChoice,
    ) -> Result<Self, OpenError> {
        if let Some((gate, kind)) = choice.unknown_gate(spec) {
            let nearest = closest_name(gate, spec.gates.iter().map(|gate| gate.name)).map(str::to_owned);
            let (component, gate, transport) = (spec.name, gate.to_owned(), kind.word());
            return Err(OpenError::NoSuchGate { component, gate, transport, nearest });
        }
        let mut transports: Vec<(TransportKind, Arc<dyn Transport>)> = Vec::new();
        for kind in [choice.default_kind()].into_iter().chain(listening(spec, &choice)) {
            if !transports.iter().any(|(known, _)| *known == kind) {
                transports.push((kind, transport(spec, dir, kind)?));
            }
        }
        Ok(Self::Files(ByKind { spec, choice, transports }))
    }

    /// Returns the transport of an end of a gate, see [`TransportChoice::of`].
    pub(super) fn of(&self, gate: &GateSpec, connections: &[ConnectionSpec]) -> &dyn Transport {
        match self {
            Self::Own(transport) => &**transport,
            Self::Files(by) => {
                let chosen = by.choice.of(by.spec, gate, connections);
                // An end that only connects finds listeners of any transport, so the default one will do.
                let found = by.transports.iter().find(|(kind, _)| *kind == chosen).unwrap_or(&by.transports[0]);
                &*found.1
            }
        }
    }
}

/// The transports of a component's listening ends.
fn listening(spec: &'static ComponentSpec, choice: &TransportChoice) -> impl Iterator<Item = TransportKind> {
    let gates = spec.gates.iter().filter(|gate| !gate.tap.is_empty());
    gates.flat_map(move |gate| {
        let at_once = if gate.endpoint.is_empty() { 1 } else { gate.connections.len().max(1) };
        let connections = gate.connections.chunks(at_once);
        [&[][..]].into_iter().chain(connections).map(move |connections| choice.of(spec, gate, connections))
    })
}

/// The transport of a kind whose ends meet in a system's folder.
#[cfg(feature = "zeromq")]
pub(super) fn transport(
    spec: &ComponentSpec,
    dir: &SystemDir,
    kind: TransportKind,
) -> Result<Arc<dyn Transport>, OpenError> {
    match kind {
        TransportKind::Shm if !cfg!(feature = "shm") => {
            Err(OpenError::TransportOff { component: spec.name, transport: kind.word() })
        }
        TransportKind::Ipc | TransportKind::Tcp | TransportKind::Shm => {
            Ok(Arc::new(crate::transport::zeromq::ZeroMq::new(dir.clone(), kind)))
        }
    }
}

#[cfg(not(feature = "zeromq"))]
pub(super) fn transport(
    spec: &ComponentSpec,
    _dir: &SystemDir,
    _kind: TransportKind,
) -> Result<Arc<dyn Transport>, OpenError> {
    Err(OpenError::NoTransport { component: spec.name })
}
