//! Where a component's gates meet those of others, and what it holds there while it runs.

use super::OpenOptions;
use crate::error::OpenError;
use crate::place::{AnnouncedEndpoint, Announcement, Claim, ComponentLock, PlaceError, RuntimeDir, SystemDir};
use crate::spec::{ComponentSpec, GateKind, GateSpec};
use crate::transport::Transport;
use std::sync::Arc;

/// A component's place among the others.
pub(super) enum Site {
    /// The system's folder, where programs find each other.
    Folder(Occupied),
    /// Whatever the chosen transport has for it; no file is touched.
    OfTransport,
}

/// The component's name in the folder, which is this program's alone.
pub(super) struct Occupied {
    folder: SystemDir,
    _lock: ComponentLock,
}

impl Site {
    /// The chosen transport, or that of the runtime folder, in which the component then takes its name.
    pub(super) fn choose(
        spec: &'static ComponentSpec,
        options: &OpenOptions,
    ) -> Result<(Self, Arc<dyn Transport>), OpenError> {
        if let Some(transport) = options.chosen_transport() {
            return Ok((Self::OfTransport, transport));
        }
        let tcp = options.uses_tcp()?;
        let occupied = Occupied::take(spec, options).map_err(|source| failed(spec, source))?;
        let transport = transport(spec, &occupied.folder, tcp)?;
        Ok((Self::Folder(occupied), transport))
    }

    /// Tells tools, and neighbours with another contract, who is here.
    pub(super) fn announce(&self, spec: &'static ComponentSpec) -> Result<Option<Claim>, OpenError> {
        let Self::Folder(occupied) = self else { return Ok(None) };
        let mut announcement = Announcement::of_this_process(spec.name);
        announcement.endpoints = spec.gates.iter().flat_map(announced_endpoints).collect();
        announcement.publish(&occupied.folder).map(Some).map_err(|source| failed(spec, source))
    }
}

impl Occupied {
    fn take(spec: &ComponentSpec, options: &OpenOptions) -> Result<Self, PlaceError> {
        let runtime_dir = RuntimeDir::locate(&|name| options.variable(name))?;
        let folder = runtime_dir.system(&options.system_name(spec.system))?;
        let lock = ComponentLock::take(&folder, spec.name)?;
        lock.clear_leftovers()?;
        Ok(Self { folder, _lock: lock })
    }
}

fn failed(spec: &ComponentSpec, source: PlaceError) -> OpenError {
    OpenError::Place { component: spec.name, source }
}

#[cfg(feature = "zeromq")]
fn transport(_spec: &ComponentSpec, folder: &SystemDir, tcp: bool) -> Result<Arc<dyn Transport>, OpenError> {
    use crate::transport::zeromq::{Medium, ZeroMq};
    Ok(Arc::new(ZeroMq::new(folder.clone(), if tcp { Medium::Tcp } else { Medium::Ipc })))
}

#[cfg(not(feature = "zeromq"))]
fn transport(spec: &ComponentSpec, _folder: &SystemDir, _tcp: bool) -> Result<Arc<dyn Transport>, OpenError> {
    Err(OpenError::NoTransport { component: spec.name })
}

fn announced_endpoints(gate: &GateSpec) -> Vec<AnnouncedEndpoint> {
    let endpoint = |name: &str, contract: &str| AnnouncedEndpoint {
        gate: gate.name.to_owned(),
        endpoint: name.to_owned(),
        contract: contract.to_owned(),
        payload: gate.payload.to_owned(),
        codec: gate.codec.to_owned(),
    };
    let links = || gate.links.iter().map(|link| endpoint(link.endpoint, link.contract));
    match gate.kind {
        GateKind::Pub => links().chain([endpoint(gate.endpoint, "")]).collect(),
        GateKind::Rep | GateKind::Pull => {
            let contract = gate.endpoint.rsplit_once('.').map_or("", |(_, contract)| contract);
            vec![endpoint(gate.endpoint, contract)]
        }
        GateKind::Sub | GateKind::Req | GateKind::Push => links().collect(),
    }
}
