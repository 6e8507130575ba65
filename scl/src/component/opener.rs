//! Opening a component: its place in the runtime folder, then its gates one by one.

use super::blocking::OwnedRuntime;
use super::{Component, Core, OpenOptions};
use crate::codec::Codec;
use crate::error::OpenError;
use crate::gate::holding::Holding;
use crate::gate::incoming::Incoming;
use crate::gate::sending::Sending;
use crate::gate::{AnyGate, GateName, Outgoing, Pub, Pull, Push, Rep, Req, Sub};
use crate::place::{AnnouncedEndpoint, Announcement, Claim, ComponentLock, PlaceError, RuntimeDir, SystemDir};
use crate::spec::{ComponentSpec, GateKind, GateSpec, LinkSpec};
use crate::time::Watchdog;
use crate::transport::{Outlet, Transport, TransportError};
use std::sync::{Arc, Mutex};

/// Makes the gates of one component; only generated code calls it.
pub struct Opener {
    core: Arc<Core>,
    place: SystemDir,
    transport: Box<dyn Transport>,
}

impl Opener {
    pub(super) fn begin(
        spec: &'static ComponentSpec,
        options: OpenOptions,
        runtime: Option<Arc<OwnedRuntime>>,
    ) -> Result<Self, OpenError> {
        let tcp = options.uses_tcp()?;
        let (place, lock) =
            occupy(spec, &options).map_err(|source| OpenError::Place { component: spec.name, source })?;
        let transport = transport(spec, &place, tcp)?;
        Ok(Self { core: Arc::new(Core::new(spec, lock, runtime)), place, transport })
    }

    pub(super) fn finish<C: Component>(mut self) -> Result<C, OpenError> {
        let component = C::assemble(&mut self)?;
        let announced = announce(C::SPEC, &self.place);
        self.core.announced(announced.map_err(|source| OpenError::Place { component: C::SPEC.name, source })?);
        Ok(component)
    }

    /// The `pub` gate at a place in the component's list.
    pub fn publisher<T, C: Codec<T>>(&mut self, index: usize) -> Result<Pub<T>, OpenError> {
        let spec = self.gate(index);
        let mut connections = self.connections(spec, |transport, endpoint| transport.publish(endpoint))?;
        let tap = self.transport.publish(spec.endpoint).map_err(|source| self.refused(spec, source))?;
        connections.push(self.connect(spec, tap, Holding::of_tap(), "a tap".to_owned()));
        Ok(Pub::new(Sending::new::<C>(Arc::clone(&self.core), spec, connections)))
    }

    /// The `push` gate at a place in the component's list.
    pub fn pusher<T, C: Codec<T>>(&mut self, index: usize) -> Result<Push<T>, OpenError> {
        let spec = self.gate(index);
        let connections = self.connections(spec, |transport, endpoint| transport.push(endpoint))?;
        Ok(Push::new(Sending::new::<C>(Arc::clone(&self.core), spec, connections)))
    }

    /// The `sub` gate at a place in the component's list.
    pub fn subscriber<T, C: Codec<T>>(&mut self, index: usize) -> Result<Sub<T>, OpenError> {
        let spec = self.gate(index);
        let subscribe = |link: &LinkSpec| self.transport.subscribe(link.endpoint);
        let links = spec.links.iter().map(subscribe).collect::<Result<_, _>>();
        let links = links.map_err(|source| self.refused(spec, source))?;
        Ok(Sub::new(Incoming::new::<C>(Arc::clone(&self.core), spec, links)))
    }

    /// The `pull` gate at a place in the component's list.
    pub fn puller<T, C: Codec<T>>(&mut self, index: usize) -> Result<Pull<T>, OpenError> {
        let spec = self.gate(index);
        let link = self.transport.pull(spec.endpoint).map_err(|source| self.refused(spec, source))?;
        Ok(Pull::new(Incoming::new::<C>(Arc::clone(&self.core), spec, vec![link])))
    }

    /// The `req` gate at a place in the component's list.
    pub fn requester<A, B, C: Codec<A> + Codec<B>>(&mut self, index: usize) -> Result<Req<A, B>, OpenError> {
        let spec = self.gate(index);
        let link = spec.links.first().map(|link| self.transport.request(link.endpoint)).transpose();
        let link = link.map_err(|source| self.refused(spec, source))?;
        let watchdog = Watchdog::new().map_err(|source| OpenError::Timer { gate: self.name(spec), source })?;
        Ok(Req::new::<C>(Arc::clone(&self.core), spec, link, watchdog))
    }

