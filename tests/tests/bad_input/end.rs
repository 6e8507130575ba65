//! The ends of the twin `left`, and how a stranger gets a connection to each.

use scl::Component;
use scl::spec::{GateKind, GateSpec};
use scl_tests::{Address, RawListener, RawPeer, System};
use std::cell::OnceCell;
use std::path::PathBuf;

mod twins {
    scl::topology!("topologies/twins.yaml", only = [left]);
}

/// One end of `left` under attack.
pub(crate) struct End {
    /// The gate, or its tap.
    pub(crate) name: String,
    /// The socket type of a good peer.
    pub(crate) peer_type: &'static str,
    access: Access,
}

enum Access {
    /// `left` listens there.
    Connect(Address),
    /// `left` connects to a listener at this path, which stands in place of its peer's. It is opened when it is needed:
    /// connections that wait to be accepted for too long are closed by `left`.
    Accept(PathBuf, OnceCell<RawListener>),
}

impl End {
    /// The end that gets the largest crowd.
    pub(crate) const CROWDED: &str = "values";

    /// All ends of a running `left` whose peer is not running.
    pub(crate) fn all(system: &System) -> Vec<Self> {
        twins::Left::SPEC.gates.iter().flat_map(|gate| Self::of_gate(system, gate)).collect()
    }

    fn of_gate(system: &System, gate: &GateSpec) -> Vec<Self> {
        let name = gate.name.to_owned();
        let link = gate.connections[0].endpoint;
        let connect = |endpoint: &str| Access::Connect(system.address("twins", endpoint));
        let accept = || Access::Accept(system.path("twins", link), OnceCell::new());
        let tap =
            || Self { name: format!("{name}.tap"), peer_type: "SUB", access: connect(&format!("left.{name}.tap")) };
        let end = |peer_type, access| Self { name: name.clone(), peer_type, access };
        match gate.kind {
            GateKind::Pub => vec![end("SUB", connect(link)), tap()],
            GateKind::Pull => vec![end("PUSH", connect(gate.endpoint)), tap()],
            GateKind::Rep => vec![end("REQ", connect(gate.endpoint)), tap()],
            GateKind::Sub => vec![end("PUB", accept())],
            GateKind::Push => vec![end("PULL", accept())],
            GateKind::Req => vec![end("REP", accept())],
        }
    }

    /// Whether strangers can connect to this end; otherwise they wait until it connects to them.
    pub(crate) fn listens(&self) -> bool {
        matches!(self.access, Access::Connect(_))
    }

    /// Makes one connection after the other, and keeps as many of them as this end has at a time.
    pub(crate) fn each<T>(
        &self,
        cases: impl IntoIterator<Item = T>,
        mut attack: impl FnMut(T) -> RawPeer,
    ) -> Vec<RawPeer> {
        let mut open = Vec::new();
        for case in cases {
            if !self.listens() {
                // It connects again when the connection before is gone.
                open.clear();
            }
            open.push(attack(case));
        }
        open
    }

    /// A connection on which nothing has been said yet.
    pub(crate) fn connection(&self) -> RawPeer {
        match &self.access {
            Access::Connect(address) => RawPeer::connect(address),
            Access::Accept(path, listener) => listener.get_or_init(|| RawListener::unix(path)).accept(),
        }
    }

    /// A connection with a completed handshake.
    pub(crate) fn joined(&self) -> RawPeer {
        let mut peer = self.connection();
        peer.handshake(self.peer_type).unwrap_or_else(|error| panic!("no handshake with `{}`: {error}", self.name));
        peer
    }
}
