//! What is declared: kinds of gates, queues and their policies.

use super::gates::{Receiver, Sender};
use scl::OpenOptions;
use scl::codec::Opaque;
use scl::private::{
    AnyGate, Component, ComponentHandle, ComponentSpec, ConnectionSpec, GateKind, GateOptions, GateSpec, OpenError,
    Opener, WhenFull, close, open,
};
use std::pin::Pin;
use std::time::Duration;

/// Number of layouts.
pub(super) const LAYOUTS: usize = 26;

const SOURCE: &str = "source";
const CONTRACT: &str = "1a2b3c4d";
const MAX_SIZE: u64 = 64 << 20;
const READERS: [&str; 3] = ["a", "b", "c"];
/// The endpoint of each reader.
pub(super) const ENDPOINTS: [&str; 3] =
    ["source.out--a.in.1a2b3c4d", "source.out--b.in.1a2b3c4d", "source.out--c.in.1a2b3c4d"];

/// A sender and its readers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) kind: GateKind,
    pub(super) backpressure: bool,
    readers: [Declared; 3],
    count: usize,
}

/// A reader.
#[derive(Debug, Clone, Copy)]
pub(super) struct Declared {
    pub(super) queue: u32,
    pub(super) when_full: WhenFull,
    pub(super) required: bool,
}

impl Declared {
    /// Returns true if only the newest message counts, so that one replaces the other and none is dropped.
    pub(super) fn is_newest_only(self) -> bool {
        self.queue == 1 && self.when_full == WhenFull::DropOldest
    }
}

impl Layout {
    pub(super) fn readers(&self) -> &[Declared] {
        &self.readers[..self.count]
    }
}

const QUEUES: [u32; 3] = [1, 3, 100];
const WHEN_FULL: [WhenFull; 3] = [WhenFull::DropOldest, WhenFull::DropNewest, WhenFull::Wait];

/// Every queue with every policy for a single reader of each kind, then mixtures.
pub(super) const fn layout(index: usize) -> Layout {
    use WhenFull::{DropNewest, DropOldest, Wait};
    let (oldest, newest, wait) = (declared(3, DropOldest), declared(3, DropNewest), declared(3, Wait));
    match index {
        0..9 => single(GateKind::Pub, QUEUES[index / 3], WHEN_FULL[index % 3]),
        9..18 => single(GateKind::Push, QUEUES[(index - 9) / 3], WHEN_FULL[index % 3]),
        18 => several(GateKind::Pub, 3, [declared(1, DropOldest), newest, declared(100, DropOldest)]),
        19 => several(GateKind::Pub, 3, [declared(100, Wait), oldest, declared(1, DropNewest)]),
        20 => several(GateKind::Pub, 3, [optional(wait), wait, declared(1, DropOldest)]),
        21 => several(GateKind::Pub, 2, [optional(declared(1, Wait)), oldest, oldest]),
        22 => Layout { backpressure: false, ..several(GateKind::Pub, 2, [wait, declared(1, Wait), wait]) },
        23 => several(GateKind::Push, 3, [declared(1, DropOldest), newest, declared(100, DropOldest)]),
        24 => several(GateKind::Push, 2, [wait, declared(1, Wait), wait]),
        25 => several(GateKind::Push, 3, [optional(wait), wait, declared(1, DropNewest)]),
        _ => panic!("there is no such layout"),
    }
}

const fn single(kind: GateKind, queue: u32, when_full: WhenFull) -> Layout {
    several(kind, 1, [declared(queue, when_full); 3])
}

const fn several(kind: GateKind, count: usize, readers: [Declared; 3]) -> Layout {
    Layout { kind, backpressure: true, readers, count }
}

const fn declared(queue: u32, when_full: WhenFull) -> Declared {
    Declared { queue, when_full, required: true }
}

const fn optional(declared: Declared) -> Declared {
    Declared { required: false, ..declared }
}

/// A component that sends, of any layout.
pub(super) trait Source {
    fn gate(&mut self) -> &mut Sender;

    /// Closes the component without waiting for its readers.
    fn close_now(self: Box<Self>) -> Pin<Box<dyn Future<Output = ()>>>;
}

impl<const LAYOUT: usize> Source for SourceOf<LAYOUT> {
    fn gate(&mut self) -> &mut Sender {
        &mut self.gate
    }

    fn close_now(self: Box<Self>) -> Pin<Box<dyn Future<Output = ()>>> {
        Box::pin(async {
            // Messages that are left are expected.
            let _left = close(*self, Duration::ZERO).await;
        })
    }
}

struct SourceOf<const LAYOUT: usize> {
    gate: Sender,
    handle: ComponentHandle,
}

/// A component that receives. A gate keeps its component open, so only the gates of readers are kept.
struct Reader<const LAYOUT: usize, const INDEX: usize> {
    gate: Receiver,
    handle: ComponentHandle,
}

