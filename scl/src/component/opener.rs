//! Opening a component: its registration, then its gates one by one.

use super::transports::{Transports, transport};
use super::{ComponentHandle, expected, needs, simulation};
use crate::codec::Codec;
use crate::error::{GateName, OpenError};
use crate::figures::FigureSource;
use crate::gate::{Connection, GateTap, Incoming, Outgoing, Pub, Pull, Push, Rep, Req, Sub};
use crate::options::OpenOptions;
#[cfg(feature = "zeromq")]
use crate::parameters::Setter;
use crate::parameters::{self, FromParameter, Live};
use crate::registration::{Registration, StatsWriter, ValuesWriter};
use crate::registry::{Registered, Unregistered};
use crate::runtime_dir::{Announcement, ComponentStats, RuntimeDir};
use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec};
use crate::state::{ComponentState, OwnedRuntime, Owner, stats_period};
use crate::time::Watchdog;
use crate::transport::{Endpoint, Receiver, Sender, Transport, TransportError};
use crate::transport_kind::TransportKind;
use crate::values::Value;
use std::slice::from_ref;
use std::sync::Arc;

/// Opens the gates of one component; only generated code calls it.
pub struct Opener {
    state: Owner,
    transports: Transports,
}

impl Opener {
    /// Registers and announces the component.
    pub(crate) fn begin(
        spec: &'static ComponentSpec,
        options: &OpenOptions,
        runtime: Option<Arc<OwnedRuntime>>,
    ) -> Result<Self, OpenError> {
        let values = parameters::given(spec, options, &|name| options.variable(name))?;
        let registering = match options.transport.clone() {
            Some(transport) => {
                let transports = Transports::Own(transport);
                needs::check(spec, &transports)?;
                Registering { registration: join(spec, options)?, stats: None, values: None, transports, setting: None }
            }
            None => register(spec, options, &values)?,
        };
        let Registering { registration, stats, values: file, transports, setting } = registering;
        let state = ComponentState::new(spec, registration, stats, runtime, options.is_test);
        let state = Owner::new(state.with_parameters(values, file));
        state.start_reporting();
        #[cfg(feature = "zeromq")]
        if let Some(transport) = setting {
            state.keep_setter(Setter::open(&*transport, &state)?);
        }
        #[cfg(not(feature = "zeromq"))]
        debug_assert!(setting.is_none(), "there is no transport for it");
        Ok(Self { state, transports })
    }

    /// The value of the parameter at an index of the component's list.
    pub fn parameter<T: FromParameter>(&self, index: usize) -> Result<T, OpenError> {
        let (component, parameter) = (self.state.spec.name, &*self.state.spec.parameters[index].name);
        let wrong = || OpenError::WrongValue { component, parameter, reason: "it is of another type".to_owned() };
        self.state.parameters.read(index, |value, _| T::from_value(value)).flatten().ok_or_else(wrong)
    }

    /// The live parameter at an index of the component's list.
    pub fn live<T: FromParameter>(&self, index: usize) -> Result<Live<T>, OpenError> {
        let (component, parameter) = (self.state.spec.name, &*self.state.spec.parameters[index].name);
        let wrong = || OpenError::WrongValue { component, parameter, reason: "it is of another type".to_owned() };
        Live::of(self.state.clone(), index).ok_or_else(wrong)
    }

    /// Opens the `pub` gate at an index of the component's list.
    pub fn publisher<T, C: Codec<T>>(&mut self, index: usize) -> Result<Pub<T>, OpenError> {
        let tap = self.tap(self.gate(index))?;
        self.outgoing::<T, C>(index, tap, |transport, endpoint| transport.publish(endpoint))
            .map(|outgoing| Pub { outgoing })
    }

    /// Opens the `push` gate at an index of the component's list.
    pub fn pusher<T, C: Codec<T>>(&mut self, index: usize) -> Result<Push<T>, OpenError> {
        // Only the pull gate at the other end has a tap.
        let no_tap = GateTap::new(None, false);
        self.outgoing::<T, C>(index, no_tap, |transport, endpoint| transport.push(endpoint))
            .map(|outgoing| Push { outgoing })
    }

    /// Opens the `sub` gate at an index of the component's list.
    pub fn subscriber<T, C: Codec<T>>(&mut self, index: usize) -> Result<Sub<T>, OpenError> {
        let spec = self.gate(index);
        let subscribe = |link| self.transports.of(spec, from_ref(link)).subscribe(&self.connecting(spec, link));
        let links = self.links(spec).iter().map(subscribe).collect::<Result<_, _>>();
        Ok(Sub::new(self.incoming::<T, C>(index, links, GateTap::new(None, false))?))
    }

