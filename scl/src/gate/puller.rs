//! The `pull` gate.

use super::GateStats;
use super::incoming::Incoming;
use super::receiving_gate::receiving_gate;
#[cfg(feature = "raw")]
use super::view::View;
use crate::error::{RecvError, RecvTimeoutError};
use std::time::Duration;

/// Receives messages from any number of `push` gates, in order of arrival.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// fn main(mut recorder: Recorder) -> scl::Result<()> {
///     loop {
///         println!("{} m/s", recorder.log.recv_blocking()?.speed);
///     }
/// }
/// ```
pub struct Pull<T> {
    pub(crate) incoming: Incoming<T>,
}

impl<T> Pull<T> {
    /// Waits for the next message.
    ///
    /// The gate's `queue` applies to what has arrived. With `queue: 1` this is always the newest message, also after a
    /// pause: a sender that may hold a newer one is asked for it.
    ///
    /// # Errors
    /// [`RecvError::Decode`] if the codec cannot read a message and the gate declares `undecodable: fail`; the next
    /// call returns the next message. By default such a message is skipped.
    ///
    /// # Cancel safety
    /// Cancel safe: no message is lost if this is dropped before it is ready.
    pub async fn recv(&mut self) -> Result<T, RecvError> {
        self.incoming.recv().await
    }

    /// [`recv`](Self::recv) from a plain thread.
    ///
    /// # Errors
    /// Those of `recv`, and [`RecvError::Blocking`] inside async code or after a stop request.
    pub fn recv_blocking(&mut self) -> Result<T, RecvError> {
        self.incoming.recv_blocking()
    }

    /// [`recv_blocking`](Self::recv_blocking) with a time limit.
    ///
    /// # Errors
    /// Those of `recv_blocking`, and [`RecvTimeoutError::Timeout`] if no message arrived in time.
    pub fn recv_timeout(&mut self, timeout: Duration) -> Result<T, RecvTimeoutError> {
        self.incoming.recv_timeout(timeout)
    }

    /// Returns the next message if one has arrived.
    ///
    /// It does not wait for new messages. Only at a gate with `queue: 1`, after a pause, it may take up to 10 ms
    /// (usually some microseconds) to fetch a newer message that the sender holds back.
    ///
    /// # Errors
    /// Those of `recv`, and [`RecvError::Blocking`] after a stop request.
    pub fn try_recv(&mut self) -> Result<Option<T>, RecvError> {
        self.incoming.try_recv()
    }

    /// Returns the newest message that has arrived and can be decoded, if any, and discards the older ones. It waits no
    /// longer than [`try_recv`](Self::try_recv).
    ///
    /// # Errors
    /// Those of `try_recv`.
    pub fn latest(&mut self) -> Result<Option<T>, RecvError> {
        self.incoming.latest()
    }

    /// Waits until the gate has missed a message: its `deadline` has passed without one. Returns how many it has missed
    /// since the last time, of all senders together, see [`GateStats::missed`]. Each is told once, here or by
    /// [`take_missed`](Self::take_missed).
    ///
    /// See [`Sub::deadline_missed`](super::Sub::deadline_missed) for an example.
    ///
    /// The future does not borrow the gate, which can receive meanwhile, and does not keep the component open. Make it
    /// before that of `recv`, which borrows the gate.
    ///
    /// While it waits it has a timer of the operating system, so a loop with hundreds of rounds a second keeps it from
    /// round to round (`std::pin::pin!`) and makes another one only when it was ready. Real time counts, also in a test
    /// that pauses tokio's clock.
    ///
    /// # Errors
    /// [`RecvError::NoDeadline`] if the gate declares no `deadline`, [`RecvError::Timer`] if the process has no file
    /// descriptor left, and [`RecvError::Blocking`] once the gate or its component is closed.
    ///
    /// # Cancel safety
    /// Cancel safe: what was missed is told by the next call if this is dropped before it is ready.
    pub fn deadline_missed(&self) -> impl Future<Output = Result<u64, RecvError>> + Send + use<T> {
        self.incoming.deadline_missed()
    }

    /// Returns how many messages the gate has missed since the last time, and does not wait: for a program without
    /// async. Each is told once, here or by [`deadline_missed`](Self::deadline_missed).
    ///
    /// # Errors
    /// [`RecvError::NoDeadline`] if the gate declares no `deadline`, and [`RecvError::Blocking`] after a stop request.
    pub fn take_missed(&mut self) -> Result<u64, RecvError> {
        self.incoming.take_missed()
    }

    /// Returns true if at least one pusher is connected.
    pub fn is_connected(&self) -> bool {
        self.incoming.is_connected()
    }

    /// Returns the gate's counts.
    pub fn stats(&self) -> GateStats {
        self.incoming.stats()
    }
}

#[cfg(feature = "raw")]
impl<T: zerocopy::FromBytes + zerocopy::KnownLayout + zerocopy::Immutable> Pull<T> {
    /// Waits for the next message, and returns it where it arrived instead of a copy: for large messages, of a type
    /// with `codec: raw`.
    ///
    /// Bytes that are not aligned for the type are copied. Those of shared memory always are aligned.
    ///
    /// See [`Sub::recv_view`](super::Sub::recv_view) for an example.
    ///
    /// # Errors
    /// Those of [`recv`](Self::recv), and [`RecvError::NoViews`] if the gate's codec is not `raw`.
    ///
    /// # Cancel safety
    /// Cancel safe: no message is lost if this is dropped before it is ready.
    pub async fn recv_view(&mut self) -> Result<View<T>, RecvError> {
        self.incoming.recv_view().await
    }

    /// [`recv_view`](Self::recv_view) from a plain thread.
    ///
    /// # Errors
    /// Those of `recv_view`, and [`RecvError::Blocking`] inside async code or after a stop request.
    pub fn recv_view_blocking(&mut self) -> Result<View<T>, RecvError> {
        self.incoming.recv_view_blocking()
    }

    /// Returns the next message where it arrived, if one has; it waits no longer than [`try_recv`](Self::try_recv).
    ///
    /// # Errors
    /// Those of `recv_view`, and [`RecvError::Blocking`] after a stop request.
    pub fn try_recv_view(&mut self) -> Result<Option<View<T>>, RecvError> {
        self.incoming.try_recv_view()
    }
}

receiving_gate!(Pull);
