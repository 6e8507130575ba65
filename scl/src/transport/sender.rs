//! Sending ends of messages, and the links to their peers.

use super::{Frame, Loan};
use std::collections::VecDeque;
use std::hash::{BuildHasher, RandomState};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// A sending end: the listening end of a `pub` connection, or a connecting `push` end.
pub trait Sender: Send {
    /// Accepts peers or connects to one, and returns the next that is ready to receive.
    ///
    /// A connecting end connects again once the link it returned before has been dropped; call this again after
    /// dropping one.
    fn poll_peer(&mut self, cx: &mut Context<'_>) -> Poll<Peer>;

    /// Returns why [`Endpoint::check`](super::Endpoint::check) refused the peer that is listening, if it did.
    fn refusal(&self) -> Option<String> {
        None
    }

    /// Prepares for calls without a runtime: from now on every call asks the operating system directly and registers no
    /// waker.
    fn detach(&mut self) {}
}

/// A peer that has connected to a [`Sender`].
pub struct Peer {
    /// What kind of peer it is.
    pub kind: PeerKind,
    /// The connection to the peer.
    pub link: Box<dyn Link>,
}

/// The kind of a peer that has connected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PeerKind {
    /// The component at the other end of the connection. A newer one replaces an older one.
    Component,
    /// A program that speaks the transport's protocol without SCL, such as a plain ZeroMQ subscriber.
    Foreign,
}

/// A live connection from a [`Sender`] to one peer. Dropping it disconnects.
pub trait Link: Send {
    /// Handles what the peer has sent, and continues writing. Pass the result to [`send_all`](Self::send_all), which
    /// must be called in the same turn even if the queue is empty.
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
    /// it has [caught up](super::Receiver::poll_caught_up).
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

    /// [`send`](Self::send) for a receiver that wants to know how old messages are: also tells it when this one was
    /// sent, if the peer understands that. The default sends only the message.
    fn send_timed(&mut self, cx: &mut Context<'_>, message: Frame, sent: Instant) -> Sent {
        let _the_peer_does_not_learn_it = sent;
        self.send(cx, message)
    }

    /// [`send_all`](Self::send_all) for such a receiver: `times` says when each message of the queue was sent, and
    /// loses those of the messages that leave it.
    fn send_all_timed(
        &mut self,
        cx: &mut Context<'_>,
        driven: Option<Driven>,
        queue: &mut VecDeque<Frame>,
        times: &mut VecDeque<Instant>,
        sent: &mut dyn FnMut(usize),
    ) {
        debug_assert_eq!(queue.len(), times.len(), "each message has its time");
        self.send_all(cx, driven, queue, sent);
        times.drain(..times.len() - queue.len());
    }

    /// Sends a message that was published `age` ago, before the peer joined, and tells the peer its age, if the peer
    /// understands that. The default sends only the message.
    fn send_latched(&mut self, cx: &mut Context<'_>, message: Frame, age: Duration) -> Sent {
        let _the_peer_does_not_learn_it = age;
        self.send(cx, message)
    }

    /// Returns true if the peer wants this message: a plain subscriber may have subscribed to other topics only.
    fn wants(&self, message: &[u8]) -> bool {
        let _wants_everything = message;
        true
    }

    /// Returns which end the peer is and how much it has taken before, if this end announced
    /// [`Endpoint::latched`](super::Endpoint::latched) and the peer reported it. A peer that reported nothing counts as
    /// new.
    fn resumed(&self) -> Option<Resumed> {
        None
    }

    /// Lends memory of `length` bytes, to be filled and passed to [`send`](Self::send), which sends it without a copy.
    /// Returns `None` if the link has no such memory, now or ever, or none for messages of this length. The gate then
    /// uses heap memory.
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

    /// Number of messages sent that the peer's program has not received yet, as far as the peer has reported: those
    /// that are [unacknowledged](Self::unacknowledged), and those that wait in the peer's gate. They count as lost if
    /// the link is dropped. The default is for a transport that cannot tell the two apart.
    fn not_received(&self) -> u64 {
        self.unacknowledged()
    }

    /// Reads, without a runtime, what the peer sent before it disconnected. Called before the link is dropped.
    fn read_last(&mut self) {}

    /// Asks the peer to acknowledge everything sent so far, and to report when its program has received it. The task is
    /// woken when the answer arrives.
    fn request_acknowledgement(&mut self, cx: &mut Context<'_>) {
        let _acknowledges_nothing = cx;
    }

    /// Prepares for calls without a runtime, as [`Sender::detach`] does. The connection is about to be closed, so
    /// messages are sent without regard to the peer's window.
    fn detach(&mut self) {}
}

/// What a receiving end reports about itself when it connects, or reconnects, to a latched publisher.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resumed {
    /// A unique number of the receiving end. A program that restarts gets a new one.
    pub end: u64,
    /// Number of messages that this end has taken over its earlier connections.
    pub taken: u64,
}

impl Resumed {
    /// Creates a new end, which has taken nothing yet, with a number that is unique across processes, but not
    /// cryptographically random.
    pub fn new_end() -> Self {
        Self { end: RandomState::new().hash_one(std::process::id()), taken: 0 }
    }
}

/// Proof that [`Link::drive`] was called in this turn. The waiting messages must now be offered with
/// [`Link::send_all`], in which a link that gathers short messages writes those that it has returned as
/// [`Sent::Deferred`].
#[derive(Debug, Default)]
#[must_use = "give it to `send_all` in the same turn, even if the queue is empty"]
pub struct Driven(());

/// What a [`Link`] did with a message. A message that comes back is unchanged, or has become bytes with the same
/// content.
#[derive(Debug)]
#[must_use = "a message that comes back was not sent"]
pub enum Sent {
    /// The message is on its way.
    Sent,
    /// The peer cannot take it now. The task is woken when it can.
    Full(Frame),
    /// The message is to be written together with those that follow: offer it with [`Link::send_all`] when the task is
    /// woken.
    Deferred(Frame),
    /// The peer is gone. The task is woken, and the next [`Link::drive`] fails.
    Gone(Frame),
}

impl Sent {
    /// Returns the message if it was not sent.
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
