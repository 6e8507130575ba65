//! A gate of any kind, with bytes as its messages.

use crate::codec::DecodeError;
use crate::component::Opener;
use crate::error::{Error, OpenError};
use crate::gate::{AnyGate, GateStats, PeerStats, Pub, Pull, Push, ReceivingGate, Rep, Req, Request, Sub};
use crate::spec::{ConnectionSpec, GateKind, GateSpec};
use bytes::Bytes;
use std::time::Duration;

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

/// Evaluates the same expression for a gate of any kind.
macro_rules! with_each {
    ($any:ident, $gate:ident => $call:expr) => {
        match $any {
            Gate::Pub($gate) => $call,
            Gate::Sub($gate) => $call,
            Gate::Req($gate) => $call,
            Gate::Rep($gate) => $call,
            Gate::Push($gate) => $call,
            Gate::Pull($gate) => $call,
        }
    };
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

    /// Returns the gate as what all kinds have in common.
    pub(super) fn any(&self) -> &dyn AnyGate {
        with_each!(self, gate => gate)
    }

    /// Returns the gate as a receiving gate, or `None` for `pub`, `push` and `req`.
    pub fn receiving(&mut self) -> Option<&mut dyn ReceivingGate> {
        match self {
            Gate::Sub(gate) => Some(gate),
            Gate::Rep(gate) => Some(gate),
            Gate::Pull(gate) => Some(gate),
            Gate::Pub(_) | Gate::Req(_) | Gate::Push(_) => None,
        }
    }

    /// Reports that the program could not decode the message or reply that this gate received last, and does what a
    /// gate with a codec does then: it counts the message ([`GateStats::undecodable`]). Returns `Ok` if the gate skips
    /// such messages, so that the program receives the next one; they are logged once for each peer. Also returns `Ok`
    /// for `pub` and `push`, which receive nothing, and for `rep`, see [`reject_request`](Self::reject_request).
    ///
    /// `reason` says why, after "cannot decode this message: "; by convention it starts in lower case and has no full
    /// stop.
    ///
    /// # Errors
    /// The error of a gate with `undecodable: fail` or of a call; it names the possible senders.
    pub fn reject(&mut self, reason: impl Into<String>) -> Result<(), Error> {
        let source = DecodeError::new(self.spec().codec, reason);
        match self {
            Gate::Sub(gate) => Ok(gate.reject(source)?),
            Gate::Pull(gate) => Ok(gate.reject(source)?),
            Gate::Req(gate) => Err(gate.reject(source).into()),
            Gate::Rep(_) | Gate::Pub(_) | Gate::Push(_) => Ok(()),
        }
    }

    /// Like [`reject`](Self::reject), for a request. Its sender is told, so that its call fails at once.
    ///
    /// # Errors
    /// Those of [`reject`](Self::reject).
    pub fn reject_request(&mut self, request: Request<Bytes, Bytes>, reason: impl Into<String>) -> Result<(), Error> {
        let source = DecodeError::new(self.spec().codec, reason);
        match self {
            Gate::Rep(gate) => Ok(gate.reject(request, source)?),
            _ => Ok(()),
        }
    }

    /// Returns what the plan says about the gate.
    pub fn spec(&self) -> &GateSpec {
        self.any().spec()
    }

    /// Returns true if all required peers are connected, or, for `rep` and `pull`, at least one peer.
    pub fn is_connected(&self) -> bool {
        with_each!(self, gate => gate.is_connected())
    }

    /// Returns the age of the message that a `sub` gate returned last, if its publisher had sent it before this gate
    /// was connected to it: see [`Sub::latched_age`]. `None` for other kinds.
    pub fn latched_age(&self) -> Option<Duration> {
        match self {
            Gate::Sub(gate) => gate.latched_age(),
            _ => None,
        }
    }

    /// Returns the connection of the message that a `sub` gate returned last: see [`Sub::last_connection`]. `None` for
    /// other kinds.
    pub fn last_connection(&self) -> Option<&'static ConnectionSpec> {
        match self {
            Gate::Sub(gate) => gate.last_connection(),
            _ => None,
        }
    }

    /// Returns the gate's counts.
    pub fn stats(&self) -> GateStats {
        with_each!(self, gate => gate.stats())
    }

    /// Returns what became of the messages of each connection of a `pub` or `push` gate. Empty for other kinds.
    pub fn peer_stats(&self) -> Vec<PeerStats> {
        match self {
            Gate::Pub(gate) => gate.peer_stats(),
            Gate::Push(gate) => gate.peer_stats(),
            _ => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::OpenOptions;
    use crate::transport::memory::Memory;
    use crate::untyped::Component;
    use scl_plan::{SystemPlan, Undecodable};

    #[test]
    fn what_the_program_cannot_decode_is_counted_and_skipped_or_an_error() {
        for (declared, is_error) in [(Undecodable::Skip, false), (Undecodable::Fail, true)] {
            check(declared, is_error);
        }
    }

    fn check(declared: Undecodable, is_error: bool) {
        let mut system = SystemPlan::from_json(include_str!("../../doc/rover.json")).unwrap();
        let gates = system.components.iter_mut().flat_map(|component| &mut component.gates);
        gates.for_each(|gate| gate.options.undecodable = declared);
        let mut recorder = Component::open_blocking_with(
            system.component("recorder").unwrap(),
            OpenOptions::new().transport(Memory::default()),
        );
        let mut gate = recorder.as_mut().unwrap().gate("log").unwrap();
        match gate.reject("it is not a `rover.Line`") {
            Ok(()) => assert!(!is_error),
            Err(error) => {
                assert!(is_error);
                assert_eq!(error.to_string(), "gate `recorder.log` received an undecodable message from `sensor.log`");
            }
        }
        assert_eq!((gate.stats().rejected, gate.stats().undecodable), (1, 1));
    }
}
