//! Routes: the ways between two hosts that the topology and the launch file require.

use scl_plan::WhenFull;

/// One way between two hosts. For `pub` and `sub` a connection; for `pull` and `rep`, whose socket serves many peers,
/// everything that one host sends to that gate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Route {
    pub pattern: Pattern,
    /// The `pub`, `push` or `req` side.
    pub from: RouteEnd,
    /// The `sub`, `pull` or `rep` side.
    pub to: RouteEnd,
    pub endpoint: String,
    pub contract: String,
    /// Messages that may wait, in the queue of the receiving gate.
    pub queue: u32,
    pub when_full: WhenFull,
    pub lossless: bool,
    /// Maximum length of a message in bytes.
    pub max_size: u64,
    pub newest_only: bool,
    /// `scl/<system>/<from component>/<gate>/<to component>/<to gate>/<contract>`; the same on both hosts.
    pub key: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// `pub`/`sub` if the sender's gate listens, `push`/`pull` otherwise.
    Messages {
        listens_at_sender: bool,
    },
    Requests,
}

/// One end of a [`Route`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RouteEnd {
    pub host: String,
    /// `None`: any component of that host that connects there.
    pub component: Option<String>,
    pub gate: Option<String>,
}