    /// Opens the `pull` gate at an index of the component's list.
    pub fn puller<T, C: Codec<T>>(&mut self, index: usize) -> Result<Pull<T>, OpenError> {
        let spec = self.gate(index);
        let longest = longest::<T, C>(spec.options.max_size);
        let endpoint = Endpoint { longest, ..endpoint(spec.endpoint, spec) };
        let link = self.transports.of(spec, spec.connections).pull(&endpoint);
        Ok(Pull { incoming: self.incoming::<T, C>(index, link.map(|link| vec![link]), self.tap(spec)?)? })
    }

    /// Opens the `req` gate at an index of the component's list.
    pub fn requester<A, B, C: Codec<A> + Codec<B>>(&mut self, index: usize) -> Result<Req<A, B>, OpenError> {
        let spec = self.gate(index);
        let in_flight = spec.options.in_flight as usize;
        let request = |link| {
            let endpoint = Endpoint { in_flight, ..self.connecting(spec, link) };
            self.transports.of(spec, from_ref(link)).request(&endpoint)
        };
        let link = spec.connections.first().map(request).transpose();
        let link = link.map_err(|source| self.refused(spec, source))?;
        let watchdogs = (0..in_flight).map(|_| Watchdog::new()).collect::<Result<_, _>>();
        let watchdogs = watchdogs.map_err(|source| OpenError::Timer { gate: self.name(spec), source })?;
        let gate = Req::new::<C>(self.state.clone(), spec, link, watchdogs);
        self.follow(index, gate.figures());
        Ok(gate)
    }

    /// Opens the `rep` gate at an index of the component's list.
    pub fn replier<A, B, C: Codec<A> + Codec<B>>(&mut self, index: usize) -> Result<Rep<A, B>, OpenError> {
        let spec = self.gate(index);
        let link = self.transports.of(spec, spec.connections).reply(&endpoint(spec.endpoint, spec));
        let link = link.map_err(|source| self.refused(spec, source))?;
        let tap = self.tap(spec)?;
        let gate = Rep::new::<C>(self.state.clone(), spec, link, tap);
        self.follow(index, gate.figures());
        Ok(gate)
    }

    /// What the component holds besides its gates.
    pub fn handle(&self) -> ComponentHandle {
        ComponentHandle(self.state.clone())
    }

    fn follow(&self, index: usize, figures: FigureSource) {
        self.state.monitor.follow(index, figures);
    }

    fn gate(&self, index: usize) -> &'static GateSpec {
        &self.state.spec.gates[index]
    }

    fn incoming<T, C: Codec<T>>(
        &self,
        index: usize,
        links: Result<Vec<Box<dyn Receiver>>, TransportError>,
        tap: GateTap,
    ) -> Result<Incoming<T>, OpenError> {
        let spec = self.gate(index);
        let links = links.map_err(|source| self.refused(spec, source))?;
        let gate = Incoming::new::<C>(self.state.clone(), spec, links, tap);
        self.follow(index, gate.figures());
        Ok(gate)
    }

    fn outgoing<T, C: Codec<T>>(
        &self,
        index: usize,
        tap: GateTap,
        open: impl Fn(&dyn Transport, &Endpoint) -> Result<Box<dyn Sender>, TransportError>,
    ) -> Result<Outgoing<T>, OpenError> {
        let spec = self.gate(index);
        let connect = |link: &'static ConnectionSpec| {
            let endpoint = Endpoint {
                lossless: spec.options.waits_for(link.when_full),
                latched: spec.options.latched,
                longest: longest::<T, C>(link.max_size),
                ..self.connecting(spec, link)
            };
            let sender = open(self.transports.of(spec, from_ref(link)), &endpoint);
            let sender = sender.map_err(|source| self.refused(spec, source))?;
            let has_ended = self.state.registration.end_check(link.peer_component);
            let connection = Connection::new(sender, self.name(spec), spec, link, self.state.changes(), has_ended);
            Ok(self.state.drive(connection))
        };
        let connections = self.links(spec).iter().map(connect).collect::<Result<_, OpenError>>()?;
        let gate = Outgoing::new::<C>(self.state.clone(), spec, connections, tap);
        self.follow(index, gate.fanout.figures());
        Ok(gate)
    }

    /// Returns the connections of a gate: all of them, or only the one to its counterpart in a unit test.
    fn links(&self, spec: &'static GateSpec) -> &'static [ConnectionSpec] {
        let first = spec.connections.len().min(1);
        if self.state.is_test { &spec.connections[..first] } else { spec.connections }
    }

    fn tap(&self, spec: &'static GateSpec) -> Result<GateTap, OpenError> {
        if spec.tap.is_empty() {
            return Ok(GateTap::new(None, false));
        }
        let tap = self.transports.of(spec, &[]).tap(&Endpoint::new(spec.tap));
        tap.map(|tap| GateTap::new(tap, spec.options.latched)).map_err(|source| self.refused(spec, source))
    }

    /// The endpoint of one connection, whose connecting end checks its peer first.
    fn connecting(&self, spec: &'static GateSpec, link: &'static ConnectionSpec) -> Endpoint {
        let check = self.state.registration.peer_check(spec, link);
        Endpoint { check, queue: link.queue as usize, ..endpoint(link.endpoint, spec) }
    }

    fn name(&self, spec: &'static GateSpec) -> GateName {
        GateName::new(self.state.spec.name, spec.name)
    }

    fn refused(&self, spec: &'static GateSpec, source: TransportError) -> OpenError {
        OpenError::Gate { gate: self.name(spec), source }
    }
}

