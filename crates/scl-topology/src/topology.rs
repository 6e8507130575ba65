//! The checked topology: indices instead of names, no error left. Only [`check`](crate::check) makes one.

mod parameter;

pub use crate::grammar::{Codec, DeclaredOptions, GateKind, WhenFull};
pub use parameter::{Parameter, choice_name, parameters_name};

use crate::source::Span;
use std::collections::HashSet;
use std::fmt;
use std::sync::Arc;

/// The index of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ComponentId(pub(crate) u32);

/// The index of a kind of components.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct KindId(pub(crate) u32);

/// The index of a gate, unique in the whole topology.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GateId(pub(crate) u32);

/// The index of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ConnectionId(pub(crate) u32);

/// A dotted message type name as written, for example `rover.Measurement`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct TypeName {
    pub(crate) dotted: String,
    pub(crate) span: Span,
    pub(crate) in_schemas: bool,
}

impl TypeName {
    /// As written: `rover.Measurement`.
    pub fn dotted(&self) -> &str {
        &self.dotted
    }

    /// Where it is written; for a type taken over from another gate, the place in that gate.
    pub fn span(&self) -> Span {
        self.span
    }

    /// Returns true if one of the file's `schemas` declares it, and false if it is a Rust path.
    pub fn in_schemas(&self) -> bool {
        self.in_schemas
    }
}

/// What a gate carries. A type that only the other end names is filled in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Payload {
    /// Bytes of no declared type, in both directions.
    Bytes,
    /// One type, of `pub`, `sub`, `push`, `pull`.
    Message(TypeName),
    /// A request and its reply, of `req`, `rep`.
    Exchange {
        /// The type of the request.
        request: TypeName,
        /// The type of the reply.
        reply: TypeName,
    },
}

impl Payload {
    /// The types, the request before its reply; none for bytes.
    pub fn types(&self) -> Vec<&TypeName> {
        match self {
            Payload::Bytes => Vec::new(),
            Payload::Message(name) => vec![name],
            Payload::Exchange { request, reply } => vec![request, reply],
        }
    }

    pub(crate) fn types_mut(&mut self) -> Vec<&mut TypeName> {
        match self {
            Payload::Bytes => Vec::new(),
            Payload::Message(name) => vec![name],
            Payload::Exchange { request, reply } => vec![request, reply],
        }
    }
}

/// As in the file: `rover.Measurement`, `rover.Command -> rover.Status`, or `bytes`.
impl fmt::Display for Payload {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Payload::Bytes => out.write_str("bytes"),
            Payload::Message(name) => out.write_str(name.dotted()),
            Payload::Exchange { request, reply } => write!(out, "{} -> {}", request.dotted(), reply.dotted()),
        }
    }
}

/// A checked kind of components.
#[derive(Debug, Clone)]
pub struct Kind {
    pub(crate) name: String,
    pub(crate) rust_name: String,
    pub(crate) doc: Option<String>,
    pub(crate) span: Span,
    pub(crate) components: Vec<ComponentId>,
}

impl Kind {
    /// The name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// The Rust type, for example `Motor`.
    pub fn rust_name(&self) -> &str {
        &self.rust_name
    }
    /// `doc:`.
    pub fn doc(&self) -> Option<&str> {
        self.doc.as_deref()
    }
    /// Where its name is written.
    pub fn span(&self) -> Span {
        self.span
    }
    /// Its components, in file order. Their gates have the same names, kinds, types and options.
    pub fn components(&self) -> &[ComponentId] {
        &self.components
    }
}

/// A checked component.
#[derive(Debug, Clone)]
pub struct Component {
    pub(crate) name: String,
    pub(crate) rust_name: String,
    pub(crate) doc: Option<String>,
    pub(crate) optional: bool,
    pub(crate) memory: Option<u64>,
    pub(crate) span: Span,
    pub(crate) kind: Option<KindId>,
    pub(crate) parameters: Arc<[Parameter]>,
    pub(crate) gates: Vec<GateId>,
}

