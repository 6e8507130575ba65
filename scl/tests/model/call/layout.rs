//! The components: a replier and three requesters, the last of which does not wait long.

use bytes::Bytes;
use scl::codec::Opaque;
use scl::private::{
    AnyGate, Component, ComponentSpec, GateKind, GateSpec, LinkSpec, OpenError, Opener, WhenFull, open,
};
use scl::{OpenOptions, Rep, Req};
use std::time::Duration;

/// How many requesters there are.
pub(super) const REQUESTERS: usize = 3;
/// The requester whose calls run out of time.
pub(super) const HASTY: usize = 2;

const ENDPOINT: &str = "replier.answer.5e6f7a8b";
const NAMES: [&str; REQUESTERS] = ["a", "b", "c"];

struct Replier {
    gate: Rep<Bytes, Bytes>,
}

struct Requester<const PLACE: usize> {
    gate: Req<Bytes, Bytes>,
}

pub(super) async fn open_replier(options: OpenOptions) -> Result<Rep<Bytes, Bytes>, OpenError> {
    Ok(open::<Replier>(options).await?.gate)
}

pub(super) async fn open_requester(place: usize, options: OpenOptions) -> Result<Req<Bytes, Bytes>, OpenError> {
    match place {
        0 => Ok(open::<Requester<0>>(options).await?.gate),
        1 => Ok(open::<Requester<1>>(options).await?.gate),
        _ => Ok(open::<Requester<HASTY>>(options).await?.gate),
    }
}

impl Component for Replier {
    const SPEC: &'static ComponentSpec = &ComponentSpec {
        system: "model",
        name: "replier",
        place: "topology.yaml:3:3",
        gates: &[gate(
            "answer",
            GateKind::Rep,
            Duration::ZERO,
            &[link(NAMES[0], "question"), link(NAMES[1], "question"), link(NAMES[2], "question")],
        )],
    };

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        Ok(Self { gate: opener.replier::<_, _, Opaque>(0)? })
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.gate]
    }
}

impl<const PLACE: usize> Component for Requester<PLACE> {
    const SPEC: &'static ComponentSpec = &ComponentSpec {
        system: "model",
        name: NAMES[PLACE],
        place: "topology.yaml:6:3",
        gates: &[gate("question", GateKind::Req, timeout(PLACE), &[link("replier", "answer")])],
    };

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        Ok(Self { gate: opener.requester::<_, _, Opaque>(0)? })
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.gate]
    }
}

/// No case takes as long as the others wait.
const fn timeout(place: usize) -> Duration {
    if place == HASTY { Duration::from_millis(2) } else { Duration::from_secs(3600) }
}

const fn gate(name: &'static str, kind: GateKind, timeout: Duration, links: &'static [LinkSpec]) -> GateSpec {
    GateSpec {
        name,
        kind,
        payload: "bytes -> bytes",
        codec: "bytes",
        place: "topology.yaml:5:5",
        endpoint: if let GateKind::Rep = kind { ENDPOINT } else { "" },
        queue: 1,
        when_full: WhenFull::DropOldest,
        backpressure: false,
        timeout,
        links,
    }
}

const fn link(peer_component: &'static str, peer_gate: &'static str) -> LinkSpec {
    LinkSpec {
        peer_component,
        peer_gate,
        endpoint: ENDPOINT,
        contract: "5e6f7a8b",
        required: true,
        queue: 1,
        when_full: WhenFull::DropOldest,
    }
}
