//! A gate of any kind, with bytes as its messages.

use crate::codec::DecodeError;
use crate::component::Opener;
use crate::error::{Error, OpenError};
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

    /// Counts a received message, request or reply that the program could not decode, as a gate with a codec does
    /// ([`GateStats::rejected`]), and returns the error of such a gate, which names the possible senders.
    ///
    /// `reason` says why, after "cannot decode this message: "; by convention it starts in lower case and has no full
    /// stop. `None` for `pub` and `push`, which receive nothing.
    pub fn reject(&mut self, reason: impl Into<String>) -> Option<Error> {
        let source = DecodeError::new(self.spec().codec, reason);
        match self {
            Gate::Sub(gate) => Some(gate.reject(source).into()),
            Gate::Pull(gate) => Some(gate.reject(source).into()),
            Gate::Rep(gate) => Some(gate.reject(source).into()),
            Gate::Req(gate) => Some(gate.reject(source).into()),
            Gate::Pub(_) | Gate::Push(_) => None,
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

#[cfg(test)]
mod tests {
    use crate::OpenOptions;
    use crate::transport::memory::Memory;
    use crate::untyped::Component;
    use scl_plan::SystemPlan;

    #[test]
    fn what_the_program_cannot_decode_counts_as_rejected() {
        let system = SystemPlan::from_json(include_str!("../../doc/rover.json")).unwrap();
        let mut recorder = Component::open_blocking_with(
            system.component("recorder").unwrap(),
            OpenOptions::new().transport(Memory::default()),
        );
        let mut gate = recorder.as_mut().unwrap().gate("log").unwrap();
        let error = gate.reject("it is not a `rover.Line`").unwrap();
        assert_eq!(error.to_string(), "gate `recorder.log` received an undecodable message from `sensor.log`");
        assert_eq!(gate.stats().rejected, 1);
    }
}