    /// The `rep` gate at a place in the component's list.
    pub fn replier<A, B, C: Codec<A> + Codec<B>>(&mut self, index: usize) -> Result<Rep<A, B>, OpenError> {
        let spec = self.gate(index);
        let link = self.transport.reply(spec.endpoint).map_err(|source| self.refused(spec, source))?;
        Ok(Rep::new::<C>(Arc::clone(&self.core), spec, link))
    }

    /// The place of a component without gates.
    pub fn idle(&mut self) -> Result<Idle, OpenError> {
        Ok(Idle { core: Arc::clone(&self.core) })
    }

    fn gate(&self, index: usize) -> &'static GateSpec {
        &self.core.spec().gates[index]
    }

    fn connections(
        &self,
        spec: &'static GateSpec,
        outlet: impl Fn(&dyn Transport, &str) -> Result<Box<dyn Outlet>, TransportError>,
    ) -> Result<Vec<Arc<Mutex<Outgoing>>>, OpenError> {
        let connect = |link: &LinkSpec| {
            let made = outlet(&*self.transport, link.endpoint).map_err(|source| self.refused(spec, source))?;
            let peer = format!("{}.{}", link.peer_component, link.peer_gate);
            Ok(self.connect(spec, made, Holding::of(spec, link), peer))
        };
        spec.links.iter().map(connect).collect()
    }

    fn connect(
        &self,
        spec: &'static GateSpec,
        link: Box<dyn Outlet>,
        holding: Holding,
        peer: String,
    ) -> Arc<Mutex<Outgoing>> {
        self.core.drive(Outgoing::new(link, holding, self.name(spec), peer))
    }

    fn name(&self, spec: &'static GateSpec) -> GateName {
        GateName::new(self.core.spec().name, spec.name)
    }

    fn refused(&self, spec: &'static GateSpec, source: TransportError) -> OpenError {
        OpenError::Gate { gate: self.name(spec), source }
    }
}

#[cfg(feature = "zeromq")]
fn transport(_spec: &ComponentSpec, place: &SystemDir, tcp: bool) -> Result<Box<dyn Transport>, OpenError> {
    use crate::transport::zeromq::{Medium, ZeroMq};
    Ok(Box::new(ZeroMq::new(place.clone(), if tcp { Medium::Tcp } else { Medium::Ipc })))
}

#[cfg(not(feature = "zeromq"))]
fn transport(spec: &ComponentSpec, _place: &SystemDir, _tcp: bool) -> Result<Box<dyn Transport>, OpenError> {
    Err(OpenError::NoTransport { component: spec.name })
}

/// Finds the system's folder and takes the component's name for this program.
fn occupy(spec: &ComponentSpec, options: &OpenOptions) -> Result<(SystemDir, ComponentLock), PlaceError> {
    let runtime_dir = RuntimeDir::locate(&|name| options.variable(name))?;
    let place = runtime_dir.system(&options.system_name(spec.system))?;
    let lock = ComponentLock::take(&place, spec.name)?;
    lock.clear_leftovers()?;
    Ok((place, lock))
}

/// Tells tools, and neighbours with another contract, who is here.
fn announce(spec: &ComponentSpec, place: &SystemDir) -> Result<Claim, PlaceError> {
    let mut announcement = Announcement::of_this_process(spec.name);
    announcement.endpoints = spec.gates.iter().flat_map(announced_endpoints).collect();
    announcement.publish(place)
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

/// The field of a component that has no gates: it holds the component's place.
#[derive(Debug)]
pub struct Idle {
    core: Arc<Core>,
}

impl AnyGate for Idle {
    fn spec(&self) -> &'static GateSpec {
        const NONE: GateSpec = GateSpec {
            name: "",
            kind: GateKind::Sub,
            payload: "",
            codec: "",
            place: "",
            endpoint: "",
            queue: 1,
            when_full: crate::spec::WhenFull::DropOldest,
            backpressure: false,
            timeout: std::time::Duration::ZERO,
            links: &[],
        };
        &NONE
    }

    fn missing(&self) -> Vec<&'static LinkSpec> {
        Vec::new()
    }

    fn core(&self) -> &Arc<Core> {
        &self.core
    }
}
