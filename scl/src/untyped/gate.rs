//! A gate of any kind, with bytes as its messages.

use crate::component::Opener;
use crate::error::OpenError;
use crate::gate::{AnyGate, GateStats, Pub, Pull, Push, ReceivingGate, Rep, Req, Sub};
use crate::spec::{GateKind, GateSpec};
use bytes::Bytes;

/// A gate whose messages are the bytes that travel: what the codec of a typed gate would write and read.
#[derive(Debug)]
#[non_exhaustive]
pub enum Gate {
    /// A `pub` gate.
    Pub(Pub<Bytes>),
    /// A `sub` gate.
    Sub(Sub<Bytes>),
    /// A `req` gate.
    Req(Req<Bytes, Bytes>),
    /// A `rep` gate.
    Rep(Rep<Bytes, Bytes>),
    /// A `push` gate.
    Push(Push<Bytes>),
    /// A `pull` gate.
    Pull(Pull<Bytes>),
}

impl Gate {
    pub(super) fn open(opener: &mut Opener, index: usize, kind: GateKind) -> Result<Self, OpenError> {
        use crate::codec::Opaque;
        Ok(match kind {
            GateKind::Pub => Gate::Pub(opener.publisher::<_, Opaque>(index)?),
            GateKind::Sub => Gate::Sub(opener.subscriber::<_, Opaque>(index)?),
            GateKind::Req => Gate::Req(opener.requester::<_, _, Opaque>(index)?),
            GateKind::Rep => Gate::Rep(opener.replier::<_, _, Opaque>(index)?),
            GateKind::Push => Gate::Push(opener.pusher::<_, Opaque>(index)?),
            GateKind::Pull => Gate::Pull(opener.puller::<_, Opaque>(index)?),
        })
    }

    /// The gate as what all kinds have in common.
    pub(super) fn any(&self) -> &dyn AnyGate {
        match self {
            Gate::Pub(gate) => gate,
            Gate::Sub(gate) => gate,
            Gate::Req(gate) => gate,
            Gate::Rep(gate) => gate,
            Gate::Push(gate) => gate,
            Gate::Pull(gate) => gate,
        }
    }

    /// The gate as one that receives, or `None` for `pub`, `push` and `req`.
    pub fn receiving(&mut self) -> Option<&mut dyn ReceivingGate> {
        match self {
            Gate::Sub(gate) => Some(gate),
            Gate::Rep(gate) => Some(gate),
            Gate::Pull(gate) => Some(gate),
            Gate::Pub(_) | Gate::Req(_) | Gate::Push(_) => None,
        }
    }

    /// What the plan says about the gate.
    pub fn spec(&self) -> &GateSpec {
        self.any().spec()
    }

    /// Returns true if all required peers are connected, or, for `rep` and `pull`, at least one peer.
    pub fn is_connected(&self) -> bool {
        match self {
            Gate::Pub(gate) => gate.is_connected(),
            Gate::Sub(gate) => gate.is_connected(),
            Gate::Req(gate) => gate.is_connected(),
            Gate::Rep(gate) => gate.is_connected(),
            Gate::Push(gate) => gate.is_connected(),
            Gate::Pull(gate) => gate.is_connected(),
        }
    }

    /// Returns the gate's counts.
    pub fn stats(&self) -> GateStats {
        match self {
            Gate::Pub(gate) => gate.stats(),
            Gate::Sub(gate) => gate.stats(),
            Gate::Req(gate) => gate.stats(),
            Gate::Rep(gate) => gate.stats(),
            Gate::Push(gate) => gate.stats(),
            Gate::Pull(gate) => gate.stats(),
        }
    }
}
