//! Transports: message patterns over opaque frames. A transport knows neither types nor codecs.
//!
//! A transport opens the two ends of each connection; gates own queues, policies and codecs. An implementation of
//! [`Transport`] provides one end per role. Every call on an end returns at once and uses the task's waker to report
//! when it is worth calling again.

use bytes::Bytes;
use std::borrow::Cow;
use std::collections::VecDeque;
use std::hash::{BuildHasher, RandomState};
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

mod frame;
mod guarantees;
mod heap_memory;
#[cfg(feature = "memory")]
pub mod memory;
#[cfg(any(feature = "memory", feature = "zeromq"))]
mod origins;
#[cfg(feature = "zeromq")]
pub mod zeromq;

pub use frame::{Frame, Loan, LoanedMemory};
pub use guarantees::{Guarantee, Guarantees};
pub(crate) use heap_memory::HeapMemory;

/// Opens the ends of connections.
///
/// Its methods are called inside a tokio runtime of any kind.
pub trait Transport: Send + Sync + 'static {
    /// What this transport promises. A component whose gates need more is refused when it is opened, with the gate, its
    /// option and the guarantee that is missing.
    ///
    /// `transport_conformance!`, of the feature `conformance`, tests what is declared here.
    fn guarantees(&self) -> Guarantees;

    /// Opens the publishing end of one connection. This end listens.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn publish(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError>;

    /// Opens the subscribing end of one connection.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn subscribe(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError>;

    /// Opens a pushing end, which connects to one puller.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn push(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError>;

    /// Opens a pulling end, which listens for any number of pushers.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn pull(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError>;

    /// Opens a requesting end, which connects to one replier.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn request(&self, endpoint: &Endpoint) -> Result<Box<dyn Requester>, TransportError>;

    /// Opens a replying end, which listens for any number of requesters.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn reply(&self, endpoint: &Endpoint) -> Result<Box<dyn Replier>, TransportError>;

    /// Opens a tap, where tools listen to a gate. A transport without taps returns `None`, which is the default.
    ///
    /// # Errors
    /// The endpoint cannot be opened.
    fn tap(&self, endpoint: &Endpoint) -> Result<Option<Box<dyn Tap>>, TransportError> {
        let _no_taps = endpoint;
        Ok(None)
    }
}

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
    /// The receiving gate's queue of this connection, in messages: what its engine has to have room for. Default: 100.
    pub queue: usize,
    /// The longest message of this connection, in bytes: what the receiving gate accepts, or the length of all messages of
    /// a type with a fixed one. Default: 64 MiB.
    pub longest: usize,
    /// Whether only the newest message matters to this receiving end, as with `queue: 1`. It then keeps few messages in
    /// flight, so that [`Receiver::poll_caught_up`] can tell exactly whether the sender has a newer one.
    pub newest_only: bool,
    /// Whether this sending end waits for slow peers instead of dropping messages. It tells them, see
    /// [`Receiver::is_lossless`].
    pub lossless: bool,
    /// How many requests this requesting end may have sent without a reply. Default: 1.
    pub in_flight: usize,
    /// Whether this publishing end keeps its last message for subscribers that join later. It tells them, see
    /// [`Receiver::is_latched`].
    pub latched: bool,
    /// For a subscribing end that continues for an earlier one: what a latched publisher is told of both. Default: none, which is
    /// a new end.
    pub resumed: Option<Resumed>,
    /// For a receiving end that passes messages on: how much the sender may have unacknowledged, and that messages are
    /// acknowledged by [`Receiver::acknowledge`] only, never because they were returned. Default: none.
    pub deferred: Option<Window>,
    /// Called by a connecting end each time before it connects; an error keeps it from connecting.
    pub check: Option<PeerCheck>,
}

impl Endpoint {
    /// The default limit of a message: 64 MiB.
    pub const MAX_SIZE: usize = 64 << 20;

    /// The default queue: 100 messages.
    pub const QUEUE: usize = 100;

    /// An endpoint with default limits.
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

