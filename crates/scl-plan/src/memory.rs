//! The most that SCL holds in memory for a gate, in bytes of encoded messages.

pub mod limits;
#[cfg(test)]
mod tests;

use crate::kind::{GateKind, WhenFull};
use crate::options::GateOptions;

/// The most that SCL holds in memory for a gate, in the process of its component: an upper bound on the bytes of the
/// encoded messages that wait, are on their way, or are kept for later subscribers. Sums that exceed 64 bits are
/// `u64::MAX`.
///
/// It counts the messages of SCL's own programs over sockets. Not in it are messages that the program has received or
/// not sent yet, the memory that allocations waste, what plain ZeroMQ subscribers and observers beside the peers cause,
/// and shared memory.
///
/// ```
/// use scl_plan::memory::GateMemory;
/// use scl_plan::{GateKind, GateOptions};
///
/// let subscriber = GateOptions { queue: 10, max_size: 1 << 20, ..GateOptions::DEFAULT };
/// let publisher = GateMemory::of(GateKind::Pub, &GateOptions::DEFAULT, [&subscriber]);
/// assert_eq!((publisher.messages, publisher.longest), (10, 1 << 20));
/// assert_eq!(publisher.waiting(), 10 << 20);
/// // The message of the call that sends, and one that is being written to the subscriber.
/// assert_eq!(publisher.in_flight, 2 << 20);
/// assert_eq!(publisher.total(), 12 << 20);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GateMemory {
    /// How many messages may wait in queues: in those of the connections at a `pub` or `push` gate, where a message
    /// that waits for several subscribers counts once; in the gate's own at `sub` and `pull`.
    pub messages: u64,
    /// The longest of these messages, in bytes.
    pub longest: u64,
    /// What may be on its way: written or read in part, sent and not acknowledged, requested and not answered.
    pub in_flight: u64,
    /// The last message, which a gate with `latched: true` keeps.
    pub latched: u64,
}

impl GateMemory {
    /// Computes it from the options of the gate and those of the gates at the other ends of its connections.
    pub fn of<'o, P>(kind: GateKind, own: &GateOptions, peers: P) -> Self
    where
        P: IntoIterator<Item = &'o GateOptions, IntoIter: Clone>,
    {
        let peers = peers.into_iter();
        match kind {
            GateKind::Pub => Self::of_publisher(own, peers),
            GateKind::Push => Self::of_sender(sum(peers.clone().map(|peer| peer.queue.into())), peers),
            GateKind::Sub if peers.clone().next().is_none() => Self::default(),
            GateKind::Sub | GateKind::Pull => Self::of_receiver(own, peers),
            GateKind::Req => sum_of_exchanges(peers.map(|replier| requesting(own, replier))),
            GateKind::Rep => Self::of_replier(own, peers),
        }
    }

    /// What may wait in queues.
    pub fn waiting(&self) -> u64 {
        self.messages.saturating_mul(self.longest)
    }

    /// All together.
    pub fn total(&self) -> u64 {
        self.waiting().saturating_add(self.in_flight).saturating_add(self.latched)
    }

