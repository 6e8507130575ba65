//! The transport of each connection of a component.

use crate::error::OpenError;
use crate::medium::Medium;
use crate::medium_choice::MediumChoice;
use crate::runtime_dir::SystemDir;
use crate::spec::{ComponentSpec, GateSpec, LinkSpec};
use crate::transport::Transport;
use std::sync::Arc;

/// The transports of a component's connections.
pub(super) enum Transports {
    /// One of the user's, for all connections.
    Own(Arc<dyn Transport>),
    /// Those of the runtime folder.
    Files(ByMedium),
}

/// One transport for each medium that a component listens on.
pub(super) struct ByMedium {
    spec: &'static ComponentSpec,
    choice: MediumChoice,
    /// The first is for the default.
    transports: Vec<(Medium, Arc<dyn Transport>)>,
}

impl Transports {
    /// The transports of a component whose ends meet in a system's folder.
    ///
    /// # Errors
    /// [`OpenError`] if a medium is chosen for a gate that the component does not have, or one that this crate was built
    /// without.
    pub(super) fn in_folder(
        spec: &'static ComponentSpec,
        dir: &SystemDir,
        choice: MediumChoice,
    ) -> Result<Self, OpenError> {
        choice.check(spec)?;
        let mut transports: Vec<(Medium, Arc<dyn Transport>)> = Vec::new();
        for medium in [choice.default_medium()].into_iter().chain(listening(spec, &choice)) {
            if !transports.iter().any(|(known, _)| *known == medium) {
                transports.push((medium, transport(spec, dir, medium)?));
            }
        }
        Ok(Self::Files(ByMedium { spec, choice, transports }))
    }

    /// For a connection with endpoints of its own.
    pub(super) fn of_link(&self, gate: &GateSpec, link: &LinkSpec) -> &dyn Transport {
        self.of(|by| by.choice.of_link(by.spec, gate, link))
    }

    /// For a gate that listens once for all peers.
    pub(super) fn of_gate(&self, gate: &GateSpec) -> &dyn Transport {
        self.of(|by| by.choice.of_gate(by.spec, gate))
    }

    /// For a gate's tap.
    pub(super) fn of_tap(&self, gate: &GateSpec) -> &dyn Transport {
        self.of(|by| by.choice.of_tap(by.spec, gate))
    }

    fn of(&self, medium: impl Fn(&ByMedium) -> Medium) -> &dyn Transport {
        match self {
            Self::Own(transport) => &**transport,
            Self::Files(by) => {
                let chosen = medium(by);
                // An end that only connects finds any medium, so the default's transport will do.
                let found = by.transports.iter().find(|(medium, _)| *medium == chosen).unwrap_or(&by.transports[0]);
                &*found.1
            }
        }
    }
}

/// The media of a component's listening ends.
fn listening(spec: &'static ComponentSpec, choice: &MediumChoice) -> impl Iterator<Item = Medium> {
    let gates = spec.gates.iter().filter(|gate| !gate.tap.is_empty());
    gates.flat_map(move |gate| {
        let taps = [choice.of_tap(spec, gate)];
        let whole = (!gate.endpoint.is_empty()).then(|| choice.of_gate(spec, gate));
        let links = gate.links.iter().filter(|_| gate.endpoint.is_empty());
        taps.into_iter().chain(whole).chain(links.map(move |link| choice.of_link(spec, gate, link)))
    })
}

#[cfg(feature = "zeromq")]
fn transport(spec: &ComponentSpec, dir: &SystemDir, medium: Medium) -> Result<Arc<dyn Transport>, OpenError> {
    if medium == Medium::Shm && !cfg!(feature = "iceoryx2") {
        return Err(OpenError::NoSharedMemory { component: spec.name });
    }
    Ok(Arc::new(crate::transport::zeromq::ZeroMq::new(dir.clone(), medium)))
}

#[cfg(not(feature = "zeromq"))]
fn transport(spec: &ComponentSpec, _dir: &SystemDir, _medium: Medium) -> Result<Arc<dyn Transport>, OpenError> {
    Err(OpenError::NoTransport { component: spec.name })
}