impl Component {
    /// The name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// The Rust type, for example `UserInterface`.
    pub fn rust_name(&self) -> &str {
        &self.rust_name
    }
    /// `doc:`.
    pub fn doc(&self) -> Option<&str> {
        self.doc.as_deref()
    }
    /// Whether peers do not wait for it at start.
    pub fn optional(&self) -> bool {
        self.optional
    }
    /// `memory:`, of the component or else of its kind, in bytes.
    pub fn memory(&self) -> Option<u64> {
        self.memory
    }
    /// Where its name is written.
    pub fn span(&self) -> Span {
        self.span
    }
    /// `kind:`.
    pub fn kind(&self) -> Option<KindId> {
        self.kind
    }
    /// Its parameters, in file order: its own, or those of its kind.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }
    /// Its gates, in file order.
    pub fn gates(&self) -> &[GateId] {
        &self.gates
    }
}

/// What becomes one type in programs: a component of no kind, or all components of a kind.
#[derive(Debug, Clone, Copy)]
pub struct ComponentType<'t> {
    /// The component, or the first one of the kind. All of a kind have the same gates.
    pub id: ComponentId,
    /// The component with this id.
    pub component: &'t Component,
    /// The kind.
    pub kind: Option<&'t Kind>,
}

impl<'t> ComponentType<'t> {
    /// The name in the file.
    pub fn name(self) -> &'t str {
        self.kind.map_or(&self.component.name, |kind| &kind.name)
    }
    /// The Rust type, for example `UserInterface`.
    pub fn rust_name(self) -> &'t str {
        self.kind.map_or(&self.component.rust_name, |kind| &kind.rust_name)
    }
    /// `doc:`.
    pub fn doc(self) -> Option<&'t str> {
        self.kind.map_or(&self.component.doc, |kind| &kind.doc).as_deref()
    }
    /// Where the name is written.
    pub fn span(self) -> Span {
        self.kind.map_or(self.component.span, |kind| kind.span)
    }
}

/// A checked gate.
#[derive(Debug, Clone)]
pub struct Gate {
    pub(crate) component: ComponentId,
    pub(crate) name: String,
    pub(crate) rust_name: String,
    pub(crate) kind: GateKind,
    pub(crate) payload: Payload,
    pub(crate) codec: Codec,
    pub(crate) options: DeclaredOptions,
    pub(crate) doc: Option<String>,
    pub(crate) span: Span,
    pub(crate) connections: Vec<ConnectionId>,
}

impl Gate {
    /// The component that the gate belongs to.
    pub fn component(&self) -> ComponentId {
        self.component
    }
    /// The name in the file.
    pub fn name(&self) -> &str {
        &self.name
    }
    /// The Rust field without `r#`, for example `set_point`.
    pub fn rust_name(&self) -> &str {
        &self.rust_name
    }
    /// The kind of the gate.
    pub fn kind(&self) -> GateKind {
        self.kind
    }
    /// The types that it carries, or bytes.
    pub fn payload(&self) -> &Payload {
        &self.payload
    }
    /// How messages become bytes; [`Codec::RAW`] for a gate without a type.
    pub fn codec(&self) -> &Codec {
        &self.codec
    }
    /// The options, defaults filled in.
    pub fn options(&self) -> &DeclaredOptions {
        &self.options
    }
    /// `doc:`.
    pub fn doc(&self) -> Option<&str> {
        self.doc.as_deref()
    }
    /// Where its name is written.
    pub fn span(&self) -> Span {
        self.span
    }
    /// Its connections, in file order.
    pub fn connections(&self) -> &[ConnectionId] {
        &self.connections
    }
}

/// A checked connection.
#[derive(Debug, Clone)]
pub struct Connection {
    pub(crate) source: GateId,
    pub(crate) sink: GateId,
    pub(crate) span: Span,
}

impl Connection {
    /// The `pub`, `push` or `req` end.
    pub fn source(&self) -> GateId {
        self.source
    }
    /// The `sub`, `pull` or `rep` end.
    pub fn sink(&self) -> GateId {
        self.sink
    }
    /// Where the pair is written.
    pub fn span(&self) -> Span {
        self.span
    }
    /// The end that is not `gate`.
    pub fn peer_of(&self, gate: GateId) -> GateId {
        if self.source == gate { self.sink } else { self.source }
    }
}

