//! Opening a component: its site, then its gates one by one.

use super::blocking::OwnedRuntime;
use super::site::Site;
use super::{Component, Core, OpenOptions};
use crate::codec::Codec;
use crate::error::OpenError;
use crate::gate::holding::Holding;
use crate::gate::incoming::Incoming;
use crate::gate::sending::Sending;
use crate::gate::{AnyGate, GateName, Outgoing, Pub, Pull, Push, Rep, Req, Sub};
use crate::spec::{ComponentSpec, GateKind, GateSpec, LinkSpec};
use crate::time::Watchdog;
use crate::transport::{Outlet, Transport, TransportError};
use std::sync::{Arc, Mutex};

/// Makes the gates of one component; only generated code calls it.
pub struct Opener {
    core: Arc<Core>,
    transport: Arc<dyn Transport>,
}

impl Opener {
    pub(super) fn begin(
        spec: &'static ComponentSpec,
        options: OpenOptions,
        runtime: Option<Arc<OwnedRuntime>>,
    ) -> Result<Self, OpenError> {
        let (site, transport) = Site::choose(spec, &options)?;
        Ok(Self { core: Arc::new(Core::new(spec, site, runtime)), transport })
    }

    pub(super) fn finish<C: Component>(mut self) -> Result<C, OpenError> {
        let component = C::assemble(&mut self)?;
        self.core.announce()?;
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