    /// An endpoint that accepts messages of up to `max_size` bytes, with default limits otherwise.
    pub fn accepting(name: impl Into<Cow<'static, str>>, max_size: u64) -> Self {
        // A limit beyond what this machine can address is none.
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

impl Resumed {
    /// An end that has taken nothing yet, with a number that no other has, in any process. Not cryptographically random.
    pub fn new_end() -> Self {
        Self { end: RandomState::new().hash_one(std::process::id()), taken: 0 }
    }
}

impl std::fmt::Debug for Endpoint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Endpoint").field("name", &self.name).field("max_size", &self.max_size).finish_non_exhaustive()
    }
}

/// A sending end: the listening end of a `pub` connection, or a connecting `push` end.
pub trait Sender: Send {
    /// Accepts peers or connects to one, and returns the next that is ready to receive.
    ///
    /// A connecting end connects again once the link it returned before has been dropped; call this again after
    /// dropping one.
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer>;

    /// Why this end does not connect to the peer that is listening, if its [`Endpoint::check`] refused it.
    fn refusal(&self) -> Option<String> {
        None
    }

    /// Prepares for calls without a runtime: from now on every call asks the operating system directly and registers no
    /// waker.
    fn detach(&mut self) {}
}

/// A peer that has connected to a [`Sender`].
pub struct Peer {
    /// Who it is.
    pub kind: PeerKind,
    /// The connection to it.
    pub link: Box<dyn Link>,
}

/// Who has connected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PeerKind {
    /// The component at the other end of the connection. A newer one replaces an older one.
    Component,
    /// A program that speaks the transport's protocol without SCL, such as a plain ZeroMQ subscriber.
    Foreign,
}