impl<const LAYOUT: usize> SourceOf<LAYOUT> {
    const LINKS: &'static [ConnectionSpec; 3] =
        &[to_reader(layout(LAYOUT), 0), to_reader(layout(LAYOUT), 1), to_reader(layout(LAYOUT), 2)];
    const GATE: GateSpec = GateSpec {
        options: GateOptions { backpressure: layout(LAYOUT).backpressure, ..OPTIONS },
        connections: Self::LINKS.split_at(layout(LAYOUT).count).0,
        ..gate("out", layout(LAYOUT).kind)
    };
}

impl<const LAYOUT: usize> Component for SourceOf<LAYOUT> {
    const SPEC: &'static ComponentSpec = &component(SOURCE, &[Self::GATE]);

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        let gate = match layout(LAYOUT).kind {
            GateKind::Push => Sender::Push(opener.pusher::<_, Opaque>(0)?),
            _ => Sender::Pub(opener.publisher::<_, Opaque>(0)?),
        };
        Ok(Self { gate, handle: opener.handle() })
    }

    fn handle(&self) -> &ComponentHandle {
        &self.handle
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        match &self.gate {
            Sender::Pub(gate) => vec![gate],
            Sender::Push(gate) => vec![gate],
        }
    }
}

impl<const LAYOUT: usize, const INDEX: usize> Reader<LAYOUT, INDEX> {
    const DECLARED: Declared = layout(LAYOUT).readers[INDEX];
    const LINK: ConnectionSpec =
        ConnectionSpec { peer_component: SOURCE, peer_gate: "out", ..to_reader(layout(LAYOUT), INDEX) };
    const GATE: GateSpec = GateSpec {
        endpoint: if let GateKind::Push = layout(LAYOUT).kind { ENDPOINTS[INDEX] } else { "" },
        options: GateOptions { queue: Self::DECLARED.queue, when_full: Self::DECLARED.when_full, ..OPTIONS },
        connections: &[Self::LINK],
        ..gate("in", if let GateKind::Push = layout(LAYOUT).kind { GateKind::Pull } else { GateKind::Sub })
    };
}

impl<const LAYOUT: usize, const INDEX: usize> Component for Reader<LAYOUT, INDEX> {
    const SPEC: &'static ComponentSpec = &component(READERS[INDEX], &[Self::GATE]);

    fn assemble(opener: &mut Opener) -> Result<Self, OpenError> {
        let gate = match layout(LAYOUT).kind {
            GateKind::Push => Receiver::Pull(opener.puller::<_, Opaque>(0)?),
            _ => Receiver::Sub(opener.subscriber::<_, Opaque>(0)?),
        };
        Ok(Self { gate, handle: opener.handle() })
    }

    fn handle(&self) -> &ComponentHandle {
        &self.handle
    }

    fn gates(&self) -> Vec<&dyn AnyGate> {
        match &self.gate {
            Receiver::Sub(gate) => vec![gate],
            Receiver::Pull(gate) => vec![gate],
        }
    }
}

const fn component(name: &'static str, gates: &'static [GateSpec]) -> ComponentSpec {
    ComponentSpec { system: "model", name, declared_at: "topology.yaml:3:3", parameters: &[], gates, schema: None }
}

const OPTIONS: GateOptions =
    GateOptions { max_size: MAX_SIZE, queue: 1, timeout: Duration::from_secs(60), ..GateOptions::DEFAULT };

const fn gate(name: &'static str, kind: GateKind) -> GateSpec {
    GateSpec {
        name,
        kind,
        payload: "bytes",
        codec: "bytes",
        declared_at: "topology.yaml:5:5",
        endpoint: "",
        tap: "",
        contract: CONTRACT,
        options: OPTIONS,
        connections: &[],
    }
}

const fn to_reader(layout: Layout, index: usize) -> ConnectionSpec {
    let Declared { queue, when_full, required } = layout.readers[index];
    ConnectionSpec {
        peer_component: READERS[index],
        peer_gate: "in",
        endpoint: ENDPOINTS[index],
        contract: CONTRACT,
        required,
        queue,
        when_full,
        max_size: MAX_SIZE,
        max_age: None,
    }
}

/// Each layout is a type of its own, and chosen by a number at run time.
macro_rules! openers {
    ($($index:literal)*) => {
        pub(super) async fn open_source(layout: usize, options: OpenOptions) -> Result<Box<dyn Source>, OpenError> {
            match layout {
                $($index => Ok(Box::new(open::<SourceOf<$index>>(options).await?)),)*
                _ => panic!("there is no such layout"),
            }
        }

        pub(super) async fn open_receiver(
            layout: usize,
            index: usize,
            options: OpenOptions,
        ) -> Result<Receiver, OpenError> {
            match (layout, index) {
                $(
                    ($index, 0) => Ok(open::<Reader<$index, 0>>(options).await?.gate),
                    ($index, 1) => Ok(open::<Reader<$index, 1>>(options).await?.gate),
                    ($index, 2) => Ok(open::<Reader<$index, 2>>(options).await?.gate),
                )*
                _ => panic!("there is no such layout"),
            }
        }
    };
}

openers!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25);
