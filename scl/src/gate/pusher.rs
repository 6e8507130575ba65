//! The `push` gate.

use super::outgoing::Outgoing;
use super::sending_gate::sending_gate;
use super::{GateStats, Loaned, PeerStats};
use crate::error::{LoanError, SendError, SendTimeoutError, TrySendError};
use bytes::Bytes;
use std::time::Duration;

/// Sends messages to the `pull` gate that this gate is connected to.
///
/// With several pullers (`share: true`) each message goes to one of them: the next in turn that can take it.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(mut sensor: Sensor) -> scl::Result<()> {
///     sensor.log.send(&rover::Measurement { speed: 1.0 }).await?;
///     Ok(())
/// }
/// ```
pub struct Push<T> {
    pub(crate) outgoing: Outgoing<T>,
}

impl<T> Push<T> {
    /// Sends a message to a puller.
    ///
    /// The message is written to each peer's socket before this returns. If a peer has not taken the messages before
    /// (4096 of them, or 1 MiB, may be on their way), or is not connected, the message waits in that connection's
    /// queue, and everything that waits is written together as soon as the peer takes more. In a burst, after 64
    /// messages within a few milliseconds during which the runtime had no turn, messages of up to 4 KiB are gathered,
    /// too: they are written as soon as the program awaits something else, when it sends later, or 128 at a time.
    ///
    /// Only a gate with `backpressure: true` waits, for a peer with `when_full: wait` whose queue is full.
    ///
    /// # Errors
    /// [`SendError::Encode`] if the codec cannot express the message, [`SendError::TooLong`] if a peer does not accept
    /// messages of this length; the message was sent to no peer then.
    ///
    /// # Cancel safety
    /// Cancel safe: a message is sent over all connections at once, or, if this is dropped while it waits, over none.
    pub async fn send(&mut self, message: &T) -> Result<(), SendError> {
        self.outgoing.send(message).await
    }

    /// [`send`](Self::send) from a plain thread.
    ///
    /// # Errors
    /// Those of `send`, and [`SendError::Blocking`] inside async code or after a stop request.
    pub fn send_blocking(&mut self, message: &T) -> Result<(), SendError> {
        self.outgoing.send_blocking(message)
    }

    /// [`send_blocking`](Self::send_blocking) with a time limit, which is exact to a millisecond. With
    /// [`Duration::ZERO`] it checks once whether there is room.
    ///
    /// # Errors
    /// [`SendTimeoutError::Timeout`] if a queue was still full after `timeout`; the message was sent to no peer then,
    /// and will not be. Otherwise those of `send_blocking`.
    pub fn send_timeout(&mut self, message: &T, timeout: Duration) -> Result<(), SendTimeoutError> {
        self.outgoing.send_timeout(message, timeout)
    }

    /// Sends without waiting.
    ///
    /// # Errors
    /// [`TrySendError::Full`] if `send` would wait; the message was sent to no peer then. Otherwise those of
    /// [`send_blocking`](Self::send_blocking).
    pub fn try_send(&mut self, message: &T) -> Result<(), TrySendError> {
        self.outgoing.try_send(message)
    }

    /// Returns true if all required peers are connected.
    pub fn is_connected(&self) -> bool {
        self.outgoing.fanout.missing().is_empty()
    }

    /// Waits until a puller has connected or disconnected since the last call, or since the gate was opened, and
    /// returns how many are connected now. Several changes in a row are reported as one.
    ///
    /// A peer that is killed disconnects at once; one that is merely stopped stays connected.
    ///
    /// ```no_run
    /// # scl::topology!("doc/rover.yaml");
    /// # async fn wait(mut sensor: Sensor) {
    /// while sensor.log.peers_changed().await > 0 {}
    /// println!("no peer is left");
    /// # }
    /// ```
    ///
    /// # Cancel safety
    /// Cancel safe: a change that was not reported is reported by the next call.
    pub async fn peers_changed(&mut self) -> usize {
        self.outgoing.fanout.peers_changed().await
    }

    /// Returns the gate's counts.
    pub fn stats(&self) -> GateStats {
        self.outgoing.fanout.stats()
    }

    /// Returns what became of the messages of each connection, in the order of the topology file.
    pub fn peer_stats(&self) -> Vec<PeerStats> {
        self.outgoing.fanout.peer_stats()
    }
}

#[cfg(feature = "raw")]
impl<T> Push<T>
where
    T: zerocopy::FromBytes + zerocopy::IntoBytes + zerocopy::KnownLayout + zerocopy::Immutable,
{
    /// Lends memory for one message, to be written in place and sent: for large messages, of a type with `codec: raw`.
    ///
    /// On a transport with shared memory, and with a view at the receiver
    /// ([`Pull::recv_view`](super::Pull::recv_view)), the message is never copied. Everywhere else the memory is from
    /// the heap, which still saves the copy that [`send`](Self::send) makes.
    ///
    /// See [`Pub::loan`](super::Pub::loan) for an example.
    ///
    /// # Errors
    /// [`LoanError::Codec`] if the gate's codec is not `raw`, [`LoanError::TooLong`] if a peer does not accept messages
    /// of this length, [`LoanError::Blocking`] if the gate cannot be used any more.
    pub fn loan(&mut self) -> Result<Loaned<'_, T>, LoanError> {
        self.outgoing.loan::<crate::codec::Raw, T>(size_of::<T>(), align_of::<T>())
    }
}

impl Push<Bytes> {
    /// Lends memory of `length` bytes for one message, to be written in place and sent.
    ///
    /// # Errors
    /// [`LoanError::TooLong`] if a peer does not accept messages of this length, [`LoanError::Blocking`] if the gate
    /// cannot be used any more, [`LoanError::Codec`] if the gate has a type and its codec is not plain bytes.
    pub fn loan_bytes(&mut self, length: usize) -> Result<Loaned<'_, [u8]>, LoanError> {
        self.outgoing.loan::<crate::codec::Opaque, [u8]>(length, 1)
    }
}

sending_gate!(Push);