/// A live connection from a [`Sender`] to one peer. Dropping it disconnects.
pub trait Link: Send {
    /// Handles what the peer has sent, and continues writing. The result is for [`send_all`](Self::send_all), which belongs to
    /// the same turn even if the queue is empty.
    ///
    /// Wakes the task when there is more to do, and when a message that was refused may be sent now.
    ///
    /// # Errors
    /// The peer is gone, or violated the protocol.
    fn drive(&mut self, cx: &mut Context<'_>) -> Result<Driven, Disconnected>;

    /// Sends `message`, or returns it. A loan of another link is sent as a copy.
    fn send(&mut self, cx: &mut Context<'_>, message: Frame) -> Sent;

    /// Sends messages from the front of a queue, as many as the peer can take now; calls `sent` with the length of
    /// each. `driven` is what [`drive`](Self::drive) returned in this turn, or `None` in a turn without it.
    ///
    /// Implementations that can write several messages at once do that here. When it returns with an empty queue,
    /// nothing newer is waiting for this peer: a link may rely on that to answer a receiver that wants to know whether
    /// it has [caught up](Receiver::poll_caught_up).
    fn send_all(
        &mut self,
        cx: &mut Context<'_>,
        driven: Option<Driven>,
        queue: &mut VecDeque<Frame>,
        sent: &mut dyn FnMut(usize),
    ) {
        let _gathers_nothing = driven;
        while let Some(message) = queue.pop_front() {
            let length = message.len();
            match self.send(cx, message).returned() {
                None => sent(length),
                Some(message) => return queue.push_front(message),
            }
        }
    }

    /// Sends a message that is `age` old, because the peer has joined since, and tells the peer so if it understands that.
    /// The default sends the message alone.
    fn send_latched(&mut self, cx: &mut Context<'_>, message: Frame, age: Duration) -> Sent {
        let _the_peer_does_not_learn_it = age;
        self.send(cx, message)
    }

    /// Returns true if the peer wants this message: a plain subscriber may have subscribed to others only.
    fn wants(&self, message: &[u8]) -> bool {
        let _wants_everything = message;
        true
    }

    /// Which end the peer is, and what it has taken before, if this end announced [`Endpoint::latched`] and the peer said so. A
    /// peer of which nothing is known counts as new.
    fn resumed(&self) -> Option<Resumed> {
        None
    }

    /// Lends memory of `length` bytes, to be filled and given to [`send`](Self::send). A link that can send such memory
    /// without copying it offers it here; `None` if it has none, now or ever, or for messages of this length. Then the gate
    /// takes memory from the heap.
    fn loan(&mut self, length: usize) -> Option<Loan> {
        let _lends_nothing = length;
        None
    }

    /// Returns true if everything sent has been handed to the operating system.
    fn is_written(&self) -> bool;

    /// Number of messages sent that the peer has not acknowledged yet: 0 for a peer that does not acknowledge.
    fn unacknowledged(&self) -> u64 {
        0
    }

    /// Number of messages sent that the peer's program has not received yet, as far as the peer has said: those that are
    /// [unacknowledged](Self::unacknowledged), and those that wait in the peer's gate. It is counted as lost if the link is
    /// dropped. The default is for a transport that cannot tell the two apart.
    fn not_received(&self) -> u64 {
        self.unacknowledged()
    }

    /// Reads what the peer has said before it disconnected; called before the link is dropped. Without a runtime.
    fn read_last(&mut self) {}

    /// Asks the peer to acknowledge everything sent so far, and to say so once its program has received that. The task is
    /// woken when the answer arrives.
    fn request_acknowledgement(&mut self, cx: &mut Context<'_>) {
        let _acknowledges_nothing = cx;
    }

    /// Prepares for calls without a runtime, as [`Sender::detach`] does. The connection is about to be closed, so
    /// messages are sent without regard to the peer's window.
    fn detach(&mut self) {}
}

/// A receiving end that connects to a latched publisher, perhaps again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resumed {
    /// A number of the receiving end that no other has: a program that restarts has another one.
    pub end: u64,
    /// Number of messages that this end has taken over its earlier connections.
    pub taken: u64,
}

/// [`Link::drive`] was called in this turn, so what waits is to be offered with [`Link::send_all`]: a link that gathers short
/// messages writes those that it has returned as [`Sent::Deferred`] then.
#[derive(Debug, Default)]
#[must_use = "give it to `send_all` in the same turn, even if the queue is empty"]
pub struct Driven(());

/// What a [`Link`] did with a message. A message that comes back is the same, or bytes of the same content.
#[derive(Debug)]
#[must_use = "a message that comes back was not sent"]
pub enum Sent {
    /// It is on its way.
    Sent,
    /// The peer cannot take it now. The task is woken when it can.
    Full(Frame),
    /// It is to be written together with those that follow: offer it with [`Link::send_all`] when the task is woken.
    Deferred(Frame),
    /// The peer is gone. The task is woken, and the next [`Link::drive`] fails.
    Gone(Frame),
}

impl Sent {
    /// The message, if it was not sent.
    pub fn returned(self) -> Option<Frame> {
        match self {
            Self::Sent => None,
            Self::Full(message) | Self::Deferred(message) | Self::Gone(message) => Some(message),
        }
    }
}

/// The peer of a [`Link`] is gone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Disconnected;

/// The listening end of a tap. Observers come and go; none of them ever delays the gate.
pub trait Tap: Send {
    /// Accepts observers and continues writing. Returns true if at least one is connected; only then is it worth
    /// calling [`observe`](Self::observe). An observer that learns during this call that it is connected is shown
    /// everything from now on: what is sent meanwhile comes after this call.
    fn drive(&mut self, cx: &mut Context<'_>) -> bool;

    /// Sends a message of two frames, `payload` and `meta`, to each observer, or drops it for those that read slowly.
    fn observe(&mut self, cx: &mut Context<'_>, payload: &Bytes, meta: &[u8]);

    /// Keeps a message for each observer that joins from now on, in place of the one kept before. Only at a latched gate.
    fn latch(&mut self, payload: &Bytes, meta: &[u8]) {
        let _keeps_nothing = (payload, meta);
    }

    /// Number of messages dropped so far because an observer reads slowly, each observer counted.
    fn dropped(&self) -> u64;
}

/// A receiving end: `sub` has one per publisher, `pull` one per gate.
pub trait Receiver: Send {
    /// Returns the next message. Reconnects by itself. Messages that do not consist of exactly one frame are counted
    /// and skipped.
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes>;

    /// Connects to a peer, or accepts those that come, without taking in messages. Called instead of
    /// [`poll_recv`](Self::poll_recv) while there is no room for another message, so that a peer that starts now is not kept
    /// waiting. The default does nothing, for transports that connect without being called.
    fn connect(&mut self, cx: &mut Context<'_>) {
        let _connects_by_itself = cx;
    }

    /// Number of connected peers: for a listening end, those that have completed the handshake.
    fn peers(&self) -> usize;

    /// Returns true if a connected sender waits instead of dropping messages: then the receiving gate takes in no more than
    /// its queue holds, whatever that queue would do when it is full.
    fn is_lossless(&self) -> bool {
        false
    }

    /// Returns true if a connected sender has announced [`Endpoint::latched`]; only then is it worth calling
    /// [`take_latched`](Self::take_latched).
    fn is_latched(&self) -> bool {
        false
    }

    /// When the message returned last was sent, if the sender had sent it before this end joined, as
    /// [`Link::send_latched`] does. Ask at once: the answer is forgotten with the next message.
    fn take_latched(&mut self) -> Option<Instant> {
        None
    }

    /// Number of messages skipped because they did not consist of exactly one frame.
    fn malformed(&self) -> u64 {
        0
    }

    /// Acknowledges the oldest `count` messages that were returned and not acknowledged yet: each to the sender that it
    /// came from, unless that has disconnected since. Only for an end with [`Endpoint::deferred`]; a transport without
    /// acknowledgements does nothing, which is the default.
    fn acknowledge(&mut self, count: u64) {
        let _acknowledges_by_itself = count;
    }

    /// Returns true if a sender has asked since the last call to have everything acknowledged that it has sent, as a flush
    /// does. Only an end with [`Endpoint::deferred`] does; ask it after [`poll_recv`](Self::poll_recv).
    fn take_acknowledgement_request(&mut self) -> bool {
        false
    }

    /// Tells how many of the messages that were returned wait in the gate's queue, for [`Link::not_received`]: the program
    /// has received the others, or the queue has dropped them. Called after an event, when no message waits any more, and as
    /// long as it returns true for each message that leaves the queue: because a sender waits to be told. So it must be cheap.
    fn note_waiting(&mut self, cx: &mut Context<'_>, waiting: u64) -> bool {
        let _does_not_tell_its_senders = (cx, waiting);
        false
    }

    /// Tells that the message returned last was dropped at once, because the gate's queue was full: the messages that wait
    /// are older than it.
    fn note_dropped(&mut self) {}

    /// Acknowledges everything that the program has received, because it will receive no more over this end.
    fn acknowledge_last(&mut self) {}

    /// Asks all senders to send nothing more to this end, which is about to be dropped: what they have not sent stays with
    /// them and is not lost. Only for an end with [`Endpoint::deferred`].
    fn finish(&mut self) {}

    /// Returns true if every connected sender has done what [`finish`](Self::finish) asks, and
    /// [`poll_recv`](Self::poll_recv) has returned all that was sent before. Ask after that returned `Pending`; its waker is
    /// used when this changes. A sender of an older release never does.
    fn is_finished(&self) -> bool {
        true
    }

    /// A receiving call begins: what senders said before it does not count for
    /// [`poll_caught_up`](Self::poll_caught_up).
    fn forget_answers(&mut self) {}

    /// Ready when each sender has said, since [`forget_answers`](Self::forget_answers), that it has nothing newer than
    /// what [`poll_recv`](Self::poll_recv) returned. The answer of one counts until all have answered. Asks senders
    /// that may hold messages back; call it after `poll_recv` returned `Pending`, and `poll_recv` again after it is
    /// ready.
    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let _cannot_be_behind = cx;
        Poll::Ready(())
    }

    /// Fetches what has arrived from the operating system without help from a runtime, so that the next `poll_recv`
    /// returns it. For an end with [`Endpoint::newest_only`], waits up to `within` for what the sender holds back.
    fn catch_up(&mut self, within: Duration) {
        let _always_caught_up = within;
    }

    /// Waits on the calling thread, without a runtime, until something has arrived, at most `within`; the next poll
    /// handles it. Returns false if nothing has, or at once if this end cannot wait so: that is the default.
    fn wait(&mut self, within: Duration) -> bool {
        let _cannot = within;
        false
    }

    /// Why this end does not connect to the peer that is listening, if its [`Endpoint::check`] refused it.
    fn refusal(&self) -> Option<String> {
        None
    }
}

/// What comes back to a [`Requester`].
#[derive(Debug)]
pub enum Answer {
    /// A reply and the number of the request it belongs to, which may be an old one.
    Reply {
        /// The number given to [`Requester::request`].
        id: u64,
        /// The reply.
        body: Bytes,
    },
    /// The replier has refused a request: it will not be answered.
    Refused {
        /// The number given to [`Requester::request`].
        id: u64,
    },
    /// The connection broke; requests sent over it will not be answered.
    Lost,
}

/// A requesting end.
pub trait Requester: Send {
    /// Ready when the replier is connected. Reconnects by itself. Replies to earlier requests are discarded, so it is not
    /// called while one is awaited.
    fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<()>;

