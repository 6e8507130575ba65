//! The events that an observer of a tap receives.

pub use crate::tap_meta::ObservedKind;

use bytes::Bytes;

/// An event at a tap.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TapEvent {
    /// The component shows this observer every message that passes the gate from now on. What passed shortly before
    /// this event may be observed, too.
    Connected,
    /// A message, request or reply.
    Observed(Observation),
    /// The component has closed, was killed, or sent invalid data. Comes only after [`Connected`](Self::Connected). The
    /// observer reconnects by itself.
    Disconnected,
}

/// A message that passed a gate.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Observation {
    /// Its bytes, as the gate's codec encoded them.
    pub payload: Bytes,
    /// Its number at this gate, from 0 when the component was opened, also counted while nobody observes. A gap means
    /// that the observer did not read fast enough.
    pub sequence: u64,
    /// When the component sent or received it, in nanoseconds since 1970 (`CLOCK_REALTIME`).
    pub sent_ns: u64,
    /// When this observer read it, by the same clock.
    pub received_ns: u64,
    /// Whether it was sent before this observer joined: the last message of a latched gate, which comes first.
    pub latched: bool,
    /// The number of the call that a request or reply belongs to; 0 for messages.
    pub call_id: u64,
    /// Whether it is a message, a request or a reply.
    pub kind: ObservedKind,
}
