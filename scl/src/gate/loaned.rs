//! Messages written in place, into memory that a connection lends.

use super::exceeded;
use super::fanout::{Fanout, Outbound};
use crate::error::{LoanError, SendError, SendTimeoutError, TrySendError};
use crate::transport::Loan;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};
use std::time::Duration;

/// A message that is written in place and then sent, see [`Pub::loan`](super::Pub::loan) and
/// [`Pub::loan_bytes`](super::Pub::loan_bytes).
///
/// The memory is that of a connected peer if the transport has some to lend, as shared memory has, and from the heap
/// otherwise; the program need not care. Dropping the message sends nothing and gives the memory back.
///
/// The initial content is unspecified: zeros, or parts of older messages. Write all of it.
#[must_use = "a message that is dropped is not sent"]
pub struct Loaned<'a, T: ?Sized> {
    fanout: &'a mut Fanout,
    memory: Loan,
    /// The connection that lent the memory; `None` if it is from the heap.
    lender: Option<usize>,
    message: PhantomData<fn() -> T>,
}

impl<'a, T: ?Sized> Loaned<'a, T> {
    /// Creates a message of `length` bytes for the peers of a gate.
    pub(super) fn new(fanout: &'a mut Fanout, length: usize, alignment: usize) -> Result<Self, LoanError> {
        let gate = fanout.name;
        fanout.state.check().map_err(|source| LoanError::Blocking { gate, source })?;
        if let Some((peer, size, limit)) = exceeded(fanout.strictest, length) {
            return Err(LoanError::TooLong { gate, peer, size, limit });
        }
        // In a program without async, the runtime may not have run since the peer connected.
        fanout.state.take_turn();
        let (memory, lender) = fanout.lend(length, alignment);
        Ok(Self { fanout, memory, lender, message: PhantomData })
    }

    /// Sends the message, as [`Pub::send`](super::Pub::send) does.
    ///
    /// The peer that lent the memory gets it without a copy. Any other recipient gets a copy: the other peers of the
    /// gate, which share one, and a peer whose connection was replaced since.
    ///
    /// # Errors
    /// Those of `send`, except `Encode` and `TooLong`.
    ///
    /// # Cancel safety
    /// If this is dropped while it waits, the message is sent to no peer, and the memory is given back.
    pub async fn send(self) -> Result<(), SendError> {
        let (fanout, message) = self.into_parts();
        let message = fanout.accept(|| Ok(message))?;
        fanout.send(message).await
    }

    /// [`send`](Self::send) from a plain thread.
    ///
    /// # Errors
    /// Those of `send`, and [`SendError::Blocking`] inside async code or after a stop request.
    pub fn send_blocking(self) -> Result<(), SendError> {
        let (fanout, message) = self.into_parts();
        fanout.send_blocking(|| Ok(message))
    }

    /// [`send_blocking`](Self::send_blocking) with a time limit.
    ///
    /// # Errors
    /// [`SendTimeoutError::Timeout`] if a queue was still full after `timeout`; the message is dropped then. Otherwise
    /// those of `send_blocking`.
    pub fn send_timeout(self, timeout: Duration) -> Result<(), SendTimeoutError> {
        let (fanout, message) = self.into_parts();
        fanout.send_timeout(|| Ok(message), timeout)
    }

    /// Sends without waiting.
    ///
    /// # Errors
    /// [`TrySendError::Full`] if `send` would wait; the message is dropped then. Otherwise those of
    /// [`send_blocking`](Self::send_blocking).
    pub fn try_send(self) -> Result<(), TrySendError> {
        let (fanout, message) = self.into_parts();
        fanout.try_send(|| Ok(message))
    }

    fn into_parts(self) -> (&'a mut Fanout, Outbound) {
        let message = match self.lender {
            Some(lender) => Outbound::Loan(self.memory, lender),
            None => Outbound::Bytes(self.memory.into_bytes()),
        };
        (self.fanout, message)
    }
}

impl Deref for Loaned<'_, [u8]> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        self.memory.as_slice()
    }
}

impl DerefMut for Loaned<'_, [u8]> {
    fn deref_mut(&mut self) -> &mut [u8] {
        self.memory.as_mut_slice()
    }
}

#[cfg(feature = "raw")]
impl<T: zerocopy::FromBytes + zerocopy::KnownLayout + zerocopy::Immutable> Deref for Loaned<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        T::ref_from_bytes(self.memory.as_slice()).unwrap_or_else(|_| unreachable!("{FITS}"))
    }
}

#[cfg(feature = "raw")]
impl<T: zerocopy::FromBytes + zerocopy::IntoBytes + zerocopy::KnownLayout + zerocopy::Immutable> DerefMut
    for Loaned<'_, T>
{
    fn deref_mut(&mut self) -> &mut T {
        T::mut_from_bytes(self.memory.as_mut_slice()).unwrap_or_else(|_| unreachable!("{FITS}"))
    }
}

/// Length and alignment were checked when the memory was lent, and a transport must not change them.
#[cfg(feature = "raw")]
const FITS: &str = "the transport moved memory that it had lent";

impl<T: ?Sized> std::fmt::Debug for Loaned<'_, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Loaned")
            .field("gate", &self.fanout.name.to_string())
            .field("length", &self.memory.len())
            .finish()
    }
}
