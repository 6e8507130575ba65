//! The components: a replier and three requesters, the last of which is impatient.

use bytes::Bytes;
use scl::codec::Opaque;
use scl::private::{
    AnyGate, Component, ComponentHandle, ComponentSpec, ConnectionSpec, GateKind, GateOptions, GateSpec, OpenError,
    Opener, WhenFull, open,
};
use scl::{OpenOptions, Rep, Req};
use std::time::Duration;

/// Number of requesters.
pub(super) const REQUESTERS: usize = 3;
/// The requester whose calls time out.
pub(super) const IMPATIENT: usize = 2;

const ENDPOINT: &str = "replier.answer.5e6f7a8b";
const CONTRACT: &str = "5e6f7a8b";
const MAX_SIZE: u64 = 64 << 20;
const NAMES: [&str; REQUESTERS] = ["a", "b", "c"];

struct Replier {
    gate: Rep<Bytes, Bytes>,
    handle: ComponentHandle,
}

struct Requester<const INDEX: usize> {
    gate: Req<Bytes, Bytes>,
    handle: ComponentHandle,
}

pub(super) async fn open_replier(options: OpenOptions) -> Result<Rep<Bytes, Bytes>, OpenError> {
    Ok(open::<Replier>(options).await?.gate)
}

pub(super) async fn open_requester(index: usize, options: OpenOptions) -> Result<Req<Bytes, Bytes>, OpenError> {
    match index {
        0 => Ok(open::<Requester<0>>(options).await?.gate),
        1 => Ok(open::<Requester<1>>(options).await?.gate),
        _ => Ok(open::<Requester<IMPATIENT>>(options).await?.gate),
    }
}

impl Component for Replier {
    const SPEC: &'static ComponentSpec = &ComponentSpec {
        system: "model",
        name: "replier",
        declared_at: "topology.yaml:3:3",
        parameters: &[],
        gates: &[gate(
            "answer",
            GateKind::Rep,
            Duration::ZERO,
            &[connection(NAMES[0], "question"), connection(NAMES[1], "question"), connection(NAMES[2], "question")],
        )],
        schema: None,
    };

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        Ok(Self { gate: opener.replier::<_, _, Opaque>(0)?, handle: opener.handle() })
    }

    fn handle(&self) -> &ComponentHandle {
        &self.handle
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.gate]
    }
}

impl<const INDEX: usize> Component for Requester<INDEX> {
    const SPEC: &'static ComponentSpec = &ComponentSpec {
        system: "model",
        name: NAMES[INDEX],
        declared_at: "topology.yaml:6:3",
        parameters: &[],
        gates: &[gate("question", GateKind::Req, timeout(INDEX), &[connection("replier", "answer")])],
        schema: None,
    };

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        Ok(Self { gate: opener.requester::<_, _, Opaque>(0)?, handle: opener.handle() })
    }

    fn handle(&self) -> &ComponentHandle {
        &self.handle
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        vec![&self.gate]
    }
}

/// The others wait longer than any case takes.
const fn timeout(index: usize) -> Duration {
    if index == IMPATIENT { Duration::from_millis(2) } else { Duration::from_secs(3600) }
}

const fn gate(
    name: &'static str,
    kind: GateKind,
    timeout: Duration,
    connections: &'static [ConnectionSpec],
) -> GateSpec {
    GateSpec {
        name,
        kind,
        payload: "bytes -> bytes",
        codec: "bytes",
        declared_at: "topology.yaml:5:5",
        tap: "",
        contract: CONTRACT,
        endpoint: if let GateKind::Rep = kind { ENDPOINT } else { "" },
        options: GateOptions { max_size: MAX_SIZE, queue: 1, timeout, ..GateOptions::DEFAULT },
        connections,
    }
}

const fn connection(peer_component: &'static str, peer_gate: &'static str) -> ConnectionSpec {
    ConnectionSpec {
        peer_component,
        peer_gate,
        endpoint: ENDPOINT,
        contract: CONTRACT,
        required: true,
        queue: 1,
        when_full: WhenFull::DropOldest,
        max_size: MAX_SIZE,
        max_age: None,
    }
}
