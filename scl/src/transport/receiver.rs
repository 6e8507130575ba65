//! Receiving ends of messages, and taps.

use bytes::Bytes;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// The listening end of a tap. Observers come and go; none of them ever delays the gate.
pub trait Tap: Send {
    /// Accepts observers and continues writing. Returns true if at least one is connected; only then is it worth
    /// calling [`observe`](Self::observe). An observer that learns during this call that it is connected is shown every
    /// message from then on: messages sent during this call are observed after it.
    fn drive(&mut self, cx: &mut Context<'_>) -> bool;

    /// Sends a message of two frames, `payload` and `meta`, to each observer, or drops it for those that read slowly.
    fn observe(&mut self, cx: &mut Context<'_>, payload: &Bytes, meta: &[u8]);

    /// Keeps a message for each observer that joins from now on, replacing the one kept before. Called only for a
    /// latched gate.
    fn latch(&mut self, payload: &Bytes, meta: &[u8]) {
        let _keeps_nothing = (payload, meta);
    }

    /// Number of messages dropped so far for slow observers; a message counts once for each observer that misses it.
    fn dropped(&self) -> u64;
}

/// A receiving end: `sub` has one per publisher, `pull` one per gate.
pub trait Receiver: Send {
    /// Returns the next message. Reconnects by itself. Messages that do not consist of exactly one frame are counted
    /// and skipped.
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes>;

    /// Connects to a peer, or accepts new peers, without taking in messages. Called instead of
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

    /// Returns when the message returned last was sent, if the sender had published it before this end joined, and sent
    /// it with [`Link::send_latched`](super::Link::send_latched). Call it right after [`poll_recv`](Self::poll_recv):
    /// the next message replaces the answer.
    fn take_latched(&mut self) -> Option<Instant> {
        None
    }

    /// Returns when the message returned last was sent, if its sender has told that, see
    /// [`Link::send_timed`](super::Link::send_timed). Call it right after [`poll_recv`](Self::poll_recv).
    fn take_sent(&mut self) -> Option<Instant> {
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

    /// Returns true if, since the last call, a sender has requested an acknowledgement of everything that it has sent,
    /// as a flush does. Only for an end with [`Endpoint::deferred`](super::Endpoint::deferred); call it after
    /// [`poll_recv`](Self::poll_recv).
    fn take_acknowledgement_request(&mut self) -> bool {
        false
    }

    /// Reports how many of the returned messages wait in the gate's queue, for
    /// [`Link::not_received`](super::Link::not_received): the program has received the others, or the queue has dropped
    /// them. Called after an event and when the queue becomes empty. If it returns true, because a sender waits for
    /// this number, it is called again for each message that leaves the queue, so it must be cheap.
    fn note_waiting(&mut self, cx: &mut Context<'_>, waiting: u64) -> bool {
        let _does_not_tell_its_senders = (cx, waiting);
        false
    }

    /// Reports that the message returned last was dropped at once, because the gate's queue was full: the messages that
    /// wait are older.
    fn note_dropped(&mut self) {}

    /// Acknowledges everything that the program has received, because it will receive no more over this end.
    fn acknowledge_last(&mut self) {}

    /// Asks all senders to send nothing more to this end, which is about to be dropped: what they have not sent stays
    /// with them and is not lost. Only for an end with [`Endpoint::deferred`](super::Endpoint::deferred).
    fn finish(&mut self) {}

    /// Returns true if every connected sender has complied with [`finish`](Self::finish), and
    /// [`poll_recv`](Self::poll_recv) has returned everything sent before. Call it after `poll_recv` has returned
    /// `Pending`, which registers the waker for a change of this result, too. A sender of an older release never
    /// complies.
    fn is_finished(&self) -> bool {
        true
    }

    /// Marks the start of a receiving call: earlier answers of senders no longer count for
    /// [`poll_caught_up`](Self::poll_caught_up).
    fn forget_answers(&mut self) {}

    /// Ready when each sender has answered, since [`forget_answers`](Self::forget_answers), that it has nothing newer
    /// than what [`poll_recv`](Self::poll_recv) returned. An answer stays valid until all senders have answered. Asks
    /// senders that may hold messages back. Call it after `poll_recv` has returned `Pending`, and call `poll_recv`
    /// again once it is ready.
    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let _cannot_be_behind = cx;
        Poll::Ready(())
    }

    /// Reads what has arrived directly from the operating system, without a runtime, so that the next `poll_recv`
    /// returns it. For an end with [`Endpoint::newest_only`](super::Endpoint::newest_only), waits up to `within` for
    /// what the sender holds back.
    fn catch_up(&mut self, within: Duration) {
        let _always_caught_up = within;
    }

    /// Blocks the calling thread, without a runtime, until something has arrived or `within` is over; the next poll
    /// handles what arrived. Returns false if nothing arrived, and at once if this end cannot wait like this, which is
    /// the default.
    fn wait(&mut self, within: Duration) -> bool {
        let _cannot = within;
        false
    }

    /// Returns why [`Endpoint::check`](super::Endpoint::check) refused the peer that is listening, if it did.
    fn refusal(&self) -> Option<String> {
        None
    }
}