/// Registers the component in the registry that the user has chosen, if any.
fn join(spec: &'static ComponentSpec, options: &OpenOptions) -> Result<Box<dyn Registered>, OpenError> {
    match &options.registry {
        Some(registry) => {
            registry.register(spec).map_err(|source| OpenError::Registry { component: spec.name, source })
        }
        None => Ok(Box::new(Unregistered)),
    }
}

/// A component that is registered, before it is open.
struct Registering {
    registration: Box<dyn Registered>,
    /// Its stats and their writer, if it writes stats.
    stats: Option<(ComponentStats, StatsWriter)>,
    /// The writer of its parameters' values, if it has parameters.
    values: Option<ValuesWriter>,
    transports: Transports,
    /// The transport over which live parameters are set, if it has any.
    setting: Option<Arc<dyn Transport>>,
}

/// Registers the component in the runtime folder. `values` are those of its parameters.
fn register(spec: &'static ComponentSpec, options: &OpenOptions, values: &[Value]) -> Result<Registering, OpenError> {
    let variables = &|name: &str| options.variable(name);
    expected::check(spec, variables)?;
    simulation::check(spec, variables)?;
    let (system, choice) = (options.system_name(variables, spec.system)?, options.transport_choice(variables)?);
    let stats = stats_period(variables)?;
    let failed = |source| OpenError::RuntimeDir { component: spec.name, source };
    let runtime_dir = RuntimeDir::locate(variables).map_err(failed)?;
    let dir = runtime_dir.system(&system).map_err(failed)?;
    let transports = Transports::in_folder(spec, &dir, choice.clone())?;
    needs::check(spec, &transports)?;
    let is_live = !values.is_empty() && spec.parameters.iter().any(|parameter| parameter.live);
    // Only programs of this machine and user set parameters.
    let setting = is_live.then(|| transport(spec, &dir, TransportKind::Ipc)).transpose()?;
    let announcement = Announcement::of(spec, &choice);
    let registration = Registration::announcing(spec, dir, announcement, stats).map_err(failed)?;
    let stats = registration.stats();
    let named =
        spec.parameters.iter().zip(values).map(|(parameter, value)| (&*parameter.name, value.text().to_owned()));
    let values = (!values.is_empty()).then(|| registration.write_values(&named.collect::<Vec<_>>()));
    Ok(Registering { registration: Box::new(registration), stats, values, transports, setting })
}

/// Returns the length of the longest message at a gate that accepts messages of up to `max_size` bytes.
fn longest<T, C: Codec<T>>(max_size: u64) -> usize {
    let max_size = usize::try_from(max_size).unwrap_or(usize::MAX);
    C::FIXED_LENGTH.map_or(max_size, |length| length.min(max_size))
}

fn endpoint(name: &'static str, spec: &GateSpec) -> Endpoint {
    let queue = spec.options.queue as usize;
    Endpoint { queue, newest_only: spec.newest_only(), ..Endpoint::accepting(name, spec.options.max_size) }
}
