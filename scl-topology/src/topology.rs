//! The checked topology: indices instead of names, no error left. Only [`check`](crate::check) makes one.

use crate::source::Span;
use std::time::Duration;

/// The index of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ComponentId(pub(crate) u32);

/// The index of a gate, unique in the whole topology.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GateId(pub(crate) u32);

/// The index of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ConnectionId(pub(crate) u32);

/// What a gate does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GateKind {
    /// Sends to any number of subscribers.
    Pub,
    /// Receives from one or several publishers.
    Sub,
    /// Asks one replier.
    Req,
    /// Answers any number of requesters.
    Rep,
    /// Hands work to a puller.
    Push,
    /// Takes work from any number of pushers.
    Pull,
}

impl GateKind {
    /// All kinds, in the order in which messages list them.
    pub const ALL: [GateKind; 6] =
        [GateKind::Pub, GateKind::Sub, GateKind::Req, GateKind::Rep, GateKind::Push, GateKind::Pull];

    /// The word in the file.
    pub fn word(self) -> &'static str {
        match self {
            GateKind::Pub => "pub",
            GateKind::Sub => "sub",
            GateKind::Req => "req",
            GateKind::Rep => "rep",
            GateKind::Push => "push",
            GateKind::Pull => "pull",
        }
    }

    /// The kind that sits at the other end.
    pub fn opposite(self) -> GateKind {
        match self {
            GateKind::Pub => GateKind::Sub,
            GateKind::Sub => GateKind::Pub,
            GateKind::Req => GateKind::Rep,
            GateKind::Rep => GateKind::Req,
            GateKind::Push => GateKind::Pull,
            GateKind::Pull => GateKind::Push,
        }
    }

    /// Whether messages start here: `pub`, `push` and `req`.
    pub fn is_source(self) -> bool {
        matches!(self, GateKind::Pub | GateKind::Push | GateKind::Req)
    }
}

/// A dotted message type name as written, for example `rover.Measurement`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct TypeName {
    pub(crate) dotted: String,
    pub(crate) span: Span,
}

impl TypeName {
    /// As written: `rover.Measurement`.
    pub fn dotted(&self) -> &str {
        &self.dotted
    }

    /// Where it is written; of an inherited type, at the other end.
    pub fn span(&self) -> Span {
        self.span
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
        /// What is asked.
        request: TypeName,
        /// What is answered.
        reply: TypeName,
    },
}

/// How messages become bytes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Codec {
    /// `protobuf`, the default of typed gates.
    Protobuf,
    /// `json`.
    Json,
    /// `cbor`.
    Cbor,
    /// `msgpack`.
    Msgpack,
    /// `postcard`.
    Postcard,
    /// `raw`: fixed layout; also the codec of gates without a type.
    Raw,
    /// A codec of the user's own, by its Rust path, for example `my_crate::Flat`.
    Path(String),
}

/// What a full queue does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WhenFull {
    /// The oldest waiting message is dropped.
    DropOldest,
    /// The new message is dropped.
    DropNewest,
    /// The sender waits, if it allows that.
    Wait,
}

/// The options of a gate, defaults filled in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GateOptions {
    /// `queue`: how many messages may wait for this gate. Default 100.
    pub queue: u32,
    /// `when_full`. Default `drop_oldest`.
    pub when_full: WhenFull,
    /// `backpressure`. Default false.
    pub backpressure: bool,
    /// `timeout` of a call. Default 1 s.
    pub timeout: Duration,
    /// `share`. Default false.
    pub share: bool,
    /// `unconnected: ok`. Default false.
    pub unconnected_ok: bool,
}

/// A checked component.
#[derive(Debug, Clone)]
pub struct Component {
    pub(crate) name: String,
    pub(crate) rust_name: String,
    pub(crate) doc: Option<String>,
    pub(crate) optional: bool,
    pub(crate) span: Span,
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
    /// Where its name is written.
    pub fn span(&self) -> Span {
        self.span
    }
    /// Its gates, in file order.
    pub fn gates(&self) -> &[GateId] {
        &self.gates
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
    pub(crate) options: GateOptions,
    pub(crate) doc: Option<String>,
    pub(crate) span: Span,
    pub(crate) connections: Vec<ConnectionId>,
}

impl Gate {
    /// Whose gate it is.
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
    /// What it does.
    pub fn kind(&self) -> GateKind {
        self.kind
    }
    /// What it carries.
    pub fn payload(&self) -> &Payload {
        &self.payload
    }
    /// How messages become bytes; [`Codec::Raw`] for a gate without a type.
    pub fn codec(&self) -> &Codec {
        &self.codec
    }
    /// The options, defaults filled in.
    pub fn options(&self) -> &GateOptions {
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
    pub(crate) components: Vec<Component>,
    pub(crate) gates: Vec<Gate>,
    pub(crate) connections: Vec<Connection>,
}

impl Topology {
    /// The system's name: `system:`, or the file's name without its ending.
    pub fn system(&self) -> &str {
        &self.system
    }
    /// The components, in file order.
    pub fn components(&self) -> impl ExactSizeIterator<Item = (ComponentId, &Component)> {
        self.components.iter().enumerate().map(|(i, c)| (ComponentId(i as u32), c))
    }
    /// The connections, in file order.
    pub fn connections(&self) -> impl ExactSizeIterator<Item = (ConnectionId, &Connection)> {
        self.connections.iter().enumerate().map(|(i, c)| (ConnectionId(i as u32), c))
    }
    /// One component.
    pub fn component(&self, id: ComponentId) -> &Component {
        &self.components[id.0 as usize]
    }
    /// One gate.
    pub fn gate(&self, id: GateId) -> &Gate {
        &self.gates[id.0 as usize]
    }
    /// One connection.
    pub fn connection(&self, id: ConnectionId) -> &Connection {
        &self.connections[id.0 as usize]
    }
    /// `component.gate`.
    pub fn gate_path(&self, id: GateId) -> String {
        let gate = self.gate(id);
        format!("{}.{}", self.component(gate.component).name, gate.name)
    }
}