/// A whole checked system.
#[derive(Debug, Clone)]
pub struct Topology {
    pub(crate) system: String,
    pub(crate) kinds: Vec<Kind>,
    pub(crate) components: Vec<Component>,
    pub(crate) gates: Vec<Gate>,
    pub(crate) connections: Vec<Connection>,
    /// How many bytes the names of a connection's gates may have in the name of its socket.
    pub(crate) connection_room: usize,
}

impl Topology {
    /// The system's name: `system:`, or else derived from the file's name.
    pub fn system(&self) -> &str {
        &self.system
    }
    /// The kinds, in file order.
    pub fn kinds(&self) -> impl ExactSizeIterator<Item = (KindId, &Kind)> {
        self.kinds.iter().enumerate().map(|(i, kind)| (KindId(i as u32), kind))
    }
    /// The kind with this id.
    pub fn kind(&self, id: KindId) -> &Kind {
        &self.kinds[id.0 as usize]
    }
    /// What becomes a type in programs, in the order of the components. A kind without components becomes none.
    pub fn types(&self) -> impl Iterator<Item = ComponentType<'_>> {
        self.components().filter_map(|(id, component)| {
            let kind = component.kind.map(|kind| self.kind(kind));
            let is_first = kind.is_none_or(|kind| kind.components.first() == Some(&id));
            is_first.then_some(ComponentType { id, component, kind })
        })
    }
    /// The type that a component is of.
    pub fn type_of(&self, id: ComponentId) -> ComponentType<'_> {
        let kind = self.component(id).kind.map(|kind| self.kind(kind));
        let id = kind.and_then(|kind| kind.components.first().copied()).unwrap_or(id);
        ComponentType { id, component: self.component(id), kind }
    }
    /// The components, in file order.
    pub fn components(&self) -> impl ExactSizeIterator<Item = (ComponentId, &Component)> {
        self.components.iter().enumerate().map(|(i, c)| (ComponentId(i as u32), c))
    }
    /// The connections, in file order.
    pub fn connections(&self) -> impl ExactSizeIterator<Item = (ConnectionId, &Connection)> {
        self.connections.iter().enumerate().map(|(i, c)| (ConnectionId(i as u32), c))
    }
    /// The component with this id.
    pub fn component(&self, id: ComponentId) -> &Component {
        &self.components[id.0 as usize]
    }
    /// The gate with this id.
    pub fn gate(&self, id: GateId) -> &Gate {
        &self.gates[id.0 as usize]
    }
    /// The connection with this id.
    pub fn connection(&self, id: ConnectionId) -> &Connection {
        &self.connections[id.0 as usize]
    }
    /// The gate and, for a kind, the same gate of its other components.
    pub(crate) fn gates_of_type(&self, id: GateId) -> impl Iterator<Item = GateId> {
        let component = self.gate(id).component;
        let index = self.component(component).gates.iter().position(|gate| *gate == id);
        let kind = self.component(component).kind.map(|kind| self.kind(kind));
        let components = kind.map_or_else(|| vec![component], |kind| kind.components.clone());
        // All components of a kind have the same gates in the same order.
        components.into_iter().filter_map(move |of| self.component(of).gates.get(index?).copied())
    }
    /// The gates at the other ends of a gate; for a kind, of this gate of each of its components.
    pub fn peers_of_type(&self, id: GateId) -> Vec<GateId> {
        let peers = self.gates_of_type(id).flat_map(|gate| self.peers(gate));
        let mut seen = HashSet::new();
        peers.filter(|peer| seen.insert(*peer)).collect()
    }
    fn peers(&self, id: GateId) -> impl Iterator<Item = GateId> {
        self.gate(id).connections.iter().map(move |connection| self.connection(*connection).peer_of(id))
    }
    /// `component.gate`.
    pub fn gate_path(&self, id: GateId) -> String {
        let gate = self.gate(id);
        format!("{}.{}", self.component(gate.component).name, gate.name)
    }
}
