//! The `sub` gate.

use super::GateStats;
use super::incoming::Incoming;
use super::receiving_gate::receiving_gate;
#[cfg(feature = "raw")]
use super::view::View;
use crate::error::{RecvError, RecvTimeoutError};
use std::time::Duration;

/// Receives messages from one or several publishers, in order of arrival.
///
/// It connects to publishers that start later, and reconnects to those that restart.
///
/// ```no_run
/// scl::topology!("doc/rover.yaml");
///
/// #[scl::main]
/// async fn main(mut controller: Controller) -> scl::Result<()> {
///     loop {
///         println!("{} m/s", controller.sensor.recv().await?.speed);
///     }
/// }
/// ```
pub struct Sub<T> {
    pub(crate) incoming: Incoming<T>,
}

impl<T> Sub<T> {
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

    /// Returns how long ago the message that the last call returned was sent, if its publisher has `latched: true` and
    /// sent it before this gate was connected to it. Returns `None` for every message that arrived while connected, and
    /// before the first one.
    ///
    /// The age keeps growing until the next message is received.
    pub fn latched_age(&self) -> Option<Duration> {
        self.incoming.latched_age()
    }

    /// Returns true if all required peers are connected.
    pub fn is_connected(&self) -> bool {
        self.incoming.is_connected()
    }

    /// Returns the gate's counts.
    pub fn stats(&self) -> GateStats {
        self.incoming.stats()
    }
}

#[cfg(feature = "raw")]
impl<T: zerocopy::FromBytes + zerocopy::KnownLayout + zerocopy::Immutable> Sub<T> {
    /// Waits for the next message and returns a view of it in the memory in which it arrived, instead of a copy: for
    /// large messages, of a type with `codec: raw`.
    ///
    /// Bytes that are not aligned for the type are copied. Messages in shared memory are always aligned.
    ///
    /// ```no_run
    /// use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};
    ///
    /// #[derive(FromBytes, IntoBytes, KnownLayout, Immutable)]
    /// #[repr(C)]
    /// struct Image {
    ///     pixels: [[u8; 1920]; 1080],
    /// }
    ///
    /// scl::topology!("doc/survey.yaml");
    ///
    /// #[scl::main]
    /// fn main(mut detector: Detector) -> scl::Result<()> {
    ///     loop {
    ///         let image = detector.images.recv_view_blocking()?;
    ///         println!("{} bright pixels", image.pixels.as_flattened().iter().filter(|&&pixel| pixel > 127).count());
    ///     }
    /// }
    /// ```
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

    /// Returns a view of the next message if one has arrived. It waits no longer than [`try_recv`](Self::try_recv).
    ///
    /// # Errors
    /// Those of `recv_view`, and [`RecvError::Blocking`] after a stop request.
    pub fn try_recv_view(&mut self) -> Result<Option<View<T>>, RecvError> {
        self.incoming.try_recv_view()
    }
}

receiving_gate!(Sub);