    /// Sends a request under a number; its reply carries the number back. As many requests as
    /// [`Endpoint::in_flight`] says may be without a reply.
    ///
    /// # Errors
    /// The body, if the replier is not connected, or there is no room for another request now.
    fn request(&mut self, cx: &mut Context<'_>, id: u64, body: Bytes) -> Result<(), Bytes>;

    /// Returns true if the replier is connected, as far as is known without asking.
    fn is_connected(&self) -> bool;

    /// Returns the next reply, or reports that the connection broke.
    fn poll_answer(&mut self, cx: &mut Context<'_>) -> Poll<Answer>;

    /// Waits on the calling thread, without a runtime, until something has arrived, at most `within`; the next poll
    /// handles it. Returns false if nothing has, or at once if this end cannot wait so: that is the default.
    fn wait(&mut self, within: Duration) -> bool {
        let _cannot = within;
        false
    }

    /// Why this end does not connect to the peer that is listening, if its [`Endpoint::check`] refused it.
    fn refusal(&self) -> Option<String> {
        None
    }
}

/// A request that has arrived, with the way back to its requester.
pub struct IncomingRequest {
    /// The request.
    pub body: Bytes,
    /// What [`ReplyPath::reply`] needs to address the requester.
    pub envelope: Bytes,
    /// The connection to the requester.
    pub path: Arc<dyn ReplyPath>,
}

/// The connection back to a requester.
pub trait ReplyPath: Send + Sync {
    /// Sends a reply.
    ///
    /// # Errors
    /// The requester has disconnected, or the replying end was dropped.
    fn reply(&self, envelope: &Bytes, body: Bytes) -> Result<(), RequesterGone>;

    /// Tells the requester, if the transport can, that its request will not be answered, because it could not be decoded
    /// for example: see [`Answer::Refused`]. By default it is told nothing, and waits until its timeout.
    fn refuse(&self, envelope: &Bytes) {
        let _cannot = envelope;
    }
}

/// The requester disconnected before it was answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RequesterGone;

/// A replying end.
pub trait Replier: Send {
    /// Returns the next request, and continues writing replies. Requests that do not consist of exactly one frame are
    /// counted and skipped.
    ///
    /// An implementation reads at most a bounded number of requests ahead.
    fn poll_request(&mut self, cx: &mut Context<'_>) -> Poll<IncomingRequest>;

    /// Accepts requesters and continues writing replies without returning a request. Returns true if everything sent
    /// has been handed to the operating system.
    fn drive(&mut self, cx: &mut Context<'_>) -> bool;

    /// Number of connected requesters.
    fn peers(&self) -> usize;

    /// Number of messages skipped because they were not a request of one frame.
    fn malformed(&self) -> u64 {
        0
    }

    /// Prepares for calls without a runtime, as [`Sender::detach`] does.
    fn detach(&mut self) {}
}

/// An end could not be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TransportError {
    /// The endpoint could not be created in the runtime folder.
    #[error(transparent)]
    RuntimeDir(#[from] crate::runtime_dir::RuntimeDirError),
    /// The transport refused.
    #[error("the transport cannot open `{endpoint}`: {reason}")]
    Refused {
        /// The endpoint's name.
        endpoint: String,
        /// The reason it gave.
        reason: String,
    },
}
