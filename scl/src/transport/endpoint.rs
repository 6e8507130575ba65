//! Endpoints: what a transport needs to know to open an end of a connection.

use super::Resumed;
use std::borrow::Cow;
use std::sync::Arc;

/// Decides whether an end may connect to the peer that is listening now. An error says why not.
pub type PeerCheck = Arc<dyn Fn() -> Result<(), String> + Send + Sync>;

/// A meeting point of two ends, and the limits of the end being opened.
#[derive(Clone)]
#[non_exhaustive]
pub struct Endpoint {
    /// Its name inside the system's folder, for example `sensor.measurements--controller.sensor.k3v9qd2m`.
    pub name: Cow<'static, str>,
    /// The longest message that this end accepts, in bytes. A peer that announces a longer one is disconnected before
    /// memory is reserved. Default: 64 MiB.
    pub max_size: usize,
    /// Capacity of the receiving gate's queue for this connection, in messages, for which shared memory must have room.
    /// Default: 100.
    pub queue: usize,
    /// The longest message of this connection, in bytes: the limit of the receiving gate, or the length of every
    /// message if its type has a fixed one. Default: 64 MiB.
    pub longest: usize,
    /// Whether only the newest message matters to this receiving end, as with `queue: 1`. It then keeps few messages in
    /// flight, so that [`Receiver::poll_caught_up`](super::Receiver::poll_caught_up) can tell exactly whether the
    /// sender has a newer one.
    pub newest_only: bool,
    /// Whether this sending end waits for slow peers instead of dropping messages. It announces this to them, see
    /// [`Receiver::is_lossless`](super::Receiver::is_lossless).
    pub lossless: bool,
    /// How many requests this requesting end may have sent without a reply. Default: 1.
    pub in_flight: usize,
    /// Whether this publishing end keeps its last message for subscribers that join later. It announces this to them,
    /// see [`Receiver::is_latched`](super::Receiver::is_latched).
    pub latched: bool,
    /// For a subscribing end that takes over from an earlier one: what it reports about both to a latched publisher.
    /// Default: none, for a new end.
    pub resumed: Option<Resumed>,
    /// For a receiving end that forwards messages: how much the sender may have unacknowledged. If set, only
    /// [`Receiver::acknowledge`](super::Receiver::acknowledge) acknowledges messages; returning them does not. Default:
    /// none.
    pub deferred: Option<Window>,
    /// Called by a connecting end each time before it connects; an error keeps it from connecting.
    pub check: Option<PeerCheck>,
}

impl Endpoint {
    /// The default limit of a message: 64 MiB.
    pub const MAX_SIZE: usize = 64 << 20;

    /// The default queue: 100 messages.
    pub const QUEUE: usize = 100;

    /// Creates an endpoint with default limits.
    pub fn new(name: impl Into<Cow<'static, str>>) -> Self {
        Self {
            name: name.into(),
            max_size: Self::MAX_SIZE,
            queue: Self::QUEUE,
            longest: Self::MAX_SIZE,
            newest_only: false,
            lossless: false,
            in_flight: 1,
            latched: false,
            resumed: None,
            deferred: None,
            check: None,
        }
    }

    /// Creates an endpoint that accepts messages of up to `max_size` bytes, with default limits otherwise.
    pub fn accepting(name: impl Into<Cow<'static, str>>, max_size: u64) -> Self {
        // A limit beyond the address space is no limit.
        Self { max_size: usize::try_from(max_size).unwrap_or(usize::MAX), ..Self::new(name) }
    }
}

/// How much may be sent without an acknowledgement. A message longer than `bytes` may be sent if nothing else is
/// unacknowledged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// In messages.
    pub messages: u64,
    /// In bytes.
    pub bytes: u64,
}

impl std::fmt::Debug for Endpoint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Endpoint").field("name", &self.name).field("max_size", &self.max_size).finish_non_exhaustive()
    }
}