    /// A message is encoded once, and all queues share it. Queues that drop their oldest message, or make the publisher
    /// wait, hold the last messages, so that the longest of them has all of these. Each of the others may hold
    /// different ones.
    fn of_publisher<'o>(own: &GateOptions, peers: impl Iterator<Item = &'o GateOptions> + Clone) -> Self {
        let keeps_old = |peer: &&GateOptions| peer.when_full == WhenFull::DropNewest;
        let queue = |peer: &GateOptions| u64::from(peer.queue);
        let recent = peers.clone().filter(|peer| !keeps_old(peer)).map(queue).max();
        let old = sum(peers.clone().filter(keeps_old).map(queue));
        let memory = Self::of_sender(recent.unwrap_or(0).saturating_add(old), peers);
        Self { latched: if own.latched { memory.longest } else { 0 }, ..memory }
    }

    /// A sending gate refuses messages that one of its peers would not accept.
    fn of_sender<'o>(messages: u64, peers: impl Iterator<Item = &'o GateOptions> + Clone) -> Self {
        let Some(longest) = shortest_limit(peers.clone()) else { return Self::default() };
        // A connection writes a message, or several short ones that it has copied from its queue.
        let written = |peer: &GateOptions| longest.max(BATCH).min(longest.saturating_mul(peer.queue.into()));
        let in_flight = sum(peers.map(written)).saturating_add(longest);
        Self { messages, longest, in_flight, latched: 0 }
    }

    /// What is on its way counts here, wherever it is: in the sender, in socket buffers, or read.
    fn of_receiver<'o>(own: &GateOptions, peers: impl Iterator<Item = &'o GateOptions>) -> Self {
        let newest_only = own.queue == 1 && own.when_full == WhenFull::DropOldest;
        let (messages, bytes) = match newest_only {
            true => (limits::NEWEST_WINDOW_MESSAGES, limits::NEWEST_WINDOW_BYTES),
            false => (limits::WINDOW_MESSAGES, limits::WINDOW_BYTES),
        };
        let longest = own.max_size;
        let window = longest.saturating_mul(messages).min(longest.saturating_add(bytes));
        let in_flight = sum(peers.map(|_| window));
        Self { messages: own.queue.into(), longest, in_flight, latched: 0 }
    }

    fn of_replier<'o>(own: &GateOptions, peers: impl Iterator<Item = &'o GateOptions> + Clone) -> Self {
        let reply = shortest_limit(peers.clone()).unwrap_or(0);
        // Of each requester, one request is read ahead while another one arrives.
        let of_peer =
            |peer: &GateOptions| sum([unread(peer.in_flight.into(), reply), own.max_size, reading(own.max_size)]);
        let memory = sum_of_exchanges(peers.map(of_peer));
        // The gate itself holds the request that its next call returns.
        Self { in_flight: memory.in_flight.saturating_add(own.max_size), ..memory }
    }
}

const BATCH: u64 = limits::BATCH as u64;
const UNREAD_BYTES: u64 = limits::UNREAD_BYTES as u64;
/// How many messages may be unread: the rest of one, those that fit into the other pieces but one, and one more.
const UNREAD_MESSAGES: u64 = 2 + ((limits::UNREAD_PIECES - 2) / limits::PIECES_OF_A_MESSAGE) as u64;

fn sum_of_exchanges(in_flight: impl Iterator<Item = u64>) -> GateMemory {
    GateMemory { in_flight: sum(in_flight), ..GateMemory::default() }
}

/// What a requester holds: its requests, the replies that its calls have not taken, and one that arrives.
fn requesting(own: &GateOptions, replier: &GateOptions) -> u64 {
    let calls = u64::from(own.in_flight);
    sum([unread(calls, replier.max_size), own.max_size.saturating_mul(calls), reading(own.max_size)])
}

/// What may wait for a peer that does not read: as many requests or replies as may be in progress, if they are several,
/// or some short ones of earlier calls, and in either case one more.
fn unread(in_progress: u64, longest: u64) -> u64 {
    let several = if in_progress > 1 { in_progress + 1 } else { 1 };
    let earlier = longest.saturating_mul(UNREAD_MESSAGES).min(longest.saturating_add(UNREAD_BYTES));
    longest.saturating_mul(several).max(earlier)
}

/// A message that arrives, and what the same read may have returned of the next ones.
fn reading(longest: u64) -> u64 {
    longest.saturating_add(limits::READ as u64)
}

/// The length of the longest message that all of these gates accept.
fn shortest_limit<'o>(gates: impl Iterator<Item = &'o GateOptions>) -> Option<u64> {
    gates.map(|gate| gate.max_size).min()
}

/// The sum of numbers of bytes, or `u64::MAX` if it exceeds 64 bits.
pub fn sum(numbers: impl IntoIterator<Item = u64>) -> u64 {
    numbers.into_iter().fold(0, u64::saturating_add)
}
