//! Events from the gateways of other hosts, other than messages.

use bytes::Bytes;

/// Event of [`Wire::poll_neighbour`](super::Wire::poll_neighbour).
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Neighbour {
    /// `component` runs on `host`. A restart of the component or of its gateway is a `Stopped` and a `Started`.
    Started { component: String, host: String, content: Bytes },
    /// `component` stopped, or the link to `host` is lost.
    Stopped { component: String, host: String },
    /// The gateway of `host` is connected.
    Connected { host: String },
    /// The gateway of `host` is not connected any more.
    Disconnected { host: String },
    /// A route has had no match for 1 s, although the other side has this connection under another contract. `text` is
    /// a whole sentence for the log. Reported at most once per route and contract.
    Mismatch { key: String, text: String },
    /// A configuration conflict: a second gateway of a host, a host that claims another host's component, or a gateway
    /// of another system. The offending gateway or component is ignored; `text` is a whole sentence for the log.
    Refused { text: String },
}
