//! Receiving ends of messages, and taps.

use bytes::Bytes;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// The listening end of a tap. Observers come and go; none of them ever delays the gate.
pub trait Tap: Send {
    /// Accepts observers and continues writing. Returns true if at least one is connected; only then is it worth
    /// calling [`observe`](Self::observe). An observer that learns during this call that it is connected is shown
    /// everything from now on: what is sent meanwhile comes after this call.
    fn drive(&mut self, cx: &mut Context<'_>) -> bool;

    /// Sends a message of two frames, `payload` and `meta`, to each observer, or drops it for those that read slowly.
    fn observe(&mut self, cx: &mut Context<'_>, payload: &Bytes, meta: &[u8]);

    /// Keeps a message for each observer that joins from now on, in place of the one kept before. Only at a latched
    /// gate.
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
    /// [`poll_recv`](Self::poll_recv) while there is no room for another message, so that a peer that starts now is not
    /// kept waiting. The default does nothing, for transports that connect without being called.
    fn connect(&mut self, cx: &mut Context<'_>) {
        let _connects_by_itself = cx;
    }

    /// Number of connected peers: for a listening end, those that have completed the handshake.
    fn peers(&self) -> usize;

    /// Returns true if a connected sender waits instead of dropping messages: then the receiving gate takes in no more
    /// than its queue holds, whatever that queue would do when it is full.
    fn is_lossless(&self) -> bool {
        false
    }

    /// Returns true if a connected sender has announced [`Endpoint::latched`](super::Endpoint::latched); only then is
    /// it worth calling [`take_latched`](Self::take_latched).
    fn is_latched(&self) -> bool {
        false
    }

    /// When the message returned last was sent, if the sender had sent it before this end joined, as
    /// [`Link::send_latched`](super::Link::send_latched) does. Ask at once: the answer is forgotten with the next
    /// message.
    fn take_latched(&mut self) -> Option<Instant> {
        None
    }

    /// Number of messages skipped because they did not consist of exactly one frame.
    fn malformed(&self) -> u64 {
        0
    }

    /// Acknowledges the oldest `count` messages that were returned and not acknowledged yet: each to the sender that it
    /// came from, unless that has disconnected since. Only for an end with
    /// [`Endpoint::deferred`](super::Endpoint::deferred); a transport without acknowledgements does nothing, which is
    /// the default.
    fn acknowledge(&mut self, count: u64) {
        let _acknowledges_by_itself = count;
    }

    /// Returns true if a sender has asked since the last call to have everything acknowledged that it has sent, as a
    /// flush does. Only an end with [`Endpoint::deferred`](super::Endpoint::deferred) does; ask it after
    /// [`poll_recv`](Self::poll_recv).
    fn take_acknowledgement_request(&mut self) -> bool {
        false
    }

    /// Tells how many of the messages that were returned wait in the gate's queue, for
    /// [`Link::not_received`](super::Link::not_received): the program has received the others, or the queue has dropped
    /// them. Called after an event, when no message waits any more, and as long as it returns true for each message
    /// that leaves the queue: because a sender waits to be told. So it must be cheap.
    fn note_waiting(&mut self, cx: &mut Context<'_>, waiting: u64) -> bool {
        let _does_not_tell_its_senders = (cx, waiting);
        false
    }

    /// Tells that the message returned last was dropped at once, because the gate's queue was full: the messages that
    /// wait are older than it.
    fn note_dropped(&mut self) {}

    /// Acknowledges everything that the program has received, because it will receive no more over this end.
    fn acknowledge_last(&mut self) {}

    /// Asks all senders to send nothing more to this end, which is about to be dropped: what they have not sent stays
    /// with them and is not lost. Only for an end with [`Endpoint::deferred`](super::Endpoint::deferred).
    fn finish(&mut self) {}

    /// Returns true if every connected sender has done what [`finish`](Self::finish) asks, and
    /// [`poll_recv`](Self::poll_recv) has returned all that was sent before. Ask after that returned `Pending`; its
    /// waker is used when this changes. A sender of an older release never does.
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
    /// returns it. For an end with [`Endpoint::newest_only`](super::Endpoint::newest_only), waits up to `within` for
    /// what the sender holds back.
    fn catch_up(&mut self, within: Duration) {
        let _always_caught_up = within;
    }

    /// Waits on the calling thread, without a runtime, until something has arrived, at most `within`; the next poll
    /// handles it. Returns false if nothing has, or at once if this end cannot wait so: that is the default.
    fn wait(&mut self, within: Duration) -> bool {
        let _cannot = within;
        false
    }

    /// Why this end does not connect to the peer that is listening, if its [`Endpoint::check`](super::Endpoint::check)
    /// refused it.
    fn refusal(&self) -> Option<String> {
        None
    }
}
